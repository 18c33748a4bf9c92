//! Atlases: the charts of a map side by side in the unit square, for textures.
//!
//! A chart is turned by quarters only, and all are scaled alike, so that a seamless map stays one. Where it lies over
//! itself in the plane, it is cut into several.

mod charts;
mod overlaps;
mod place;

use charts::Charts;
use overlaps::overlaps;
use seamstress_mesh::{Face, FaceData, TriMesh};

/// The charts of a map in the unit square.
#[derive(Debug, Clone)]
pub struct Atlas {
    /// One UV per corner, three per face, from 0 to 1.
    pub corner_uvs: Vec<[f64; 2]>,
    /// The chart of each face.
    pub chart: FaceData<u32>,
    /// How many there are.
    pub n_charts: usize,
    /// How many there were before any was cut.
    pub n_islands: usize,
    /// Faces that lay over others of their chart before it was cut, ascending.
    pub overlapping: Vec<Face>,
    /// Texels per unit of the map.
    pub density: f64,
}

/// Why there is no atlas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "{n_charts} charts with margins of {margin} texels do not fit into {texels} by {texels} texels"
)]
#[non_exhaustive]
pub struct AtlasError {
    /// How many charts there are.
    pub n_charts: usize,
    /// Texels on a side of the square.
    pub texels: u32,
    /// Texels between charts.
    pub margin: u32,
}

impl Atlas {
    /// That of a map without flips, given by one UV per corner, for a texture of so many texels on a side, at most 2^15;
    /// charts are so many texels from each other and from the sides of the square, or more.
    ///
    /// # Errors
    /// If there is no room.
    pub fn new(
        mesh: &TriMesh,
        corner_uvs: &[[f64; 2]],
        texels: u32,
        margin: u32,
    ) -> Result<Self, AtlasError> {
        let islands = Charts::new(mesh, corner_uvs, &FaceData::filled(mesh.n_faces(), Vec::new()));
        let over = overlaps(&islands, corner_uvs);
        let overlapping: Vec<Face> = mesh.faces().filter(|&f| !over[f].is_empty()).collect();
        let n_islands = islands.n_charts();
        let charts = match overlapping.is_empty() {
            true => islands,
            false => Charts::new(mesh, corner_uvs, &over),
        };
        let n_charts = charts.n_charts();
        let placed = place::place(&charts, corner_uvs, texels, margin).ok_or(AtlasError {
            n_charts,
            texels,
            margin,
        })?;
        Ok(Self {
            corner_uvs: placed.corner_uvs,
            chart: charts.of_face,
            n_charts,
            n_islands,
            overlapping,
            density: placed.density,
        })
    }
}

/// The UVs of the corners of a face.
fn triangle(corner_uvs: &[[f64; 2]], f: Face) -> [[f64; 2]; 3] {
    f.halfedges().map(|h| corner_uvs[h.at()])
}

/// The least rectangle with sides along the axes around some points: its corners.
fn bounds(points: impl Iterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.fold(start, |[low, high], p| {
        [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
    })
}

#[cfg(test)]
mod tests;
