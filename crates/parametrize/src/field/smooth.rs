//! A smooth cross field by mixed-integer rounding of period jumps (Bommes, Zimmer, Kobbelt 2009).

use super::face_laplacian::{FaceMatrix, nearest_angles};
use super::frames_of_matchings::frames_of;
use crate::cut::MatchedCut;
use crate::progress::{Cancelled, Watch};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{Halfedge, Metric, TriMesh, VertexData};

/// What the rounding of the field did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SmoothStats {
    /// Rounds of rounding.
    pub rounds: usize,
    /// Linear solves.
    pub solves: usize,
    /// Mean over interior edges of the squared rotation of the cross across it, quarters squared.
    pub energy: f64,
}

/// Why a field was not finished.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SmoothError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A linear system could not be solved.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
}

/// Rounds in which the largest turn that is rounded grows linearly to one half, which is all.
const ROUNDS: usize = 50;
/// Turns above this, in quarters, keep a vertex apart within a round: they act on each other.
const LARGE_TURN: f64 = 0.1;
/// The angles are solved anew once this share of the seams was rounded.
const SOLVE_SHARE: f64 = 0.005;

/// Chooses the matchings of a connected mesh such that the field they allow is smooth: minimises
/// `sum over interior edges of (r - r0(angles))^2` over one real angle per face and one integer `r` per
/// edge, with `r = 0` across the dual tree of the cut.
///
/// Greedy, as in the paper: while all other jumps are real, those nearest to integers are rounded and held
/// and the angles solved anew. The paper rounds one at a time; here a round takes all up to a bound that
/// grows. Returns the frames, in the gauge of the cut.
///
/// # Errors
/// [`SmoothError`].
pub fn smooth_field(
    mesh: &TriMesh,
    metric: &Metric,
    matched: &mut MatchedCut,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<Complex64>, SmoothStats), SmoothError> {
    let mut work = Rounding::new(mesh, matched)?;
    let mut open: Vec<u32> = (0..matched.matching.len() as u32).collect();
    let total = open.len().max(1) as f64;
    let mut stats = SmoothStats::default();
    let mut since_solve = 0;
    while !open.is_empty() {
        watch.tick(1.0 - open.len() as f64 / total)?;
        stats.rounds += 1;
        let bound = 0.5 * (stats.rounds as f64 / ROUNDS as f64).min(1.0);
        let chosen = work.choose(mesh, matched, &open, bound);
        for &(seam, integer) in &chosen {
            matched.matching[seam as usize] = integer;
            work.held[work.edge_of_seam[seam as usize] as usize] = true;
        }
        open.retain(|&seam| !work.held[work.edge_of_seam[seam as usize] as usize]);
        since_solve += chosen.len();
        let is_due = since_solve as f64 >= SOLVE_SHARE * total || open.is_empty();
        if is_due && since_solve > 0 {
            since_solve = 0;
            stats.solves += 1;
            work.solve(matched)?;
        }
    }
    stats.energy = work.energy(matched);
    Ok((frames_of(mesh, metric, matched, &work.angles), stats))
}

struct Rounding {
    matrix: FaceMatrix<f64>,
    /// Interior edge of each seam, and the seam of each edge.
    edge_of_seam: Vec<u32>,
    seam_of_edge: Vec<Option<u32>>,
    /// Edges whose jump is an integer: those the tree crosses, from the start, and rounded seams.
    held: Vec<bool>,
    /// Turn of each face against the isometric layout, quarters.
    angles: Vec<f64>,
}

impl Rounding {
    fn new(mesh: &TriMesh, matched: &MatchedCut) -> Result<Self, NotPositiveDefinite> {
        let edges: Vec<Halfedge> = mesh.interior_edges().collect();
        let mut seam_of_edge = vec![None; edges.len()];
        let mut edge_of_seam = Vec::with_capacity(matched.cut.seams.len());
        for (e, _) in edges.iter().enumerate().filter(|(_, h)| matched.cut.is_seam[**h]) {
            // Both are listed by left half-edge, ascending.
            seam_of_edge[e] = Some(edge_of_seam.len() as u32);
            edge_of_seam.push(e as u32);
        }
        Ok(Self {
            matrix: FaceMatrix::new(mesh)?,
            held: seam_of_edge.iter().map(Option::is_none).collect(),
            edge_of_seam,
            seam_of_edge,
            angles: vec![0.0; mesh.n_faces()],
        })
    }

    /// Rotation of a seam at the present angles, quarters.
    fn rotation(&self, matched: &MatchedCut, seam: u32) -> f64 {
        let [left, right] = self.matrix.faces()[self.edge_of_seam[seam as usize] as usize];
        matched.isometric[seam as usize] + self.angles[right as usize] - self.angles[left as usize]
    }

    /// Seams to round now with their integers, least turns first.
    fn choose(
        &self,
        mesh: &TriMesh,
        matched: &MatchedCut,
        open: &[u32],
        bound: f64,
    ) -> Vec<(u32, i32)> {
        let candidate = |&seam: &u32| {
            let r = self.rotation(matched, seam);
            ((r - r.round()).abs(), seam, r.round() as i32)
        };
        let mut candidates: Vec<(f64, u32, i32)> =
            open.iter().map(candidate).filter(|c| c.0 <= bound).collect();
        candidates.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut used = VertexData::filled(mesh.n_vertices(), false);
        candidates.retain(|&(turn, seam, _)| {
            let h = matched.cut.seams[seam as usize];
            let ends = [mesh.origin(h), mesh.tip(h)];
            if turn <= LARGE_TURN {
                return true;
            }
            let free = ends.iter().all(|&v| !used[v]);
            ends.iter().for_each(|&v| used[v] |= free);
            free
        });
        candidates.into_iter().map(|(_, seam, integer)| (seam, integer)).collect()
    }

    fn target(&self, matched: &MatchedCut, edge: usize) -> f64 {
        let seam = self.seam_of_edge[edge].map(|s| s as usize);
        seam.map_or(0.0, |s| f64::from(matched.matching[s]) - matched.isometric[s])
    }

    fn solve(&mut self, matched: &MatchedCut) -> Result<(), NotPositiveDefinite> {
        let target: Vec<f64> = (0..self.held.len()).map(|e| self.target(matched, e)).collect();
        let held = &self.held;
        let weight = |e: usize| if held[e] { 1.0 } else { 0.0 };
        self.angles = nearest_angles(&mut self.matrix, weight, |e| target[e])?;
        Ok(())
    }

    fn energy(&self, matched: &MatchedCut) -> f64 {
        let square = |(e, &[left, right]): (usize, &[u32; 2])| {
            let turn = self.angles[right as usize] - self.angles[left as usize];
            (self.target(matched, e) - turn).powi(2)
        };
        let n = self.held.len().max(1) as f64;
        self.matrix.faces().iter().enumerate().map(square).sum::<f64>() / n
    }
}
