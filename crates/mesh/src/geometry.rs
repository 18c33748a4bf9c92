//! What the metric of a mesh is made of.

use crate::components::Component;
use crate::ids::{Halfedge, Vertex};
use crate::mesh::TriMesh;
use crate::metric::Metric;

/// Where the vertices of a mesh are, and how large cells are to be there.
#[derive(Debug, Clone, Copy)]
pub struct Geometry<'a> {
    /// Positions of the vertices.
    pub positions: &'a [[f64; 3]],
    /// The sizes that cells are to have at the vertices, as multiples of one length; none if all are alike.
    pub sizes: Option<&'a [f64]>,
    /// A direction in space that lines are to follow on each face, zero on those where any will do; none if there are none.
    pub directions: Option<&'a [[f64; 3]]>,
}

/// The geometry of a piece of a mesh.
#[derive(Debug, Clone)]
pub struct PieceGeometry {
    positions: Vec<[f64; 3]>,
    sizes: Option<Vec<f64>>,
    directions: Option<Vec<[f64; 3]>>,
}

impl PieceGeometry {
    /// As one of a whole mesh.
    pub fn whole(&self) -> Geometry<'_> {
        Geometry {
            positions: &self.positions,
            sizes: self.sizes.as_deref(),
            directions: self.directions.as_deref(),
        }
    }
}

impl<'a> From<&'a [[f64; 3]]> for Geometry<'a> {
    fn from(positions: &'a [[f64; 3]]) -> Self {
        Self { positions, sizes: None, directions: None }
    }
}

impl<'a> From<&'a Vec<[f64; 3]>> for Geometry<'a> {
    fn from(positions: &'a Vec<[f64; 3]>) -> Self {
        positions.as_slice().into()
    }
}

impl<'a, const N: usize> From<&'a [[f64; 3]; N]> for Geometry<'a> {
    fn from(positions: &'a [[f64; 3]; N]) -> Self {
        positions.as_slice().into()
    }
}

impl Geometry<'_> {
    /// That of a piece.
    pub fn of_piece(&self, piece: &Component) -> PieceGeometry {
        let on_faces =
            |of_whole: &[[f64; 3]]| piece.faces.iter().map(|f| of_whole[f.at()]).collect();
        PieceGeometry {
            positions: piece.of_vertices(self.positions),
            sizes: self.sizes.map(|sizes| piece.of_vertices(sizes)),
            directions: self.directions.map(on_faces),
        }
    }

    /// The metric in which all cells are alike: that of the positions, with lengths counted in cells.
    pub fn metric(&self, mesh: &TriMesh) -> Metric {
        let metric = Metric::from_positions(mesh, self.positions);
        match self.sizes {
            Some(sizes) => metric.scaled(mesh, sizes),
            None => metric,
        }
    }

    /// The size at the vertices of a face; 1 if all are alike.
    pub fn size(&self, vertices: [Vertex; 3]) -> f64 {
        self.sizes.map_or(1.0, |sizes| vertices.map(|v| sizes[v.at()]).iter().sum::<f64>() / 3.0)
    }
}

impl Metric {
    /// The metric in which every edge is divided by the sizes at its ends: by their harmonic mean.
    ///
    /// Sizes that differ much within a triangle may leave its sides no triangle; it is then as flat as triangles get.
    pub fn scaled(&self, mesh: &TriMesh, sizes: &[f64]) -> Self {
        self.with_lengths(mesh, |h| self.length[h] * edge_scale(mesh, sizes, h))
    }
}

/// What an edge is multiplied by if lengths are counted in sizes.
pub fn edge_scale(mesh: &TriMesh, sizes: &[f64], h: Halfedge) -> f64 {
    0.5 * (1.0 / sizes[mesh.origin(h).at()] + 1.0 / sizes[mesh.tip(h).at()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_counted_in_sizes() {
        let mesh = TriMesh::from_faces(3, &[[0, 1, 2]]).unwrap();
        let positions = [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
        let raw = Geometry::from(&positions).metric(&mesh);
        let with = |sizes: &[f64]| {
            Geometry { sizes: Some(sizes), ..Geometry::from(&positions) }.metric(&mesh)
        };
        // Twice the size everywhere: half the side, and nothing else.
        let half = with(&[2.0; 3]);
        assert!((half.side() - 0.5 * raw.side()).abs() < 1e-12);
        assert!(half.angle.iter().zip(raw.angle.iter()).all(|(a, b)| (a - b).abs() < 1e-12));
        // Sides of 6, 10 and 8 become 6 (1 + 1) / 2, 10 (1 + 1/2) / 2 and 8 (1 + 1/2) / 2.
        let graded = with(&[1.0, 1.0, 2.0]);
        let lengths = [0, 1, 2].map(|h| graded.length[Halfedge(h)] * graded.unit);
        assert!(lengths.iter().zip([6.0, 7.5, 6.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
