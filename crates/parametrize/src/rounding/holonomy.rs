//! Choosing the rotations around handles and between boundaries for fixed cones.

use super::lattice::closest_integers;
use crate::cut::{FramedCut, MatchedCut, Unfolding};
use crate::features::Sectors;
use crate::field::{Guide, frames_of};
use crate::quarter::nearest_quarter;
use num_complex::Complex64;
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern};
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, Vertex};
use seamstress_parallel::prelude::*;
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;

/// Weights of dual edges are inverse cotangent sums, these kept in this range.
const COTANGENT_RANGE: (f64, f64) = (0.1, 10.0);
/// Directions that count fully pull with as much as turning across the mesh over so many cells costs.
const PULL_LENGTH: f64 = 4.0;
/// Added to the diagonal of the face Laplacian, whose constants would be its null space where nothing is held: far below
/// its other eigenvalues, far above rounding errors.
const SHIFT: f64 = 1e-10;

/// Chooses the circulations of matchings, which no cone sees: moving cones changes how much a loop around a handle turns,
/// and the best integers change with it. With the smoothest frames for them.
///
/// The matchings' difference to the isometric rotations is a flow on dual edges. The best rotation of every face,
/// which is its frame, takes part of it away; what remains is its divergence-free part, whose weighted square is made
/// small over integer multiples of the turning edges' cycles (paths between boundaries are cycles too). With a guide the
/// rotations are pulled to it, from where the frames of the start are.
/// An integer least squares problem in 2g + b - 1 unknowns. The cones stay.
pub struct Holonomy<'a> {
    sectors: &'a Sectors<'a>,
    metric: &'a Metric,
    guide: Option<&'a Guide>,
    /// Faces on the left and right of each dual edge; the ground follows on the faces.
    sides: Vec<[u32; 2]>,
    /// Dual edge of each half-edge that has one.
    number: HalfedgeData<u32>,
    weights: Vec<f64>,
    /// Per face how much its rotation is pulled; none without a guide.
    pull: Vec<f64>,
    /// Faces, and the ground if there is one.
    nodes: usize,
    cholesky: Cholesky<f64>,
}

impl<'a> Holonomy<'a> {
    /// Factors the face Laplacian, which is the same for all cones.
    ///
    /// # Errors
    /// When it cannot be factored.
    pub fn new(
        sectors: &'a Sectors<'a>,
        metric: &'a Metric,
        guide: Option<&'a Guide>,
    ) -> Result<Self, NotPositiveDefinite> {
        let slit = sectors.slit();
        let ground = slit.n_faces() as u32;
        let nodes = slit.n_faces() + usize::from(sectors.any_aligned());
        let edges: Vec<Halfedge> = slit.interior_edges().chain(sectors.aligned()).collect();
        let cotangent = metric.cotangent();
        let side = |h: Halfedge| [h.face().0, slit.twin(h).map_or(ground, |t| t.face().0)];
        let sides: Vec<[u32; 2]> = edges.iter().map(|&h| side(h)).collect();
        let weights: Vec<f64> = edges
            .iter()
            .map(|&h| {
                let sum = cotangent[h] + slit.twin(h).map_or(0.0, |t| cotangent[t]);
                2.0 / sum.clamp(COTANGENT_RANGE.0, COTANGENT_RANGE.1)
            })
            .collect();
        let pattern = Pattern::of_cliques(nodes, sides.iter());
        let order = sectors.order_of_faces(nodes);
        let mut matrix = vec![0.0; pattern.len()];
        for &k in pattern.diagonal() {
            matrix[k as usize] = SHIFT;
        }
        let pull = guide.map_or(Vec::new(), |guide| pull(guide, metric));
        for (&k, weight) in pattern.diagonal().iter().zip(&pull) {
            matrix[k as usize] += weight;
        }
        for (&[f, g], weight) in sides.iter().zip(&weights) {
            matrix[pattern.diagonal()[f as usize] as usize] += weight;
            matrix[pattern.diagonal()[g as usize] as usize] += weight;
            if let Some(slot) = pattern.slot(f, g) {
                matrix[slot as usize] -= weight;
            }
        }
        let mut cholesky = Cholesky::analyze(&pattern, &order)?;
        cholesky.factorize(&matrix)?;
        let mut number = HalfedgeData::filled(slit.n_halfedges(), 0);
        edges.iter().enumerate().for_each(|(e, &h)| number[h] = e as u32);
        Ok(Self { sectors, metric, guide, sides, number, weights, pull, nodes, cholesky })
    }

    /// The matchings of a start with the best circulations, and the smoothest frames for them.
    pub fn fix(&self, start: FramedCut) -> FramedCut {
        let FramedCut { mut matched, frames } = start;
        let projector = Projector::new(self, &matched.unfolding, &frames);
        let excess = |matched: &MatchedCut| -> Vec<(u32, f64)> {
            matched.excess().enumerate().map(|(s, excess)| (s as u32, excess)).collect()
        };
        let cycles = turning_cycles(self.sectors, &matched.unfolding);
        if !cycles.is_empty() {
            let target = projector.residual(&excess(&matched), 1.0);
            let columns: Vec<Vec<f64>> = cycles
                .par_iter()
                .map(|cycle| {
                    let signed = cycle.iter().map(|&(s, sign)| (s, f64::from(sign)));
                    projector.residual(&signed.collect::<Vec<_>>(), 0.0)
                })
                .collect();
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
            let gram: Vec<Vec<f64>> =
                columns.par_iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
            let rhs: Vec<f64> = columns.iter().map(|a| -dot(a, &target)).collect();
            let multiples = closest_integers(&gram, &rhs);
            for (cycle, &n) in cycles.iter().zip(&multiples) {
                for &(s, sign) in cycle {
                    matched.matching[s as usize] += sign * n;
                }
            }
        }
        let turns = projector.turns(&excess(&matched));
        let frames = frames_of(self.sectors.slit(), self.metric, &matched.unfolding, &turns);
        FramedCut { matched, frames }
    }

    /// Per face the rotation of the guide nearest to the one there is, quarters.
    fn wanted(&self, guide: &Guide, unfolding: &Unfolding, frames: &[Complex64]) -> Vec<f64> {
        let mut turn = vec![0.0; frames.len()];
        let isometric = frames_of(self.sectors.slit(), self.metric, unfolding, &turn);
        for &f in &unfolding.tree.order {
            let wanted = nearest_quarter(guide.rotation[f], frames[f.at()]);
            let off = (wanted * isometric[f.at()].conj()).arg() / FRAC_PI_2;
            let before = unfolding.tree.parent[f].map_or(0.0, |h| turn[h.face().at()]);
            // Lifted along the tree, across which full turns are zero.
            turn[f.at()] = off + 4.0 * ((before - off) / 4.0).round();
        }
        turn
    }
}

/// A basis of the cycles of the graph of turning edges, the free sectors merged to one: signed edges.
fn turning_cycles(sectors: &Sectors<'_>, unfolding: &Unfolding) -> Vec<Vec<(u32, i32)>> {
    let slit = sectors.slit();
    let free = slit.n_vertices() as u32;
    let id = |s: Vertex| if sectors.is_free(s) { free } else { s.0 };
    let ends: Vec<[u32; 2]> =
        unfolding.turning.iter().map(|&h| [id(slit.origin(h)), id(slit.tip(h))]).collect();
    let mut at = vec![Vec::new(); slit.n_vertices() + 1];
    for (s, &[a, b]) in ends.iter().enumerate() {
        at[a as usize].push((b, s as u32, 1));
        at[b as usize].push((a, s as u32, -1));
    }
    // Breadth-first forest: (parent, seam, sign of walking from the parent), depth.
    let mut parent: Vec<Option<(u32, u32, i32)>> = vec![None; at.len()];
    let mut depth = vec![u32::MAX; at.len()];
    let mut in_forest = vec![false; ends.len()];
    for start in (0..at.len()).rev() {
        if depth[start] != u32::MAX {
            continue;
        }
        depth[start] = 0;
        let mut queue = VecDeque::from([start as u32]);
        while let Some(v) = queue.pop_front() {
            for &(w, s, sign) in &at[v as usize] {
                if depth[w as usize] == u32::MAX {
                    depth[w as usize] = depth[v as usize] + 1;
                    parent[w as usize] = Some((v, s, sign));
                    in_forest[s as usize] = true;
                    queue.push_back(w);
                }
            }
        }
    }
    let close = |s: usize| {
        // The seam from a to b, then back from b to a through the forest.
        let [mut a, mut b] = ends[s];
        let mut cycle = vec![(s as u32, 1)];
        while a != b {
            let from_b = depth[b as usize] >= depth[a as usize];
            let Some((up, seam, sign)) = parent[if from_b { b } else { a } as usize] else {
                break;
            };
            cycle.push((seam, if from_b { -sign } else { sign }));
            if from_b {
                b = up;
            } else {
                a = up;
            }
        }
        cycle
    };
    (0..ends.len()).filter(|&s| !in_forest[s]).map(close).collect()
}

/// How much the rotation of each face is pulled to that of a guide.
fn pull(guide: &Guide, metric: &Metric) -> Vec<f64> {
    let stiffness = (PULL_LENGTH * guide.cell).powi(-2);
    let weight = |(weight, area): (&f64, &f64)| stiffness * weight * area;
    guide.weight.iter().zip(metric.area.iter()).map(weight).collect()
}

/// Projects flows on dual edges to their part that no rotation of faces can remove; the ground does not
/// rotate.
struct Projector<'a> {
    system: &'a Holonomy<'a>,
    /// Dual edge of each turning edge.
    of_turning: Vec<u32>,
    /// Per face the rotation it is pulled to, quarters; none without a guide.
    wanted: Vec<f64>,
}

impl<'a> Projector<'a> {
    fn new(system: &'a Holonomy<'_>, unfolding: &Unfolding, frames: &[Complex64]) -> Self {
        let of_turning = unfolding.turning.iter().map(|&h| system.number[h]).collect();
        let wanted = system.guide.map(|guide| system.wanted(guide, unfolding, frames));
        Self { system, of_turning, wanted: wanted.unwrap_or_default() }
    }

    /// A flow, given on turning edges, on all dual edges.
    fn spread(&self, flow: &[(u32, f64)]) -> Vec<f64> {
        let mut x = vec![0.0; self.system.sides.len()];
        for &(e, value) in flow {
            x[self.of_turning[e as usize] as usize] += value;
        }
        x
    }

    /// The rotations of the nodes whose differences across dual edges are nearest to a flow, and they themselves to
    /// a multiple of what they are pulled to.
    fn potential(&self, x: &[f64], pulled: f64) -> Vec<f64> {
        let mut turn = vec![0.0; self.system.nodes];
        for ((&[left, right], x), w) in self.system.sides.iter().zip(x).zip(&self.system.weights) {
            turn[right as usize] += w * x;
            turn[left as usize] -= w * x;
        }
        for ((turn, wanted), weight) in turn.iter_mut().zip(&self.wanted).zip(&self.system.pull) {
            *turn += pulled * weight * wanted;
        }
        self.system.cholesky.solve_columns(&mut turn, 1);
        turn
    }

    /// What is left of a flow, and of the pull, by square roots of weights.
    fn residual(&self, flow: &[(u32, f64)], pulled: f64) -> Vec<f64> {
        let mut x = self.spread(flow);
        let turn = self.potential(&x, pulled);
        for ((&[left, right], x), w) in
            self.system.sides.iter().zip(&mut x).zip(&self.system.weights)
        {
            *x = (*x - (turn[right as usize] - turn[left as usize])) * w.sqrt();
        }
        let left = turn.iter().zip(&self.wanted).zip(&self.system.pull);
        x.extend(left.map(|((turn, wanted), w)| (pulled * wanted - turn) * w.sqrt()));
        x
    }

    /// The best rotations of the faces for a flow, against the ground if there is one.
    fn turns(&self, flow: &[(u32, f64)]) -> Vec<f64> {
        let mut turn = self.potential(&self.spread(flow), 1.0);
        let ground = turn.get(self.system.sectors.slit().n_faces()).copied().unwrap_or(0.0);
        turn.truncate(self.system.sectors.slit().n_faces());
        turn.iter_mut().for_each(|x| *x -= ground);
        turn
    }
}
