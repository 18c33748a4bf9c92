//! Parts of machines: turned, milled, bent, with fillets, thin walls and holes.

use super::{between, whole};
use crate::data::planar::Planar;
use crate::{Rng, extruded, revolved, ring, subdivide, voxel_surface};
use seamstress_mesh::soup::TriangleSoup;
use std::f64::consts::TAU;

type Point2 = [f64; 2];

/// Round corners of a polygon: each corner gives way to a parabola that touches both sides. The ends of an open one stay.
fn filleted(corners: &[Point2], size: f64, steps: u32, is_closed: bool) -> Vec<Point2> {
    let n = corners.len();
    let mut outline = Vec::new();
    for (k, &corner) in corners.iter().enumerate() {
        if !is_closed && (k == 0 || k == n - 1) {
            outline.push(corner);
            continue;
        }
        // Where the curve begins and ends: less than half the way to the neighbours.
        let towards = |other: Point2| {
            let [x, y] = [other[0] - corner[0], other[1] - corner[1]];
            let part = (size / x.hypot(y)).min(0.45);
            [corner[0] + part * x, corner[1] + part * y]
        };
        let (from, to) = (towards(corners[(k + n - 1) % n]), towards(corners[(k + 1) % n]));
        for step in 0..=steps {
            let t = f64::from(step) / f64::from(steps);
            let weights = [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
            outline.push(
                [0, 1].map(|i| weights[0] * from[i] + weights[1] * corner[i] + weights[2] * to[i]),
            );
        }
    }
    outline
}

/// With round corners, or as it is.
fn perhaps_filleted(rng: &mut Rng, corners: Vec<Point2>, is_closed: bool) -> Vec<Point2> {
    let (size, steps) = (between(rng, 0.02, 0.15), whole(rng, 1, 5));
    if rng.below(3) == 0 { corners } else { filleted(&corners, size, steps, is_closed) }
}

/// Twice as fine, or as it is.
fn perhaps_finer(rng: &mut Rng, soup: TriangleSoup) -> TriangleSoup {
    if rng.below(2) == 0 && soup.faces.len() < 1200 { subdivide(&soup) } else { soup }
}

/// A shaft with steps and grooves.
pub(super) fn turned(rng: &mut Rng) -> TriangleSoup {
    let (mut height, mut profile) = (0.0, Vec::new());
    for _ in 0..whole(rng, 1, 5) {
        let radius = between(rng, 0.2, 1.0);
        profile.push([radius, height]);
        height += between(rng, 0.1, 0.8);
        profile.push([radius, height]);
    }
    let profile = perhaps_filleted(rng, profile, false);
    let shaft = revolved(&profile, whole(rng, 6, 48));
    perhaps_finer(rng, shaft)
}

/// A bush, a flange or a tube, whose wall may be a hundredth of its radius.
pub(super) fn ring_shaped(rng: &mut Rng) -> TriangleSoup {
    let wall = between(rng, 0.01f64.ln(), 0.7f64.ln()).exp();
    let (inner, height) = (1.0 - wall, between(rng, 0.1, 2.0));
    let mut profile = vec![[inner, 0.0], [1.0, 0.0]];
    if rng.below(2) == 0 {
        // A collar, as thick as the wall or less.
        let (reach, collar) = (between(rng, 1.1, 1.6), height * between(rng, 0.1, 0.5));
        profile = vec![[inner, 0.0], [reach, 0.0], [reach, collar], [1.0, collar]];
    }
    profile.extend([[1.0, height], [inner, height]]);
    let profile = perhaps_filleted(rng, profile, true);
    let part = ring(&profile, whole(rng, 8, 40));
    perhaps_finer(rng, part)
}

/// An outline raised: profiles, wheels with teeth, combs.
pub(super) fn prism(rng: &mut Rng) -> TriangleSoup {
    let outline = match rng.below(3) {
        0 => {
            let n = whole(rng, 3, 12);
            let radii: Vec<f64> = (0..n).map(|_| between(rng, 0.5, 1.0)).collect();
            around(&radii)
        }
        1 => {
            let (teeth, inner) = (whole(rng, 4, 16), between(rng, 0.5, 0.9));
            let radius = |k: u32| if k % 4 < 2 { 1.0 } else { inner };
            around(&(0..4 * teeth).map(radius).collect::<Vec<_>>())
        }
        _ => comb(rng),
    };
    let outline = perhaps_filleted(rng, outline, true);
    let height = between(rng, 0.02f64.ln(), 2.0f64.ln()).exp();
    let part = extruded(&outline, height);
    perhaps_finer(rng, part)
}

/// Corners at even angles.
fn around(radii: &[f64]) -> Vec<Point2> {
    let n = radii.len() as f64;
    let corner = |(k, radius): (usize, &f64)| {
        let (sin, cos) = (TAU * k as f64 / n).sin_cos();
        [radius * cos, radius * sin]
    };
    radii.iter().enumerate().map(corner).collect()
}

/// A bar with fins of one width, which may be thin.
fn comb(rng: &mut Rng) -> Vec<Point2> {
    let (n, thick, depth) = (whole(rng, 2, 7), between(rng, 0.05, 0.6), between(rng, 0.2, 1.5));
    let base = between(rng, 0.05, 0.4);
    let mut outline = vec![[0.0, 0.0], [f64::from(n) - 1.0 + thick, 0.0]];
    for fin in (0..n).rev().map(f64::from) {
        outline.extend([[fin + thick, base + depth], [fin, base + depth]]);
        if fin > 0.0 {
            outline.extend([[fin, base], [fin - 1.0 + thick, base]]);
        }
    }
    outline
}

/// A plate with holes of two sizes; flat, bent, or open and lifted.
pub(super) fn plate(rng: &mut Rng) -> TriangleSoup {
    let blocks = [whole(rng, 1, 5), whole(rng, 1, 4)];
    let (radii, seed) = ([between(rng, 0.15, 0.3), between(rng, 0.3, 0.45)], rng.bits());
    let hole = |x: u32, y: u32| {
        let choice = Rng::new(seed ^ u64::from(8 * x + y)).below(4);
        radii.get(choice).copied()
    };
    let flat = Planar::blocks(blocks, whole(rng, 1, 4), hole);
    let thick = between(rng, 0.02f64.ln(), 0.8f64.ln()).exp();
    let bend = between(rng, 0.0, 2.5) / f64::from(blocks[0]);
    let place = |[x, y, z]: [f64; 3]| {
        let (angle, radius) = (bend * x, 1.0 / bend - z);
        [radius * angle.sin(), y, 1.0 / bend - radius * angle.cos()]
    };
    let mut soup = match rng.below(4) {
        0 => flat.lifted(|[x, y]| [x, y, 0.0]),
        _ => flat.extruded(&[0.0, 0.5 * thick, thick]),
    };
    if rng.below(2) == 0 && bend > 0.05 && thick * bend < 0.8 {
        soup.positions.iter_mut().for_each(|p| *p = place(*p));
    }
    soup.triangles()
}

/// Bars along the edges of a lattice of cubes, or a random pile of them with square corners.
pub(super) fn frame(rng: &mut Rng) -> TriangleSoup {
    let [x, y, z] = [(); 3].map(|()| 2 * whole(rng, 1, 2).cast_signed());
    let mut cells = Vec::new();
    for cell in (0..=x).flat_map(|x| (0..=y).flat_map(move |y| (0..=z).map(move |z| [x, y, z]))) {
        // A bar has two even coordinates, a node three; a few walls are filled.
        let even = cell.iter().filter(|c| *c % 2 == 0).count();
        if even >= 2 || (even == 1 && rng.below(5) == 0) {
            cells.push(cell);
        }
    }
    let bars = voxel_surface(&cells);
    let stretched = [(); 3].map(|()| between(rng, 0.5, 2.0));
    perhaps_finer(rng, crate::stretch(&bars, stretched))
}
