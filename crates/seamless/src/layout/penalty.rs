//! Soft closing of seams, for the homotopies.

use crate::cut::Cut;
use num_complex::Complex64;
use seamstress_numerics::Assembly;
use seamstress_surface::TriMesh;

/// Soft closing of seams: `weight / 2 * sum |e_right - rotation e_left|^2`.
pub struct SeamPenalty {
    seams: Vec<SeamElement>,
    /// Rotation of each seam.
    pub rotations: Vec<Complex64>,
    /// Weight of all of them.
    pub weight: f64,
}

struct SeamElement {
    /// Distinct wedges of the seam.
    wedges: Vec<u32>,
    /// Coefficient of each is `constant + linear * rotation`.
    constant: Vec<f64>,
    linear: Vec<f64>,
}

impl SeamElement {
    fn new([a, b, c, d]: [u32; 4]) -> Self {
        let mut element = Self { wedges: Vec::new(), constant: Vec::new(), linear: Vec::new() };
        // (d - c) - rotation (b - a)
        for (wedge, constant, linear) in
            [(a, 0.0, 1.0), (b, 0.0, -1.0), (c, -1.0, 0.0), (d, 1.0, 0.0)]
        {
            let k = element.wedges.iter().position(|&w| w == wedge).unwrap_or_else(|| {
                element.wedges.push(wedge);
                element.constant.push(0.0);
                element.linear.push(0.0);
                element.wedges.len() - 1
            });
            element.constant[k] += constant;
            element.linear[k] += linear;
        }
        element
    }

    fn coefficient(&self, k: usize, rotation: Complex64) -> Complex64 {
        self.constant[k] + self.linear[k] * rotation
    }

    /// Gradient and Hessian of `weight / 2 |gap|^2` in the coordinates of the wedges.
    fn fill(
        &self,
        weight: f64,
        rotation: Complex64,
        z: &[Complex64],
        block: &mut [f64],
        vector: &mut [f64],
    ) {
        let gap = self.gap(rotation, z);
        for i in 0..self.wedges.len() {
            let ci = self.coefficient(i, rotation);
            let g = weight * ci.conj() * gap;
            vector[2 * i] = g.re;
            vector[2 * i + 1] = g.im;
            for j in 0..=i {
                // real 2 x 2 form of conj(c_i) c_j; on the diagonal it is a multiple of the identity
                let p = weight * ci.conj() * self.coefficient(j, rotation);
                let at = |row: usize, column: usize| row * (row + 1) / 2 + column;
                block[at(2 * i, 2 * j)] = p.re;
                block[at(2 * i + 1, 2 * j)] = p.im;
                block[at(2 * i + 1, 2 * j + 1)] = p.re;
                if j < i {
                    block[at(2 * i, 2 * j + 1)] = -p.im;
                }
            }
        }
    }

    fn gap(&self, rotation: Complex64, z: &[Complex64]) -> Complex64 {
        let term = |k: usize| self.coefficient(k, rotation) * z[self.wedges[k] as usize];
        (0..self.wedges.len()).map(term).sum()
    }
}

impl SeamPenalty {
    /// Penalty on all seams of a cut.
    pub fn new(mesh: &TriMesh, cut: &Cut, rotations: Vec<Complex64>, weight: f64) -> Self {
        let element = |&h| SeamElement::new(cut.seam_wedges(mesh, h));
        Self { seams: cut.seams.iter().map(element).collect(), rotations, weight }
    }

    /// Value at a layout.
    pub fn value(&self, z: &[Complex64]) -> f64 {
        let squares = self.seams.iter().zip(&self.rotations).map(|(s, &r)| s.gap(r, z).norm_sqr());
        0.5 * self.weight * squares.sum::<f64>()
    }

    /// The distinct wedges of each seam.
    pub(super) fn elements(&self) -> impl Iterator<Item = &[u32]> {
        self.seams.iter().map(|seam| seam.wedges.as_slice())
    }

    /// Fills the blocks and vectors of the seams, which follow on `first` other elements.
    pub(super) fn fill(
        &self,
        z: &[Complex64],
        assembly: &Assembly,
        first: usize,
        blocks: &mut [f64],
        locals: &mut [f64],
    ) {
        for (s, (seam, &rotation)) in self.seams.iter().zip(&self.rotations).enumerate() {
            let vector = &mut locals[assembly.local(first + s)];
            let block = &mut blocks[assembly.block(first + s)];
            seam.fill(self.weight, rotation, z, block, vector);
        }
    }

    /// The largest mismatch of a seam.
    pub fn largest_gap(&self, z: &[Complex64]) -> f64 {
        let gaps = self.seams.iter().zip(&self.rotations).map(|(s, &r)| s.gap(r, z).norm());
        gaps.fold(0.0, f64::max)
    }
}
