//! How to recognise the format of a file.

use crate::format::Format;
use crate::text::{Text, parse_integer};
use crate::{gltf, obj, off, stl};

impl Format {
    /// The format of a file's content, if it is plain from the first lines (for binary STL, from the size).
    #[must_use]
    pub fn detect(bytes: &[u8]) -> Option<Self> {
        Self::detect_by_keyword(bytes).or_else(|| starts_with_counts(bytes).then_some(Self::Off))
    }

    /// Like [`Format::detect`], but leaves out OFF without its keyword, which many texts resemble.
    pub(crate) fn detect_by_keyword(bytes: &[u8]) -> Option<Self> {
        if gltf::looks_like(bytes) {
            return Some(Self::Gltf);
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_tells_the_format() {
        assert_eq!(Format::detect(b"# made by hand\n\nv 0 0 0"), Some(Format::Obj));
        assert_eq!(Format::detect(b"mtllib a.mtl"), Some(Format::Obj));
        assert_eq!(Format::detect(b"\xef\xbb\xbf  COFF\n3 1 0"), Some(Format::Off));
        assert_eq!(Format::detect(b"8 6 12\n0 0 0"), Some(Format::Off));
        assert_eq!(Format::detect(b"ply\r\nformat ascii 1.0"), Some(Format::Ply));
        assert_eq!(Format::detect(b"solid a\n facet normal 0 0 1"), Some(Format::Stl));
        assert_eq!(Format::detect(b"glTF\x02\0\0\0"), Some(Format::Gltf));
        assert_eq!(Format::detect(b" {\n \"asset\": {}}"), Some(Format::Gltf));
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
