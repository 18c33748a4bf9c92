//! What a reader changed or left out.

use std::fmt;

use crate::Format;
use crate::error::Count;

/// Something a reader did that its caller may want to know.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Note {
    /// The content is of another format than the file name claims; the content decided.
    ExtensionContradicted {
        /// The format of the name, or the one asked for.
        claimed: Format,
        /// The format of the content.
        found: Format,
    },
    /// Facet corners at the same position became one vertex (STL).
    VerticesWelded {
        /// Facet corners in the file.
        before: usize,
        /// Vertices of the mesh.
        after: usize,
    },
    /// Facets that name a vertex twice after welding; they are kept (STL).
    DegenerateFacets {
        /// How many.
        count: usize,
    },
    /// Values after the three coordinates of a vertex: a weight, colours, a normal or a texture coordinate.
    VertexColumnsIgnored {
        /// Vertices with such values.
        count: usize,
    },
    /// Colours after the corners of a face (OFF).
    FaceColorsIgnored {
        /// Faces with such values.
        count: usize,
    },
    /// Vertex normals (`vn`) are not kept.
    NormalsIgnored {
        /// How many.
        count: usize,
    },
    /// Texture coordinates (`vt`) that no face uses are not kept.
    TextureCoordinatesUnused {
        /// How many.
        count: usize,
    },
    /// Some corners have no texture coordinate, so none are kept.
    TextureCoordinatesIncomplete {
        /// Corners without one.
        without: usize,
        /// All corners.
        corners: usize,
    },
    /// A texture coordinate is not finite, so none are kept.
    TextureCoordinatesNotFinite {
        /// Its line.
        line: usize,
    },
    /// Properties of a PLY element that are not kept.
    PropertiesIgnored {
        /// The element.
        element: String,
        /// Its properties that were skipped.
        names: Vec<String>,
    },
    /// Elements that are not part of a surface, such as points, curves or PLY edges.
    ElementsIgnored {
        /// What they are.
        kind: String,
        /// How many.
        count: usize,
    },
    /// Lines whose keyword is not one of OBJ.
    UnknownKeywords {
        /// How many lines.
        count: usize,
        /// The first of them.
        first_line: usize,
        /// Its keyword, shortened and escaped.
        keyword: String,
    },
    /// Bytes after the last facet of a binary STL.
    TrailingBytes {
        /// How many.
        count: usize,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ExtensionContradicted { claimed, found } => {
                write!(f, "taken for {claimed}, but the content is {found}; read as {found}")
            }
            Self::VerticesWelded { before, after } => {
                write!(
                    f,
                    "{before} facet corners welded by exact position into {}",
                    Count(*after, "vertex")
                )
            }
            Self::DegenerateFacets { count } => {
                write!(f, "{} with a repeated vertex after welding", Count(*count, "facet"))
            }
            Self::VertexColumnsIgnored { count } => write!(
                f,
                "extra values (weight, colour, normal or texture coordinate) ignored on {}",
                Count(*count, "vertex")
            ),
            Self::FaceColorsIgnored { count } => {
                write!(f, "colours ignored on {}", Count(*count, "face"))
            }
            Self::NormalsIgnored { count } => {
                write!(f, "{} ignored", Count(*count, "vertex normal"))
            }
            Self::TextureCoordinatesUnused { count } => {
                write!(f, "{} ignored: no face uses them", Count(*count, "texture coordinate"))
            }
            Self::TextureCoordinatesIncomplete { without, corners } => {
                write!(
                    f,
                    "texture coordinates ignored: {without} of {corners} face corners have none"
                )
            }
            Self::TextureCoordinatesNotFinite { line } => {
                write!(f, "texture coordinates ignored: line {line} has one that is not finite")
            }
            Self::PropertiesIgnored { element, names } => {
                const SHOWN: usize = 12;
                let shown = &names[..names.len().min(SHOWN)];
                write!(f, "{element} properties ignored: {}", shown.join(", "))?;
                match names.len() - shown.len() {
                    0 => Ok(()),
                    more => write!(f, " and {more} more"),
                }
            }
            Self::ElementsIgnored { kind, count } => write!(f, "{} ignored", Count(*count, kind)),
            Self::UnknownKeywords { count, first_line, keyword } => write!(
                f,
                "{} with an unknown keyword ignored, the first is {keyword} in line {first_line}",
                Count(*count, "line")
            ),
            Self::TrailingBytes { count } => {
                write!(f, "{} after the last facet ignored", Count(*count, "byte"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_are_sentences() {
        let note = Note::ExtensionContradicted { claimed: Format::Off, found: Format::Obj };
        assert_eq!(note.to_string(), "taken for OFF, but the content is OBJ; read as OBJ");
        let note = Note::VerticesWelded { before: 576, after: 96 };
        assert_eq!(note.to_string(), "576 facet corners welded by exact position into 96 vertices");
        let note =
            Note::PropertiesIgnored { element: "vertex".into(), names: vec!["red".into(); 20] };
        assert!(note.to_string().ends_with("red, red and 8 more"), "{note}");
        let note = Note::ElementsIgnored { kind: "point".into(), count: 1 };
        assert_eq!(note.to_string(), "1 point ignored");
    }
}
