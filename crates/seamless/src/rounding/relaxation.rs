//! The layout between roundings: as rigid as possible, rounded seams held, the others free.

use crate::cut::Cut;
use crate::quarter::{direction, unit};
use num_complex::Complex64;
use rayon::prelude::*;
use seamstress_numerics::ordering::{Graph, nested_dissection};
use seamstress_numerics::{Buckets, Cholesky, NotPositiveDefinite, Pattern, PatternBuilder};
use seamstress_surface::{Halfedge, Metric, TriMesh, VertexData};
use std::f64::consts::FRAC_PI_2;

/// Weight of the rows that hold a rounded seam closed; the rigidity energy has weights of order one.
const SEAM_WEIGHT: f64 = 1e3;
/// Shift of the diagonal that settles rigid motions of loose pieces.
const SHIFT: f64 = 1e-8;

/// How far a local step goes beyond the best rotation: with this, four iterations do what eight do
/// without.
const OVERSHOOT: f64 = 0.8;

/// State of the relaxation. The matrix is complex Hermitian, one unknown per wedge; its pattern has
/// room for every seam from the start, so that one symbolic analysis serves all rounds.
pub(super) struct Relaxation {
    z: Vec<Complex64>,
    /// Per corner: `sum of z conj(g)` over a face has the face's rotation; `sum of rotation g` over a
    /// wedge is its right-hand side.
    corner_weights: Vec<Complex64>,
    wedge_of_corner: Vec<u32>,
    corners_of_wedge: Buckets,
    frames: Vec<Complex64>,
    seams: Vec<[u32; 4]>,
    pattern: Pattern,
    matrix: Vec<Complex64>,
    cholesky: Cholesky<Complex64>,
}

impl Relaxation {
    /// Starts from a layout of the cut.
    ///
    /// # Errors
    /// When the system cannot be set up.
    pub(super) fn new(
        mesh: &TriMesh,
        metric: &Metric,
        cut: &Cut,
        z: Vec<Complex64>,
    ) -> Result<Self, NotPositiveDefinite> {
        let n = cut.n_wedges;
        let seams: Vec<[u32; 4]> = cut.seams.iter().map(|&h| cut.seam_wedges(mesh, h)).collect();
        let faces: Vec<[u32; 3]> =
            mesh.faces().map(|f| f.halfedges().map(|h| cut.wedge[h])).collect();
        let mut builder = PatternBuilder::new(n);
        faces.iter().for_each(|w| builder.add_clique(w));
        seams.iter().for_each(|w| builder.add_clique(w));
        let pattern = builder.build();
        let order = nested_dissection(&wedge_graph(n, &faces, &seams));
        let cholesky = Cholesky::analyze(&pattern, &order)?;
        let mut relaxation = Self {
            z,
            corner_weights: corner_weights(mesh, metric),
            wedge_of_corner: cut.wedge.to_vec(),
            corners_of_wedge: Buckets::new(n, &cut.wedge),
            frames: vec![Complex64::ONE; faces.len()],
            seams,
            matrix: vec![Complex64::ZERO; pattern.len()],
            pattern,
            cholesky,
        };
        let cotangent = metric.cotangent();
        for h in mesh.halfedges() {
            let [a, b] = cut.ends(h);
            relaxation.add_row(&[(a, -Complex64::ONE), (b, Complex64::ONE)], cotangent[h] / 2.0);
        }
        for &k in relaxation.pattern.diagonal() {
            relaxation.matrix[k as usize] += SHIFT;
        }
        Ok(relaxation)
    }

    /// Adds `weight |sum of c z|^2` to the quadratic form.
    fn add_row(&mut self, row: &[(u32, Complex64)], weight: f64) {
        for &(i, ci) in row {
            for &(j, cj) in row {
                // Entry (i, j) is conj(c_i) c_j; only the lower triangle is stored.
                if let Some(slot) = self.pattern.slot(i, j).filter(|_| i >= j) {
                    self.matrix[slot as usize] += weight * ci.conj() * cj;
                }
            }
        }
    }

    /// Holds a seam closed up to a quarter turn from now on.
    pub(super) fn close(&mut self, seam: usize, matching: i32) {
        let [a, b, c, d] = self.seams[seam];
        let r = unit(matching);
        let one = Complex64::ONE;
        self.add_row(&[(d, one), (c, -one), (b, -r), (a, r)], SEAM_WEIGHT);
    }

    /// Local and global steps (Liu et al. 2008) with one factorisation.
    ///
    /// # Errors
    /// When the matrix is not positive definite to working precision.
    pub(super) fn relax(&mut self, iterations: usize) -> Result<(), NotPositiveDefinite> {
        self.cholesky.factorize(&self.pattern, &self.matrix)?;
        for _ in 0..iterations {
            self.local_step(OVERSHOOT);
            self.right_hand_side();
            self.cholesky.solve(&mut self.z);
        }
        Ok(())
    }

    fn local_step(&mut self, overshoot: f64) {
        let (z, wedges, weights) = (&self.z, &self.wedge_of_corner, &self.corner_weights);
        self.frames.par_iter_mut().enumerate().with_min_len(4096).for_each(|(f, frame)| {
            let term = |c: usize| z[wedges[c] as usize] * weights[c].conj();
            let best = direction(term(3 * f) + term(3 * f + 1) + term(3 * f + 2));
            *frame = direction(best + overshoot * (best - *frame));
        });
    }

    fn right_hand_side(&mut self) {
        let (frames, weights) = (&self.frames, &self.corner_weights);
        let corners = &self.corners_of_wedge;
        self.z.par_iter_mut().enumerate().with_min_len(4096).for_each(|(w, out)| {
            let terms = corners.of(w).iter().map(|&c| frames[c as usize / 3] * weights[c as usize]);
            *out = terms.sum();
        });
    }

    /// Rotation of a seam in the layout, lifted to the branch nearest to `last`; quarter turns.
    pub(super) fn rotation(&self, seam: usize, last: f64) -> f64 {
        let [a, b, c, d] = self.seams[seam].map(|w| self.z[w as usize]);
        let r = ((d - c) * (b - a).conj()).arg() / FRAC_PI_2;
        last + (r - last + 2.0).rem_euclid(4.0) - 2.0
    }

    /// Logarithm of the scale of the layout at each vertex, an area-weighted mean over its faces.
    pub(super) fn log_scale(&self, mesh: &TriMesh, metric: &Metric) -> VertexData<f64> {
        let mut sum = VertexData::filled(mesh.n_vertices(), 0.0);
        let mut area = VertexData::filled(mesh.n_vertices(), 0.0);
        for f in mesh.faces() {
            let term = |h: Halfedge| {
                self.z[self.wedge_of_corner[h.at()] as usize] * self.corner_weights[h.at()].conj()
            };
            let similar: Complex64 = f.halfedges().map(term).iter().sum();
            // An isometric layout has twice the area here.
            let scale = similar.norm() / (2.0 * metric.area[f]);
            for v in mesh.face_vertices(f) {
                sum[v] += metric.area[f] * scale.max(1e-3).ln();
                area[v] += metric.area[f];
            }
        }
        mesh.vertices().map(|v| sum[v] / area[v]).collect()
    }

    /// Rotations of the faces in the layout.
    pub(super) fn frames(mut self) -> Vec<Complex64> {
        self.local_step(0.0);
        self.frames
    }
}

/// Halved cotangent weights times edge vectors, gathered at the corners.
fn corner_weights(mesh: &TriMesh, metric: &Metric) -> Vec<Complex64> {
    let cotangent = metric.cotangent();
    let edge = |h: Halfedge| {
        let flat = metric.flat[h.face()];
        (flat[h.next().side()] - flat[h.side()]) * (cotangent[h] / 2.0)
    };
    mesh.halfedges().map(|h| edge(h.prev()) - edge(h)).collect()
}

fn wedge_graph(n: usize, faces: &[[u32; 3]], seams: &[[u32; 4]]) -> Graph {
    let face_edges = faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let seam_edges =
        seams.iter().flat_map(|&[a, b, c, d]| [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)]);
    Graph::from_edges(n, face_edges.chain(seam_edges))
}
