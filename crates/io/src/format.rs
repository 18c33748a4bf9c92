//! The mesh formats and how to recognise them.

use std::fmt;
use std::path::Path;

use crate::text::{Text, parse_integer};
use crate::{obj, off, stl};

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Geomview OFF.
    Off,
    /// Stanford PLY.
    Ply,
    /// Stereolithography, ASCII or binary.
    Stl,
}

impl Format {
    /// The format of a file name extension (without its dot, in any case).
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        let known =
            [("obj", Self::Obj), ("off", Self::Off), ("ply", Self::Ply), ("stl", Self::Stl)];
        known
            .into_iter()
            .find(|(name, _)| extension.eq_ignore_ascii_case(name))
            .map(|(_, format)| format)
    }

    /// The format that a path's extension claims.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        Self::from_extension(path.extension()?.to_str()?)
    }

    /// The format of a file's content, if it is plain from the first lines (for binary STL, from the size).
    #[must_use]
    pub fn detect(bytes: &[u8]) -> Option<Self> {
        Self::detect_by_keyword(bytes).or_else(|| starts_with_counts(bytes).then_some(Self::Off))
    }

    /// Like [`Format::detect`], but leaves out OFF without its keyword, which many texts resemble.
    pub(crate) fn detect_by_keyword(bytes: &[u8]) -> Option<Self> {
        if stl::has_binary_size(bytes) || stl::looks_ascii(bytes) {
            return Some(Self::Stl);
        }
        let mut text = Text::new(bytes);
        text.seek();
        let first = text.token()?;
        if first == b"ply" {
            Some(Self::Ply)
        } else if off::Header::parse(first).is_some() {
            Some(Self::Off)
        } else {
            obj::is_keyword(first).then_some(Self::Obj)
        }
    }
}

/// Whether the first line holds two or three counts and nothing else: OFF without its keyword.
fn starts_with_counts(bytes: &[u8]) -> bool {
    let mut text = Text::new(bytes);
    text.seek();
    let mut counts = 0;
    while let Some(token) = text.token() {
        if parse_integer(token).is_none() {
            return false;
        }
        counts += 1;
    }
    counts == 2 || counts == 3
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Off => "OFF",
            Self::Ply => "PLY",
            Self::Stl => "STL",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_in_any_case() {
        assert_eq!(Format::from_extension("STL"), Some(Format::Stl));
        assert_eq!(Format::from_path(Path::new("a/b.c.ObJ")), Some(Format::Obj));
        assert_eq!(Format::from_path(Path::new("obj")), None);
        assert_eq!(Format::from_extension("gltf"), None);
    }

    #[test]
    fn content_tells_the_format() {
        assert_eq!(Format::detect(b"# made by hand\n\nv 0 0 0"), Some(Format::Obj));
        assert_eq!(Format::detect(b"mtllib a.mtl"), Some(Format::Obj));
        assert_eq!(Format::detect(b"\xef\xbb\xbf  COFF\n3 1 0"), Some(Format::Off));
        assert_eq!(Format::detect(b"8 6 12\n0 0 0"), Some(Format::Off));
        assert_eq!(Format::detect(b"ply\r\nformat ascii 1.0"), Some(Format::Ply));
        assert_eq!(Format::detect(b"solid a\n facet normal 0 0 1"), Some(Format::Stl));
        assert_eq!(Format::detect(b"lorem ipsum"), None);
        assert_eq!(Format::detect(b"1 2 3 4"), None);
        assert_eq!(Format::detect(b""), None);
    }

    #[test]
    fn a_binary_stl_is_known_by_its_size() {
        let mut bytes = vec![b'v'; 84 + 50];
        bytes[80..84].copy_from_slice(&1u32.to_le_bytes());
        assert_eq!(Format::detect(&bytes), Some(Format::Stl));
        bytes.push(0);
        assert_ne!(Format::detect(&bytes), Some(Format::Stl));
    }
}
