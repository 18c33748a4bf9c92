//! The mesh formats.

use std::fmt;
use std::path::Path;

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
    /// glTF 2.0, as JSON or in one binary file (GLB).
    Gltf,
}

impl Format {
    /// The format of a file name extension (without its dot, in any case).
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        let known = [
            ("obj", Self::Obj),
            ("off", Self::Off),
            ("ply", Self::Ply),
            ("stl", Self::Stl),
            ("glb", Self::Gltf),
            ("gltf", Self::Gltf),
        ];
        known
            .into_iter()
            .find(|(name, _)| extension.eq_ignore_ascii_case(name))
            .map(|(_, format)| format)
    }

    /// The format that a path's extension claims; `.gz` after it says that the file is compressed.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        let path = if is_compressed(path) { Path::new(path.file_stem()?) } else { path };
        Self::from_extension(path.extension()?.to_str()?)
    }
}

/// Whether the name says that a file is compressed with gzip.
#[must_use]
pub fn is_compressed(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"))
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Off => "OFF",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Gltf => "glTF",
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
        assert_eq!(Format::from_extension("GLB"), Some(Format::Gltf));
        assert_eq!(Format::from_extension("fbx"), None);
        assert_eq!(Format::from_path(Path::new("a.b/c.ply.GZ")), Some(Format::Ply));
        assert_eq!(Format::from_path(Path::new("a.gz")), None);
    }
}
