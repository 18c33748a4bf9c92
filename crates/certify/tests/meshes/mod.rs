//! Maps of meshes, certified.
#![allow(clippy::unwrap_used, dead_code, unreachable_pub, reason = "helpers of tests")]

use seamstress_certify::{
    Alignment, Certificate, Cone, Map, Seam, Seamless, Tolerance, Violations,
};
use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::TriangleSoup;

/// UVs that have passed the check, and what was found.
pub struct SeamlessMap {
    uvs: Vec<[f64; 2]>,
    found: Seamless,
}

impl SeamlessMap {
    pub fn certify(
        mesh: &TriMesh,
        uvs: Vec<[f64; 2]>,
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        let found = Map::new(mesh.n_vertices(), &faces(mesh), &uvs)?.seamless(tolerance)?;
        Ok(Self { uvs, found })
    }

    pub fn alignment(
        &self,
        mesh: &TriMesh,
        edges: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Result<Alignment, Violations> {
        Map::new(mesh.n_vertices(), &faces(mesh), &self.uvs)?.alignment(edges, tolerance)
    }

    pub fn cones(&self) -> &[Cone] {
        &self.found.cones
    }

    pub fn seams(&self) -> &[Seam] {
        &self.found.seams
    }

    pub fn certificate(&self) -> &Certificate {
        &self.found.certificate
    }
}

pub fn mesh_of(soup: &TriangleSoup) -> TriMesh {
    TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap()
}

fn faces(mesh: &TriMesh) -> Vec<[u32; 3]> {
    mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.0)).collect()
}
