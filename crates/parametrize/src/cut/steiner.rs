//! Few seams through all cones: a Steiner tree, then a dual tree that respects it.

use super::{Cut, DualTree, prune::prune};
use crate::ordered::Ordered;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A cut to a disk whose seams end at cones or the boundary only, and the dual tree it belongs to.
///
/// Steiner tree over the cones with the boundary as one more terminal (Mehlhorn's approximation on
/// edge lengths), then a breadth-first dual tree that does not cross it; seams that end elsewhere are
/// pruned. The seams are few and come in chains, which keeps the exact seamless space small.
pub fn connect_cones(
    mesh: &TriMesh,
    metric: &Metric,
    is_cone: &VertexData<bool>,
) -> Option<(Cut, DualTree)> {
    let forbidden = steiner_edges(mesh, metric, is_cone);
    let tree = DualTree::breadth_first(mesh, &forbidden)?;
    let mut is_seam: HalfedgeData<bool> =
        mesh.halfedges().map(|h| mesh.twin(h).is_some() && !tree.crossed[h]).collect();
    prune(mesh, &mut is_seam, |v, _| !is_cone[v] && !mesh.is_boundary(v));
    Some((Cut::new(mesh, |h| !is_seam[h]), tree))
}

/// Marks the edges of a short tree that joins all cones and, if there is one, the boundary.
fn steiner_edges(
    mesh: &TriMesh,
    metric: &Metric,
    is_cone: &VertexData<bool>,
) -> HalfedgeData<bool> {
    let n = mesh.n_vertices();
    let boundary = n as u32;
    let mut marked = HalfedgeData::filled(mesh.n_halfedges(), false);
    if !is_cone.contains(&true) {
        return marked;
    }
    // Voronoi cells of the terminals.
    let mut cell = VertexData::filled(n, u32::MAX);
    let mut distance = VertexData::filled(n, f64::INFINITY);
    let mut from: VertexData<Option<Halfedge>> = VertexData::filled(n, None);
    let mut queue = BinaryHeap::new();
    for v in mesh.vertices() {
        if mesh.is_boundary(v) || is_cone[v] {
            cell[v] = if mesh.is_boundary(v) { boundary } else { v.0 };
            distance[v] = 0.0;
            queue.push(Reverse((Ordered(0.0), v)));
        }
    }
    while let Some(Reverse((Ordered(d), v))) = queue.pop() {
        if d > distance[v] {
            continue;
        }
        for h in mesh.outgoing(v).filter(|&h| mesh.twin(h).is_some()) {
            let (w, reach) = (mesh.tip(h), d + metric.length[h]);
            if reach < distance[w] {
                distance[w] = reach;
                cell[w] = cell[v];
                from[w] = Some(h);
                queue.push(Reverse((Ordered(reach), w)));
            }
        }
    }
    // Kruskal over the edges between cells.
    let mut bridges: Vec<(Ordered, Halfedge)> = mesh
        .interior_edges()
        .filter(|&h| cell[mesh.origin(h)] != cell[mesh.tip(h)])
        .map(|h| {
            let reach = distance[mesh.origin(h)] + distance[mesh.tip(h)] + metric.length[h];
            (Ordered(reach), h)
        })
        .collect();
    bridges.sort_unstable();
    let mut sets = DisjointSets::new(n + 1);
    for (_, h) in bridges {
        if sets.unite(cell[mesh.origin(h)], cell[mesh.tip(h)]) {
            mark(mesh, &mut marked, h);
            for mut v in [mesh.origin(h), mesh.tip(h)] {
                while let Some(g) = from[v] {
                    mark(mesh, &mut marked, g);
                    v = mesh.origin(g);
                }
            }
        }
    }
    marked
}

fn mark(mesh: &TriMesh, marked: &mut HalfedgeData<bool>, h: Halfedge) {
    marked[h] = true;
    if let Some(t) = mesh.twin(h) {
        marked[t] = true;
    }
}

/// Sets of ids that grow together.
pub(crate) struct DisjointSets(Vec<u32>);

impl DisjointSets {
    pub(crate) fn new(n: usize) -> Self {
        Self((0..n as u32).collect())
    }

    /// The id that stands for the set of `x`.
    pub(crate) fn find(&mut self, mut x: u32) -> u32 {
        while self.0[x as usize] != x {
            let parent = self.0[x as usize];
            self.0[x as usize] = self.0[parent as usize];
            x = parent;
        }
        x
    }

    /// Joins two sets; false if they were one already.
    pub(crate) fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a as usize] = b;
        a != b
    }
}
