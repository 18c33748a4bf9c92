//! Vertices that follow each other along curves.

use crate::QuadConnectivity;
use crate::constraints::{Constraints, Domain};
use crate::curve::Curve;
use crate::vector::Point;

/// A vertex stays at a corner of a curve that turns more, radians: it would be cut off.
const SHARP_TURN: f64 = 0.5;

/// Vertices joined by edges along a curve, between two that stay, or all around a loop along which none does.
pub(crate) struct Stretch<'a> {
    pub(crate) curve: &'a Curve,
    /// Each with its arc length, which may go on past the start of a closed curve. Of a loop, the first comes again.
    pub(crate) vertices: Vec<(u32, f64)>,
    pub(crate) is_loop: bool,
}

impl Stretch<'_> {
    /// The length that an edge at an arc length would have if all were even.
    pub(crate) fn edge_at(&self, parameter: f64) -> f64 {
        let n = self.vertices.len() - 1;
        let count = self.curve.count(self.vertices[n].1) - self.curve.count(self.vertices[0].1);
        self.curve.size(parameter) * count / n as f64
    }
}

/// The curves along which vertices slide, with the vertices.
pub(crate) fn curves(constraints: &Constraints) -> Vec<(Curve, &[u32])> {
    let curves = constraints.curves.iter();
    curves.filter_map(|c| Some((Curve::new(&c.points, &c.sizes)?, c.vertices.as_slice()))).collect()
}

/// All stretches with a vertex that can slide.
pub(crate) fn stretches<'a>(
    curves: &'a [(Curve, &[u32])],
    domain: &Domain,
    connectivity: &QuadConnectivity,
    positions: &[Point],
) -> Vec<Stretch<'a>> {
    let of_curve = |(curve, vertices): &'a (Curve, &[u32])| {
        let along = along(curve, vertices, positions);
        split(curve, &along, connectivity, |v| domain.is_fixed(v))
    };
    curves.iter().flat_map(of_curve).collect()
}

/// Vertices in their order along a curve, with the arc length of each.
fn along(curve: &Curve, vertices: &[u32], positions: &[Point]) -> Vec<(u32, f64)> {
    let with_length = vertices.iter().map(|&v| (v, curve.parameter(positions[v as usize])));
    let mut along: Vec<(u32, f64)> = with_length.collect();
    along.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    along
}

fn split<'a>(
    curve: &'a Curve,
    along: &[(u32, f64)],
    connectivity: &QuadConnectivity,
    is_fixed: impl Fn(u32) -> bool,
) -> Vec<Stretch<'a>> {
    let n = along.len();
    if n < 3 {
        return Vec::new();
    }
    let is_joined = |k: usize| {
        let next = along[(k + 1) % n].0;
        (k + 1 < n || curve.is_closed()) && connectivity.neighbours(along[k].0).any(|w| w == next)
    };
    let is_joined: Vec<bool> = (0..n).map(is_joined).collect();
    let stays = |&k: &usize| {
        let (v, at) = along[k];
        let is_held = is_fixed(v) || curve.turn(at) > SHARP_TURN;
        is_held || !is_joined[k] || !is_joined[(k + n - 1) % n]
    };
    // Past the start of a closed curve, arc lengths go on.
    let place = |k: usize| (along[k % n].0, along[k % n].1 + (k / n) as f64 * curve.length());
    let stretch = |from: usize, to: usize, is_loop| {
        let vertices = (from..=to).map(place).collect();
        Stretch { curve, vertices, is_loop }
    };
    let stays: Vec<usize> = (0..n).filter(stays).collect();
    let Some(&first) = stays.first() else { return vec![stretch(0, n, true)] };
    let again = curve.is_closed().then_some(first + n);
    let ends: Vec<usize> = stays.into_iter().chain(again).collect();
    let apart = ends.windows(2).filter(|ends| ends[1] > ends[0] + 1);
    apart.map(|ends| stretch(ends[0], ends[1], false)).collect()
}
