//! Sizes at which cells leave a surface alike far.

use super::fit::{Bounds, SizeError, balanced};
use crate::field::Bending;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{HalfedgeData, Metric, TriMesh, VertexData};

/// Sizes of cells at which it is measured how far they leave the surface; between them it goes by powers of the size.
const SIZES: [f64; N] = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0];
const N: usize = 6;
/// Curvature is averaged over this part of a cell: the chord of a cell over a crease then has its height.
const RADIUS: f64 = 0.25;
/// The least and the largest size: smaller cells are worth little, and larger ones follow no shape.
const BOUNDS: Bounds = Bounds([0.2, 3.0]);
/// What counts as flat: bent by so much over a cell.
const FLAT: f64 = 1e-3;

/// How far a surface is from cells of the sizes of [`SIZES`]: the logarithms of the heights of arcs over them, in eighths of the
/// mean cell.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Heights([f64; N]);

impl Heights {
    /// Of cells over which the surface bends by these angles. Larger ones bend no less: detail that is averaged out is still
    /// missed.
    fn new(bends: [f64; N]) -> Self {
        let mut most = FLAT;
        Self(std::array::from_fn(|k| {
            most = most.max(bends[k]);
            (most * SIZES[k]).ln()
        }))
    }

    /// The size of a cell with a height; curvature stays as it is below the least size measured, and beyond the largest.
    fn size(&self, height: f64) -> f64 {
        let Self(heights) = self;
        match heights.iter().take_while(|&&other| other < height).count() {
            0 => SIZES[0] * (0.5 * (height - heights[0])).exp(),
            N => SIZES[N - 1] * (0.5 * (height - heights[N - 1])).exp(),
            k => {
                let part = (height - heights[k - 1]) / (heights[k] - heights[k - 1]);
                SIZES[k - 1] * (SIZES[k] / SIZES[k - 1]).powf(part)
            }
        }
    }
}

/// Sizes with the same height of the surface over each cell, in all of the area asked for; along features it bends nothing.
pub(super) fn sizes(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    metric: &Metric,
    features: &EdgeSet,
    cell: f64,
    goal: f64,
) -> Result<Vec<f64>, SizeError> {
    let heights = heights(mesh, positions, metric, features, cell)?;
    let all = || heights.iter().flat_map(|heights| heights.0);
    // Where all have the least size, and where all have the largest.
    let least = all().fold(f64::INFINITY, f64::min) - SPAN;
    let largest = all().fold(f64::NEG_INFINITY, f64::max) + SPAN;
    let Bounds([smallest, biggest]) = BOUNDS;
    let size = |height: f64, v: usize| heights[v].size(height).clamp(smallest, biggest);
    balanced(heights.len(), size, [least, largest], &metric.vertex_area(mesh), goal)
}

/// Logarithms of heights beyond those measured at which sizes are at their bounds.
const SPAN: f64 = 4.0;

/// The heights at each vertex, for the largest principal curvature, either way.
fn heights(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    metric: &Metric,
    features: &EdgeSet,
    cell: f64,
) -> Result<Vec<Heights>, SizeError> {
    let is_feature: HalfedgeData<bool> = mesh.halfedges().map(|h| features.contains(h)).collect();
    let (slit, vertex) = mesh.slit(&is_feature);
    let slit_positions: Vec<[f64; 3]> = vertex.iter().map(|v| positions[v.at()]).collect();
    let mut bending = Bending::new(&slit, &slit_positions, metric)?;
    let mut bends = VertexData::filled(mesh.n_vertices(), [0.0f64; N]);
    for (k, size) in SIZES.into_iter().enumerate() {
        let curvature = bending.averaged(RADIUS * size * cell)?;
        for f in mesh.faces() {
            let bend = size * cell * (curvature[f].mean.abs() + curvature[f].anisotropy.norm());
            mesh.face_vertices(f).into_iter().for_each(|v| bends[v][k] = bends[v][k].max(bend));
        }
    }
    Ok(bends.iter().copied().map(Heights::new).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_over_cells_have_the_height_asked_for() {
        // A sphere of curvature 0.1, and a crease of 0.1: heights go with the square of the size, and with the size.
        let sphere = Heights::new(SIZES.map(|size| 0.1 * size));
        let crease = Heights::new([0.1; N]);
        for size in [0.05f64, 0.125, 0.2, 1.0, 3.0, 4.0, 7.0] {
            let height = (0.1 * size * size).ln();
            assert!((sphere.size(height) - size).abs() < 1e-12 * size);
        }
        for size in [0.125f64, 0.2, 1.0, 3.0, 4.0] {
            assert!((crease.size((0.1 * size).ln()) - size).abs() < 1e-12 * size);
        }
        // A bump that larger cells average out is as far from them as from small ones.
        let bump = Heights::new([0.1, 0.2, 0.1, 0.01, 0.0, 0.0]);
        assert!((bump.size((0.2 * 0.25f64).ln()) - 0.25).abs() < 1e-12);
        assert!((bump.size((0.2f64).ln()) - 1.0).abs() < 1e-12);
    }
}
