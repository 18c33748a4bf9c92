//! Least squares over the angles of faces, coupled across edges.

use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern, Scalar};
use seamstress_mesh::{Halfedge, TriMesh};

/// Shift of the diagonal, against the constant that is free on every component.
const SHIFT: f64 = 1e-10;

/// A matrix with a row per face and an entry per interior edge, of one symbolic analysis.
pub(super) struct FaceMatrix<T: Scalar> {
    /// Left and right face of each interior edge, in the order of [`TriMesh::interior_edges`].
    faces: Vec<[u32; 2]>,
    pattern: Pattern,
    values: Vec<T>,
    cholesky: Cholesky<T>,
}

impl<T: Scalar + std::ops::AddAssign + From<f64>> FaceMatrix<T> {
    /// # Errors
    /// When memory runs out.
    pub(super) fn new(mesh: &TriMesh) -> Result<Self, NotPositiveDefinite> {
        let sides = |h: Halfedge| Some((h.face().0, mesh.twin(h)?.face().0));
        let graph = Graph::from_edges(mesh.n_faces(), mesh.interior_edges().filter_map(sides));
        Self::ordered(mesh, &fill_reducing_order(&graph))
    }

    /// The same where an elimination order of the faces is known.
    ///
    /// # Errors
    /// When memory runs out.
    pub(super) fn ordered(mesh: &TriMesh, order: &[u32]) -> Result<Self, NotPositiveDefinite> {
        let sides = |h: Halfedge| [h.face().0, mesh.twin(h).map_or(h, |t| t).face().0];
        let faces: Vec<[u32; 2]> = mesh.interior_edges().map(sides).collect();
        let pattern = Pattern::of_cliques(mesh.n_faces(), faces.iter());
        let cholesky = Cholesky::analyze(&pattern, order)?;
        let values = vec![T::default(); pattern.len()];
        Ok(Self { faces, pattern, values, cholesky })
    }

    /// Left and right face of each interior edge.
    pub(super) fn faces(&self) -> &[[u32; 2]] {
        &self.faces
    }

    /// Factors the sum over edges of `weight |x_right - c x_left|^2`; `couple` returns per edge the weight
    /// and minus the weight times `c`.
    ///
    /// # Errors
    /// When the sum is not positive definite to working precision.
    pub(super) fn factorize(
        &mut self,
        couple: impl Fn(usize) -> (f64, T),
        conjugate: impl Fn(T) -> T,
    ) -> Result<(), NotPositiveDefinite> {
        self.factorize_near(couple, |_| 0.0, conjugate)
    }

    /// The same with the sum over faces of `pull |x|^2`.
    ///
    /// # Errors
    /// When the sum is not positive definite to working precision.
    pub(super) fn factorize_near(
        &mut self,
        couple: impl Fn(usize) -> (f64, T),
        pull: impl Fn(usize) -> f64,
        conjugate: impl Fn(T) -> T,
    ) -> Result<(), NotPositiveDefinite> {
        self.values.fill(T::default());
        for (f, &k) in self.pattern.diagonal().iter().enumerate() {
            self.values[k as usize] += T::from(SHIFT + pull(f));
        }
        for (e, &[left, right]) in self.faces.iter().enumerate() {
            let (weight, off) = couple(e);
            for face in [left, right] {
                let slot = self.pattern.diagonal()[face as usize];
                self.values[slot as usize] += T::from(weight);
            }
            if let Some(slot) = self.pattern.slot(left, right) {
                // The lower triangle holds (larger, smaller).
                self.values[slot as usize] += if right > left { off } else { conjugate(off) };
            }
        }
        self.cholesky.factorize(&self.values)
    }

    /// Overwrites the right-hand side with the solution.
    pub(super) fn solve(&mut self, rhs: &mut [T]) {
        self.cholesky.solve(rhs);
    }
}

/// The angles, one per face, whose differences `x_right - x_left` across edges are nearest to `target`,
/// weighted; edges of weight zero are free. Any unit.
///
/// # Errors
/// When the system cannot be solved.
pub(super) fn nearest_angles(
    matrix: &mut FaceMatrix<f64>,
    weight: impl Fn(usize) -> f64,
    target: impl Fn(usize) -> f64,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    matrix.factorize(|e| (weight(e), -weight(e)), |x| x)?;
    let mut x = vec![0.0; matrix.pattern.order()];
    for (e, &[left, right]) in matrix.faces().iter().enumerate() {
        let pull = weight(e) * target(e);
        x[right as usize] += pull;
        x[left as usize] -= pull;
    }
    matrix.solve(&mut x);
    Ok(x)
}
