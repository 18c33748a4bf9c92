//! Smoothing along a surface.

use crate::constraints::{Constraints, Domain};
use crate::moves::{Fair, Moves};
use crate::surface::Surface;
use crate::vector::{Point, add, scale};
use crate::{QuadConnectivity, QuadFaults, QuadMesh};
use seamstress_linalg::NotPositiveDefinite;
use seamstress_parallel::prelude::*;
use seamstress_parametrize::progress::{Cancelled, Observer, Stage, Watch};

/// How to smooth.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothOptions {
    /// How often every vertex is moved.
    pub rounds: u32,
    /// Vertices that stay where they are, or on a curve.
    pub constraints: Constraints,
}

impl Default for SmoothOptions {
    fn default() -> Self {
        Self { rounds: 10, constraints: Constraints::default() }
    }
}

/// Why quads were not smoothed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SmoothError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The quads are no oriented manifold.
    #[error("the quads are no manifold: {0}")]
    NoManifold(#[from] QuadFaults),
    /// The surface has no triangles to project to.
    #[error("the surface to smooth on cannot be used: {0}")]
    BadSurface(String),
    /// The system of the vertices around curves could not be solved.
    #[error("the vertices around curves could not be moved: {0}")]
    NoFactor(#[from] NotPositiveDefinite),
}

/// A smoothed mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Smoothed {
    /// The mesh, with the quads as they were.
    pub mesh: QuadMesh,
    /// Moves not made in the last round because a quad would have become worse than it may.
    pub refused: usize,
}

/// Part of the way to the mean of the neighbours that a vertex goes in one round.
const STEP: f64 = 0.5;
/// No corner may become worse; sides may, of any length.
const FAIR: Fair = Fair { corner: 0.0, thinness: f64::INFINITY };

/// Moves the vertices of a quad mesh along a surface towards the means of their neighbours.
///
/// Each move ends at the point of the surface, or of the vertex's curve, nearest to its target. Fixed vertices stay.
/// A move is made only if it does not raise the worst of the quads around the vertex, judged by the
/// cosines of their corners and by their side of the surface, and if no more of them are inverted or crossed.
///
/// Moves of a round are proposed from the same positions, then made one by one in the order of the
/// vertices: the result does not depend on the number of threads.
///
/// # Errors
/// If the quads are no manifold or the surface has no triangle, and where the observer breaks.
pub fn smooth(
    mesh: &QuadMesh,
    surface: (&[Point], &[[u32; 3]]),
    options: &SmoothOptions,
    observer: &mut Observer<'_>,
) -> Result<Smoothed, SmoothError> {
    let mut watch = Watch::new(observer, 0, 1);
    watch.enter(Stage::Shaping)?;
    let connectivity = mesh.connectivity()?;
    let surface = Surface::new(surface.0, surface.1).map_err(SmoothError::BadSurface)?;
    let positions = mesh.positions().to_vec();
    let domain = Domain::new(surface, &connectivity, positions.len(), &options.constraints);
    let movable: Vec<u32> = (0..positions.len() as u32).filter(|&v| !domain.is_fixed(v)).collect();
    let normals = positions.par_iter().map(|&p| domain.normal(p)).collect();
    let mut moves = Moves::new(&connectivity, mesh.quads(), positions, normals);
    let mut refused = 0;
    for round in 0..options.rounds {
        watch.tick(f64::from(round) / f64::from(options.rounds))?;
        let on_surface = |&v: &u32| {
            let size = |v: u32| options.constraints.size(v);
            domain.place(v, target(&connectivity, &moves.positions, size, v))
        };
        let targets: Vec<(Point, Point)> = movable.par_iter().map(on_surface).collect();
        refused =
            movable.iter().zip(targets).filter(|&(&v, to)| !moves.try_move(v, to, FAIR)).count();
    }
    Ok(Smoothed { mesh: QuadMesh::from_parts(moves.positions, mesh.quads().to_vec()), refused })
}

/// Where a vertex goes: towards the mean of its neighbours, which count less the longer the edges to them are to be.
fn target(
    connectivity: &QuadConnectivity,
    positions: &[Point],
    size: impl Fn(u32) -> f64,
    v: u32,
) -> Point {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for n in connectivity.neighbours(v) {
        let weight = 2.0 / (size(v) + size(n));
        sum = add(sum, scale(positions[n as usize], weight));
        count += weight;
    }
    let here = positions[v as usize];
    [0, 1, 2].map(|k| here[k] + STEP * (sum[k] / count - here[k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::badness;
    use crate::quality::Orientation;
    use crate::vector::{dot, sub};
    use seamstress_parametrize::progress::go_on;
    use seamstress_testkit::{Rng, cube, disk_grid};

    fn quads_of(faces: &[[u32; 3]]) -> Vec<[u32; 4]> {
        faces.chunks(2).map(|pair| [pair[0][0], pair[0][1], pair[0][2], pair[1][2]]).collect()
    }

    #[test]
    fn a_disturbed_grid_becomes_even_and_its_rim_stays() {
        let grid = disk_grid(8, 8);
        let mut rng = Rng::new(3);
        let mut disturbed = grid.positions.clone();
        for p in disturbed.iter_mut().filter(|p| p[0].abs() < 1.0 && p[1].abs() < 1.0) {
            p[0] += 0.1 * (rng.unit() - 0.5);
            p[1] += 0.1 * (rng.unit() - 0.5);
        }
        let before = QuadMesh::new(disturbed.clone(), quads_of(&grid.faces)).unwrap();
        let options = SmoothOptions { rounds: 100, ..SmoothOptions::default() };
        let smoothed =
            smooth(&before, (&grid.positions, &grid.faces), &options, &mut go_on).unwrap();
        let distance = |points: &[Point]| {
            let pairs = points.iter().zip(&grid.positions);
            pairs.map(|(&a, &b)| dot(sub(a, b), sub(a, b)).sqrt()).fold(0.0, f64::max)
        };
        let after = smoothed.mesh.positions();
        assert!(distance(after) < 0.3 * distance(&disturbed), "{}", distance(after));
        assert!(after.iter().all(|p| p[2] == 0.0));
        let worst = |mesh: &QuadMesh| {
            let quads = mesh.quads().iter().map(|q| q.map(|v| mesh.positions()[v as usize]));
            quads.map(badness::of_quad).fold(0.0, f64::max)
        };
        assert!(worst(&smoothed.mesh) < worst(&before));
    }

    #[test]
    fn no_more_quads_are_inverted_or_crossed_than_before() {
        let grid = disk_grid(8, 8);
        let surface = (grid.positions.as_slice(), grid.faces.as_slice());
        let faults = |mesh: &QuadMesh| {
            let polygons = mesh.quads().iter().map(<[u32; 4]>::as_slice);
            let side = Orientation::new(mesh.positions(), polygons, surface).unwrap();
            side.faults()
        };
        for seed in 0..20 {
            let mut rng = Rng::new(seed);
            let mut disturbed = grid.positions.clone();
            for p in disturbed.iter_mut().filter(|p| p[0].abs() < 1.0 && p[1].abs() < 1.0) {
                p[0] += rng.unit() - 0.5;
                p[1] += rng.unit() - 0.5;
            }
            let mut mesh = QuadMesh::new(disturbed, quads_of(&grid.faces)).unwrap();
            for _ in 0..20 {
                let options = SmoothOptions { rounds: 1, ..SmoothOptions::default() };
                let next = smooth(&mesh, surface, &options, &mut go_on).unwrap().mesh;
                assert!(faults(&next) <= faults(&mesh), "{seed}");
                mesh = next;
            }
        }
    }

    #[test]
    fn sizes_asked_for_are_kept() {
        // Columns at 0, 1, 3 and 7 in a strip, as wide as asked for, but for the inner vertices: those are where they would be
        // if all sizes were alike.
        let row = |y: f64, inner: [f64; 2]| [0.0, inner[0], inner[1], 7.0].map(|x| [x, y, 0.0]);
        let points = [row(0.0, [1.0, 3.0]), row(1.0, [1.4, 3.6]), row(2.0, [1.0, 3.0])].concat();
        let quad = |k: u32| [k, k + 1, k + 5, k + 4];
        let quads: Vec<[u32; 4]> = [0, 1, 2, 4, 5, 6].map(quad).to_vec();
        let corners = [[0.0; 3], [7.0, 0.0, 0.0], [7.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
        let mesh = QuadMesh::new(points, quads).unwrap();
        // Neighbours are apart by the sum of these.
        let sizes = [0.5, 0.5, 1.5, 2.5].repeat(3);
        let constraints = Constraints { sizes, ..Constraints::default() };
        let options = SmoothOptions { rounds: 100, constraints };
        let surface = (&corners[..], &[[0, 1, 2], [0, 2, 3]][..]);
        let smoothed = smooth(&mesh, surface, &options, &mut go_on).unwrap().mesh;
        let inner = [5, 6].map(|v| smoothed.positions()[v]);
        assert!(inner.iter().zip([1.0, 3.0]).all(|(p, x)| (p[0] - x).abs() < 0.01), "{inner:?}");
    }

    #[test]
    fn fixed_vertices_stay() {
        let shape = cube();
        let mut positions = shape.positions.clone();
        positions[0] = [0.1, 0.0, 0.0];
        let mesh = QuadMesh::new(positions, quads_of(&shape.faces)).unwrap();
        let fixed = mesh.quads().iter().flat_map(|q| [q[0], q[2]]).collect();
        let constraints = Constraints { fixed, ..Constraints::default() };
        let options = SmoothOptions { rounds: 3, constraints };
        let smoothed =
            smooth(&mesh, (&shape.positions, &shape.faces), &options, &mut go_on).unwrap();
        for &v in &options.constraints.fixed {
            assert_eq!(smoothed.mesh.positions()[v as usize], mesh.positions()[v as usize]);
        }
    }

    #[test]
    fn what_cannot_be_smoothed_is_refused() {
        let bow = QuadMesh::new(vec![[0.0; 3]; 7], vec![[0, 1, 2, 3], [2, 4, 5, 6]]).unwrap();
        let shape = cube();
        let surface = (&shape.positions[..], &shape.faces[..]);
        let error = smooth(&bow, surface, &SmoothOptions::default(), &mut go_on).unwrap_err();
        assert!(matches!(error, SmoothError::NoManifold(_)), "{error}");
        let mesh = QuadMesh::new(shape.positions.clone(), quads_of(&shape.faces)).unwrap();
        let error = smooth(&mesh, (&shape.positions, &[]), &SmoothOptions::default(), &mut go_on)
            .unwrap_err();
        assert!(matches!(error, SmoothError::BadSurface(_)), "{error}");
    }
}
