//! An optional collection of real meshes: the folder `SEAMSTRESS_MESHES`, by default `../shared/meshes` beside
//! the workspace.
#![allow(clippy::print_stdout, reason = "tells what was skipped")]

use seamstress_mesh::soup::{TriangleSoup, triangulate};
use std::path::{Path, PathBuf};

/// The folder, if it is there.
pub(crate) fn folder() -> Option<PathBuf> {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/meshes");
    let folder = std::env::var_os("SEAMSTRESS_MESHES").map_or_else(default, PathBuf::from);
    if !folder.is_dir() {
        println!("skipped: no mesh collection in {}", folder.display());
        return None;
    }
    Some(folder)
}

/// A mesh of the folder, if it is there.
pub(crate) fn read(folder: &Path, file: &str) -> Option<TriangleSoup> {
    let path = folder.join(file);
    if !path.is_file() {
        println!("skipped: no {file}");
        return None;
    }
    let mesh = seamstress_io::read_mesh(&path).unwrap();
    let faces = triangulate(&mesh.positions, mesh.polygons.iter()).unwrap().faces;
    Some(TriangleSoup { positions: mesh.positions, faces })
}
