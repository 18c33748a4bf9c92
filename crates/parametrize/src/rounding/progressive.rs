//! The rounding loop of the direct method.

use super::options::{RoundingOptions, RoundingStrategy};
use super::patch::LocalEstimate;
use super::relaxation::{Faces, Relaxation};
use super::weights::SectorWeights;
use super::{Rounding, RoundingStats};
use crate::cut::{FramedCut, MatchedCut, Unfolding, frames_of_angles};
use crate::features::Sectors;
use crate::field::Guide;
use crate::progress::{SolveError, Watch};
use seamstress_mesh::{Halfedge, Metric, TriMesh, VertexData};
use std::f64::consts::FRAC_PI_2;

/// Cost threshold of the first and last round.
const FIRST_THRESHOLD: f64 = 0.05;
const LAST_THRESHOLD: f64 = 1.0;
/// Costs closer than this are the same.
const SAME_COST: f64 = 1e-9;
/// A new layout is worth its time once this part of the edges that were open at the last one was rounded (a larger one towards
/// a guide, which tells most of what it would), and this part of all.
const OPEN_SHARE: f64 = 0.05;
const GUIDED_OPEN_SHARE: f64 = 0.3;
const LEAST_SHARE: f64 = 0.0025;
/// Layout iterations before the first round towards a guide, which is far away.
const GUIDED_ITERATIONS: usize = 8;
/// Edges nearer than this to the middle of two quarters are undecided.
const UNDECIDED_TURN: f64 = 0.4;
/// The part of the undecided edges at corners that might be either that is rounded at once: how these are decided
/// tells the next layout about the others.
const UNDECIDED_SHARE: f64 = 1.0 / 16.0;
/// Roundings that turn an edge by more than this (quarters) keep apart within a round.
const LARGE_TURN: f64 = 0.1;

/// Rounds the matchings of all turning edges, cheapest first, laying the mesh out again after each round
/// that changed enough.
///
/// The cost of turning an edge of rotation r by d = i - r to the integer i, with k the real indices of
/// its ends less the preferred ones, is `size(d) + bias (|k_o - d| + |k_d + d| - |k_o| - |k_d|)`: turning moves
/// curvature from one end to the other, and the second term is the change of total absolute curvature. At
/// corners the bias is the corner weight, and what leads out of the bounds of the index costs more still.
/// The frames are those of the last layout.
pub(super) fn round_progressively(
    sectors: &Sectors<'_>,
    metric: &Metric,
    unfolding: Unfolding,
    guide: Option<&Guide>,
    options: &RoundingOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, SolveError> {
    let slit = sectors.slit();
    let weights = SectorWeights::new(sectors, options);
    let undecided = |edge: u32, rotation: f64| {
        let h = unfolding.turning[edge as usize];
        let at = |s| sectors.preferences(s)[0] < sectors.preferences(s)[1];
        (rotation - rotation.round()).abs() > UNDECIDED_TURN
            && (at(slit.origin(h)) || at(slit.tip(h)))
    };
    let mut rotation = unfolding.isometric.clone();
    let mut known: Vec<Option<i32>> = vec![None; rotation.len()];
    let mut faces = Faces {
        frames: frames_of_angles(slit, metric, &metric.angle, &unfolding.tree),
        wanted: Vec::new(),
    };
    if let Some(guide) = guide {
        let mut relaxation = Relaxation::new(sectors, metric, &unfolding, &known, faces)?;
        let turned = relaxation.follow(guide, metric, &unfolding.tree, GUIDED_ITERATIONS);
        for (edge, (r, &h)) in rotation.iter_mut().zip(&unfolding.turning).enumerate() {
            let right = slit.twin(h).map_or(0.0, |t| turned[t.face()]);
            *r -= (right - turned[h.face()]) / FRAC_PI_2;
            *r = relaxation.rotation(edge, *r);
        }
        faces = relaxation.into_faces();
    }
    let open_share = if guide.is_some() { GUIDED_OPEN_SHARE } else { OPEN_SHARE };
    let mut relaxation: Option<Relaxation> = None;
    let mut open: Vec<u32> = (0..rotation.len() as u32).collect();
    let total = open.len().max(1) as f64;
    let mut stats = RoundingStats::default();
    let mut since_layout = 0;
    let mut estimate: Option<(LocalEstimate, VertexData<f64>)> = None;
    while !open.is_empty() {
        watch.tick(1.0 - open.len() as f64 / total)?;
        let growth = stats.rounds as f64 / (options.rounds.max(2) - 1) as f64;
        let threshold = if growth < 1.0 {
            FIRST_THRESHOLD + (LAST_THRESHOLD - FIRST_THRESHOLD) * growth
        } else {
            f64::INFINITY
        };
        let index = unfolding.indices(sectors, metric, &rotation);
        let cost = |edge: u32, turn: f64| {
            let size = match &estimate {
                Some((patches, log_scale)) => patches.size(edge, turn, log_scale),
                None => turn.abs(),
            };
            let h = unfolding.turning[edge as usize];
            let (o, d) = (slit.origin(h), slit.tip(h));
            size + (weights.change(o, index[o], -turn) + weights.change(d, index[d], turn))
        };
        let chosen = choose(slit, &unfolding.turning, &rotation, &open, threshold, cost, undecided);
        stats.rounds += 1;
        if chosen.is_empty() {
            continue;
        }
        let decides = chosen.iter().any(|&(edge, _)| undecided(edge, rotation[edge as usize]));
        for &(edge, integer) in &chosen {
            known[edge as usize] = Some(integer);
            rotation[edge as usize] = f64::from(integer);
            if let Some(relaxation) = &mut relaxation {
                relaxation.close(edge as usize, integer);
            }
        }
        open.retain(|&edge| known[edge as usize].is_none());
        since_layout += chosen.len();
        let worth = (LEAST_SHARE * total).max(open_share * (open.len() + since_layout) as f64);
        let is_enough = decides || since_layout as f64 >= worth;
        if !is_enough && !open.is_empty() {
            continue;
        }
        since_layout = 0;
        let mut layout = match relaxation.take() {
            Some(mut layout) => {
                layout.lay_out()?;
                layout
            }
            None => {
                let faces = std::mem::take(&mut faces);
                Relaxation::new(sectors, metric, &unfolding, &known, faces)?
            }
        };
        layout.steps(options.layout_iterations);
        stats.layouts += 1;
        if options.strategy == RoundingStrategy::LocalEstimation {
            // Most edges are rounded at first sight; the patches of the others are worth solving.
            let patches = match estimate {
                Some((patches, _)) => patches,
                None => LocalEstimate::new(sectors, metric, &unfolding.turning, &open),
            };
            estimate = Some((patches, layout.log_scale(slit, metric)));
        }
        for &edge in &open {
            let r = &mut rotation[edge as usize];
            *r = layout.rotation(edge as usize, *r);
        }
        relaxation = Some(layout);
    }
    let frames = relaxation.map_or(faces, Relaxation::into_faces).frames;
    let matching = known.into_iter().flatten().collect();
    let matched = MatchedCut { unfolding, matching };
    Ok(Rounding { start: FramedCut { matched, frames }, stats })
}

/// The open edges to round now, with their integers: cost within the threshold, cheapest first, large
/// turns at least a sector apart, and of the undecided edges a few.
fn choose(
    mesh: &TriMesh,
    turning: &[Halfedge],
    rotation: &[f64],
    open: &[u32],
    threshold: f64,
    cost: impl Fn(u32, f64) -> f64,
    undecided: impl Fn(u32, f64) -> bool,
) -> Vec<(u32, i32)> {
    let mut candidates: Vec<SeamRounding> = open
        .iter()
        .filter_map(|&edge| {
            let r = rotation[edge as usize];
            let cost = |integer: f64| cost(edge, integer - r);
            let option = |integer: f64| SeamRounding {
                cost: cost(integer),
                turn: (integer - r).abs(),
                edge,
                integer: integer as i32,
            };
            let (low, high) = (option(r.floor()), option(r.ceil()));
            let best = if high.key() < low.key() { high } else { low };
            (best.cost <= threshold).then_some(best)
        })
        .collect();
    candidates.sort_unstable_by_key(SeamRounding::key);
    let undecided = |c: &SeamRounding| undecided(c.edge, rotation[c.edge as usize]);
    let n_undecided = candidates.iter().filter(|c| undecided(c)).count() as f64;
    let mut left = (UNDECIDED_SHARE * n_undecided).ceil() as usize;
    candidates.retain(|candidate| {
        let waits = undecided(candidate);
        let is_due = !waits || left > 0;
        left -= usize::from(waits && is_due);
        is_due
    });
    let mut used = VertexData::filled(mesh.n_vertices(), false);
    candidates.retain(|candidate| {
        if candidate.turn <= LARGE_TURN {
            return true;
        }
        let h = turning[candidate.edge as usize];
        let (o, d) = (mesh.origin(h), mesh.tip(h));
        let free = !used[o] && !used[d];
        used[o] |= free;
        used[d] |= free;
        free
    });
    candidates.into_iter().map(|c| (c.edge, c.integer)).collect()
}

/// The rounding of a seam; its key orders by cost, then by how little it turns, then by id. Costs and turns that differ by
/// rounding errors only count as equal: these must not decide.
#[derive(Debug, Clone, Copy)]
struct SeamRounding {
    cost: f64,
    turn: f64,
    edge: u32,
    integer: i32,
}

impl SeamRounding {
    fn key(&self) -> (i64, i64, u32, i32) {
        let coarse = |x: f64| (x / SAME_COST).round() as i64;
        (coarse(self.cost), coarse(self.turn), self.edge, self.integer)
    }
}
