//! A smooth cross field by mixed-integer rounding of period jumps (Bommes, Zimmer, Kobbelt 2009).

use super::face_laplacian::{FaceMatrix, nearest_angles};
use super::frames_of_matchings::frames_of;
use crate::cut::{FramedCut, MatchedCut, Unfolding};
use crate::progress::{SolveError, Watch};
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
/// grows.
///
/// # Errors
/// [`SolveError`].
pub fn smooth_field(
    mesh: &TriMesh,
    metric: &Metric,
    unfolding: Unfolding,
    watch: &mut Watch<'_, '_>,
) -> Result<(FramedCut, SmoothStats), SolveError> {
    let mut work = FieldRounding::new(mesh, &unfolding)?;
    let mut open: Vec<u32> = (0..unfolding.cut.seams.len() as u32).collect();
    let total = open.len().max(1) as f64;
    let mut stats = SmoothStats::default();
    let mut since_solve = 0;
    while !open.is_empty() {
        watch.tick(1.0 - open.len() as f64 / total)?;
        stats.rounds += 1;
        let bound = 0.5 * (stats.rounds as f64 / ROUNDS as f64).min(1.0);
        let chosen = work.choose(mesh, &open, bound);
        for &(seam, integer) in &chosen {
            work.matching[seam as usize] = integer;
            work.held[work.edge_of_seam[seam as usize] as usize] = true;
        }
        open.retain(|&seam| !work.held[work.edge_of_seam[seam as usize] as usize]);
        since_solve += chosen.len();
        let is_due = since_solve as f64 >= SOLVE_SHARE * total || open.is_empty();
        if is_due && since_solve > 0 {
            since_solve = 0;
            stats.solves += 1;
            work.solve()?;
        }
    }
    stats.energy = work.energy();
    let FieldRounding { matching, angles, .. } = work;
    let frames = frames_of(mesh, metric, &unfolding, &angles);
    Ok((FramedCut { matched: MatchedCut { unfolding, matching }, frames }, stats))
}

struct FieldRounding<'a> {
    unfolding: &'a Unfolding,
    /// Integer of each seam; zero where it has none yet.
    matching: Vec<i32>,
    matrix: FaceMatrix<f64>,
    /// Interior edge of each seam, and the seam of each edge.
    edge_of_seam: Vec<u32>,
    seam_of_edge: Vec<Option<u32>>,
    /// Edges whose jump is an integer: those the tree crosses, from the start, and rounded seams.
    held: Vec<bool>,
    /// Turn of each face against the isometric layout, quarters.
    angles: Vec<f64>,
}

impl<'a> FieldRounding<'a> {
    fn new(mesh: &TriMesh, unfolding: &'a Unfolding) -> Result<Self, NotPositiveDefinite> {
        let edges: Vec<Halfedge> = mesh.interior_edges().collect();
        let mut seam_of_edge = vec![None; edges.len()];
        let mut edge_of_seam = Vec::with_capacity(unfolding.cut.seams.len());
        for (e, _) in edges.iter().enumerate().filter(|(_, h)| unfolding.cut.is_seam[**h]) {
            // Both are listed by left half-edge, ascending.
            seam_of_edge[e] = Some(edge_of_seam.len() as u32);
            edge_of_seam.push(e as u32);
        }
        Ok(Self {
            unfolding,
            matching: vec![0; edge_of_seam.len()],
            matrix: FaceMatrix::new(mesh)?,
            held: seam_of_edge.iter().map(Option::is_none).collect(),
            edge_of_seam,
            seam_of_edge,
            angles: vec![0.0; mesh.n_faces()],
        })
    }

    /// Rotation of a seam at the present angles, quarters.
    fn rotation(&self, seam: u32) -> f64 {
        let [left, right] = self.matrix.faces()[self.edge_of_seam[seam as usize] as usize];
        self.unfolding.isometric[seam as usize] + self.angles[right as usize]
            - self.angles[left as usize]
    }

    /// Seams to round now with their integers, least turns first.
    fn choose(&self, mesh: &TriMesh, open: &[u32], bound: f64) -> Vec<(u32, i32)> {
        let candidate = |&seam: &u32| {
            let r = self.rotation(seam);
            ((r - r.round()).abs(), seam, r.round() as i32)
        };
        let mut candidates: Vec<(f64, u32, i32)> =
            open.iter().map(candidate).filter(|c| c.0 <= bound).collect();
        candidates.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut used = VertexData::filled(mesh.n_vertices(), false);
        candidates.retain(|&(turn, seam, _)| {
            let h = self.unfolding.cut.seams[seam as usize];
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

    fn target(&self, edge: usize) -> f64 {
        let seam = self.seam_of_edge[edge].map(|s| s as usize);
        seam.map_or(0.0, |s| f64::from(self.matching[s]) - self.unfolding.isometric[s])
    }

    fn solve(&mut self) -> Result<(), NotPositiveDefinite> {
        let target: Vec<f64> = (0..self.held.len()).map(|e| self.target(e)).collect();
        let held = &self.held;
        let weight = |e: usize| if held[e] { 1.0 } else { 0.0 };
        self.angles = nearest_angles(&mut self.matrix, weight, |e| target[e])?;
        Ok(())
    }

    fn energy(&self) -> f64 {
        let square = |(e, &[left, right]): (usize, &[u32; 2])| {
            let turn = self.angles[right as usize] - self.angles[left as usize];
            (self.target(e) - turn).powi(2)
        };
        let n = self.held.len().max(1) as f64;
        self.matrix.faces().iter().enumerate().map(square).sum::<f64>() / n
    }
}
