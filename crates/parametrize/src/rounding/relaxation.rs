//! The layout between roundings: as rigid as possible, rounded edges held, the others free.

use super::system::RelaxationSystem;
use crate::cut::{Cut, DualTree, Unfolding};
use crate::features::Sectors;
use crate::field::Guide;
use crate::quarter::{direction, nearest_quarter, unit};
use num_complex::Complex64;
use seamstress_linalg::{Buckets, NotPositiveDefinite};
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use seamstress_parallel::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Weight of the rows that hold a rounded edge; the rigidity energy has weights of order one.
const SEAM_WEIGHT: f64 = 1e3;

/// How far a local step goes beyond the best rotation: with this, four iterations do what eight do
/// without.
const OVERSHOOT: f64 = 0.8;

/// State of the relaxation. The pattern of the system has room for every row from the start, so that one
/// symbolic analysis serves all rounds; it is real only where edges are to be aligned.
pub(super) struct Relaxation {
    z: Vec<Complex64>,
    /// Per corner: `sum of z conj(g)` over a face has the face's rotation; `sum of rotation g` over a
    /// wedge is its right-hand side.
    corner_weights: Vec<Complex64>,
    wedge_of_corner: Vec<u32>,
    corners_of_wedge: Buckets,
    frames: Vec<Complex64>,
    /// Per face the rotation wanted, up to quarter turns, by what it counts: as much as rigidity where directions count
    /// fully. Empty without a guide.
    wanted: Vec<Complex64>,
    /// Wedges of each seam: origin and tip on the left, origin and tip on the right.
    seams: Vec<[u32; 4]>,
    /// All aligned half-edges.
    aligned: Vec<AlignedEdge>,
    /// Those of them that turn; they follow on the seams.
    turning: Vec<u32>,
    system: RelaxationSystem,
}

/// One side of an aligned edge.
struct AlignedEdge {
    /// Wedges of its origin and tip.
    ends: [u32; 2],
    /// The other side, by its place in the list.
    twin: Option<u32>,
    /// Its direction in quarters, once it has one.
    direction: Option<i32>,
}

impl Relaxation {
    /// Starts from the isometric layout; the aligned edges that hang on the ground are held at once.
    ///
    /// # Errors
    /// When the system cannot be set up.
    pub(super) fn new(
        sectors: &Sectors<'_>,
        metric: &Metric,
        unfolding: &Unfolding,
    ) -> Result<Self, NotPositiveDefinite> {
        let (slit, cut) = (sectors.slit(), &unfolding.cut);
        let n = cut.n_wedges;
        let seams: Vec<[u32; 4]> = cut.seams.iter().map(|&h| cut.seam_wedges(slit, h)).collect();
        let faces: Vec<[u32; 3]> =
            slit.faces().map(|f| f.halfedges().map(|h| cut.wedge[h])).collect();
        let (aligned, place) = aligned_edges(sectors, cut);
        let links: Vec<[u32; 4]> = aligned.iter().filter_map(|e| link(&aligned, e)).collect();
        let quads = seams.iter().chain(&links).map(<[u32; 4]>::as_slice);
        let cliques = faces.iter().map(<[u32; 3]>::as_slice).chain(quads);
        let mut relaxation = Self {
            z: unfolding.positions(sectors, metric),
            corner_weights: corner_weights(slit, metric),
            wedge_of_corner: cut.wedge.to_vec(),
            corners_of_wedge: Buckets::new(n, &cut.wedge),
            frames: vec![Complex64::ONE; faces.len()],
            wanted: Vec::new(),
            system: RelaxationSystem::new(n, cliques, sectors.any_aligned())?,
            turning: unfolding.turning[seams.len()..].iter().map(|&h| place[h]).collect(),
            seams,
            aligned,
        };
        let cotangent = metric.cotangent();
        for h in slit.halfedges() {
            let [a, b] = cut.ends(h);
            let row = [(a, -Complex64::ONE), (b, Complex64::ONE)];
            relaxation.system.add_row(&row, cotangent[h] / 2.0);
        }
        relaxation.system.shift();
        for h in unfolding.tree.ground.iter().flatten() {
            relaxation.align(place[*h], 0);
        }
        Ok(relaxation)
    }

    /// Turns every face to a guide, which local steps follow from now on, and relaxes the layout; how far each was turned
    /// back at first, radians.
    ///
    /// Of the four directions of a face the one is taken that turns it least against the face before it in the
    /// tree: chosen face by face they would make pairs of cones along the tree.
    ///
    /// # Errors
    /// When the matrix is not positive definite to working precision.
    pub(super) fn follow(
        &mut self,
        guide: &Guide,
        metric: &Metric,
        tree: &DualTree,
        iterations: usize,
    ) -> Result<FaceData<f64>, NotPositiveDefinite> {
        self.local_step(0.0);
        let mut turned = FaceData::filled(self.frames.len(), 0.0);
        for &f in &tree.order {
            let off = (self.frames[f.at()] * guide.rotation[f].conj()).arg();
            let before = tree.parent[f].map_or(0.0, |h| turned[h.face()]);
            turned[f] = off + ((before - off) / FRAC_PI_2).round() * FRAC_PI_2;
        }
        for (frame, by) in self.frames.iter_mut().zip(turned.iter()) {
            *frame *= Complex64::from_polar(1.0, -by);
        }
        let faces = guide.weight.iter().zip(metric.area.iter());
        let pull = |(r, (weight, area)): (&Complex64, (&f64, &f64))| r * (2.0 * weight * area);
        self.wanted = guide.rotation.iter().zip(faces).map(pull).collect();
        self.system.factorize()?;
        self.global_step();
        self.steps(iterations);
        Ok(turned)
    }

    /// Holds an edge at its rotation from now on.
    pub(super) fn close(&mut self, edge: usize, matching: i32) {
        match self.seams.get(edge) {
            Some(&seam) => self.hold(seam, matching),
            None => self.align(self.turning[edge - self.seams.len()], -matching),
        }
    }

    /// Holds two images of an edge up to a quarter turn.
    fn hold(&mut self, [a, b, c, d]: [u32; 4], matching: i32) {
        let r = unit(matching);
        let one = Complex64::ONE;
        self.system.add_row(&[(d, one), (c, -one), (b, -r), (a, r)], SEAM_WEIGHT);
    }

    /// Holds an aligned half-edge along an axis, and the edge together if its other side is held too.
    fn align(&mut self, place: u32, direction: i32) {
        self.aligned[place as usize].direction = Some(direction);
        let edge = &self.aligned[place as usize];
        let constant = if direction.rem_euclid(2) == 0 { 1 } else { 0 };
        self.system.equate(edge.ends, constant, SEAM_WEIGHT);
        let twin = edge.twin.and_then(|t| self.aligned[t as usize].direction);
        if let (Some(twin), Some(quad)) = (twin, link(&self.aligned, edge)) {
            // The twin runs backwards: its direction is turned by two quarters.
            self.hold(quad, twin + 2 - direction);
        }
    }

    /// Local and global steps (Liu et al. 2008) with one factorisation.
    ///
    /// # Errors
    /// When the matrix is not positive definite to working precision.
    pub(super) fn relax(&mut self, iterations: usize) -> Result<(), NotPositiveDefinite> {
        self.system.factorize()?;
        self.steps(iterations);
        Ok(())
    }

    fn steps(&mut self, iterations: usize) {
        for _ in 0..iterations {
            self.local_step(OVERSHOOT);
            self.global_step();
        }
    }

    fn global_step(&mut self) {
        self.right_hand_side();
        self.system.solve(&mut self.z);
    }

    fn local_step(&mut self, overshoot: f64) {
        let (z, wedges, weights) = (&self.z, &self.wedge_of_corner, &self.corner_weights);
        let wanted = &self.wanted;
        self.frames.par_iter_mut().enumerate().with_min_len(4096).for_each(|(f, frame)| {
            let term = |c: usize| z[wedges[c] as usize] * weights[c].conj();
            let mut similar = term(3 * f) + term(3 * f + 1) + term(3 * f + 2);
            if let Some(&wanted) = wanted.get(f) {
                similar += nearest_quarter(wanted, similar);
            }
            let best = direction(similar);
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

    /// Rotation of an edge in the layout, lifted to the branch nearest to `last`; quarter turns.
    pub(super) fn rotation(&self, edge: usize, last: f64) -> f64 {
        let r = match self.seams.get(edge) {
            Some(seam) => {
                let [a, b, c, d] = seam.map(|w| self.z[w as usize]);
                ((d - c) * (b - a).conj()).arg() / FRAC_PI_2
            }
            None => {
                let place = self.turning[edge - self.seams.len()];
                let [a, b] = self.aligned[place as usize].ends.map(|w| self.z[w as usize]);
                -(b - a).arg() / FRAC_PI_2
            }
        };
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

/// All aligned half-edges, and the place of each in the list.
fn aligned_edges(sectors: &Sectors<'_>, cut: &Cut) -> (Vec<AlignedEdge>, HalfedgeData<u32>) {
    let mut place = HalfedgeData::filled(sectors.slit().n_halfedges(), u32::MAX);
    for (k, h) in sectors.aligned().enumerate() {
        place[h] = k as u32;
    }
    let edge = |h| AlignedEdge {
        ends: cut.ends(h),
        twin: sectors.mesh().twin(h).map(|t| place[t]),
        direction: None,
    };
    (sectors.aligned().map(edge).collect(), place)
}

/// Wedges at the origin and tip of an aligned edge on its own side, then on the other.
fn link(aligned: &[AlignedEdge], edge: &AlignedEdge) -> Option<[u32; 4]> {
    let twin = &aligned[edge.twin? as usize];
    let ([a, b], [d, c]) = (edge.ends, twin.ends);
    Some([a, b, c, d])
}
