//! Features of the mesh and of its components, and the certificate of the whole.

use super::MapError;
use crate::features::ReleasedFeature;
use crate::map::{Alignment, SeamlessMap, Tolerance};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Halfedge, TriMesh, Vertex};

/// What became of the features of all components, in the ids of the whole mesh.
#[derive(Debug, Default)]
pub(super) struct FeatureTally {
    kept: Vec<Halfedge>,
    released: Vec<ReleasedFeature>,
    /// The certified map of a component that is the whole mesh.
    whole: Option<(SeamlessMap, Alignment)>,
}

/// A certified map of all components, with what became of the features.
pub(super) struct AlignedMap {
    pub(super) map: SeamlessMap,
    pub(super) features: EdgeSet,
    pub(super) alignment: Alignment,
    pub(super) released: Vec<ReleasedFeature>,
}

impl FeatureTally {
    /// Adds those of a component, given in its own ids.
    pub(super) fn add(&mut self, piece: &Component, kept: &EdgeSet, released: &[ReleasedFeature]) {
        let whole = |h: &Halfedge| piece.faces[h.face().at()].halfedge(h.side());
        self.kept.extend(kept.edges().iter().map(whole));
        self.released.extend(released.iter().map(|feature| ReleasedFeature {
            vertices: feature.vertices.map(|v| piece.vertices[Vertex(v)].0),
            ..*feature
        }));
    }

    /// Takes the certified map of a component that is the mesh itself.
    pub(super) fn take_whole(&mut self, map: SeamlessMap, alignment: Alignment) {
        self.whole = Some((map, alignment));
    }

    /// Certifies the map of all components, unless it is that of the only one, which is certified; if it is strict about
    /// features, none may be released.
    ///
    /// # Errors
    /// [`MapError::Released`] or [`MapError::Uncertified`].
    pub(super) fn certify(
        self,
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        is_strict: bool,
        tolerance: &Tolerance,
    ) -> Result<AlignedMap, MapError> {
        let Self { kept, released, whole } = self;
        if is_strict && !released.is_empty() {
            return Err(MapError::Released { released });
        }
        let features = EdgeSet::new(mesh, kept);
        let pairs = features.vertex_pairs(mesh);
        let (map, alignment) = match whole.filter(|(map, _)| map.corner_uvs() == corner_uvs) {
            Some(certified) => certified,
            None => SeamlessMap::certify_aligned(mesh, corner_uvs, &pairs, tolerance)?,
        };
        Ok(AlignedMap { map, features, alignment, released })
    }
}
