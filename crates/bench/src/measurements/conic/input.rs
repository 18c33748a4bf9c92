//! Maps from files.

use crate::map_files::corner_uvs;
use num_complex::Complex64;
use seamstress_io::read_mesh;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::{SeamlessMap, Tolerance};
use std::error::Error;
use std::path::Path;

/// The exact layout of a map and its unknowns.
pub(super) struct Input {
    pub(super) layout: ExactLayout,
    pub(super) y: Vec<f64>,
    pub(super) z: Vec<Complex64>,
}

impl Input {
    /// Reads and certifies a map, and opens its exact layout.
    pub(super) fn load(path: &Path) -> Result<Self, Box<dyn Error>> {
        let read = read_mesh(path)?;
        let uvs = corner_uvs(&read).ok_or("the file has no texture coordinates")?;
        let faces: Result<Vec<[u32; 3]>, _> =
            read.polygons.iter().map(<[u32; 3]>::try_from).collect();
        let mesh = TriMesh::from_faces(read.positions.len(), &faces?)?;
        let metric = Metric::from_positions(&mesh, &read.positions);
        let map = SeamlessMap::certify(&mesh, uvs, &Tolerance::default())?;
        let (layout, y) = ExactLayout::from_map(&mesh, &metric, &map)?;
        Ok(Self { z: layout.expand(&y), layout, y })
    }
}
