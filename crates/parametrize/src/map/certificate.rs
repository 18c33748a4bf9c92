//! Certified maps.

use seamstress_certify::{
    Alignment, Certificate, Cone, IntegerCertificate, Map, Seam, Seamless, Tolerance, Violations,
};
use seamstress_mesh::{Halfedge, TriMesh};

/// An interior edge across which the UVs jump.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SeamEdge {
    /// Left half-edge; its twin is on the right.
    #[serde(skip)]
    pub left: Halfedge,
    /// Ends of the edge.
    pub vertices: [u32; 2],
    /// Quarter turns from left to right, 0 to 3: `uv_right = i^matching uv_left + translation`.
    pub matching: i32,
    /// Translation from left to right, UV units.
    pub translation: [f64; 2],
}

impl From<Seam> for SeamEdge {
    fn from(Seam { left, vertices, matching, translation }: Seam) -> Self {
        Self { left: Halfedge(left), vertices, matching, translation }
    }
}

/// A locally injective, seamless map with cones at multiples of a quarter turn.
///
/// It can only be had by passing [`SeamlessMap::certify`], so whoever holds one needs no further check.
#[derive(Debug, Clone)]
pub struct SeamlessMap {
    corner_uvs: Vec<[f64; 2]>,
    cones: Vec<Cone>,
    seams: Vec<SeamEdge>,
    certificate: Certificate,
}

impl SeamlessMap {
    /// Certifies a map given by one UV per corner (three per face, in the faces' order), by [`Map::seamless`].
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn certify(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        let found = checked(mesh, &corner_uvs)?.seamless(tolerance)?;
        Ok(Self::found(corner_uvs, found))
    }

    /// The same, with [`Self::alignment`].
    ///
    /// # Errors
    /// Every violation of the map or, if there is none, of its alignment.
    pub(crate) fn certify_aligned(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        edges: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Result<(Self, Alignment), Violations> {
        let map = checked(mesh, &corner_uvs)?;
        let found = map.seamless(tolerance)?;
        let alignment = map.alignment(edges, &Tolerance::default())?;
        Ok((Self::found(corner_uvs, found), alignment))
    }

    fn found(corner_uvs: Vec<[f64; 2]>, found: Seamless) -> Self {
        let Seamless { cones, seams, certificate } = found;
        let seams = seams.into_iter().map(SeamEdge::from).collect();
        Self { corner_uvs, cones, seams, certificate }
    }

    /// Certifies that edges, given by their end vertices, run along the axes of this map of a mesh, by
    /// [`Map::alignment`].
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn alignment(
        &self,
        mesh: &TriMesh,
        edges: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Result<Alignment, Violations> {
        checked(mesh, &self.corner_uvs)?.alignment(edges, tolerance)
    }

    /// Certifies that this map of a mesh, in grid units, is an integer-grid map with edges on its isolines, by
    /// [`Map::integers`].
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn integers(
        &self,
        mesh: &TriMesh,
        aligned: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Result<IntegerCertificate, Violations> {
        checked(mesh, &self.corner_uvs)?.integers(aligned, tolerance)
    }

    /// One UV per corner, three per face.
    pub fn corner_uvs(&self) -> &[[f64; 2]] {
        &self.corner_uvs
    }

    /// Its UVs.
    pub(crate) fn into_corner_uvs(self) -> Vec<[f64; 2]> {
        self.corner_uvs
    }

    /// Interior vertices with an angle other than a full turn, ascending.
    pub fn cones(&self) -> &[Cone] {
        &self.cones
    }

    /// Interior edges across which the UVs jump.
    pub fn seams(&self) -> &[SeamEdge] {
        &self.seams
    }

    /// The figures of the certificate.
    pub fn certificate(&self) -> &Certificate {
        &self.certificate
    }
}

/// The map as the checker takes it: from the faces alone.
fn checked<'a>(mesh: &TriMesh, corner_uvs: &'a [[f64; 2]]) -> Result<Map<'a>, Violations> {
    let faces: Vec<_> = mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.0)).collect();
    Map::new(mesh.n_vertices(), &faces, corner_uvs)
}
