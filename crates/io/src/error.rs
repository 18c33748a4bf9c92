//! What can be wrong with a mesh file.

use std::fmt;
use std::io;

/// A mesh file that cannot be read: which file, where in it, and why.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[error("{name}{}: {kind}", Place(*.position))]
pub struct ReadError {
    /// The file name, as given by the caller.
    pub name: String,
    /// Where the fault is, if it has a place.
    pub position: Option<Position>,
    /// What is wrong.
    pub kind: ReadErrorKind,
}

impl ReadError {
    /// The line of the fault, counted from 1, for faults in text.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        match self.position? {
            Position::Line(line) => Some(line),
            Position::Byte(_) => None,
        }
    }

    /// The offset of the fault, counted from 0, for faults in binary data.
    #[must_use]
    pub fn byte(&self) -> Option<usize> {
        match self.position? {
            Position::Line(_) => None,
            Position::Byte(byte) => Some(byte),
        }
    }
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Position {
    /// A line of text, counted from 1.
    Line(usize),
    /// A byte, counted from 0.
    Byte(usize),
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// Writes a place after a file name.
struct Place(Option<Position>);

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |position| write!(f, ", {position}"))
    }
}

/// What is wrong with a mesh file. Quoted parts of the file are shortened and escaped.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadErrorKind {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Io(io::Error),
    /// Neither the name nor the content tells the format.
    #[error(
        "the format is not known (OBJ, OFF, PLY, STL and glTF are read); the content starts with {found}"
    )]
    UnknownFormat {
        /// The first bytes.
        found: String,
    },
    /// There is no mesh in the file.
    #[error("{0}")]
    Empty(Missing),
    /// The text or data does not follow the format.
    #[error("expected {expected}, found {found}")]
    Syntax {
        /// What the format asks for.
        expected: String,
        /// What is there.
        found: String,
    },
    /// An index names no element.
    #[error("{what} index {index} is out of range: {}", Range { what, index, count: *.count, base: *.base })]
    IndexOutOfRange {
        /// What the index refers to, such as `vertex`.
        what: &'static str,
        /// The index as written in the file.
        index: String,
        /// How many elements the file has; for a relative index, how many come before it.
        count: usize,
        /// The first valid index: 1 in OBJ, 0 elsewhere.
        base: usize,
    },
    /// A face with fewer than three corners.
    #[error("a face needs at least 3 corners, found {found}")]
    TooFewCorners {
        /// The number of corners.
        found: usize,
    },
    /// The file ends too early.
    #[error("the file ends too early: expected {expected}")]
    Truncated {
        /// What is missing.
        expected: String,
    },
    /// A coordinate is not a number, infinite, or too large for a double.
    #[error("expected a finite number, found {found}")]
    NonFinite {
        /// The number as written in the file.
        found: String,
    },
    /// The file holds more than its header announces.
    #[error("the header announces {announced}, but the file goes on with {found}")]
    CountMismatch {
        /// The counts of the header.
        announced: String,
        /// What follows.
        found: String,
    },
    /// The file is for another mesh.
    #[error("the file is for {found} {what}, and the mesh has {expected}")]
    OtherMesh {
        /// What is counted, such as `faces`.
        what: &'static str,
        /// Of the mesh.
        expected: usize,
        /// In the file.
        found: String,
    },
    /// A correct file of a kind that is not read.
    #[error("{what}")]
    Unsupported {
        /// What is not read, and what to do.
        what: String,
    },
    /// More vertices than 32-bit indices can name.
    #[error("more than 4294967295 vertices")]
    TooManyVertices,
}

/// What an empty mesh file lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// The file has no byte, or only blanks and comments.
    Content,
    /// There is no vertex.
    Vertices,
    /// There are vertices but no face.
    Faces {
        /// The number of vertices.
        vertices: usize,
    },
    /// There is no polyline.
    Lines,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Content => f.write_str("the file is empty"),
            Self::Vertices => f.write_str("the file has no vertices"),
            Self::Lines => f.write_str("the file has no `l` elements"),
            Self::Faces { vertices } => {
                write!(f, "the file has {} but no faces", Count(*vertices, "vertex"))
            }
        }
    }
}

/// Writes a number with its noun.
pub(crate) struct Count<'a>(pub(crate) usize, pub(crate) &'a str);

impl fmt::Display for Count<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.0, self.1) {
            (1, noun) => write!(f, "1 {noun}"),
            (count, "vertex") => write!(f, "{count} vertices"),
            (count, noun) => write!(f, "{count} {noun}s"),
        }
    }
}

/// Writes why an index is out of range.
struct Range<'a> {
    what: &'a str,
    index: &'a str,
    count: usize,
    base: usize,
}

impl fmt::Display for Range<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = Count(self.count, self.what);
        match (self.base, self.index) {
            (0, _) => write!(f, "the file has {count}, counted from 0"),
            (_, "0") => f.write_str("OBJ counts from 1"),
            (_, index) if index.starts_with('-') => {
                write!(f, "{count} {} it", if self.count == 1 { "precedes" } else { "precede" })
            }
            _ => write!(f, "the file has {count}"),
        }
    }
}

/// A fault before the file's name is known.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) position: Option<Position>,
    pub(crate) kind: ReadErrorKind,
}

/// The result of a step of a reader.
pub(crate) type Parsed<T> = Result<T, Fault>;

impl Fault {
    #[cold]
    pub(crate) fn at(position: Position, kind: ReadErrorKind) -> Self {
        Self { position: Some(position), kind }
    }

    #[cold]
    pub(crate) fn whole_file(kind: ReadErrorKind) -> Self {
        Self { position: None, kind }
    }

    #[cold]
    pub(crate) fn syntax(
        position: Position,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        Self::at(position, ReadErrorKind::Syntax { expected: expected.into(), found: found.into() })
    }

    #[cold]
    pub(crate) fn truncated(position: Position, expected: impl Into<String>) -> Self {
        Self::at(position, ReadErrorKind::Truncated { expected: expected.into() })
    }

    #[cold]
    pub(crate) fn unsupported(position: Option<Position>, what: impl Into<String>) -> Self {
        Self { position, kind: ReadErrorKind::Unsupported { what: what.into() } }
    }

    pub(crate) fn named(self, name: &str) -> ReadError {
        ReadError { name: name.to_owned(), position: self.position, kind: self.kind }
    }
}

/// The index of the next vertex, if 32 bits can hold it.
pub(crate) fn check_room(vertices: usize) -> Parsed<()> {
    if vertices < u32::MAX as usize {
        Ok(())
    } else {
        Err(Fault::whole_file(ReadErrorKind::TooManyVertices))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_file_and_place() {
        let fault = Fault::syntax(Position::Line(7), "a number", "`abc`");
        let error = fault.named("a.obj");
        assert_eq!(error.to_string(), "a.obj, line 7: expected a number, found `abc`");
        assert_eq!((error.line(), error.byte()), (Some(7), None));
        let error = Fault::truncated(Position::Byte(84), "2 facets, found 0").named("a.stl");
        assert_eq!(
            error.to_string(),
            "a.stl, byte 84: the file ends too early: expected 2 facets, found 0"
        );
        assert_eq!((error.line(), error.byte()), (None, Some(84)));
        let error =
            Fault::whole_file(ReadErrorKind::Empty(Missing::Faces { vertices: 1 })).named("p.ply");
        assert_eq!(error.to_string(), "p.ply: the file has 1 vertex but no faces");
    }

    #[test]
    fn indices_are_limited_to_32_bits() {
        assert!(check_room(3).is_ok());
        let fault = check_room(u32::MAX as usize).unwrap_err();
        assert!(matches!(fault.kind, ReadErrorKind::TooManyVertices));
    }
}
