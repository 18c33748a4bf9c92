//! Cones that a map shall have.

use seamstress_mesh::{Component, TriMesh, Vertex, VertexData};
use std::f64::consts::FRAC_PI_2;

/// A given angle is a multiple of a quarter turn up to this, radians. Files with few digits must pass.
const ANGLE: f64 = 1e-3;

/// Why cones cannot be had.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrescriptionError {
    /// Not one angle per vertex.
    #[error("{found} cone angles for {expected} vertices")]
    AngleCount {
        /// Vertices.
        expected: usize,
        /// Given.
        found: usize,
    },
    /// No such vertex, or one without a face.
    #[error("cone vertex {vertex} is not a vertex of the surface")]
    NoVertex {
        /// As given.
        vertex: u32,
    },
    /// A vertex is listed twice.
    #[error("vertex {vertex} is listed twice among the cones")]
    Repeated {
        /// The vertex.
        vertex: u32,
    },
    /// An index at the boundary, where angles are free.
    #[error("vertex {vertex} is on the boundary and cannot be a cone of index {index}")]
    Boundary {
        /// The vertex.
        vertex: u32,
        /// Its index, quarters.
        index: i32,
    },
    /// An angle that is no multiple of a quarter turn.
    #[error("the angle of vertex {vertex}, {angle} rad, is not a multiple of a quarter turn")]
    NotQuarters {
        /// The vertex.
        vertex: u32,
        /// Its angle, radians.
        angle: f64,
    },
    /// A cone without a positive angle.
    #[error("a cone of index {index} at vertex {vertex} would have no positive angle (at most 3)")]
    NoAngle {
        /// The vertex.
        vertex: u32,
        /// Its index, quarters.
        index: i32,
    },
    /// A cone wider than the vertex's triangles can be.
    #[error(
        "a cone of index {index} at vertex {vertex} would need {quarters} quarter turns, and its \
         {valence} triangles have less than two each"
    )]
    Valence {
        /// The vertex.
        vertex: u32,
        /// Its index, quarters.
        index: i32,
        /// Its angle, quarters.
        quarters: i32,
        /// Its number of triangles.
        valence: usize,
    },
    /// The indices of a closed component do not sum to four times its Euler characteristic.
    #[error(
        "the cones of component {component} have indices that sum to {sum}; they must sum to \
         {expected}, four times the Euler characteristic"
    )]
    Sum {
        /// The component, in order of first faces.
        component: usize,
        /// Sum of the indices, quarters.
        sum: i64,
        /// What it must be.
        expected: i64,
    },
    /// One cone of three quarters and one of five on a torus and no other; impossible by
    /// Izmestiev et al. 2013.
    #[error(
        "component {component} is a torus with cones of index +1 at vertex {plus} and -1 at vertex \
         {minus} only, which no seamless map has"
    )]
    TorusPair {
        /// The component, in order of first faces.
        component: usize,
        /// Vertex of index 1.
        plus: u32,
        /// Vertex of index -1.
        minus: u32,
    },
    /// The free vertices cannot take what the prescribed ones leave.
    #[error("no vertex that is free can take the index that vertex {vertex} must lose or gain")]
    NoTaker {
        /// A prescribed vertex.
        vertex: u32,
    },
}

/// Indices that a map shall have, in quarters, at all interior vertices or at some.
#[derive(Debug, Clone, PartialEq)]
pub struct ConePrescription {
    /// None where the index is free. Boundary vertices are free.
    index: VertexData<Option<i32>>,
}

impl ConePrescription {
    /// These cones and no others inside.
    ///
    /// # Errors
    /// [`PrescriptionError`] naming what cannot be had.
    pub fn exactly(mesh: &TriMesh, cones: &[(u32, i32)]) -> Result<Self, PrescriptionError> {
        let none = |v| (!mesh.is_boundary(v)).then_some(0);
        Self::with(mesh, mesh.vertices().map(none).collect(), cones)
    }

    /// These indices, zero included; the other vertices as rounding finds best.
    ///
    /// # Errors
    /// [`PrescriptionError`] naming what cannot be had.
    pub fn among_others(mesh: &TriMesh, cones: &[(u32, i32)]) -> Result<Self, PrescriptionError> {
        Self::with(mesh, VertexData::filled(mesh.n_vertices(), None), cones)
    }

    /// The total angle in radians of every vertex; those of the boundary are not read.
    ///
    /// # Errors
    /// [`PrescriptionError`] naming what cannot be had.
    pub fn from_angles(mesh: &TriMesh, angles: &[f64]) -> Result<Self, PrescriptionError> {
        let (expected, found) = (mesh.n_vertices(), angles.len());
        if expected != found {
            return Err(PrescriptionError::AngleCount { expected, found });
        }
        let mut cones = Vec::new();
        for (v, &angle) in mesh.vertices().zip(angles) {
            if mesh.is_boundary(v) || mesh.outgoing(v).next().is_none() {
                continue;
            }
            let quarters = (angle / FRAC_PI_2).round();
            // Not a number fails, too; so does what has no index of 32 bits.
            let is_near = (angle - quarters * FRAC_PI_2).abs() <= ANGLE && quarters.abs() < 1e9;
            if !is_near {
                return Err(PrescriptionError::NotQuarters { vertex: v.0, angle });
            }
            cones.push((v.0, 4 - quarters as i32));
        }
        Self::exactly(mesh, &cones)
    }

    /// Index of each vertex, quarters; none where it is free.
    pub fn index(&self) -> &VertexData<Option<i32>> {
        &self.index
    }

    /// The prescription on one connected piece.
    pub fn restrict(&self, piece: &Component) -> Self {
        Self { index: piece.vertices.iter().map(|&v| self.index[v]).collect() }
    }

    fn with(
        mesh: &TriMesh,
        mut index: VertexData<Option<i32>>,
        cones: &[(u32, i32)],
    ) -> Result<Self, PrescriptionError> {
        let mut listed = VertexData::filled(mesh.n_vertices(), false);
        for &(vertex, k) in cones {
            let v = Vertex(vertex);
            let is_there = v.at() < mesh.n_vertices() && mesh.outgoing(v).next().is_some();
            if !is_there {
                return Err(PrescriptionError::NoVertex { vertex });
            }
            if std::mem::replace(&mut listed[v], true) {
                return Err(PrescriptionError::Repeated { vertex });
            }
            check_angle(mesh, v, k)?;
            if !mesh.is_boundary(v) {
                index[v] = Some(k);
            }
        }
        let prescription = Self { index };
        prescription.check_sums(mesh)?;
        Ok(prescription)
    }

    /// On closed components without a free vertex.
    fn check_sums(&self, mesh: &TriMesh) -> Result<(), PrescriptionError> {
        let (labels, count) = mesh.connected_faces();
        let mut expected = vec![0i64; count];
        mesh.faces().for_each(|f| expected[labels[f] as usize] += 4);
        mesh.edges().for_each(|h| expected[labels[h.face()] as usize] -= 4);
        let mut sums = vec![0i64; count];
        let mut is_bound = vec![true; count];
        let mut cones = vec![Vec::new(); count];
        for v in mesh.vertices() {
            let Some(h) = mesh.outgoing(v).next() else { continue };
            let component = labels[h.face()] as usize;
            expected[component] += 4;
            match self.index[v] {
                Some(k) => sums[component] += i64::from(k),
                None => is_bound[component] = false,
            }
            cones[component].extend(self.index[v].filter(|&k| k != 0).map(|k| (k, v.0)));
        }
        for component in (0..count).filter(|&c| is_bound[c]) {
            let (sum, expected) = (sums[component], expected[component]);
            if sum != expected {
                return Err(PrescriptionError::Sum { component, sum, expected });
            }
            cones[component].sort_unstable();
            if let ([(-1, minus), (1, plus)], 0) = (&cones[component][..], expected) {
                let (plus, minus) = (*plus, *minus);
                return Err(PrescriptionError::TorusPair { component, plus, minus });
            }
        }
        Ok(())
    }
}

/// Whether triangles around a vertex can have this index.
pub(crate) fn check_angle(mesh: &TriMesh, v: Vertex, index: i32) -> Result<(), PrescriptionError> {
    let vertex = v.0;
    if mesh.is_boundary(v) {
        return match index {
            0 => Ok(()),
            _ => Err(PrescriptionError::Boundary { vertex, index }),
        };
    }
    if index > 3 {
        return Err(PrescriptionError::NoAngle { vertex, index });
    }
    let (quarters, valence) = (4i32.saturating_sub(index), mesh.valence(v));
    if i64::from(quarters) >= 2 * valence as i64 {
        return Err(PrescriptionError::Valence { vertex, index, quarters, valence });
    }
    Ok(())
}
