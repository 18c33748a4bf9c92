//! Untangling as a whole.

use super::*;
use crate::QuadMesh;
use crate::constraints::SlideCurve;
use crate::quality::{Angles, Orientation, angle_deviations};
use crate::surface::distance_to_triangle;
use seamstress_parametrize::progress::go_on;
use seamstress_testkit::{Rng, disk_grid};
use std::ops::ControlFlow;

fn grid() -> (Vec<Point>, Vec<[u32; 3]>, Vec<[u32; 4]>) {
    let grid = disk_grid(8, 8);
    let faces = grid.faces.chunks(2);
    let quads = faces.map(|pair| [pair[0][0], pair[0][1], pair[0][2], pair[1][2]]).collect();
    (grid.positions, grid.faces, quads)
}

fn angles(mesh: &QuadMesh) -> Angles {
    Angles::new(mesh.positions(), mesh.quads().iter().map(<[u32; 4]>::as_slice))
}

#[test]
fn it_stops_when_the_observer_breaks() {
    let (mut positions, faces, quads) = grid();
    let source = positions.clone();
    positions[40][0] += 1.0;
    let bad = QuadMesh::new(positions, quads).unwrap();
    let stops_after = |calls: usize| {
        let mut seen = 0;
        let mut observer = |_| {
            seen += 1;
            if seen > calls { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        untangle(&bad, (&source, &faces), &UntangleOptions::default(), &mut observer)
    };
    for calls in 0..3 {
        assert!(matches!(stops_after(calls), Err(SmoothError::Cancelled(_))), "{calls}");
    }
    assert!(stops_after(usize::MAX).unwrap().moved > 0);
}

#[test]
fn a_tangled_grid_is_untangled_and_the_rest_stays() {
    let (positions, faces, quads) = grid();
    let surface = (positions.as_slice(), faces.as_slice());
    let side = 0.25;
    for seed in 0..20 {
        let mut rng = Rng::new(seed);
        let mut tangled = positions.clone();
        let centre = positions.iter().position(|p| p[0] == 0.0 && p[1] == 0.0).unwrap();
        for x in &mut tangled[centre][..2] {
            *x += side * (3.0 * rng.unit() - 1.5);
        }
        let before = QuadMesh::new(tangled, quads.clone()).unwrap();
        let untangled =
            untangle(&before, surface, &UntangleOptions::default(), &mut go_on).unwrap();
        let after = angles(&untangled.mesh);
        assert!(after.min >= 44.9 && after.max <= 135.1, "{seed}: {after:?}");
        let polygons = untangled.mesh.quads().iter().map(<[u32; 4]>::as_slice);
        let side = Orientation::new(untangled.mesh.positions(), polygons, surface).unwrap();
        assert_eq!(side, Orientation::default());
        // Only around the centre, of 81.
        assert!(untangled.moved <= 25, "{seed}: {} moved", untangled.moved);
    }
}

/// A mesh and the surface it lies on.
struct Case {
    mesh: QuadMesh,
    surface: (Vec<Point>, Vec<[u32; 3]>),
}

impl Case {
    /// With the 25 vertices within a square in the middle in another order.
    fn knotted(&self, half_side: f64, seed: u64) -> Self {
        let inner = |p: &Point| p[0].abs() < half_side && p[1].abs() < half_side;
        let positions = self.mesh.positions();
        let block: Vec<usize> = (0..positions.len()).filter(|&v| inner(&positions[v])).collect();
        assert_eq!(block.len(), 25);
        let mut knotted = positions.to_vec();
        for (k, &from) in Rng::new(seed).permutation(block.len()).iter().enumerate() {
            knotted[block[k]] = positions[block[from as usize]];
        }
        let mesh = QuadMesh::new(knotted, self.mesh.quads().to_vec()).unwrap();
        Self { mesh, surface: self.surface.clone() }
    }

    /// Quads with a corner more than 45 degrees off a right angle that are left.
    fn left(&self, reaches: &[Reach]) -> usize {
        let options = UntangleOptions::default();
        let surface = (self.surface.0.as_slice(), self.surface.1.as_slice());
        let mesh =
            untangle_within(&self.mesh, surface, &options, reaches, &mut go_on).unwrap().mesh;
        let polygons = mesh.quads().iter().map(<[u32; 4]>::as_slice);
        let deviations = angle_deviations(mesh.positions(), polygons);
        deviations.into_iter().filter(|&off| off.is_nan() || off > 45.1).count()
    }
}

/// A pyramid whose sides are cut into grids.
fn pyramid() -> Case {
    let n = 4i32;
    let mut positions = Vec::new();
    for y in -n..=n {
        for x in -n..=n {
            let height = 3.0 * (1.0 - f64::from(x.abs().max(y.abs())) / f64::from(n));
            positions.push([f64::from(x), f64::from(y), height]);
        }
    }
    let at = |x: i32, y: i32| ((y + n) * (2 * n + 1) + x + n) as u32;
    let cells = (-n..n).flat_map(|y| (-n..n).map(move |x| (x, y)));
    let quads = cells.map(|(x, y)| [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
    let mesh = QuadMesh::new(positions, quads.collect()).unwrap();
    let corners = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
    let base = corners.map(|[x, y]| [x, y, 0.0]);
    let surface = [base.as_slice(), &[APEX]].concat();
    Case { mesh, surface: (surface, vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]) }
}

/// Of the pyramid.
const APEX: Point = [0.0, 0.0, 3.0];

#[test]
fn knots_are_opened_and_each_reach_is_needed() {
    let (positions, faces, quads) = grid();
    let flat = Case {
        mesh: QuadMesh::new(positions.clone(), quads).unwrap(),
        surface: (positions, faces),
    };
    let flat: Vec<Case> = (0..6).map(|seed| flat.knotted(0.6, seed)).collect();
    let tips = (0..14).map(|seed| pyramid().knotted(2.5, seed));
    let knots: Vec<Case> = flat.into_iter().chain(tips).collect();
    let left: Vec<usize> = knots.iter().map(|knot| knot.left(&REACHES)).collect();
    // Not all: a knot may open or stay by the last bits of the functions of the system.
    let opened = left.iter().filter(|&&left| left == 0).count();
    assert!(5 * opened >= 4 * knots.len(), "{left:?}");
    for k in 0..REACHES.len() {
        let others = [&REACHES[..k], &REACHES[k + 1..]].concat();
        let is_worse = |(knot, &left): (&Case, &usize)| knot.left(&others) > left;
        assert!(knots.iter().zip(&left).any(is_worse), "without {:?}", REACHES[k]);
    }
}

#[test]
fn good_quads_and_fixed_vertices_stay() {
    let (positions, faces, quads) = grid();
    let surface = (positions.as_slice(), faces.as_slice());
    let good = QuadMesh::new(positions.clone(), quads.clone()).unwrap();
    let untangled = untangle(&good, surface, &UntangleOptions::default(), &mut go_on).unwrap();
    assert_eq!((untangled.mesh, untangled.moved, untangled.largest_move), (good, 0, 0.0));
    let mut tangled = positions.clone();
    let centre = positions.iter().position(|p| p[0] == 0.0 && p[1] == 0.0).unwrap();
    tangled[centre][0] += 0.3;
    let bad = QuadMesh::new(tangled, quads.clone()).unwrap();
    let fixed = quads.iter().flatten().copied().collect();
    let constraints = Constraints { fixed, ..Constraints::default() };
    let options = UntangleOptions { constraints, ..UntangleOptions::default() };
    assert_eq!(untangle(&bad, surface, &options, &mut go_on).unwrap().moved, 0);
}

#[test]
fn vertices_on_a_curve_slide_along_it() {
    let (positions, faces, quads) = grid();
    let surface = (positions.as_slice(), faces.as_slice());
    // The middle row, and the lower side of the rim.
    for height in [0.0, -1.0] {
        let row: Vec<u32> =
            (0..).zip(&positions).filter(|(_, p)| p[1] == height).map(|(v, _)| v).collect();
        let points = vec![[-1.0, height, 0.0], [1.0, height, 0.0]];
        let (ends, inner) = ([row[0], row[8]], row[1..8].to_vec());
        let middle = row[4];
        let mut bad = positions.clone();
        // Past the next one.
        bad[middle as usize][0] += 0.3;
        let bad = QuadMesh::new(bad, quads.clone()).unwrap();
        let curves = vec![SlideCurve { points, sizes: Vec::new(), vertices: inner.clone() }];
        let constraints = Constraints { fixed: ends.to_vec(), curves, sizes: Vec::new() };
        let options = UntangleOptions { constraints, ..UntangleOptions::default() };
        let untangled = untangle(&bad, surface, &options, &mut go_on).unwrap().mesh;
        let after = angles(&untangled);
        assert!(angles(&bad).max > 140.0 && after.max <= 135.1, "{after:?}");
        let at = |&v: &u32| untangled.positions()[v as usize];
        assert!(inner.iter().all(|v| at(v)[1] == height));
        assert!(ends.iter().all(|v| at(v) == positions[*v as usize]));
    }
}

/// A flat ring of quads between circles of radius 1 and 2, with vertices at given angles.
fn ring(rows: usize, angles: &[f64]) -> (Vec<Point>, Vec<[u32; 4]>) {
    let columns = angles.len();
    let at = |row: usize, column: usize| (row * columns + column % columns) as u32;
    let radius = |row: usize| 1.0 + row as f64 / (rows - 1) as f64;
    let point =
        |row: usize, angle: f64| [radius(row) * angle.cos(), radius(row) * angle.sin(), 0.0];
    let points = (0..rows).flat_map(|row| angles.iter().map(move |&angle| point(row, angle)));
    let cells = (1..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let quads =
        cells.map(|(r, c)| [at(r - 1, c), at(r, c), at(r, c + 1), at(r - 1, c + 1)]).collect();
    (points.collect(), quads)
}

#[test]
fn vertices_on_a_hole_become_even_and_the_hole_stays_round() {
    let turn = |n: usize| (0..n).map(move |k| std::f64::consts::TAU * k as f64 / n as f64);
    let fine: Vec<f64> = turn(120).collect();
    let (points, faces) = ring(2, &fine);
    let faces: Vec<[u32; 3]> =
        faces.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    // Edges of the circles differ by a factor of more than five.
    let crowded: Vec<f64> = turn(24).map(|angle| angle + 0.7 * angle.sin()).collect();
    let (positions, quads) = ring(4, &crowded);
    let closed = |row: usize| (0..=120).map(|k| points[120 * row + k % 120]).collect();
    let circle = |row: usize, first: u32| SlideCurve {
        points: closed(row),
        sizes: Vec::new(),
        vertices: (first..first + 24).collect(),
    };
    let curves = vec![circle(0, 0), circle(1, 72)];
    for fixed in [vec![], vec![3, 75]] {
        let constraints = Constraints { fixed, curves: curves.clone(), sizes: Vec::new() };
        let mesh = QuadMesh::new(positions.clone(), quads.clone()).unwrap();
        let ratio = |mesh: &QuadMesh, first: usize| {
            let at = |k: usize| mesh.positions()[first + k % 24];
            let lengths: Vec<f64> = (0..24).map(|k| norm(sub(at(k), at(k + 1)))).collect();
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            longest / lengths.into_iter().fold(f64::INFINITY, f64::min)
        };
        assert!(ratio(&mesh, 0) > 5.0);
        let options =
            UntangleOptions { constraints: constraints.clone(), ..UntangleOptions::default() };
        let even = untangle(&mesh, (&points, &faces), &options, &mut go_on).unwrap().mesh;
        assert!(ratio(&even, 0) < 3.0 && ratio(&even, 72) < 3.0);
        let radius = |&v: &u32| norm(even.positions()[v as usize]);
        let is_round = |v: &u32| (0.9996..=1.0).contains(&radius(v));
        assert!(curves[0].vertices.iter().all(is_round));
        for &v in &constraints.fixed {
            assert_eq!(even.positions()[v as usize], mesh.positions()[v as usize]);
        }
        // No quad is slanted by more than the 30 degrees that evenness may cost.
        let after = angles(&even);
        assert!(after.min >= 59.9 && after.max <= 120.1, "{after:?}");
    }
}

#[test]
fn vertices_on_a_hole_take_the_sizes_asked_for() {
    let turn = |n: usize| (0..n).map(move |k| std::f64::consts::TAU * k as f64 / n as f64);
    let size = |p: Point| 1.0 + 0.6 * p[0] / norm(p);
    let (points, faces) = ring(2, &turn(120).collect::<Vec<_>>());
    let faces: Vec<[u32; 3]> =
        faces.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    let (positions, quads) = ring(4, &turn(24).collect::<Vec<_>>());
    let circle = |row: usize, first: u32| {
        let points: Vec<Point> = (0..=120).map(|k| points[120 * row + k % 120]).collect();
        let sizes = points.iter().map(|&p| size(p)).collect();
        SlideCurve { points, sizes, vertices: (first..first + 24).collect() }
    };
    let sizes = positions.iter().map(|&p| size(p)).collect();
    let curves = vec![circle(0, 0), circle(1, 72)];
    let constraints = Constraints { fixed: Vec::new(), curves, sizes };
    // Of edges counted in their sizes, the longest by the shortest.
    let ratio = |mesh: &QuadMesh, first: usize| {
        let at = |k: usize| mesh.positions()[first + k % 24];
        let count =
            |k| norm(sub(at(k), at(k + 1))) * 0.5 * (1.0 / size(at(k)) + 1.0 / size(at(k + 1)));
        let counts: Vec<f64> = (0..24).map(count).collect();
        counts.iter().copied().fold(0.0, f64::max)
            / counts.into_iter().fold(f64::INFINITY, f64::min)
    };
    let mesh = QuadMesh::new(positions, quads).unwrap();
    let options =
        UntangleOptions { constraints: constraints.clone(), ..UntangleOptions::default() };
    let spaced = untangle(&mesh, (&points, &faces), &options, &mut go_on).unwrap().mesh;
    for first in [0, 72] {
        let (before, after) = (ratio(&mesh, first), ratio(&spaced, first));
        assert!(before > 3.5 && after < 2.3, "{before} {after}");
    }
}

#[test]
fn tips_are_not_cut_off() {
    // One line is slanted; the apex is the only vertex on top.
    let Case { mesh, surface: (corners, sides) } = pyramid();
    let mut positions = mesh.positions().to_vec();
    positions[41] = [0.1, 0.0, 2.925];
    let bad = QuadMesh::new(positions, mesh.quads().to_vec()).unwrap();
    let untangled =
        untangle(&bad, (&corners, &sides), &UntangleOptions::default(), &mut go_on).unwrap();
    let (before, after) = (angles(&bad), angles(&untangled.mesh));
    assert!(before.max > 138.0 && after.max <= 135.1, "{before:?} {after:?}");
    // The apex may slide, but not off the top.
    let at = |v: u32| untangled.mesh.positions()[v as usize];
    let halves =
        untangled.mesh.quads().iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    let gaps = halves.map(|half| distance_to_triangle(APEX, half.map(at)));
    let gap = gaps.fold(f64::INFINITY, f64::min);
    assert!(gap < 0.2, "{gap}");
}

#[test]
fn what_cannot_be_untangled_is_refused() {
    let (positions, faces, quads) = grid();
    let mesh = QuadMesh::new(positions.clone(), quads).unwrap();
    let error =
        untangle(&mesh, (&positions, &[]), &UntangleOptions::default(), &mut go_on).unwrap_err();
    assert!(matches!(error, SmoothError::BadSurface(_)), "{error}");
    let bow = QuadMesh::new(vec![[0.0; 3]; 7], vec![[0, 1, 2, 3], [2, 4, 5, 6]]).unwrap();
    let error =
        untangle(&bow, (&positions, &faces), &UntangleOptions::default(), &mut go_on).unwrap_err();
    assert!(matches!(error, SmoothError::NoManifold(_)), "{error}");
}
