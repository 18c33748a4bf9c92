//! Directions that lines are to follow, as asked for.

use crate::as_text::as_text;
use crate::feature_sources::FeatureSource;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Where directions come from that the lines of a map follow where they can.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum DirectionSource {
    /// Polylines near the surface: the `l` elements of an OBJ file, `strokes:FILE`.
    Strokes(PathBuf),
    /// A direction of a cross for every triangle: `field:FILE`, a .rawfield, or a .rosy with a vector per face.
    Field(PathBuf),
    /// Edges that need not be on lines, as features are: any source of these.
    Edges(FeatureSource),
}

impl DirectionSource {
    /// The file it is read from, other than that of the surface.
    pub(crate) fn file(&self) -> Option<&Path> {
        match self {
            Self::Strokes(file) | Self::Field(file) => Some(file),
            Self::Edges(source) => source.file(),
        }
    }
}

impl FromStr for DirectionSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            Some(("strokes", file)) if !file.is_empty() => Ok(Self::Strokes(file.into())),
            Some(("field", file)) if !file.is_empty() => Ok(Self::Field(file.into())),
            _ => text.parse().map(Self::Edges).map_err(|_| {
                "expected strokes:FILE, field:FILE or a source of `--features`".to_owned()
            }),
        }
    }
}

impl fmt::Display for DirectionSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Strokes(file) => write!(f, "strokes:{}", file.display()),
            Self::Field(file) => write!(f, "field:{}", file.display()),
            Self::Edges(source) => source.fmt(f),
        }
    }
}

as_text!(DirectionSource, "strokes:FILE, field:FILE or a source of features");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_read_and_written_alike() {
        for text in ["strokes:a b.obj", "field:x.rosy", "lines", "edges:0-1,4-2", "angle:40"] {
            assert_eq!(text.parse::<DirectionSource>().unwrap().to_string(), text);
        }
        for text in ["", "strokes:", "field", "edges:x", "none"] {
            assert!(text.parse::<DirectionSource>().is_err(), "{text}");
        }
    }
}
