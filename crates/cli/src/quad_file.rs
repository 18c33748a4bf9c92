//! Quad meshes from files.

use crate::outcome::Failure;
use seamstress_io::{PolygonMesh, read_mesh};
use seamstress_quads::QuadMesh;
use std::path::Path;

/// Polygons that are no quads, named at most.
const SHOWN: usize = 5;

/// Reads a mesh of quads only.
pub(crate) fn read_quads(path: &Path) -> Result<QuadMesh, Failure> {
    let read = read_mesh(path)?;
    quads(&read).map_err(|text| Failure::BadMesh { file: path.to_owned(), text })
}

fn quads(read: &PolygonMesh) -> Result<QuadMesh, String> {
    let others: Vec<(usize, usize)> = read
        .polygons
        .iter()
        .map(<[u32]>::len)
        .enumerate()
        .filter(|&(_, corners)| corners != 4)
        .collect();
    if !others.is_empty() {
        let shown: Vec<String> = others
            .iter()
            .take(SHOWN)
            .map(|(face, corners)| format!("face {face} with {corners} corners"))
            .collect();
        let more = if others.len() > SHOWN { ", ..." } else { "" };
        return Err(format!(
            "not a quad mesh: {} of its {} faces have another number of corners than four: {}{more}",
            others.len(),
            read.polygons.len(),
            shown.join(", ")
        ));
    }
    let corners = read.polygons.iter().filter_map(|polygon| <[u32; 4]>::try_from(polygon).ok());
    QuadMesh::new(read.positions.clone(), corners.collect()).map_err(|error| error.to_string())
}
