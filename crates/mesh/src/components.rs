//! The connected pieces of a mesh, each made a mesh of its own.

use crate::ids::{Face, Vertex, VertexData};
use crate::mesh::{MeshError, TriMesh};

/// A connected piece of a larger mesh, with the way back.
#[derive(Debug, Clone)]
pub struct Component {
    /// The piece; every vertex has a face.
    pub mesh: TriMesh,
    /// Vertex of the whole for each vertex of the piece.
    pub vertices: VertexData<Vertex>,
    /// Face of the whole for each face of the piece, ascending.
    pub faces: Vec<Face>,
}

impl Component {
    /// Those of the piece among the positions of the whole.
    pub fn positions(&self, of_whole: &[[f64; 3]]) -> Vec<[f64; 3]> {
        self.of_vertices(of_whole)
    }

    /// Those of the piece among values of the vertices of the whole.
    pub fn of_vertices<T: Copy>(&self, of_whole: &[T]) -> Vec<T> {
        self.vertices.iter().map(|v| of_whole[v.at()]).collect()
    }

    /// Those of the piece among the UVs of the whole, one per corner.
    pub fn corner_uvs(&self, of_whole: &[[f64; 2]]) -> Vec<[f64; 2]> {
        self.faces.iter().flat_map(|f| f.halfedges().map(|h| of_whole[h.at()])).collect()
    }
}

/// A connected piece of a mesh for which something failed.
#[derive(Debug, Clone, thiserror::Error)]
#[error("component {component} (with face {face}): {cause}")]
pub struct FailedComponent<E: std::error::Error> {
    /// The piece, in order of first faces.
    pub component: usize,
    /// Its first face.
    pub face: u32,
    /// What failed, with the elements of the whole.
    pub cause: E,
}

/// All pieces that failed, in words.
pub fn listed<E: std::error::Error>(failed: &[FailedComponent<E>]) -> String {
    failed.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

/// Splits a mesh into its connected pieces, in order of their first face.
///
/// # Errors
/// None for a mesh that stands; the type is that of [`TriMesh::from_faces`].
pub fn components(mesh: &TriMesh) -> Result<Vec<Component>, MeshError> {
    let (label, count) = mesh.connected_faces();
    let mut members = vec![Vec::new(); count];
    for (f, &piece) in label.enumerate() {
        members[piece as usize].push(f);
    }
    let mut local = VertexData::filled(mesh.n_vertices(), u32::MAX);
    members
        .into_iter()
        .map(|faces| {
            let mut vertices = VertexData(Vec::new());
            let mut triples = Vec::with_capacity(faces.len());
            for &f in &faces {
                triples.push(mesh.face_vertices(f).map(|v| {
                    if local[v] == u32::MAX {
                        local[v] = vertices.0.len() as u32;
                        vertices.0.push(v);
                    }
                    local[v]
                }));
            }
            let mesh = TriMesh::from_faces(vertices.len(), &triples)?;
            Ok(Component { mesh, vertices, faces })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_and_a_stray_vertex() {
        let mesh = TriMesh::from_faces(8, &[[4, 5, 6], [0, 1, 2], [6, 5, 7]]).unwrap();
        let pieces = components(&mesh).unwrap();
        assert_eq!(pieces.len(), 2);
        assert_eq!(pieces[0].faces, [Face(0), Face(2)]);
        assert_eq!(pieces[0].vertices.0, [4, 5, 6, 7].map(Vertex));
        assert_eq!(pieces[1].mesh.n_faces(), 1);
        let positions: Vec<[f64; 3]> = (0..8).map(|v| [f64::from(v); 3]).collect();
        assert_eq!(pieces[0].positions(&positions), [4.0, 5.0, 6.0, 7.0].map(|x| [x; 3]));
        let uvs: Vec<[f64; 2]> = (0..9).map(|corner| [f64::from(corner); 2]).collect();
        assert_eq!(pieces[1].corner_uvs(&uvs), [3.0, 4.0, 5.0].map(|x| [x; 2]));
    }
}
