//! Soft closing of seams, for the homotopies.

use super::patch::Patch;
use crate::cut::Unfolding;
use crate::features::Sectors;
use num_complex::Complex64;
use seamstress_linalg::Assembly;
use seamstress_mesh::{Halfedge, HalfedgeData};

/// Soft closing of seams: `weight / 2 * sum |e_right - rotation e_left|^2`; with aligned edges also of their
/// two sides, and of what they have across their axis.
pub struct SeamPenalty {
    /// The seams, and their places among the turning edges.
    seams: Vec<(SeamElement, usize)>,
    /// The two sides of each interior feature, and their places among the axes.
    links: Vec<(SeamElement, [usize; 2])>,
    /// Every aligned half-edge.
    axes: Vec<AxisElement>,
    /// Rotation of each turning edge.
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

/// One side of an aligned edge: `gap = Im(rotation (z_tip - z_origin))`, the rotation leads from the edge to
/// the u axis.
struct AxisElement {
    /// Wedges of origin and tip.
    ends: [u32; 2],
    /// Its place among the turning edges; on the ground it stands still.
    turning: Option<u32>,
}

impl AxisElement {
    fn gap(&self, rotation: Complex64, z: &[Complex64]) -> f64 {
        let [a, b] = self.ends.map(|w| z[w as usize]);
        (rotation * (b - a)).im
    }

    fn fill(
        &self,
        weight: f64,
        rotation: Complex64,
        z: &[Complex64],
        block: &mut [f64],
        vector: &mut [f64],
    ) {
        let row = [-rotation.im, -rotation.re, rotation.im, rotation.re];
        let gap = self.gap(rotation, z);
        let mut at = 0;
        for i in 0..4 {
            vector[i] = weight * gap * row[i];
            for j in 0..=i {
                block[at] = weight * row[i] * row[j];
                at += 1;
            }
        }
    }
}

impl SeamPenalty {
    /// Penalty on the seams of a cut within a patch, on the two sides of its interior features, and on what keeps these
    /// from the axes; `rotations` are those of all turning edges.
    pub fn new(
        sectors: &Sectors<'_>,
        unfolding: &Unfolding,
        patch: &Patch,
        rotations: Vec<Complex64>,
        weight: f64,
    ) -> Self {
        let (slit, n_seams) = (sectors.slit(), unfolding.cut.seams.len());
        let joint = |[left, right]: [Halfedge; 2]| {
            let ([a, b], [d, c]) = (patch.ends(left), patch.ends(right));
            SeamElement::new([a, b, c, d])
        };
        let is_inside = |sides: &[Halfedge; 2]| sides.iter().all(|&h| patch.has(h));
        let seam = |(k, &h): (usize, &Halfedge)| {
            let sides = slit.twin(h).map(|t| [h, t]).filter(is_inside)?;
            Some((joint(sides), k))
        };
        let aligned = || sectors.aligned().filter(|&h| patch.has(h));
        let mut axis_of = HalfedgeData::filled(slit.n_halfedges(), 0);
        aligned().enumerate().for_each(|(k, h)| axis_of[h] = k);
        let axis = |h| AxisElement { ends: patch.ends(h), turning: None };
        let mut axes: Vec<AxisElement> = aligned().map(axis).collect();
        let turning = unfolding.turning.iter().enumerate();
        for (k, &h) in turning.clone().skip(n_seams).filter(|(_, h)| patch.has(**h)) {
            axes[axis_of[h]].turning = Some(k as u32);
        }
        let link = |sides: [Halfedge; 2]| (joint(sides), sides.map(|h| axis_of[h]));
        Self {
            seams: turning.take(n_seams).filter_map(seam).collect(),
            links: sectors.aligned_pairs().filter(is_inside).map(link).collect(),
            axes,
            rotations,
            weight,
        }
    }

    /// Rotation of an aligned half-edge to the u axis.
    fn to_axis(&self, axis: usize) -> Complex64 {
        self.axes[axis].turning.map_or(Complex64::ONE, |k| self.rotations[k as usize])
    }

    /// Seams and links with their rotations.
    fn joints(&self) -> impl Iterator<Item = (&SeamElement, Complex64)> {
        let seams = self.seams.iter().map(|(seam, k)| (seam, self.rotations[*k]));
        // The other side runs backwards.
        let across = |[h, t]: [usize; 2]| -self.to_axis(h) * self.to_axis(t).conj();
        seams.chain(self.links.iter().map(move |(link, sides)| (link, across(*sides))))
    }

    /// Value at a layout.
    pub fn value(&self, z: &[Complex64]) -> f64 {
        let squares = self.joints().map(|(joint, r)| joint.gap(r, z).norm_sqr());
        let axes = self.axes.iter().enumerate();
        let off_axis = axes.map(|(k, axis)| axis.gap(self.to_axis(k), z).powi(2));
        0.5 * self.weight * (squares.sum::<f64>() + off_axis.sum::<f64>())
    }

    /// The distinct wedges of each element.
    pub(super) fn elements(&self) -> impl Iterator<Item = &[u32]> {
        let seams = self.seams.iter().map(|(seam, _)| seam);
        let joints = seams.chain(self.links.iter().map(|(link, _)| link));
        let axes = self.axes.iter().map(|axis| axis.ends.as_slice());
        joints.map(|joint| joint.wedges.as_slice()).chain(axes)
    }

    /// Fills the blocks and vectors of the elements, which follow on `first` other ones.
    pub(super) fn fill(
        &self,
        z: &[Complex64],
        assembly: &Assembly,
        first: usize,
        blocks: &mut [f64],
        locals: &mut [f64],
    ) {
        let mut element = first;
        for (joint, rotation) in self.joints() {
            let vector = &mut locals[assembly.local(element)];
            let block = &mut blocks[assembly.block(element)];
            joint.fill(self.weight, rotation, z, block, vector);
            element += 1;
        }
        for (k, axis) in self.axes.iter().enumerate() {
            let vector = &mut locals[assembly.local(element)];
            let block = &mut blocks[assembly.block(element)];
            axis.fill(self.weight, self.to_axis(k), z, block, vector);
            element += 1;
        }
    }

    /// The largest mismatch of an element.
    pub fn largest_gap(&self, z: &[Complex64]) -> f64 {
        let joints = self.joints().map(|(joint, r)| joint.gap(r, z).norm());
        let axes = self.axes.iter().enumerate().map(|(k, axis)| axis.gap(self.to_axis(k), z).abs());
        joints.chain(axes).fold(0.0, f64::max)
    }
}
