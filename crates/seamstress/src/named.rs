//! The names of elements in errors: those of the input, also where another mesh of the surface has more of them.

use crate::finding::Elements;
use crate::surface::Surface;
use seamstress_mesh::symmetry::Segments;
use seamstress_mesh::{Halfedge, Vertex};

impl Surface {
    /// The vertex of the input that a vertex was, or that is nearest to it on the face that it lies on.
    pub(crate) fn vertex_named(&self, vertex: u32) -> u32 {
        let nearest = || {
            let (source, faces) = self.remesh_of()?;
            let h = self.mesh().outgoing(Vertex(vertex)).next()?;
            let at = self.positions()[vertex as usize];
            let distance = |v: u32| {
                let p = source.positions()[v as usize];
                (0..3).map(|k| (p[k] - at[k]).powi(2)).sum::<f64>()
            };
            let corners = source.faces()[faces[h.face().at()] as usize].into_iter();
            let nearest = corners.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
            Some(source.vertex_named(nearest))
        };
        self.input_vertex(vertex).or_else(nearest).unwrap_or(vertex)
    }

    /// The ends in the input of an edge, or of the side nearest to it of the face that it lies on.
    pub(crate) fn edge_named(&self, ends: [u32; 2]) -> [u32; 2] {
        let nearest = |h: Halfedge| {
            let (source, faces) = self.remesh_of()?;
            let [a, b, c] = source.faces()[faces[h.face().at()] as usize];
            let sides = [[a, b], [b, c], [c, a]];
            let place = |v: u32| source.positions()[v as usize];
            let [p, q] = ends.map(|v| self.positions()[v as usize]);
            let middle = [0, 1, 2].map(|k| 0.5 * (p[k] + q[k]));
            let (side, _) = Segments::new(sides.map(|side| side.map(place))).nearest(middle)?;
            Some(source.edge_named(sides[side]))
        };
        match ends.map(|v| self.input_vertex(v)) {
            [Some(a), Some(b)] => [a, b],
            _ => {
                let [a, b] = ends.map(Vertex);
                let edge = self.mesh().edge_between(a, b);
                edge.and_then(nearest).unwrap_or_else(|| ends.map(|v| self.vertex_named(v)))
            }
        }
    }

    /// The polygon of the input that a face is of.
    pub(crate) fn face_named(&self, face: u32) -> u32 {
        self.input_face(face).unwrap_or(face)
    }

    /// Elements of this surface as those of its input.
    pub(crate) fn in_input(&self, elements: &Elements) -> Elements {
        let mut named = Elements {
            vertices: elements.vertices.iter().map(|&v| self.vertex_named(v)).collect(),
            edges: elements.edges.iter().map(|&ends| self.edge_named(ends)).collect(),
            faces: elements.faces.iter().map(|&face| self.face_named(face)).collect(),
        };
        named.vertices.dedup();
        named.edges.dedup();
        named.faces.dedup();
        named
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_of_a_finer_mesh_are_named_by_those_they_lie_on() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let square = Surface::from_triangles(&positions, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        // Face 1 split at a point near vertex 3, and then the side between that and vertex 2 in two.
        let finer = |surface: &Surface, at: [f64; 3], faces: Vec<[u32; 3]>, origin: &[u32]| {
            let positions = [surface.positions(), &[at]].concat();
            surface.refined(positions, faces, origin).unwrap()
        };
        let faces = vec![[0, 1, 2], [0, 2, 4], [2, 3, 4], [3, 0, 4]];
        let fine = finer(&square, [0.2, 0.9, 0.0], faces, &[0, 1, 1, 1]);
        let faces = vec![[0, 1, 2], [0, 2, 5], [0, 5, 4], [2, 3, 5], [3, 4, 5], [3, 0, 4]];
        let finest = finer(&fine, [0.7, 0.96, 0.0], faces, &[0, 1, 1, 2, 2, 3]);
        assert_eq!([2, 4, 5].map(|v| finest.vertex_named(v)), [2, 3, 2]);
        assert_eq!(finest.edge_named([0, 2]), [0, 2]);
        assert_eq!(finest.edge_named([2, 5]), [2, 3]);
        assert_eq!(finest.edge_named([4, 0]), [3, 0]);
        let elements = Elements { vertices: vec![4, 3], edges: vec![], faces: vec![0, 3, 4] };
        let named = finest.in_input(&elements);
        assert_eq!((named.vertices, named.faces), (vec![3], vec![0, 1]));
    }
}
