//! The curves that feature edges form.

use super::{EdgeSet, sectors};
use crate::ids::{Halfedge, HalfedgeData, Vertex, VertexData};
use crate::mesh::TriMesh;
use crate::metric::Metric;
use std::f64::consts::FRAC_PI_2;

/// What makes a vertex end the curves that meet there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum NodeKind {
    /// A single edge ends inside the surface.
    OpenEnd,
    /// A single edge ends on the boundary, which is not part of the features.
    BoundaryEnd,
    /// Two edges meet at a turn: the surface on one side has an angle nearer to another number of
    /// quarter turns than to two.
    Turn,
    /// Three or more edges meet.
    Junction,
}

/// A vertex at which curves end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Node {
    /// The vertex.
    pub vertex: Vertex,
    /// Number of feature edges there.
    pub degree: usize,
    /// Why curves end there.
    pub kind: NodeKind,
}

/// A chain of feature edges from node to node, or a loop without a node.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its vertices in order, one more than it has edges; of a closed curve the first comes again.
    pub vertices: Vec<Vertex>,
    /// The smaller half-edge of each of its edges, in order.
    pub edges: Vec<Halfedge>,
    /// Whether no node lies on it; it is closed then.
    pub is_loop: bool,
    /// Number of its edges on the boundary of the mesh.
    pub boundary_edges: usize,
    /// Length, mesh units.
    pub length: f64,
}

/// Nodes and curves of a set of feature edges.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureGraph {
    /// Vertices at which curves end, ascending.
    pub nodes: Vec<Node>,
    /// The curves: those between nodes in the order of their first nodes, then the loops.
    pub curves: Vec<Curve>,
}

impl FeatureGraph {
    /// Joins edges to curves. Nothing but the metric decides what is a turn.
    pub fn new(mesh: &TriMesh, metric: &Metric, edges: &EdgeSet) -> Self {
        let nodes = mesh.vertices().filter_map(|v| node(mesh, metric, edges, v)).collect();
        Self::between(mesh, metric, edges, nodes)
    }

    /// Joins edges to chains that pass through turns: only vertices without exactly two edges end them.
    pub(super) fn chains(mesh: &TriMesh, metric: &Metric, edges: &EdgeSet) -> Self {
        let nodes = mesh.vertices().filter_map(|v| node(mesh, metric, edges, v));
        let nodes = nodes.filter(|node| node.kind != NodeKind::Turn).collect();
        Self::between(mesh, metric, edges, nodes)
    }

    fn between(mesh: &TriMesh, metric: &Metric, edges: &EdgeSet, nodes: Vec<Node>) -> Self {
        let mut tracer = Tracer::new(mesh, metric, edges, &nodes);
        let mut curves = Vec::new();
        for node in &nodes {
            for (edge, _) in edges.around(mesh, node.vertex) {
                curves.extend(tracer.trace(node.vertex, edge, false));
            }
        }
        for &edge in edges.edges() {
            curves.extend(tracer.trace(mesh.origin(edge), edge, true));
        }
        Self { nodes, curves }
    }

    /// The nodes at the ends of a curve.
    pub(super) fn ends(&self, curve: &Curve) -> impl Iterator<Item = &Node> {
        let ends = [curve.vertices.first(), curve.vertices.last()].into_iter().flatten();
        ends.filter_map(|&v| {
            let found = self.nodes.binary_search_by_key(&v, |node| node.vertex);
            found.ok().map(|k| &self.nodes[k])
        })
    }

    /// Number of nodes of a kind.
    pub fn count(&self, kind: NodeKind) -> usize {
        self.nodes.iter().filter(|node| node.kind == kind).count()
    }

    /// Number of loops without a node.
    pub fn n_loops(&self) -> usize {
        self.curves.iter().filter(|curve| curve.is_loop).count()
    }

    /// Total length, mesh units.
    pub fn length(&self) -> f64 {
        self.curves.iter().map(|curve| curve.length).sum()
    }
}

fn node(mesh: &TriMesh, metric: &Metric, edges: &EdgeSet, vertex: Vertex) -> Option<Node> {
    let degree = edges.around(mesh, vertex).count();
    let kind = match degree {
        0 => return None,
        1 if mesh.is_boundary(vertex) => NodeKind::BoundaryEnd,
        1 => NodeKind::OpenEnd,
        2 if turns(mesh, metric, edges, vertex) => NodeKind::Turn,
        2 => return None,
        _ => NodeKind::Junction,
    };
    Some(Node { vertex, degree, kind })
}

fn turns(mesh: &TriMesh, metric: &Metric, edges: &EdgeSet, v: Vertex) -> bool {
    sectors(mesh, edges, v).iter().filter(|sector| !sector.is_free).any(|sector| {
        let angle: f64 = sector.corners.iter().map(|&corner| metric.angle[corner]).sum();
        (angle / FRAC_PI_2).round() != 2.0
    })
}

/// Follows curves, each edge once.
struct Tracer<'a> {
    mesh: &'a TriMesh,
    metric: &'a Metric,
    edges: &'a EdgeSet,
    is_node: VertexData<bool>,
    is_used: HalfedgeData<bool>,
}

impl<'a> Tracer<'a> {
    fn new(mesh: &'a TriMesh, metric: &'a Metric, edges: &'a EdgeSet, nodes: &[Node]) -> Self {
        let mut is_node = VertexData::filled(mesh.n_vertices(), false);
        for node in nodes {
            is_node[node.vertex] = true;
        }
        let is_used = HalfedgeData::filled(mesh.n_halfedges(), false);
        Self { mesh, metric, edges, is_node, is_used }
    }

    /// The curve that leaves a vertex along an edge, if that edge is not part of one yet.
    fn trace(&mut self, from: Vertex, edge: Halfedge, is_loop: bool) -> Option<Curve> {
        if self.is_used[edge] {
            return None;
        }
        let mut curve = Curve {
            vertices: vec![from],
            edges: Vec::new(),
            is_loop,
            boundary_edges: 0,
            length: 0.0,
        };
        let mut at = from;
        let mut next = Some(edge);
        while let Some(edge) = next {
            self.is_used[edge] = true;
            curve.edges.push(edge);
            curve.length += self.metric.length[edge] * self.metric.unit;
            curve.boundary_edges += usize::from(self.mesh.twin(edge).is_none());
            let (origin, tip) = (self.mesh.origin(edge), self.mesh.tip(edge));
            at = if at == origin { tip } else { origin };
            curve.vertices.push(at);
            next = if self.is_node[at] { None } else { self.unused(at) };
        }
        Some(curve)
    }

    fn unused(&self, v: Vertex) -> Option<Halfedge> {
        let mut around = self.edges.around(self.mesh, v).map(|(edge, _)| edge);
        around.find(|&edge| !self.is_used[edge])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit square grid of `n` by `n` cells, each split along a diagonal; vertex `(n + 1) y + x`.
    fn grid(n: u32) -> (TriMesh, Metric) {
        let at = |x, y| y * (n + 1) + x;
        let cells = (0..n).flat_map(|y| (0..n).map(move |x| (x, y)));
        let faces: Vec<_> = cells
            .flat_map(|(x, y)| {
                let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let vertices =
            (0..=n).flat_map(|y| (0..=n).map(move |x| [f64::from(x), f64::from(y), 0.0]));
        let positions: Vec<_> = vertices.collect();
        let mesh = TriMesh::from_faces(positions.len(), &faces).unwrap();
        let metric = Metric::from_positions(&mesh, &positions);
        (mesh, metric)
    }

    fn path(mesh: &TriMesh, vertices: &[u32]) -> EdgeSet {
        let edge = |p: &[u32]| mesh.edge_between(Vertex(p[0]), Vertex(p[1])).unwrap();
        EdgeSet::new(mesh, vertices.windows(2).map(edge))
    }

    fn kinds(graph: &FeatureGraph) -> Vec<(u32, NodeKind)> {
        graph.nodes.iter().map(|node| (node.vertex.0, node.kind)).collect()
    }

    fn vertices(curve: &Curve) -> Vec<u32> {
        curve.vertices.iter().map(|v| v.0).collect()
    }

    #[test]
    fn the_rim_of_a_square_turns_at_its_corners() {
        let (mesh, metric) = grid(2);
        let graph = FeatureGraph::new(&mesh, &metric, &EdgeSet::boundary(&mesh));
        assert_eq!(kinds(&graph), [0, 2, 6, 8].map(|v| (v, NodeKind::Turn)));
        assert_eq!((graph.curves.len(), graph.n_loops()), (4, 0));
        for curve in &graph.curves {
            assert_eq!((curve.vertices.len(), curve.edges.len(), curve.boundary_edges), (3, 2, 2));
            for (pair, &edge) in curve.vertices.windows(2).zip(&curve.edges) {
                assert_eq!(mesh.edge_between(pair[0], pair[1]), Some(edge));
            }
            assert!((curve.length - 2.0).abs() < 1e-14);
        }
        assert!((graph.length() - 8.0).abs() < 1e-14);
    }

    #[test]
    fn open_ends_boundary_ends_and_turns() {
        let (mesh, metric) = grid(4);
        // From the boundary at the left to the middle, and up.
        let graph = FeatureGraph::new(&mesh, &metric, &path(&mesh, &[10, 11, 12, 17]));
        let expected = [(10, NodeKind::BoundaryEnd), (12, NodeKind::Turn), (17, NodeKind::OpenEnd)];
        assert_eq!(kinds(&graph), expected);
        let curves: Vec<_> = graph.curves.iter().map(vertices).collect();
        assert_eq!(curves, [vec![10, 11, 12], vec![12, 17]]);
        // With the boundary, the end on it is a junction.
        let with_rim = path(&mesh, &[10, 11, 12]).union(&mesh, &EdgeSet::boundary(&mesh));
        let graph = FeatureGraph::new(&mesh, &metric, &with_rim);
        assert_eq!(graph.count(NodeKind::Junction), 1);
        assert_eq!(graph.count(NodeKind::BoundaryEnd), 0);
        assert_eq!(
            graph.nodes[2],
            Node { vertex: Vertex(10), degree: 3, kind: NodeKind::Junction }
        );
        assert_eq!(graph.curves.iter().map(|c| c.boundary_edges).sum::<usize>(), 16);
    }

    #[test]
    fn crossings_part_curves() {
        let (mesh, metric) = grid(4);
        let cross = path(&mesh, &[10, 11, 12, 13, 14]);
        let cross = cross.union(&mesh, &path(&mesh, &[2, 7, 12, 17, 22]));
        let graph = FeatureGraph::new(&mesh, &metric, &cross);
        assert_eq!(graph.curves.len(), 4);
        assert_eq!(graph.count(NodeKind::Junction), 1);
        assert_eq!(graph.count(NodeKind::BoundaryEnd), 4);
    }

    #[test]
    fn the_rim_of_a_round_fan_is_a_loop() {
        let n = 12u32;
        let faces: Vec<_> = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
        let rim = (0..n).map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            [angle.cos(), angle.sin(), 0.0]
        });
        let positions: Vec<_> = std::iter::once([0.0; 3]).chain(rim).collect();
        let mesh = TriMesh::from_faces(positions.len(), &faces).unwrap();
        let metric = Metric::from_positions(&mesh, &positions);
        let graph = FeatureGraph::new(&mesh, &metric, &EdgeSet::boundary(&mesh));
        assert_eq!((graph.nodes.len(), graph.n_loops(), graph.curves.len()), (0, 1, 1));
        let around = vertices(&graph.curves[0]);
        assert_eq!((around.len(), around[0]), (13, around[12]));
    }

    #[test]
    fn a_closed_curve_with_one_node_is_no_loop() {
        let (mesh, metric) = grid(4);
        // A drop: a stem from the boundary that ends in a ring around a cell.
        let drop = path(&mesh, &[10, 11, 12, 17, 16, 11]);
        let graph = FeatureGraph::new(&mesh, &metric, &drop);
        assert_eq!(graph.n_loops(), 0);
        assert_eq!(graph.count(NodeKind::Junction), 1);
        assert_eq!(graph.curves.iter().map(|c| c.vertices.len() - 1).sum::<usize>(), drop.len());
        assert_eq!(FeatureGraph::new(&mesh, &metric, &path(&mesh, &[])).curves, []);
    }
}
