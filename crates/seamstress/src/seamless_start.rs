//! The seamless map that a grid is made from.

use crate::features::{AlignedFeatures, edges_of};
use seamstress_mesh::TriMesh;
use seamstress_mesh::features::EdgeSet;
use seamstress_parametrize::Tolerance;
use seamstress_parametrize::map::SeamlessMap;

/// What an integer-grid map is made from.
pub(crate) struct SeamlessStart {
    pub(crate) map: SeamlessMap,
    pub(crate) features: Option<AlignedFeatures>,
    /// What it was certified to.
    pub(crate) tolerance: Tolerance,
}

impl SeamlessStart {
    /// The features that it follows.
    pub(crate) fn kept(&self, mesh: &TriMesh) -> EdgeSet {
        let kept = self.features.as_ref().map_or(&[][..], |features| &features.kept);
        edges_of(mesh, kept)
    }

    /// The same, following fewer of them.
    pub(crate) fn without(mut self, mesh: &TriMesh, edges: &EdgeSet) -> Self {
        if let Some(features) = &mut self.features {
            let left = edges_of(mesh, &features.kept).without(mesh, edges.edges().iter().copied());
            features.kept = left.vertex_pairs(mesh);
        }
        self
    }
}
