//! Meshes of the optional collection.

use seamstress_mesh::soup::{TriangleSoup, triangulate};
use seamstress_testkit::in_collection;
use std::path::{Path, PathBuf};

/// The folder, if it is there.
#[track_caller]
pub(crate) fn folder() -> Option<PathBuf> {
    in_collection("")
}

/// A mesh of the folder, if it is there.
#[track_caller]
pub(crate) fn read(folder: &Path, file: &str) -> Option<TriangleSoup> {
    in_collection(file)?;
    let mesh = seamstress_io::read_mesh(&folder.join(file)).unwrap();
    let faces = triangulate(&mesh.positions, mesh.polygons.iter()).unwrap().faces;
    Some(TriangleSoup { positions: mesh.positions, faces })
}
