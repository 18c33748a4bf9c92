//! Shapes that grow, or are measured: blobs, scans, terrain, lattices, castings.

use super::{between, whole};
use crate::data::implicit;
use crate::{Rng, bumpy, graph, random_flips, with_boundaries};
use seamstress_mesh::soup::TriangleSoup;

type Point3 = [f64; 3];

fn distance(p: Point3, q: Point3) -> f64 {
    (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt()
}

/// Balls along random walks from the middle, with their radii.
fn limbs(rng: &mut Rng) -> Vec<(Point3, f64)> {
    let mut balls = vec![([0.0; 3], between(rng, 0.2, 0.35))];
    for _ in 0..whole(rng, 1, 6) {
        let (mut place, mut radius) = balls[0];
        for _ in 0..whole(rng, 1, 4) {
            let step = rng.in_ball();
            place = [0, 1, 2].map(|i| (place[i] + 1.2 * radius * step[i]).clamp(-0.6, 0.6));
            radius = (radius * between(rng, 0.6, 1.0)).max(0.08);
            balls.push((place, radius));
        }
    }
    balls
}

/// Positive inside balls that flow together.
fn flow(balls: &[(Point3, f64)], p: Point3) -> f64 {
    let ball = |&(centre, radius): &(Point3, f64)| (-(distance(p, centre) / radius).powi(2)).exp();
    balls.iter().map(ball).sum::<f64>() - 0.4
}

/// A creature of a few limbs.
pub(super) fn blob(rng: &mut Rng) -> TriangleSoup {
    let balls = limbs(rng);
    let n = whole(rng, 14, 34).cast_signed();
    implicit::surface(n, |p| flow(&balls, p)).triangles()
}

/// A blob as a scanner sees it: noise, bad triangles, holes.
pub(super) fn scan(rng: &mut Rng) -> TriangleSoup {
    let clean = blob(rng);
    let n_flips = rng.below(clean.faces.len() / 4);
    let flipped = random_flips(&clean, n_flips, rng.bits());
    let noise = between(rng, 0.05, 0.6);
    let noisy = bumpy(&flipped, noise, rng.bits());
    let n_holes = if noisy.faces.len() > 800 { rng.below(5) } else { 0 };
    with_boundaries(&noisy, n_holes, rng.bits())
}

/// Hills of all sizes, perhaps in terraces.
pub(super) fn terrain(rng: &mut Rng) -> TriangleSoup {
    let rough = between(rng, 0.02, 0.25);
    let waves: Vec<([f64; 3], f64)> = (0..24)
        .map(|k| {
            let frequency = 2.0 * 1.15f64.powi(k);
            let [x, y, _] = rng.in_ball();
            let phase = between(rng, 0.0, 6.0);
            ([frequency * x, frequency * y, phase], rough * (2.0 / frequency))
        })
        .collect();
    let terrace = (rng.below(3) == 0).then(|| between(rng, 0.05, 0.2));
    let height = |x: f64, y: f64| {
        let wave = |&([a, b, c], size): &(Point3, f64)| size * (6.0 * (a * x + b * y) + c).cos();
        let height: f64 = waves.iter().map(wave).sum();
        terrace.map_or(height, |step| {
            let level = (height / step).floor();
            let part = height / step - level;
            step * (level + part.powi(6))
        })
    };
    graph(whole(rng, 12, 50), whole(rng, 12, 50), height)
}

/// Bars or walls of a lattice within a box or a ball: many handles.
pub(super) fn lattice(rng: &mut Rng) -> TriangleSoup {
    let cells = between(rng, 1.0, 2.2);
    let (thick, shift, kind) = (between(rng, 0.35, 0.7), rng.in_ball(), rng.below(3));
    let is_round = rng.below(2) == 0;
    let inside = move |p: Point3| {
        let [x, y, z] = [0, 1, 2].map(|i| std::f64::consts::PI * cells * (p[i] + shift[i]));
        let body = match kind {
            // Schwarz P, and the gyroid, as bodies and as walls.
            0 => thick - 0.6 - (x.cos() + y.cos() + z.cos()),
            1 => thick - 0.5 + x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos(),
            _ => thick - (x.cos() + y.cos() + z.cos()).abs(),
        };
        let most = if is_round {
            distance(p, [0.0; 3])
        } else {
            p.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
        };
        body.min(8.0 * (0.85 - most))
    };
    implicit::surface(whole(rng, 16, 24).cast_signed(), inside).triangles()
}

/// Blocks, cylinders and bores that run into each other with round edges.
pub(super) fn cast(rng: &mut Rng) -> TriangleSoup {
    let place = |rng: &mut Rng| rng.in_ball().map(|x| 0.45 * x);
    let bodies: Vec<_> = (0..whole(rng, 2, 5))
        .map(|_| (place(rng), [(); 3].map(|()| between(rng, 0.12, 0.4)), rng.below(4)))
        .collect();
    let bores: Vec<_> =
        (0..rng.below(4)).map(|_| (place(rng), between(rng, 0.06, 0.15), rng.below(3))).collect();
    let smooth = between(rng, 0.02, 0.12);
    let inside = |p: Point3| {
        // The depths under the surfaces, joined as log-sum-exp.
        let depth = |&(centre, half, kind): &(Point3, Point3, usize)| {
            let q = [0, 1, 2].map(|i| (p[i] - centre[i]).abs());
            match kind {
                axis @ 0..3 => {
                    let across = q[(axis + 1) % 3].hypot(q[(axis + 2) % 3]);
                    (half[0] - across).min(half[axis].max(0.2) - q[axis])
                }
                _ => (0..3).map(|i| half[i] - q[i]).fold(f64::INFINITY, f64::min),
            }
        };
        let sum: f64 = bodies.iter().map(|body| (depth(body) / smooth).exp()).sum();
        let solid = smooth * sum.ln();
        let bored = bores.iter().map(|&(centre, radius, axis): &(Point3, f64, usize)| {
            let q = [0, 1, 2].map(|i| p[i] - centre[i]);
            q[(axis + 1) % 3].hypot(q[(axis + 2) % 3]) - radius
        });
        bored.fold(solid, f64::min).min(0.95 - p.iter().fold(0.0, |m: f64, x| m.max(x.abs())))
    };
    implicit::surface(whole(rng, 18, 36).cast_signed(), inside).triangles()
}
