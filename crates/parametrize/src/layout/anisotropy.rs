//! Stretches wanted of a layout, face by face.

use crate::energy::Triangle;
use seamstress_mesh::{Face, FaceData, TriMesh};

/// A stretch per face that counts as no distortion: the frames `A` of Levi 2021, suppl. sec. 5.
///
/// Levi 2021 measures `|A^-1 Df - R|` with `A` in the plane. Here the stretch `W` acts on the surface and
/// `|Df W^-1 - R|` is measured, with `A = R W R^T`: both vanish for the same maps, but `W` needs no turning
/// at seams. Every objective works with it, since `Df W^-1` is the Jacobian from the stretched triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Anisotropy {
    /// Inverse of the stretch of each face, in the coordinates of its flat triangle: xx, xy, yy.
    inverse: FaceData<[f64; 3]>,
}

/// A wanted stretch of one face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// A direction in space, of any length; what counts is its part in the face's plane.
    pub direction: [f64; 3],
    /// Stretch along the direction, UV units per mesh unit.
    pub along: f64,
    /// Stretch across it.
    pub across: f64,
}

/// Why stretches are refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnisotropyError {
    /// There must be one per face.
    #[error("{found} stretches for {expected} faces")]
    Count {
        /// Faces of the mesh.
        expected: usize,
        /// Stretches given.
        found: usize,
    },
    /// A stretch is not positive and finite.
    #[error("the stretch of face {face} is not positive and finite")]
    NotPositive {
        /// The face.
        face: u32,
    },
    /// A direction has no part in its face's plane, while the two stretches differ.
    #[error("the direction of face {face} has no part in its plane")]
    NoDirection {
        /// The face.
        face: u32,
    },
}

impl Anisotropy {
    /// From one stretch per face of a mesh in space.
    ///
    /// # Errors
    /// [`AnisotropyError`].
    pub fn new(
        mesh: &TriMesh,
        positions: &[[f64; 3]],
        stretches: &[Stretch],
    ) -> Result<Self, AnisotropyError> {
        let (expected, found) = (mesh.n_faces(), stretches.len());
        if expected != found {
            return Err(AnisotropyError::Count { expected, found });
        }
        let of = |(f, stretch): (Face, &Stretch)| {
            let corners = mesh.face_vertices(f).map(|v| positions[v.at()]);
            inverse(f, corners, stretch)
        };
        let inverse = mesh.faces().zip(stretches).map(of).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { inverse: FaceData(inverse) })
    }

    /// The stretches of some faces, in their order.
    pub(crate) fn of_faces(&self, faces: &[Face]) -> Self {
        Self { inverse: faces.iter().map(|&f| self.inverse[f]).collect() }
    }

    /// Triangles as seen from the stretched faces: their Jacobians are `Df W^-1`.
    pub(super) fn apply(&self, triangles: &mut [Triangle]) {
        for (t, [xx, xy, yy]) in triangles.iter_mut().zip(&self.inverse.0) {
            t.gradients = t.gradients.map(|[x, y]| [xx * x + xy * y, xy * x + yy * y]);
        }
    }
}

/// Least part of a direction in its face's plane, as a fraction.
const LEAST_PART: f64 = 1e-9;

fn inverse(
    face: Face,
    [a, b, c]: [[f64; 3]; 3],
    stretch: &Stretch,
) -> Result<[f64; 3], AnisotropyError> {
    let Stretch { direction, along, across } = *stretch;
    let is_positive = |x: f64| x > 0.0 && x.is_finite() && (1.0 / x).is_finite();
    if !is_positive(along) || !is_positive(across) {
        return Err(AnisotropyError::NotPositive { face: face.0 });
    }
    let sub = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
    let dot = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| p[k] * q[k]).sum::<f64>();
    let scaled = |p: [f64; 3], s: f64| p.map(|x| s * x);
    // The flat triangle has its first corner at 0 and its second on the real axis.
    let e1 = sub(b, a);
    let e1 = scaled(e1, 1.0 / dot(e1, e1).sqrt());
    let e2 = sub(c, a);
    let e2 = sub(e2, scaled(e1, dot(e1, e2)));
    let e2 = scaled(e2, 1.0 / dot(e2, e2).sqrt());
    let [x, y] = [dot(direction, e1), dot(direction, e2)];
    let (part, length) = (x.hypot(y), dot(direction, direction).sqrt());
    if along == across {
        return Ok([1.0 / along, 0.0, 1.0 / along]);
    }
    if !(part > LEAST_PART * length && part.is_finite()) {
        return Err(AnisotropyError::NoDirection { face: face.0 });
    }
    let [x, y] = [x / part, y / part];
    let (p, q) = (1.0 / along, 1.0 / across);
    Ok([p * x * x + q * y * y, (p - q) * x * y, p * y * y + q * x * x])
}
