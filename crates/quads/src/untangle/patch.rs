//! A quad to be improved, with those around it.

use super::{Reach, Site, State};
use crate::constraints::Constraints;
use crate::stretch::Stretch;
use crate::surface::distance_to_triangle;
use crate::vector::{Point, norm, sub};
use crate::{QuadConnectivity, QuadMesh};
use std::collections::BTreeSet;

/// Quads with vertices that may move, numbered anew.
pub(super) struct Patch {
    /// In the mesh; those that move come first.
    pub(super) vertices: Vec<u32>,
    /// Where the vertices are.
    pub(super) sites: Vec<Site>,
    /// Numbers into `vertices`.
    pub(super) quads: Vec<[u32; 4]>,
    /// The lengths that sides 0 and 2, and sides 1 and 3, of each quad should have.
    pub(super) sides: Vec<[f64; 2]>,
    /// Edges along curves with an end that moves.
    pub(super) curve_edges: Vec<CurveEdge>,
    /// Of the vertices that move.
    pub(super) tethers: Vec<Tether>,
    /// The mean length of an edge.
    pub(super) edge: f64,
}

/// An edge along a curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurveEdge {
    pub(super) ends: [u32; 2],
    /// The length it would have if all edges of its stretch were even.
    pub(super) length: f64,
}

/// What keeps the quads around a vertex near the surface.
pub(super) struct Tether {
    /// The point the vertex comes from.
    pub(super) home: Point,
    /// Halves of the quads around the vertex.
    pub(super) fan: Vec<[u32; 3]>,
    /// How far they may go from the point.
    pub(super) radius: f64,
}

/// A vertex that has gone as far as it may already can still move: its radius is so much more than the distance.
const LEEWAY: f64 = 1.05;

impl Patch {
    pub(super) fn new(state: &State<'_>, quad: u32, reach: &Reach) -> Self {
        let corners_around = |&v: &u32| {
            let quads = state.quads_around(v);
            quads.flat_map(|q| state.quads[q as usize]).collect::<Vec<_>>()
        };
        let mut inner: BTreeSet<u32> = state.quads[quad as usize].into_iter().collect();
        for _ in 0..reach.rings {
            inner = inner.iter().flat_map(corners_around).collect();
        }
        inner.retain(|&v| !state.domain.is_fixed(v));
        let ids: BTreeSet<u32> = inner.iter().flat_map(|&v| state.quads_around(v)).collect();
        let rim: BTreeSet<u32> = ids.iter().flat_map(|&q| state.quads[q as usize]).collect();
        let rim: Vec<u32> = rim.difference(&inner).copied().collect();
        let inner: Vec<u32> = inner.into_iter().collect();
        let number = |v: u32| match inner.binary_search(&v) {
            Ok(number) => number,
            Err(_) => inner.len() + rim.partition_point(|&w| w < v),
        };
        let quads: Vec<[u32; 4]> =
            ids.iter().map(|&q| state.quads[q as usize].map(|v| number(v) as u32)).collect();
        let vertices = [inner.as_slice(), &rim].concat();
        let sites: Vec<Site> = vertices.iter().map(|&v| state.sites[v as usize]).collect();
        let side = |a: u32, b: u32| norm(sub(sites[b as usize].at, sites[a as usize].at));
        let around = |q: &[u32; 4]| (0..4).map(|k| side(q[k], q[(k + 1) % 4])).sum::<f64>();
        let edge = quads.iter().map(around).sum::<f64>() / (4 * quads.len()) as f64;
        let tether = |&v: &u32| {
            let home = state.homes[v as usize];
            Tether { home, fan: Vec::new(), radius: reach.stray * edge }
        };
        let mut tethers: Vec<Tether> = inner.iter().map(tether).collect();
        for (q, k) in quads.iter().flat_map(|q| (0..4).map(move |k| (q, k))) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|j| q[(k + j) % 4]);
            if let Some(tether) = tethers.get_mut(a as usize) {
                tether.fan.extend([[a, b, c], [a, c, d]]);
            }
        }
        for tether in &mut tethers {
            tether.radius = tether.radius.max(LEEWAY * tether.nearest(&sites).1);
        }
        let starts = vertices.iter().flat_map(|&v| &state.curve_edges[v as usize]);
        let moves = |edge: &&CurveEdge| edge.ends.iter().any(|v| inner.binary_search(v).is_ok());
        let curve_edges = starts.filter(moves).map(|edge| {
            let ends = edge.ends.map(|v| number(v) as u32);
            CurveEdge { ends, ..*edge }
        });
        let curve_edges = curve_edges.collect();
        let sides = ids.iter().map(|&q| state.sides[q as usize]).collect();
        Self { vertices, sites, quads, sides, curve_edges, tethers, edge }
    }
}

impl Tether {
    /// The half quad around the vertex that is nearest to where it comes from, and its distance.
    pub(super) fn nearest(&self, sites: &[Site]) -> ([u32; 3], f64) {
        self.fan.iter().fold(([0; 3], f64::INFINITY), |best, &half| {
            let corners = half.map(|v| sites[v as usize].at);
            let distance = distance_to_triangle(self.home, corners);
            if distance < best.1 { (half, distance) } else { best }
        })
    }
}

/// For each vertex the edges along curves that start there.
pub(super) fn curve_edges(stretches: &[Stretch<'_>], n_vertices: usize) -> Vec<Vec<CurveEdge>> {
    let mut starting = vec![Vec::new(); n_vertices];
    for stretch in stretches {
        for pair in stretch.vertices.windows(2) {
            let ends = [pair[0].0, pair[1].0];
            let length = stretch.edge_at(0.5 * (pair[0].1 + pair[1].1));
            starting[ends[0] as usize].push(CurveEdge { ends, length });
        }
    }
    starting
}

/// Rounds in which each quad takes the mean of its neighbours: enough to see past a knot.
const AVERAGING_ROUNDS: usize = 4;

/// For each quad the lengths that sides 0 and 2, and sides 1 and 3, should have: geometric means over its surroundings.
///
/// A quad's own sides say nothing where it is tangled, and one length for all would ask stretched quads to be squares. Lengths
/// are counted in the sizes asked for.
pub(super) fn side_lengths(
    connectivity: &QuadConnectivity,
    mesh: &QuadMesh,
    constraints: &Constraints,
) -> Vec<[f64; 2]> {
    let size = |q: &[u32; 4]| q.map(|v| constraints.size(v)).iter().sum::<f64>() / 4.0;
    let logarithms = |q: &[u32; 4]| {
        let size = size(q);
        let [a, b, c, d] = q.map(|v| mesh.positions()[v as usize]);
        let mean = |e: Point, f: Point| 0.5 * (norm(e) + norm(f));
        [mean(sub(a, b), sub(c, d)), mean(sub(b, c), sub(d, a))]
            .map(|side| (side / size).max(f64::MIN_POSITIVE).ln())
    };
    let mut means: Vec<[f64; 2]> = mesh.quads().iter().map(logarithms).collect();
    for _ in 0..AVERAGING_ROUNDS {
        let mean = |q: usize| {
            let (mut sum, mut count) = (means[q], 1.0);
            for k in 0..4 {
                let Some(twin) = connectivity.twin((4 * q + k) as u32) else { continue };
                let (other, side) = (twin as usize / 4, twin as usize % 4);
                // Side k of this quad is that side of the other.
                for axis in 0..2 {
                    sum[axis] += means[other][(axis + k + side) % 2];
                }
                count += 1.0;
            }
            sum.map(|sum| sum / count)
        };
        means = (0..means.len()).map(mean).collect();
    }
    let lengths = |(sides, q): ([f64; 2], _)| sides.map(|side: f64| size(q) * side.exp());
    means.into_iter().zip(mesh.quads()).map(lengths).collect()
}
