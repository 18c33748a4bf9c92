//! Full turns of matchings from indices: eq. (13) of Levi 2021 by elimination.

use super::cross_field::loop_index;
use super::homology::{Homology, NodeIndices};
use seamstress_mesh::{HalfedgeData, TriMesh};

/// Why no full turns give the indices asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LiftError {
    /// The index asked for is not that of the matchings modulo 4.
    #[error("node {node} has index {found} and cannot get {expected}: they differ by no full turn")]
    Node {
        /// Interior vertex or boundary loop, by its number in the homology basis.
        node: u32,
        /// At the matchings given.
        found: i32,
        /// Asked for.
        expected: i32,
    },
    /// The same for a loop.
    #[error(
        "loop {index} has index {found} and cannot get {expected}: they differ by no full turn"
    )]
    Loop {
        /// The loop.
        index: usize,
        /// At the matchings given.
        found: i32,
        /// Asked for.
        expected: i32,
    },
    /// The indices asked for do not have the sum that the topology fixes.
    #[error("the indices of a component miss four times its Euler characteristic by {by}")]
    Sum {
        /// Quarters in excess.
        by: i32,
    },
}

/// The full turns `k`, negated on twins, such that the matchings `r + 4 k` have these indices at all nodes
/// and loops; eq. (13).
///
/// `found` are the node indices at `r`. The system is homogeneous up to its right-hand side and is solved
/// by elimination: `k = 0` across the cotree; the edge that closes a loop is alone in its condition (13c);
/// the spanning forest of the nodes is walked from its leaves, where (13b) has one unknown left.
///
/// # Errors
/// [`LiftError`] exactly when the system has no solution.
pub fn lift(
    mesh: &TriMesh,
    homology: &Homology,
    matching: &HalfedgeData<i32>,
    found: &NodeIndices,
    nodes: &NodeIndices,
    loops: &[i32],
) -> Result<HalfedgeData<i32>, LiftError> {
    let mut k = HalfedgeData::filled(mesh.n_halfedges(), 0);
    // Full turns by which the node's index has to fall.
    let mut excess = Vec::with_capacity(found.0.len());
    for (node, (&found, &expected)) in found.0.iter().zip(&nodes.0).enumerate() {
        if (found - expected) % 4 != 0 {
            return Err(LiftError::Node { node: node as u32, found, expected });
        }
        excess.push((found - expected) / 4);
    }
    let generators = homology.generators().iter().zip(homology.loops());
    for (index, ((&h, dual_loop), &expected)) in generators.zip(loops).enumerate() {
        let found = loop_index(mesh, matching, dual_loop);
        if (expected - found) % 4 != 0 {
            return Err(LiftError::Loop { index, found, expected });
        }
        let turns = (expected - found) / 4;
        let Some(t) = mesh.twin(h) else { continue };
        (k[h], k[t]) = (turns, -turns);
        // A full turn more on a half-edge takes 4 from the index of its origin.
        if let (Some(a), Some(b)) =
            (homology.nodes()[mesh.origin(h)], homology.nodes()[mesh.tip(h)])
        {
            excess[a as usize] -= turns;
            excess[b as usize] += turns;
        }
    }
    for branch in homology.branches().iter().rev() {
        let turns = std::mem::take(&mut excess[branch.node as usize]);
        excess[branch.parent as usize] += turns;
        let Some(t) = mesh.twin(branch.edge) else { continue };
        (k[branch.edge], k[t]) = (turns, -turns);
    }
    match homology.roots().iter().find(|&&root| excess[root as usize] != 0) {
        Some(&root) => Err(LiftError::Sum { by: -4 * excess[root as usize] }),
        None => Ok(k),
    }
}
