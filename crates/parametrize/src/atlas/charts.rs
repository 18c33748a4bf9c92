//! Charts: faces that hang together in the plane.

use seamstress_mesh::{Face, FaceData, Halfedge, TriMesh};
use std::collections::VecDeque;

/// The faces of a map in charts.
#[derive(Debug, Clone)]
pub(super) struct Charts {
    pub(super) of_face: FaceData<u32>,
    /// The faces of each, in the order in which it grew.
    pub(super) faces: Vec<Vec<Face>>,
}

impl Charts {
    /// Charts grown face by face across edges on whose sides the UVs are the same, ring by ring; none takes a face that lies
    /// over one that it has, given the faces that each lies over.
    pub(super) fn new(mesh: &TriMesh, corner_uvs: &[[f64; 2]], over: &FaceData<Vec<Face>>) -> Self {
        const NONE: u32 = u32::MAX;
        let mut of_face = FaceData::filled(mesh.n_faces(), NONE);
        let mut faces: Vec<Vec<Face>> = Vec::new();
        let across = |h: Halfedge| {
            let uv = |h: Halfedge| corner_uvs[h.at()];
            let twin = mesh.twin(h)?;
            (uv(h) == uv(twin.next()) && uv(h.next()) == uv(twin)).then(|| twin.face())
        };
        for seed in mesh.faces() {
            if of_face[seed] != NONE {
                continue;
            }
            let chart = faces.len() as u32;
            let mut taken = vec![seed];
            of_face[seed] = chart;
            let mut ring = VecDeque::from([seed]);
            while let Some(f) = ring.pop_front() {
                for g in f.halfedges().into_iter().filter_map(across) {
                    let is_free = of_face[g] == NONE;
                    if is_free && over[g].iter().all(|&other| of_face[other] != chart) {
                        of_face[g] = chart;
                        taken.push(g);
                        ring.push_back(g);
                    }
                }
            }
            faces.push(taken);
        }
        Self { of_face, faces }
    }

    pub(super) fn n_charts(&self) -> usize {
        self.faces.len()
    }
}
