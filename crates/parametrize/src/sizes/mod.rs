//! Sizes of cells on a surface: multiples of one length at the vertices.
//!
//! [`sizes`] makes them of what is wanted and of the curvature ([`chord`]), and makes a metric possible in which all cells
//! are alike: sizes grow slowly, and triangles close ([`limit`]); all cells together have the area asked for ([`fit`]).

mod chord;
mod fit;
mod limit;

pub use fit::SizeError;

use fit::{Bounds, fitted};
use limit::{closing, growing};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Metric, TriMesh};

/// What sizes shall be like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizing {
    /// The length that sizes are multiples of, in the unit of the positions.
    pub cell: f64,
    /// Side of a square with the area that the surface shall have if lengths are counted in sizes, in the same unit.
    pub side: f64,
    /// How much cells are to be smaller where the surface bends, from 0 to 1.
    pub adaptive: f64,
    /// The least and the largest size, as multiples.
    pub bounds: [f64; 2],
    /// How much the length of a cell may grow for each unit of length on the surface.
    pub growth: f64,
}

/// Limits on sizes ask for other cells, and these for other sizes: rounds after which they agree to a percent.
const ROUNDS: usize = 4;

/// The sizes at the vertices of a surface, in proportion to those wanted as far as the limits allow. Edges that cells will
/// follow, `features`, bend nothing.
///
/// # Errors
/// [`SizeError`].
pub fn sizes(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    features: &EdgeSet,
    wanted: &[f64],
    sizing: &Sizing,
) -> Result<Vec<f64>, SizeError> {
    let metric = Metric::from_positions(mesh, positions);
    let unit = sizing.side / metric.unit;
    let goal = unit * unit;
    let area = metric.vertex_area(mesh);
    let mut wanted = wanted.to_vec();
    if sizing.adaptive > 0.0 {
        let cell = sizing.cell / metric.unit;
        let by_chord = chord::sizes(mesh, positions, &metric, features, cell, goal)?;
        let factors = by_chord.iter().map(|size| size.powf(sizing.adaptive));
        wanted.iter_mut().zip(factors).for_each(|(wanted, factor)| *wanted *= factor);
    }
    let bounds = Bounds(sizing.bounds);
    let mut sizes = wanted;
    let growth = sizing.growth * metric.unit / sizing.cell;
    for _ in 0..ROUNDS {
        let fits = fitted(&sizes, &area, goal, bounds)?;
        sizes = closing(mesh, &metric, growing(mesh, &metric, fits, growth));
    }
    // As many cells as asked for, those between the vertices, too, by a factor with which triangles still close.
    let rest = metric.scaled(mesh, &sizes).side() / sizing.side;
    sizes.iter_mut().for_each(|size| *size *= rest);
    Ok(sizes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit as testkit;

    fn sizing(side: f64) -> Sizing {
        Sizing { cell: 0.1, side, adaptive: 0.0, bounds: [0.01, 100.0], growth: 0.5 }
    }

    #[test]
    fn equal_wishes_leave_all_cells_alike() {
        let soup = testkit::torus(12, 8, 2.0, 0.7);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let side = Metric::from_positions(&mesh, &soup.positions).side();
        let none = EdgeSet::new(&mesh, []);
        let wanted = vec![3.0; mesh.n_vertices()];
        let made = sizes(&mesh, &soup.positions, &none, &wanted, &sizing(side)).unwrap();
        assert!(made.iter().all(|size| (size - 1.0).abs() < 1e-9));
    }

    #[test]
    fn cells_are_small_where_the_surface_bends_and_as_many_as_before() {
        let soup = testkit::torus(96, 48, 3.0, 1.0);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        // Flattened: the top and the bottom bend little, the rims much.
        let squash = |p: &[f64; 3]| [p[0], p[1], 0.2 * p[2]];
        let positions: Vec<[f64; 3]> = soup.positions.iter().map(squash).collect();
        let metric = Metric::from_positions(&mesh, &positions);
        let none = EdgeSet::new(&mesh, []);
        let wanted = vec![1.0; mesh.n_vertices()];
        let sizing = Sizing { cell: 0.2, adaptive: 1.0, ..sizing(metric.side()) };
        let made = sizes(&mesh, &positions, &none, &wanted, &sizing).unwrap();
        let scaled = metric.scaled(&mesh, &made);
        assert!((scaled.side() / metric.side() - 1.0).abs() < 1e-9);
        let at = |is_there: &dyn Fn(f64) -> bool| {
            let radius = |p: &[f64; 3]| p[0].hypot(p[1]);
            let there = made.iter().zip(&positions).filter(|(_, p)| is_there(radius(p)));
            let (sum, n) = there.fold((0.0, 0.0), |(sum, n), (size, _)| (sum + size, n + 1.0));
            sum / n
        };
        let (rim, top) = (at(&|r| r > 3.99), at(&|r| (2.9..3.1).contains(&r)));
        assert!(rim < 0.7 * top, "{rim} {top}");
    }

    #[test]
    fn wishes_are_met_as_far_as_bounds_allow() {
        let soup = testkit::disk_grid(16, 16);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let side = Metric::from_positions(&mesh, &soup.positions).side();
        let none = EdgeSet::new(&mesh, []);
        let wanted: Vec<f64> = soup.positions.iter().map(|p| (p[0] + 2.0).powi(2)).collect();
        let with = |bounds| {
            let sizing = Sizing { bounds, growth: 100.0, ..sizing(side) };
            sizes(&mesh, &soup.positions, &none, &wanted, &sizing)
        };
        let free = with([0.01, 100.0]).unwrap();
        let ratios: Vec<f64> =
            free.iter().zip(&wanted).map(|(size, wanted)| size / wanted).collect();
        assert!(ratios.iter().all(|ratio| (ratio / ratios[0] - 1.0).abs() < 1e-6));
        let bound = with([0.5, 2.0]).unwrap();
        assert!(bound.iter().all(|size| (0.45..=2.2).contains(size)));
        assert_eq!(with([0.1, 0.5]).unwrap_err(), SizeError::TooMany);
    }
}
