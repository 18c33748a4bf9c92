//! Creases of a surface, found by its shape alone.
//!
//! An edge of a CAD model and an edge of a scan may bend alike; they differ in what lies around them. Beside a crease the
//! surface is smooth, beside an edge of a scan, or of a coarse organic shape, it bends at every edge by something in
//! between. This is the *clutter* of an edge. A smooth surface of coarse facets is told apart by its edges side by side,
//! which bend alike. What is found is followed through gaps, and only what lasts for some cells is kept. A solid of few
//! flat faces has hardly anything around its edges but other edges: there every sharp one is a crease.

use super::dihedral::dihedral_angle;
use super::{Curve, EdgeSet, FeatureGraph, NodeKind, strips};
use crate::flat::FlatParts;
use crate::ids::{Halfedge, HalfedgeData, Vertex, VertexData};
use crate::mesh::TriMesh;
use crate::metric::Metric;
use crate::vector::dot;
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_4, PI};

const fn degrees(angle: f64) -> f64 {
    angle * PI / 180.0
}

/// Smallest bend of an edge of a crease: chamfers and the flat ends of fading creases bend less.
const WEAK: f64 = degrees(25.0);

/// Smallest mean bend of a crease, by length.
const STRONG: f64 = degrees(35.0);

/// Below this bend an edge is no crease if an edge on one side bends alike, which is so at the rim of a rounding that
/// has few facets.
const ROUNDING: f64 = degrees(40.0);

/// Below this bend an edge is no crease if edges on both sides bend alike: a prism of 8 sides, which bend by 45 degrees, has
/// creases, a cylinder of 9 and an icosahedron, whose edges bend by 41.8 degrees, have none.
const SMOOTH: f64 = degrees(43.0);

/// An edge beside another bends alike if it bends by this part of it or more, times the cosine between the two...
const ALIKE: f64 = 0.8;

/// ... and at most by so many times it: beside a crease a chamfer is no part of a rounding.
const MUCH_MORE: f64 = 1.5;

/// Edges that bend by so large a part of another continue neither its crease nor the smooth surface beside it.
const BETWEEN: std::ops::Range<f64> = 0.1..0.65;

/// Cosine of the largest angle between an edge and the next of its crease, which are not part of its clutter.
const ONWARD: f64 = 0.6;

/// Largest clutter of an edge of a crease. A regular octahedron has 1 everywhere.
const EDGE_CLUTTER: f64 = 1.0;

/// Largest mean clutter of a crease of 45 degrees, by length. Creases of CAD models have 0.1 to 0.6, edges of scans 0.8 to 1.1.
const CLUTTER: f64 = 0.7;

/// What is added to it up to a crease of 90 degrees, which scans hardly have.
const MORE_CLUTTER: f64 = 0.15;

/// Most edges of a gap through which a crease is followed.
const GAP: usize = 8;

/// Smallest bend of an edge through which a crease is followed.
const FADED: f64 = degrees(15.0);

/// Cosine of the largest turn of a crease in a gap.
const GAP_TURN: f64 = 0.5;

/// Creases that end inside the surface have at least so many edges, and are as long as so many cells: shorter ones bend the
/// grid around their ends more than they shape it.
const SHORTEST: usize = 3;

/// Creases that hang together are as long as so many cells in all, which go around a cell, unless they are clear.
const SPECK: f64 = 4.0;

/// Largest mean clutter of clear creases, such as the rim of a drill hole.
const CLEAR: f64 = 0.5;

/// Fewest edges of clear creases: around a spike, or a triangle that sticks out, there are fewer.
const ROUND: usize = 6;

/// Creases that hang together and go from crossing to crossing in less than so many cells, for most of their length, are
/// finer than the grid: the steps of voxels, for instance, for two thirds of it. Those of CAD models do for a third at most.
const FINE: f64 = 1.5;

/// Creases between crossings that are closer than so many cells are details that the grid has no room for.
const DETAIL: f64 = 0.5;

/// Most flat faces of a polyhedron. Coarse organic shapes have some hundred.
const MOST_FACES: usize = 40;

/// Smallest bend of its creases: 40 degrees, the sides of a regular prism of nine, but for rounding.
const SHARP: f64 = degrees(39.9);

/// The creases of a surface that a grid with cells of an edge length, mesh units, should follow. Boundary edges are none.
pub fn creases(mesh: &TriMesh, positions: &[[f64; 3]], metric: &Metric, cell: f64) -> EdgeSet {
    let cell = cell / metric.unit;
    let shape = Shape::new(mesh, positions, metric);
    let found = shape.clear_chains();
    let found = shape.through_gaps(&found);
    // Both ends of a sliver along a crease are crossings until one of its sides is gone.
    let found = shape.without_strips(found, cell);
    let found = shape.without_short_ends(found, cell);
    let found = shape.without_specks(&found, cell);
    let found = shape.without_details(found, cell);
    let found = shape.without_short_ends(found, cell);
    shape.without_strips(shape.of_polyhedra(&found), cell)
}

/// A surface and how it bends at its edges.
struct Shape<'a> {
    mesh: &'a TriMesh,
    positions: &'a [[f64; 3]],
    metric: &'a Metric,
    /// Radians; none on the boundary and beside a triangle without area.
    bend: HalfedgeData<Option<f64>>,
    /// Of edges that bend by [`WEAK`] or more.
    around: HalfedgeData<Option<Around>>,
}

/// What lies around an edge.
#[derive(Debug, Clone, Copy)]
struct Around {
    /// The share of the edges around it, by length, that bend [`BETWEEN`] it and flat, and the root mean square of
    /// how much they bend relative to it, at most 1 each.
    clutter: f64,
    /// The strongest bend on either side of an edge alike, relative to it, times the cosine between the two.
    beside: [f64; 2],
}

impl<'a> Shape<'a> {
    fn new(mesh: &'a TriMesh, positions: &'a [[f64; 3]], metric: &'a Metric) -> Self {
        let bend = mesh.halfedges().map(|h| dihedral_angle(mesh, positions, h)).collect();
        let around = HalfedgeData::filled(mesh.n_halfedges(), None);
        let mut shape = Self { mesh, positions, metric, bend, around };
        let around = |h| (shape.bend(h) >= WEAK).then(|| shape.look_around(h)).flatten();
        shape.around = mesh.halfedges().map(around).collect();
        shape
    }

    fn bend(&self, h: Halfedge) -> f64 {
        self.bend[h].unwrap_or(0.0)
    }

    fn edge(&self, h: Halfedge) -> Halfedge {
        self.mesh.twin(h).map_or(h, |twin| h.min(twin))
    }

    /// From one vertex to another, in the unit of the metric.
    fn vector(&self, from: Vertex, to: Vertex) -> [f64; 3] {
        let (a, b) = (self.positions[from.at()], self.positions[to.at()]);
        // Halved first, so that no difference overflows.
        [0, 1, 2].map(|i| (0.5 * b[i] - 0.5 * a[i]) / (0.5 * self.metric.unit))
    }

    /// The unit vector along a half-edge.
    fn direction(&self, h: Halfedge) -> [f64; 3] {
        unit(self.vector(self.mesh.origin(h), self.mesh.tip(h)))
    }

    /// What lies around an interior edge; either half-edge finds the same, with the sides exchanged.
    fn look_around(&self, h: Halfedge) -> Option<Around> {
        let twin = self.mesh.twin(h)?;
        let ends = [self.mesh.origin(h), self.mesh.tip(h)];
        let apexes = [h, twin].map(|h| self.mesh.tip(h.next()));
        let (bend, along) = (self.bend(h), self.direction(h));
        let into = apexes.map(|apex| {
            let to = self.vector(ends[0], apex);
            let across = dot(to, along);
            unit([0, 1, 2].map(|i| to[i] - across * along[i]))
        });
        let sideways: [f64; 3] = [0, 1, 2].map(|i| into[0][i] - into[1][i]);
        let corners = ends.into_iter().chain(apexes).flat_map(|v| self.mesh.outgoing(v));
        let mut edges: Vec<Halfedge> =
            corners.flat_map(|c| c.face().halfedges()).map(|side| self.edge(side)).collect();
        edges.sort_unstable();
        edges.dedup();
        let (mut length, mut between, mut square) = (0.0, 0.0, 0.0);
        let mut beside = [0.0f64; 2];
        for other in edges.into_iter().filter(|&other| other != self.edge(h)) {
            let Some(angle) = self.bend[other] else { continue };
            let (from, to) = (self.mesh.origin(other), self.mesh.tip(other));
            let touches = ends.contains(&from) || ends.contains(&to);
            let cosine = dot(along, self.direction(other)).abs();
            if touches && cosine > ONWARD {
                continue;
            }
            let (relative, weight) = (angle / bend, self.metric.length[other]);
            length += weight;
            between += if BETWEEN.contains(&relative) { weight } else { 0.0 };
            square += weight * relative.min(1.0).powi(2);
            if !touches && relative < MUCH_MORE {
                let away = [from, to].map(|v| dot(self.vector(ends[0], v), sideways));
                let side = usize::from(away[0] + away[1] <= 0.0);
                beside[side] = beside[side].max(relative.min(1.0) * cosine);
            }
        }
        let share = |part: f64| if length > 0.0 { part / length } else { 0.0 };
        Some(Around { clutter: share(between) + share(square).sqrt(), beside })
    }

    /// Whether an edge may be part of a crease.
    fn is_candidate(&self, h: Halfedge) -> bool {
        let Some(Around { clutter, beside: [a, b] }) = self.around[h] else { return false };
        let is_rounding = self.bend(h) < ROUNDING && a.max(b) > ALIKE;
        let is_smooth = self.bend(h) < SMOOTH && a.min(b) > ALIKE;
        clutter <= EDGE_CLUTTER && !is_rounding && !is_smooth
    }

    fn clutter(&self, h: Halfedge) -> f64 {
        self.around[h].map_or(EDGE_CLUTTER, |around| around.clutter)
    }

    /// The mean over edges, by length.
    fn mean(&self, edges: &[Halfedge], value: impl Fn(Halfedge) -> f64) -> f64 {
        let length = self.length(edges);
        let sum: f64 = edges.iter().map(|&h| self.metric.length[h] * value(h)).sum();
        if length > 0.0 { sum / length } else { 0.0 }
    }

    fn length(&self, edges: &[Halfedge]) -> f64 {
        edges.iter().map(|&h| self.metric.length[h]).sum()
    }

    /// The chains of edges that bend enough for what lies around them.
    fn clear_chains(&self) -> EdgeSet {
        let candidates = self.mesh.interior_edges().filter(|&h| self.is_candidate(h));
        let candidates = EdgeSet::new(self.mesh, candidates);
        let chains = FeatureGraph::chains(self.mesh, self.metric, &candidates).curves;
        let clear = chains.into_iter().filter(|chain| {
            let bend = self.mean(&chain.edges, |h| self.bend(h));
            let more = MORE_CLUTTER * ((bend - FRAC_PI_4) / FRAC_PI_4).clamp(0.0, 1.0);
            bend >= STRONG && self.mean(&chain.edges, |h| self.clutter(h)) <= CLUTTER + more
        });
        EdgeSet::new(self.mesh, clear.flat_map(|chain| chain.edges))
    }

    /// The same and the ways from open ends on to other creases, or to the boundary.
    fn through_gaps(&self, creases: &EdgeSet) -> EdgeSet {
        let mut degree = VertexData::filled(self.mesh.n_vertices(), 0);
        for &h in creases.edges() {
            degree[self.mesh.origin(h)] += 1;
            degree[self.mesh.tip(h)] += 1;
        }
        let is_open = |v: &Vertex| degree[*v] == 1 && !self.mesh.is_boundary(*v);
        let ways = self.mesh.vertices().filter(is_open).filter_map(|v| self.way_on(v, creases));
        let ways: Vec<Halfedge> = ways.flatten().collect();
        EdgeSet::new(self.mesh, ways.into_iter().chain(creases.edges().iter().copied()))
    }

    /// The edges that lead on from an open end the straightest and sharpest way to a crease or the boundary, if there is one.
    fn way_on(&self, end: Vertex, creases: &EdgeSet) -> Option<Vec<Halfedge>> {
        let (_, from) = creases.around(self.mesh, end).next()?;
        let (mut from, mut at) = (from, end);
        let mut way: Vec<Halfedge> = Vec::new();
        while way.len() < GAP {
            let ahead = unit(self.vector(from, at));
            let next = self.mesh.outgoing(at).filter(|&h| self.may_be_faded(h));
            let next = next.filter(|&h| !creases.contains(h) && !way.contains(&self.edge(h)));
            let rated = next.map(|h| (h, dot(ahead, self.direction(h))));
            let rated = rated.filter(|&(_, cosine)| cosine >= GAP_TURN);
            let rated = rated.map(|(h, cosine)| (h, cosine * self.bend[h].unwrap_or(FADED)));
            let (h, _) = rated.max_by(|a, b| a.1.total_cmp(&b.1))?;
            way.push(self.edge(h));
            (from, at) = (at, self.mesh.tip(h));
            if self.mesh.is_boundary(at) || creases.around(self.mesh, at).next().is_some() {
                return Some(way);
            }
        }
        None
    }

    /// Whether a crease may lead through an edge: how it bends beside a triangle without area nobody knows.
    fn may_be_faded(&self, h: Halfedge) -> bool {
        self.mesh.twin(h).is_some() && self.bend[h].is_none_or(|bend| bend >= FADED)
    }

    /// Removes chains that end inside the surface and are short, until there are none.
    fn without_short_ends(&self, mut creases: EdgeSet, cell: f64) -> EdgeSet {
        loop {
            let chains = FeatureGraph::chains(self.mesh, self.metric, &creases);
            let is_short = |chain: &&Curve| {
                let too_few = chain.edges.len() < SHORTEST;
                too_few || self.length(&chain.edges) < SHORTEST as f64 * cell
            };
            let is_open =
                |chain: &&Curve| chains.ends(chain).any(|node| node.kind == NodeKind::OpenEnd);
            let short = chains.curves.iter().filter(is_short).filter(is_open);
            let removed: Vec<Halfedge> = short.flat_map(|chain| &chain.edges).copied().collect();
            if removed.is_empty() {
                return creases;
            }
            creases = creases.without(self.mesh, removed);
        }
    }

    /// Removes chains between crossings that are much shorter than a cell, the shortest first, until there are none: what
    /// they have cut in pieces hangs together then.
    fn without_details(&self, mut creases: EdgeSet, cell: f64) -> EdgeSet {
        loop {
            let chains = FeatureGraph::chains(self.mesh, self.metric, &creases).curves;
            let open = chains.iter().filter(|chain| !chain.is_loop);
            let short: Vec<(f64, &Curve)> = open
                .map(|chain| (self.length(&chain.edges), chain))
                .filter(|&(length, _)| length < DETAIL * cell)
                .collect();
            let mut shortest = VertexData::filled(self.mesh.n_vertices(), f64::INFINITY);
            for &(length, chain) in &short {
                for &end in chain_ends(chain) {
                    shortest[end] = shortest[end].min(length);
                }
            }
            let is_shortest = |&&(length, chain): &&(f64, &Curve)| {
                chain_ends(chain).all(|&end| length <= shortest[end])
            };
            let removed = short.iter().filter(is_shortest).flat_map(|(_, chain)| &chain.edges);
            let removed: Vec<Halfedge> = removed.copied().collect();
            if removed.is_empty() {
                return creases;
            }
            creases = creases.without(self.mesh, removed);
        }
    }

    /// Removes one side of each strip that is much narrower than a cell.
    fn without_strips(&self, creases: EdgeSet, cell: f64) -> EdgeSet {
        let cell = cell * self.metric.unit;
        let strips = strips(self.mesh, self.positions, self.metric, &creases, cell);
        creases.without(self.mesh, strips.edges().iter().copied())
    }

    /// Removes creases that hang together and are specks, or finer than the grid.
    fn without_specks(&self, creases: &EdgeSet, cell: f64) -> EdgeSet {
        let chains = FeatureGraph::chains(self.mesh, self.metric, creases).curves;
        let is_fine = |chain: &&Curve| !chain.is_loop && self.length(&chain.edges) < FINE * cell;
        let fine = chains.iter().filter(is_fine);
        let fine = EdgeSet::new(self.mesh, fine.flat_map(|chain| chain.edges.iter().copied()));
        let is_kept = |group: &[Halfedge]| {
            let is_clear =
                || group.len() >= ROUND && self.mean(group, |h| self.clutter(h)) <= CLEAR;
            let share_fine = self.mean(group, |h| f64::from(u8::from(fine.contains(h))));
            let lasts = self.length(group) >= SPECK * cell || is_clear();
            lasts && share_fine <= 0.5 && !self.is_triangle(group)
        };
        let kept = self.groups(creases).into_iter().filter(|group| is_kept(group));
        EdgeSet::new(self.mesh, kept.flatten())
    }

    /// The same, but in components of few flat faces all sharp edges.
    fn of_polyhedra(&self, creases: &EdgeSet) -> EdgeSet {
        let parts = FlatParts::new(self.mesh, self.positions, |_| false);
        let (component, n_components) = self.mesh.connected_faces();
        let mut n_parts = vec![0; n_components];
        parts.faces.iter().for_each(|faces| n_parts[component[faces[0]] as usize] += 1);
        let is_polyhedron = |h: Halfedge| n_parts[component[h.face()] as usize] <= MOST_FACES;
        let is_crease = |&h: &Halfedge| match is_polyhedron(h) {
            true => self.bend(h) >= SHARP,
            false => creases.contains(h),
        };
        EdgeSet::new(self.mesh, self.mesh.interior_edges().filter(is_crease))
    }

    /// Whether edges are the sides of a triangle: what sticks out there is no larger than the mesh resolves.
    fn is_triangle(&self, edges: &[Halfedge]) -> bool {
        let ends = edges.iter().flat_map(|&h| [self.mesh.origin(h), self.mesh.tip(h)]);
        edges.len() == 3 && ends.collect::<BTreeSet<_>>().len() == 3
    }

    /// The edges of creases that hang together, group by group.
    fn groups(&self, creases: &EdgeSet) -> Vec<Vec<Halfedge>> {
        let mut is_seen = VertexData::filled(self.mesh.n_vertices(), false);
        let mut groups = Vec::new();
        for &first in creases.edges() {
            let mut group = Vec::new();
            let mut ahead = vec![self.mesh.origin(first)];
            while let Some(v) = ahead.pop() {
                if std::mem::replace(&mut is_seen[v], true) {
                    continue;
                }
                for (h, other) in creases.around(self.mesh, v) {
                    ahead.push(other);
                    // Each edge once, from its origin.
                    group.extend((self.mesh.origin(h) == v).then_some(h));
                }
            }
            groups.push(group);
        }
        groups
    }
}

/// The first and the last vertex of a chain.
fn chain_ends(chain: &Curve) -> impl Iterator<Item = &Vertex> {
    chain.vertices.first().into_iter().chain(chain.vertices.last())
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 { a.map(|x| x / length) } else { a }
}
