//! Some faces of a cut mesh.

use crate::cut::{Cut, DisjointSets};
use crate::features::widened;
use seamstress_mesh::{Face, FaceData, Halfedge, HalfedgeData, TriMesh, VertexData};

/// Some faces of a cut mesh, with numbers of their own for their wedges.
pub struct Patch {
    /// The faces, ascending.
    faces: Vec<Face>,
    is_inside: FaceData<bool>,
    /// Wedge of the patch at every corner inside.
    wedge: HalfedgeData<u32>,
    n_wedges: usize,
}

impl Patch {
    /// All faces, with the wedges of the cut.
    pub fn whole(mesh: &TriMesh, cut: &Cut) -> Self {
        let is_inside = FaceData::filled(mesh.n_faces(), true);
        let (wedge, n_wedges) = (cut.wedge.clone(), cut.n_wedges);
        Self { faces: mesh.faces().collect(), is_inside, wedge, n_wedges }
    }

    /// The faces in so many rings around marked vertices.
    pub fn around(mesh: &TriMesh, cut: &Cut, marked: VertexData<bool>, rings: usize) -> Self {
        // The last ring is of the faces that touch the others.
        let inner = rings.checked_sub(1).map(|rings| widened(mesh, marked, rings));
        let touches = |inner: &VertexData<bool>, f| mesh.face_vertices(f).iter().any(|&v| inner[v]);
        let is_near = |&f: &Face| inner.as_ref().is_some_and(|inner| touches(inner, f));
        let faces: Vec<Face> = mesh.faces().filter(is_near).collect();
        let mut is_inside = FaceData::filled(mesh.n_faces(), false);
        let mut wedge = HalfedgeData::filled(mesh.n_halfedges(), u32::MAX);
        let (mut number, mut n_wedges) = (vec![None; cut.n_wedges], 0);
        for &f in &faces {
            is_inside[f] = true;
            for h in f.halfedges() {
                wedge[h] = *number[cut.wedge[h] as usize].get_or_insert_with(|| {
                    n_wedges += 1;
                    n_wedges - 1
                });
            }
        }
        Self { faces, is_inside, wedge, n_wedges: n_wedges as usize }
    }

    /// Its faces, ascending.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Number of its wedges.
    pub fn n_wedges(&self) -> usize {
        self.n_wedges
    }

    /// Whether the face of a half-edge belongs to it.
    #[inline]
    pub fn has(&self, h: Halfedge) -> bool {
        self.is_inside[h.face()]
    }

    /// The corners of its faces, with their wedges.
    pub fn corners(&self) -> impl Iterator<Item = (Halfedge, u32)> + '_ {
        self.faces.iter().flat_map(|f| f.halfedges()).map(|h| (h, self.wedge[h]))
    }

    /// Its wedges at the corners of a face inside.
    #[inline]
    pub fn wedges(&self, f: Face) -> [u32; 3] {
        f.halfedges().map(|h| self.wedge[h])
    }

    /// Its wedges at the origin and the tip of a half-edge inside.
    #[inline]
    pub fn ends(&self, h: Halfedge) -> [u32; 2] {
        [self.wedge[h], self.wedge[h.next()]]
    }

    /// For every face of the mesh a face that stands for the piece of the patch it belongs to: those that hang together by edges.
    pub fn pieces(&self, mesh: &TriMesh) -> FaceData<Face> {
        let mut sets = DisjointSets::new(mesh.n_faces());
        for (h, _) in self.corners() {
            if let Some(t) = mesh.twin(h).filter(|&t| self.has(t)) {
                sets.unite(h.face().0, t.face().0);
            }
        }
        mesh.faces().map(|f| Face(sets.find(f.0))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_mesh::Vertex;
    use seamstress_testkit::disk_grid;

    #[test]
    fn rings_around_a_vertex_grow() {
        let grid = disk_grid(7, 7);
        let mesh = TriMesh::from_faces(grid.positions.len(), &grid.faces).unwrap();
        let cut = Cut::new(&mesh, |_| true);
        let inner = |&v: &Vertex| !mesh.is_boundary(v);
        let middle = mesh.vertices().filter(inner).nth(12).unwrap();
        let patch = |rings| {
            let mut marked = VertexData::filled(mesh.n_vertices(), false);
            marked[middle] = true;
            Patch::around(&mesh, &cut, marked, rings)
        };
        let one = patch(1);
        assert_eq!((one.faces().len(), one.n_wedges()), (6, 7));
        assert!(one.corners().all(|(h, w)| one.has(h) && (w as usize) < one.n_wedges()));
        let counts: Vec<usize> = (0..13).map(|rings| patch(rings).faces().len()).collect();
        assert!(counts.is_sorted() && counts[0] == 0 && counts[12] == mesh.n_faces());
        // Around two corners far from each other there are two pieces.
        let mut ends = VertexData::filled(mesh.n_vertices(), false);
        (ends[Vertex(0)], ends[Vertex(mesh.n_vertices() as u32 - 1)]) = (true, true);
        let apart = Patch::around(&mesh, &cut, ends, 1);
        let pieces = apart.pieces(&mesh);
        let mut ids: Vec<Face> = apart.faces().iter().map(|&f| pieces[f]).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), 2);
    }
}
