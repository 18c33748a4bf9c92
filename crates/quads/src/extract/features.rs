//! Vertices of quads on features of the source.

use super::{Extraction, SurfacePoint};
use crate::constraints::{Constraints, SlideCurve};
use seamstress_mesh::features::{EdgeSet, FeatureGraph};
use seamstress_mesh::{
    Face, Geometry, Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData,
};
use std::collections::HashSet;

impl Extraction {
    /// What keeps vertices of the quad mesh on edges of the source and on its boundary: those at ends, turns and
    /// junctions of the curves that these edges form are fixed, others slide along their curve. Curves list both.
    ///
    /// Edges are named by their ends. A vertex counts as on an edge if the map has it there exactly.
    pub fn constraints(
        &self,
        source: &TriMesh,
        geometry: Geometry<'_>,
        edges: &[[u32; 2]],
    ) -> Constraints {
        let edges = named(source, edges).union(source, &EdgeSet::boundary(source));
        let positions = geometry.positions;
        let metric = Metric::from_positions(source, positions);
        let graph = FeatureGraph::new(source, &metric, &edges);
        let mut ends = VertexData::filled(source.n_vertices(), Vec::new());
        for (c, curve) in graph.curves.iter().enumerate().filter(|(_, curve)| !curve.is_loop) {
            let [first, last] = [curve.vertices[0], curve.vertices[curve.vertices.len() - 1]];
            ends[first].push(c);
            if last != first {
                ends[last].push(c);
            }
        }
        let mut curve_of = HalfedgeData::filled(source.n_halfedges(), None);
        for (c, curve) in graph.curves.iter().enumerate() {
            curve.edges.iter().for_each(|&edge| curve_of[edge] = Some(c));
        }

        let empty = |vertices: &[Vertex]| SlideCurve {
            points: vertices.iter().map(|v| positions[v.at()]).collect(),
            sizes: geometry
                .sizes
                .map_or_else(Vec::new, |sizes| vertices.iter().map(|v| sizes[v.at()]).collect()),
            vertices: Vec::new(),
        };
        let curves = graph.curves.iter().map(|curve| empty(&curve.vertices)).collect();
        let sizes = geometry.sizes.map_or_else(Vec::new, |sizes| {
            let size = |at: &SurfacePoint| {
                let corners = source.face_vertices(Face(at.face)).map(|v| sizes[v.at()]);
                at.weighted(corners)
            };
            self.sources.iter().map(size).collect()
        });
        let mut constraints = Constraints { fixed: Vec::new(), curves, sizes };
        for (v, at) in (0..).zip(&self.sources) {
            let edge = match Site::new(source, at) {
                Site::Vertex(at) if !ends[at].is_empty() => {
                    constraints.fixed.push(v);
                    ends[at].iter().for_each(|&c| constraints.curves[c].vertices.push(v));
                    continue;
                }
                Site::Vertex(at) => edges.around(source, at).next().map(|(edge, _)| edge),
                Site::Edge(edge) => Some(edge),
                Site::Inside => None,
            };
            if let Some(curve) = edge.and_then(|edge| curve_of[edge]) {
                constraints.curves[curve].vertices.push(v);
            }
        }
        constraints.curves.retain(|curve| !curve.vertices.is_empty());
        constraints
    }
}

/// The edges with these ends.
fn named(mesh: &TriMesh, ends: &[[u32; 2]]) -> EdgeSet {
    let ends: HashSet<[u32; 2]> = ends.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    let is_named = |&h: &Halfedge| {
        let [a, b] = [mesh.origin(h).0, mesh.tip(h).0];
        ends.contains(&[a.min(b), a.max(b)])
    };
    EdgeSet::new(mesh, mesh.edges().filter(is_named))
}

/// Where a point lies on a mesh.
enum Site {
    Vertex(Vertex),
    /// The smaller half-edge.
    Edge(Halfedge),
    Inside,
}

impl Site {
    fn new(mesh: &TriMesh, at: &SurfacePoint) -> Self {
        let sides = Face(at.face).halfedges();
        let edge = |h: Halfedge| Self::Edge(mesh.twin(h).map_or(h, |twin| h.min(twin)));
        match at.barycentric.map(|w| w == 0.0) {
            [false, true, true] => Self::Vertex(mesh.origin(sides[0])),
            [true, false, true] => Self::Vertex(mesh.origin(sides[1])),
            [true, true, false] => Self::Vertex(mesh.origin(sides[2])),
            [false, false, true] => edge(sides[0]),
            [true, false, false] => edge(sides[1]),
            [false, true, false] => edge(sides[2]),
            _ => Self::Inside,
        }
    }
}
