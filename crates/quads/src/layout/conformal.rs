//! The alternative of section 7: one linear system for all coordinates.

use super::{LayoutError, QuadLayout, lay_out_squares};
use crate::QuadMesh;
use num_complex::Complex64;
use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Cholesky, Pattern};
use seamstress_mesh::Halfedge;
use seamstress_parametrize::cut::Cut;

/// The anti-conformal part of a map of the half square with corners `0, 1, 1 + i`, and of
/// `0, 1 + i, i`: coefficients of the corners, up to a common factor.
const LOWER: [Complex64; 3] =
    [Complex64::new(-1.0, 0.0), Complex64::new(1.0, -1.0), Complex64::new(0.0, 1.0)];
const UPPER: [Complex64; 3] =
    [Complex64::new(0.0, -1.0), Complex64::new(1.0, 0.0), Complex64::new(-1.0, 1.0)];

/// Lays a quad mesh out by least squares conformal maps over the flat metric of unit squares.
///
/// The cut is that of [`lay_out_squares`], and two corners of each component are pinned where they lie
/// there. Both layouts would agree in exact arithmetic: a conformal map of a flat disk is a
/// similarity. In floating point this one is the less accurate, and slower.
///
/// # Errors
/// [`LayoutError`].
///
/// # Source
/// Levi 2021, supplement, section 7; Levy et al. 2002.
pub fn lay_out_conformal(quads: &QuadMesh) -> Result<QuadLayout, LayoutError> {
    let squares = lay_out_squares(quads)?;
    let cut = Cut::new(&squares.mesh, |h| fits(&squares, h));
    let z = solve(&squares, &cut)?;
    let uv = |h: Halfedge| z[cut.wedge[h] as usize];
    let corner_uvs = squares.mesh.halfedges().map(|h| [uv(h).re, uv(h).im]).collect();
    Ok(QuadLayout { corner_uvs, ..squares })
}

fn point(layout: &QuadLayout, h: Halfedge) -> Complex64 {
    let [u, v] = layout.corner_uvs[h.at()];
    Complex64::new(u, v)
}

/// Whether both sides of an edge lie at the same place.
fn fits(layout: &QuadLayout, h: Halfedge) -> bool {
    layout.mesh.twin(h).is_some_and(|t| {
        point(layout, h) == point(layout, t.next()) && point(layout, h.next()) == point(layout, t)
    })
}

/// Positions of the wedges.
fn solve(layout: &QuadLayout, cut: &Cut) -> Result<Vec<Complex64>, LayoutError> {
    let mut z = vec![Complex64::ZERO; cut.n_wedges];
    let mut number = vec![Some(0); cut.n_wedges];
    for pin in pins(layout) {
        let w = cut.wedge[pin] as usize;
        z[w] = point(layout, pin);
        number[w] = None;
    }
    let mut n = 0;
    for unknown in number.iter_mut().flatten() {
        *unknown = n;
        n += 1;
    }
    let system = System::new(layout, cut, &number, n as usize);
    let solution = system.solve(&z, &number)?;
    for (z, unknown) in z.iter_mut().zip(&number) {
        if let Some(k) = unknown {
            *z = solution[*k as usize];
        }
    }
    Ok(z)
}

/// The normal equations of `sum of |anti-conformal part|^2`; the wedges that are not pinned are unknown.
struct System {
    faces: Vec<[usize; 3]>,
    pattern: Pattern,
    order: Vec<u32>,
}

impl System {
    fn new(layout: &QuadLayout, cut: &Cut, number: &[Option<u32>], n: usize) -> Self {
        let faces: Vec<[usize; 3]> =
            layout.mesh.faces().map(|f| f.halfedges().map(|h| cut.wedge[h] as usize)).collect();
        let unknowns: Vec<Vec<u32>> =
            faces.iter().map(|f| f.iter().filter_map(|&w| number[w]).collect()).collect();
        let pattern = Pattern::of_cliques(n, unknowns.iter());
        let edges = unknowns.iter().flat_map(|clique| {
            (0..clique.len()).flat_map(move |i| (0..i).map(move |j| (clique[i], clique[j])))
        });
        let order = fill_reducing_order(&Graph::from_edges(n, edges));
        Self { faces, pattern, order }
    }

    fn solve(
        &self,
        z: &[Complex64],
        number: &[Option<u32>],
    ) -> Result<Vec<Complex64>, LayoutError> {
        let mut matrix = vec![Complex64::ZERO; self.pattern.len()];
        let mut rhs = vec![Complex64::ZERO; self.pattern.order()];
        for (t, wedges) in self.faces.iter().enumerate() {
            let row = if t % 2 == 0 { LOWER } else { UPPER };
            for (&w, c) in wedges.iter().zip(row) {
                let Some(i) = number[w] else { continue };
                for (&other, d) in wedges.iter().zip(row) {
                    let entry = c.conj() * d;
                    match number[other] {
                        None => rhs[i as usize] -= entry * z[other],
                        Some(j) if i >= j => {
                            if let Some(slot) = self.pattern.slot(i, j) {
                                matrix[slot as usize] += entry;
                            }
                        }
                        Some(_) => {}
                    }
                }
            }
        }
        let mut cholesky =
            Cholesky::analyze(&self.pattern, &self.order).map_err(|_| LayoutError::NoFactor)?;
        cholesky.factorize(&matrix).map_err(|_| LayoutError::NoFactor)?;
        cholesky.solve(&mut rhs);
        Ok(rhs)
    }
}

/// Two corners of each component, far apart: its leftmost and its rightmost.
fn pins(layout: &QuadLayout) -> Vec<Halfedge> {
    let (labels, components) = layout.mesh.connected_faces();
    let mut ends: Vec<Option<[Halfedge; 2]>> = vec![None; components];
    for h in layout.mesh.halfedges() {
        let [left, right] = ends[labels[h.face()] as usize].get_or_insert([h, h]);
        if point(layout, h).re < point(layout, *left).re {
            *left = h;
        }
        if point(layout, h).re > point(layout, *right).re {
            *right = h;
        }
    }
    ends.into_iter().flatten().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn similarities_have_no_anti_conformal_part_and_reflections_have() {
        let corners = [[0, 1, 2], [0, 2, 3]];
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let z = |k: usize| Complex64::new(square[k].0, square[k].1);
        for (row, corners) in [LOWER, UPPER].iter().zip(corners) {
            let part = |map: &dyn Fn(Complex64) -> Complex64| {
                row.iter().zip(corners).map(|(c, k)| c * map(z(k))).sum::<Complex64>().norm()
            };
            assert!(part(&|z| Complex64::new(3.0, -2.0) * z + Complex64::I) < 1e-15);
            assert!(part(&|z| z.conj()) > 1.0);
        }
    }
}
