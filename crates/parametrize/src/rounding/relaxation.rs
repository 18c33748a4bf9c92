//! The layout between roundings: as rigid as possible, rounded edges held, the others free.

use super::system::RelaxationSystem;
use crate::chebyshev::{Step, accelerated};
use crate::cut::{Cut, DualTree, PartialCut, Unfolding};
use crate::features::Sectors;
use crate::field::Guide;
use crate::quarter::{direction, nearest_quarter, turn, unit};
use num_complex::Complex64;
use seamstress_linalg::{Buckets, NotPositiveDefinite};
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use seamstress_parallel::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Weight of the rows that hold a rounded edge; the rigidity energy has weights of order one.
const SEAM_WEIGHT: f64 = 1e3;

/// State of the relaxation, on the cut that the matchings known at its start leave. The pattern of the system has room
/// for every row from the start, so that one symbolic analysis serves all rounds; it is real only where edges are to be
/// aligned.
///
/// Whoever calls it speaks in the gauge of the unfolding.
pub(super) struct Relaxation {
    z: Vec<Complex64>,
    /// Per corner: `sum of z conj(g)` over a face has the face's rotation; `sum of rotation g` over a
    /// wedge is its right-hand side.
    corner_weights: Vec<Complex64>,
    wedge_of_corner: Vec<u32>,
    corners_of_wedge: Buckets,
    frames: Vec<Complex64>,
    /// The frames before the last step.
    before: Vec<Complex64>,
    wanted: Vec<Complex64>,
    /// From the gauge of the unfolding to that of the cut, quarter turns.
    gauge: FaceData<i32>,
    /// The seams of the unfolding.
    seams: Vec<Seam>,
    /// All aligned half-edges.
    aligned: Vec<AlignedEdge>,
    /// Those of them that turn; they follow on the seams.
    turning: Vec<u32>,
    system: RelaxationSystem,
}

/// What a layout does with each face, in the gauge of the unfolding.
#[derive(Default)]
pub(super) struct Faces {
    /// Its rotation, a unit complex number.
    pub(super) frames: Vec<Complex64>,
    /// The rotation wanted, up to quarter turns, by what it counts: as much as rigidity where directions count fully.
    /// Empty without a guide.
    pub(super) wanted: Vec<Complex64>,
}

/// A seam of the unfolding.
struct Seam {
    /// Wedges of origin and tip on the left, then on the right.
    wedges: [u32; 4],
    /// How much further the gauge turns the left face than the right one, quarter turns.
    gauge: i32,
}

/// One side of an aligned edge.
struct AlignedEdge {
    /// Wedges of its origin and tip.
    ends: [u32; 2],
    /// Gauge of its face.
    gauge: i32,
    /// The other side, by its place in the list.
    twin: Option<u32>,
    /// Its direction in quarters, in the gauge of the cut, once it has one.
    direction: Option<i32>,
}

impl Relaxation {
    /// Lays the faces out as near to their frames as the known matchings let them, and their sides that hang on the
    /// ground.
    ///
    /// # Errors
    /// When the system cannot be set up.
    pub(super) fn new(
        sectors: &Sectors<'_>,
        metric: &Metric,
        unfolding: &Unfolding,
        matching: &[Option<i32>],
        Faces { mut frames, wanted }: Faces,
    ) -> Result<Self, NotPositiveDefinite> {
        let slit = sectors.slit();
        let PartialCut { cut, gauge, known } = PartialCut::new(slit, unfolding, matching);
        let n = cut.n_wedges;
        for (frame, &k) in frames.iter_mut().zip(gauge.iter()) {
            *frame = turn(*frame, k);
        }
        let seam = |&h: &Halfedge| Seam {
            wedges: cut.seam_wedges(slit, h),
            gauge: gauge[h.face()] - slit.twin(h).map_or(0, |t| gauge[t.face()]),
        };
        let faces: Vec<[u32; 3]> =
            slit.faces().map(|f| f.halfedges().map(|h| cut.wedge[h])).collect();
        let (aligned, place) = aligned_edges(sectors, &cut, &gauge);
        let seams = cut.seams.iter().map(|&h| cut.seam_wedges(slit, h));
        let links = aligned.iter().filter_map(|edge| link(&aligned, edge));
        let quads: Vec<[u32; 4]> = seams.chain(links).collect();
        let quads = quads.iter().map(<[u32; 4]>::as_slice);
        let cliques = faces.iter().map(<[u32; 3]>::as_slice).chain(quads);
        let vertex = |h| sectors.mesh().origin(h).0;
        let order =
            sectors.dissection().induced(n, slit.halfedges().map(|h| (cut.wedge[h], vertex(h))));
        let mut relaxation = Self {
            z: vec![Complex64::ZERO; n],
            corner_weights: corner_weights(slit, metric),
            wedge_of_corner: cut.wedge.to_vec(),
            corners_of_wedge: Buckets::new(n, &cut.wedge),
            before: frames.clone(),
            frames,
            wanted,
            system: RelaxationSystem::new(&order, cliques, sectors.any_aligned())?,
            seams: unfolding.cut.seams.iter().map(seam).collect(),
            turning: unfolding.turning[unfolding.cut.seams.len()..]
                .iter()
                .map(|&h| place[h])
                .collect(),
            aligned,
            gauge,
        };
        let cotangent = metric.cotangent();
        for h in slit.halfedges() {
            let [a, b] = cut.ends(h);
            let row = [(a, -Complex64::ONE), (b, Complex64::ONE)];
            relaxation.system.add_row(&row, cotangent[h] / 2.0);
        }
        relaxation.system.shift();
        for (h, matching) in known {
            relaxation.hold(cut.seam_wedges(slit, h), matching);
        }
        for h in unfolding.tree.ground.iter().flatten() {
            relaxation.align(place[*h], 0);
        }
        for (place, matching) in matching[relaxation.seams.len()..].iter().enumerate() {
            if let Some(matching) = matching {
                relaxation.align(relaxation.turning[place], -matching);
            }
        }
        relaxation.lay_out()?;
        Ok(relaxation)
    }

    /// Turns every face to a guide, which local steps follow from now on, and relaxes the layout; how far each was turned
    /// back at first, radians.
    ///
    /// Of the four directions of a face the one is taken that turns it least against the face before it in the
    /// tree: chosen face by face they would make pairs of cones along the tree.
    pub(super) fn follow(
        &mut self,
        guide: &Guide,
        metric: &Metric,
        tree: &DualTree,
        iterations: usize,
    ) -> FaceData<f64> {
        self.local_step(Step::PLAIN);
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
        self.global_step();
        self.steps(iterations);
        turned
    }

    /// Holds an edge at its rotation from now on.
    pub(super) fn close(&mut self, edge: usize, matching: i32) {
        match self.seams.get(edge) {
            Some(&Seam { wedges, gauge }) => self.hold(wedges, matching - gauge),
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
        let direction = direction + self.aligned[place as usize].gauge;
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

    /// Lays the faces out anew, with the edges held by now.
    ///
    /// # Errors
    /// When the matrix is not positive definite to working precision.
    pub(super) fn lay_out(&mut self) -> Result<(), NotPositiveDefinite> {
        self.system.factorize()?;
        self.global_step();
        Ok(())
    }

    /// Local and global steps (Liu et al. 2008), accelerated.
    pub(super) fn steps(&mut self, iterations: usize) {
        for step in accelerated().take(iterations) {
            self.local_step(step);
            self.global_step();
        }
    }

    fn global_step(&mut self) {
        self.right_hand_side();
        self.system.solve(&mut self.z);
    }

    /// Turns every face towards its best rotation.
    fn local_step(&mut self, step: Step) {
        let (z, wedges, weights) = (&self.z, &self.wedge_of_corner, &self.corner_weights);
        let wanted = &self.wanted;
        let faces = self.frames.par_iter_mut().zip(self.before.par_iter_mut());
        faces.enumerate().with_min_len(4096).for_each(|(f, (frame, before))| {
            let term = |c: usize| z[wedges[c] as usize] * weights[c].conj();
            let mut similar = term(3 * f) + term(3 * f + 1) + term(3 * f + 2);
            if let Some(&wanted) = wanted.get(f) {
                similar += nearest_quarter(wanted, similar);
            }
            step.turn(frame, before, direction(similar));
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
                let [a, b, c, d] = seam.wedges.map(|w| self.z[w as usize]);
                ((d - c) * (b - a).conj()).arg() / FRAC_PI_2 + f64::from(seam.gauge)
            }
            None => {
                let edge = &self.aligned[self.turning[edge - self.seams.len()] as usize];
                let [a, b] = edge.ends.map(|w| self.z[w as usize]);
                f64::from(edge.gauge) - (b - a).arg() / FRAC_PI_2
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

    /// The faces as they are turned now.
    pub(super) fn into_faces(mut self) -> Faces {
        self.local_step(Step::PLAIN);
        let frames = self.frames.iter().zip(self.gauge.iter());
        Faces { frames: frames.map(|(&r, &k)| turn(r, -k)).collect(), wanted: self.wanted }
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
fn aligned_edges(
    sectors: &Sectors<'_>,
    cut: &Cut,
    gauge: &FaceData<i32>,
) -> (Vec<AlignedEdge>, HalfedgeData<u32>) {
    let mut place = HalfedgeData::filled(sectors.slit().n_halfedges(), u32::MAX);
    for (k, h) in sectors.aligned().enumerate() {
        place[h] = k as u32;
    }
    let edge = |h| AlignedEdge {
        ends: cut.ends(h),
        gauge: gauge[h.face()],
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
