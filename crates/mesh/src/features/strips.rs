//! Features that run side by side.
//!
//! A sliver along the edge of a solid, a tiny chamfer or a shallow step has an edge on either side. A grid that follows both
//! has a row of cells on the strip between them, however narrow. Where cells are many times wider than the strip, one of its
//! two sides is enough: quads that follow the other are within the width of the strip from it.

use super::dihedral::{dihedral_angle, normal};
use super::{Curve, EdgeSet, FeatureGraph};
use crate::ids::{FaceData, Halfedge, HalfedgeData};
use crate::mesh::TriMesh;
use crate::metric::Metric;
use crate::vector::{dot, norm, sub};
use num_complex::Complex64;
use std::collections::BTreeSet;

/// Strips narrower than so many cells are details.
const WIDTH: f64 = 0.125;

/// Cosine of the largest angle between the two sides of a strip: with more it is a wedge, whose sides meet.
const PARALLEL: f64 = 0.96;

/// Cosine of the largest angle that the surface turns by from one side of a strip to the other. At the rim of a thin plate
/// it turns back: there the strip is no detail.
const TURNS_BACK: f64 = -0.5;

/// A chain of which so large a part is the side of a strip is given up as a whole.
const MOST: f64 = 0.5;

/// An edge looks across from the middles of so many parts of it; with half of them at a strip it is the side of one.
const PARTS: usize = 4;

/// Edges that are crossed on the way over a strip at most.
const MOST_CROSSED: usize = 100;

/// The features that a grid with cells of an edge length, mesh units, has no room for: of every strip that is much narrower
/// than a cell the weaker side. Boundary edges are never among them.
pub fn strips(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    metric: &Metric,
    features: &EdgeSet,
    cell: f64,
) -> EdgeSet {
    Surface::new(mesh, positions, metric, cell)
        .weaker_sides(features, |strips, h| strips.straight_across(h))
}

/// The same, and of slivers: triangles much lower than a cell, with a feature along their base and another one in line with
/// it at their tip. A grid that follows both has a cell between the two, though neither runs beside the other; where the
/// mesh may still change, it may lose such triangles.
pub fn strips_and_slivers(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    metric: &Metric,
    features: &EdgeSet,
    cell: f64,
) -> EdgeSet {
    let surface = Surface::new(mesh, positions, metric, cell);
    surface
        .weaker_sides(features, |strips, h| [strips.straight_across(h), strips.at_tip(h)].concat())
}

/// The features beyond what is beside an edge.
type Beyond = fn(&Strips<'_>, Halfedge) -> Vec<Halfedge>;

struct Surface<'a> {
    mesh: &'a TriMesh,
    positions: &'a [[f64; 3]],
    metric: &'a Metric,
    normals: FaceData<Option<[f64; 3]>>,
    /// What the surface turns by at each edge, radians.
    bends: HalfedgeData<f64>,
    /// Of strips at most, in the unit of the metric.
    width: f64,
}

impl<'a> Surface<'a> {
    fn new(mesh: &'a TriMesh, positions: &'a [[f64; 3]], metric: &'a Metric, cell: f64) -> Self {
        let normals = mesh.faces().map(|f| normal(mesh, positions, f)).collect();
        let bend = |h| dihedral_angle(mesh, positions, h).unwrap_or(0.0);
        let bends = mesh.halfedges().map(bend).collect();
        Self { mesh, positions, metric, normals, bends, width: WIDTH * cell / metric.unit }
    }

    /// The edges to give up until no feature has another one beyond.
    fn weaker_sides(&self, features: &EdgeSet, beyond: Beyond) -> EdgeSet {
        let mut kept = features.clone();
        loop {
            let sides = Strips::new(self, &kept).weaker_sides(beyond);
            if sides.is_empty() {
                return features.without(self.mesh, kept.edges().iter().copied());
            }
            kept = kept.without(self.mesh, sides);
        }
    }
}

/// Features, and what is between them.
struct Strips<'a> {
    surface: &'a Surface<'a>,
    features: &'a EdgeSet,
    graph: FeatureGraph,
    /// The chain of each half-edge of a feature.
    chain_of: HalfedgeData<usize>,
}

/// Edges of a chain that are sides of strips, and the chains across.
struct Sides {
    chain: usize,
    edges: Vec<Halfedge>,
    across: BTreeSet<usize>,
}

impl<'a> Strips<'a> {
    fn new(surface: &'a Surface<'a>, features: &'a EdgeSet) -> Self {
        let mesh = surface.mesh;
        let graph = FeatureGraph::chains(mesh, surface.metric, features);
        let mut chain_of = HalfedgeData::filled(mesh.n_halfedges(), usize::MAX);
        for (k, chain) in graph.curves.iter().enumerate() {
            for &h in &chain.edges {
                chain_of[h] = k;
                mesh.twin(h).into_iter().for_each(|twin| chain_of[twin] = k);
            }
        }
        Self { surface, features, graph, chain_of }
    }

    /// The edges to give up now: a side across from one that is given up waits, it may have nothing beyond then.
    fn weaker_sides(&self, beyond: Beyond) -> Vec<Halfedge> {
        let mut sides: Vec<Sides> =
            (0..self.graph.curves.len()).filter_map(|k| self.sides(k, beyond)).collect();
        let rank = |side: &Sides| self.rank(&self.graph.curves[side.chain]);
        sides.sort_by(|a, b| {
            let ((bend, length), (other_bend, other_length)) = (rank(a), rank(b));
            bend.total_cmp(&other_bend).then(length.total_cmp(&other_length))
        });
        let (mut weaker, mut edges) = (BTreeSet::new(), Vec::new());
        for side in sides {
            if weaker.is_disjoint(&side.across) {
                weaker.insert(side.chain);
                edges.extend(side.edges);
            }
        }
        edges
    }

    /// How much a chain says of the shape: its mean bend, in whole degrees, then its length.
    fn rank(&self, chain: &Curve) -> (f64, f64) {
        let Surface { metric, bends, .. } = self.surface;
        let length = self.length(&chain.edges);
        let bend: f64 = chain.edges.iter().map(|&h| metric.length[h] * bends[h]).sum();
        ((bend / length).to_degrees().round(), length)
    }

    fn length(&self, edges: &[Halfedge]) -> f64 {
        edges.iter().map(|&h| self.surface.metric.length[h]).sum()
    }

    /// What of a chain inside the surface is to be given up, as far as the chains across are kept.
    fn sides(&self, k: usize, beyond: Beyond) -> Option<Sides> {
        let chain = self.graph.curves.get(k).filter(|chain| chain.boundary_edges == 0)?;
        let (mut edges, mut across) = (Vec::new(), BTreeSet::new());
        for &edge in &chain.edges {
            let both = [Some(edge), self.surface.mesh.twin(edge)];
            let found: Vec<Halfedge> =
                both.into_iter().flatten().flat_map(|h| beyond(self, h)).collect();
            if !found.is_empty() {
                edges.push(edge);
                across.extend(found.into_iter().map(|h| self.chain_of[h]));
            }
        }
        if self.length(&edges) >= MOST * self.length(&chain.edges) {
            edges.clone_from(&chain.edges);
        }
        (!edges.is_empty()).then_some(Sides { chain: k, edges, across })
    }

    /// The other sides of the strip beside a half-edge, over its face.
    fn straight_across(&self, h: Halfedge) -> Vec<Halfedge> {
        let at = |part: usize| (part as f64 + 0.5) / PARTS as f64;
        let found = (0..PARTS).filter_map(|part| self.across(h, at(part)));
        let found: Vec<Halfedge> = found.filter(|&other| self.is_strip(h, other)).collect();
        if 2 * found.len() >= PARTS { found } else { Vec::new() }
    }

    /// The features at the tip of the triangle on a half-edge, in line with it, if the triangle is as low as a strip and has
    /// no other side that is one.
    fn at_tip(&self, h: Halfedge) -> Vec<Halfedge> {
        let Surface { mesh, metric, width, .. } = *self.surface;
        let is_low = 2.0 * metric.area[h.face()] < width * metric.length[h];
        if !is_low || [h.next(), h.prev()].iter().any(|&side| self.features.contains(side)) {
            return Vec::new();
        }
        let at_tip = self.features.around(mesh, mesh.origin(h.prev())).map(|(other, _)| other);
        let both = |other| [Some(other), mesh.twin(other)].into_iter().flatten();
        let is_other = |&other: &Halfedge| both(other).all(|side| self.is_strip(h, side));
        at_tip.filter(is_other).collect()
    }

    /// Whether what is between a half-edge, seen from the side before it, and another one beyond is a strip.
    fn is_strip(&self, before: Halfedge, beyond: Halfedge) -> bool {
        let Surface { mesh, positions, normals, .. } = self.surface;
        let along = |h: Halfedge| sub(positions[mesh.tip(h).at()], positions[mesh.origin(h).at()]);
        let (a, b) = (along(before), along(beyond));
        let normal = |h| mesh.twin(h).and_then(|twin| normals[twin.face()]);
        let turns_back = match (normal(before), normal(beyond)) {
            (Some(a), Some(b)) => dot(a, b) < TURNS_BACK,
            _ => false,
        };
        dot(a, b).abs() >= PARALLEL * norm(a) * norm(b) && !turns_back
    }

    /// The feature that is met straight ahead from a place on a half-edge, over its face, within the width of a strip.
    fn across(&self, start: Halfedge, at: f64) -> Option<Halfedge> {
        let Surface { mesh, metric, width, .. } = *self.surface;
        let ends = |h: Halfedge| {
            let corners = metric.flat[h.face()];
            [corners[h.side()], corners[(h.side() + 1) % 3]]
        };
        let [a, b] = ends(start);
        let (mut from, mut point) = (start, a + (b - a) * at);
        let mut ahead = Complex64::i() * (b - a) / (b - a).norm();
        let mut left = width;
        for _ in 0..MOST_CROSSED {
            // The side that the way leaves the face by, where on it, and how far that is.
            let leaves = |h: Halfedge| {
                let [a, b] = ends(h);
                let (side, to) = (b - a, a - point);
                let cross = |p: Complex64, q: Complex64| (p.conj() * q).im;
                let on_side = -cross(ahead, to) / cross(ahead, side);
                let far = cross(to, side) / cross(ahead, side);
                ((0.0..=1.0).contains(&on_side) && far >= 0.0).then_some((h, on_side, far))
            };
            let (h, on_side, far) = [from.next(), from.prev()].into_iter().find_map(leaves)?;
            left -= far;
            if left.is_nan() || left <= 0.0 {
                return None;
            }
            if self.features.contains(h) {
                return (self.chain_of[h] != self.chain_of[start]).then_some(h);
            }
            let twin = mesh.twin(h)?;
            let ([a, b], [c, d]) = (ends(h), ends(twin));
            ahead *= (c - d) / (b - a);
            ahead /= ahead.norm();
            (from, point) = (twin, d + (c - d) * on_side);
        }
        None
    }
}
