//! The graph of seams: nodes joined by chains, one translation per chain.

use super::Cut;
use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh, Vertex, VertexData};

/// A chain of seams between two nodes, or a loop through one.
#[derive(Debug, Clone)]
pub struct Chain {
    /// The half-edges on its left, in order.
    pub left: Vec<Halfedge>,
}

/// Seams grouped in chains.
///
/// A *node* is a vertex where the number of seams is not two, a cone, or a boundary vertex; loops
/// without any get one.
#[derive(Debug, Clone)]
pub struct SeamGraph {
    /// All chains.
    pub chains: Vec<Chain>,
    /// For a seam half-edge: its chain, and whether it lies on the chain's left.
    pub chain_of: HalfedgeData<Option<(u32, bool)>>,
    /// Whether a vertex is a node.
    pub is_node: VertexData<bool>,
    /// Number of seams at each vertex.
    pub degree: VertexData<u32>,
}

impl SeamGraph {
    /// Groups the seams of a cut.
    pub fn new(mesh: &TriMesh, cut: &Cut, is_cone: &VertexData<bool>) -> Self {
        let mut degree = VertexData::filled(mesh.n_vertices(), 0u32);
        for h in mesh.halfedges().filter(|&h| cut.is_seam[h]) {
            degree[mesh.origin(h)] += 1;
        }
        let node =
            |v: Vertex| degree[v] > 0 && (degree[v] != 2 || is_cone[v] || mesh.is_boundary(v));
        let is_node = mesh.vertices().map(node).collect();
        let mut graph = Self {
            chains: Vec::new(),
            chain_of: HalfedgeData::filled(mesh.n_halfedges(), None),
            is_node,
            degree,
        };
        for v in mesh.vertices() {
            if graph.is_node[v] {
                for h in mesh.outgoing(v).filter(|&h| cut.is_seam[h]) {
                    graph.trace(mesh, cut, h);
                }
            }
        }
        // What is left are loops without a node.
        for h in mesh.halfedges().filter(|&h| cut.is_seam[h]) {
            if graph.chain_of[h].is_none() {
                graph.is_node[mesh.origin(h)] = true;
                graph.trace(mesh, cut, h);
            }
        }
        graph
    }

    /// Follows the seams from a node to the next one, unless that was done already.
    fn trace(&mut self, mesh: &TriMesh, cut: &Cut, start: Halfedge) {
        if self.chain_of[start].is_some() {
            return;
        }
        let id = self.chains.len() as u32;
        let mut left = Vec::new();
        let mut h = start;
        while let Some(t) = mesh.twin(h) {
            self.chain_of[h] = Some((id, true));
            self.chain_of[t] = Some((id, false));
            left.push(h);
            let v = mesh.origin(t);
            if self.is_node[v] {
                break;
            }
            match mesh.outgoing(v).find(|&g| cut.is_seam[g] && g != t) {
                Some(g) => h = g,
                None => break,
            }
        }
        self.chains.push(Chain { left });
    }
}
