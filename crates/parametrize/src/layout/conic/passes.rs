//! The passes over the triangles of one interior-point iteration.

use super::cells::{Cones, Elimination};
use super::cone::{Scaling, dot, largest_step, product, quotient, stays_inside};
use super::element::{block_back, parts, vector_back};
use super::program::Renewal;
use crate::energy::Triangle;
use crate::layout::problem::LayoutProblem;
use crate::quarter::direction;
use num_complex::Complex64;

/// What the interior point keeps of one triangle.
pub(super) struct Cell<const D: usize, const C: usize> {
    pub(super) frame: Complex64,
    pub(super) scale: f64,
    pub(super) epigraph: f64,
    pub(super) epigraph_step: f64,
    pub(super) elimination: Elimination,
    /// Right-hand side of the eliminated row.
    pub(super) eliminated: f64,
    pub(super) slack: [[f64; D]; C],
    pub(super) slack_step: [[f64; D]; C],
    pub(super) dual: [[f64; D]; C],
    pub(super) dual_step: [[f64; D]; C],
    pub(super) scaling: [Scaling<D>; C],
}

/// Far beyond the whole steps that are taken.
const LONGEST_STEP: f64 = 4.0;

/// Reductions over the triangles.
pub(super) struct Tally {
    /// `sum of slack . dual`.
    pub(super) gap: f64,
    /// Sum of what belongs to mu.
    pub(super) corner: f64,
    /// `sum of slack_step . dual`, `slack . dual_step`, `slack_step . dual_step`.
    products: [f64; 3],
    /// Largest primal and dual steps, at most [`LONGEST_STEP`].
    pub(super) steps: [f64; 2],
}

impl Default for Tally {
    fn default() -> Self {
        Self { gap: 0.0, corner: 0.0, products: [0.0; 3], steps: [LONGEST_STEP; 2] }
    }
}

impl Tally {
    fn of(parts: Vec<Self>) -> Self {
        parts.into_iter().fold(Self::default(), |a, b| Self {
            gap: a.gap + b.gap,
            corner: a.corner + b.corner,
            products: std::array::from_fn(|k| a.products[k] + b.products[k]),
            steps: std::array::from_fn(|k| a.steps[k].min(b.steps[k])),
        })
    }

    fn reach<const D: usize>(&mut self, at: &[f64; D], step: &[f64; D], which: usize) {
        // Most triangles do not hold a step up: that is seen without a root.
        if !stays_inside(at, step, self.steps[which]) {
            self.steps[which] = self.steps[which].min(largest_step(at, step));
        }
    }

    /// Mehrotra's centring parameter after an affine step: the cube of the part of the gap it leaves.
    pub(super) fn centring(&self, gap: f64) -> f64 {
        let [p, d] = self.steps.map(|s| s.min(1.0));
        let [a, b, c] = self.products;
        ((gap + p * a + d * b + p * d * c) / gap).powi(3)
    }
}

impl<const D: usize, const C: usize> Cell<D, C> {
    fn parts(&self, triangle: &Triangle, z: &[Complex64]) -> [f64; 4] {
        parts(triangle, z, self.scale)
    }

    /// Adapts frame and scale to the iterate, which stays inside: the frame is the nearest rotation, and at
    /// the scale both bounds on the singular values have the same room.
    fn renew(&mut self, q: &mut [f64; 4], renewal: Renewal, bound: f64) {
        if renewal == Renewal::Never {
            return;
        }
        let (similar, anti) = (Complex64::new(q[0], q[1]), Complex64::new(q[2], q[3]));
        self.frame = direction(similar);
        if renewal == Renewal::FramesAndScales {
            let (a, b) = (similar.norm(), anti.norm());
            let factor = match C {
                1 => a / (a * a + b * b),
                _ => (bound / ((a - b) * (a + b))).sqrt(),
            };
            self.scale *= factor;
            self.epigraph *= factor;
            q.iter_mut().for_each(|x| *x *= factor);
        }
    }

    /// The steps of slack and epigraph variable for a step of layout and bound.
    fn set_slack_step<K: Cones<D, C>>(&mut self, dq: &[f64; 4], bound_step: f64) {
        let e = &self.elimination;
        let row = dot(&e.row, dq) + e.border * bound_step;
        self.epigraph_step = e.inverse * (self.eliminated - row);
        self.slack_step = K::step(self.frame, dq, self.epigraph_step, bound_step);
    }

    /// `W^-2` times the slack's step.
    fn scaled_slack_step(&self, c: usize) -> [f64; D] {
        self.scaling[c].apply_inverse_square(&self.slack_step[c])
    }
}

/// Slacks, scalings and normal equations at the iterate; tallies gap and corner.
pub(super) fn assemble<const D: usize, const C: usize, K: Cones<D, C>>(
    problem: &mut LayoutProblem,
    cells: &mut [Cell<D, C>],
    z: &[Complex64],
    bound: f64,
    renewal: Renewal,
    border: &mut [f64],
) -> Tally {
    Tally::of(problem.assemble(cells, border, |t, cell, tally: &mut Tally, local, block| {
        let mut q = cell.parts(t, z);
        cell.renew(&mut q, renewal, bound);
        if renewal == Renewal::FramesAndScales {
            cell.epigraph = K::centre(&q, bound);
        }
        cell.slack = K::slack(cell.frame, &q, cell.epigraph, bound);
        for c in 0..C {
            cell.scaling[c] = Scaling::new(&cell.slack[c], &cell.dual[c]);
            tally.gap += dot(&cell.slack[c], &cell.dual[c]);
        }
        let normal = K::normal(cell.frame, &cell.scaling);
        cell.elimination = normal.epigraph;
        cell.eliminated = 0.0;
        tally.corner += normal.corner;
        block_back(t, cell.scale, &normal.block, block);
        vector_back(t, cell.scale, &normal.border, local);
    }))
}

/// The affine step; tallies its reach and what the gap becomes.
pub(super) fn affine_steps<const D: usize, const C: usize, K: Cones<D, C>>(
    problem: &LayoutProblem,
    cells: &mut [Cell<D, C>],
    dz: &[Complex64],
    bound_step: f64,
) -> Tally {
    Tally::of(problem.visit(cells, |t, cell, tally: &mut Tally| {
        let dq = cell.parts(t, dz);
        cell.set_slack_step::<K>(&dq, bound_step);
        for c in 0..C {
            let scaled = cell.scaled_slack_step(c);
            let dual_step: [f64; D] = std::array::from_fn(|k| -cell.dual[c][k] - scaled[k]);
            tally.reach(&cell.slack[c], &cell.slack_step[c], 0);
            tally.reach(&cell.dual[c], &dual_step, 1);
            tally.products[0] += dot(&cell.slack_step[c], &cell.dual[c]);
            tally.products[1] += dot(&cell.slack[c], &dual_step);
            tally.products[2] += dot(&cell.slack_step[c], &dual_step);
            cell.dual_step[c] = dual_step;
        }
    }))
}

/// Right-hand side of the corrector, for complementarity `target` in every cone; tallies the row of mu.
/// Leaves in `dual_step` the part of the dual step that does not depend on the slack's.
pub(super) fn correction<const D: usize, const C: usize, K: Cones<D, C>>(
    problem: &mut LayoutProblem,
    cells: &mut [Cell<D, C>],
    target: f64,
    rhs: &mut [f64],
) -> Tally {
    Tally::of(problem.assemble_vector(cells, rhs, |t, cell, tally: &mut Tally, local| {
        let pull: [[f64; D]; C] = std::array::from_fn(|c| {
            let w = &cell.scaling[c];
            let (primal, dual) = (&cell.slack_step[c], &cell.dual_step[c]);
            let cross = product(&w.apply_inverse(primal), &w.apply(dual));
            let mut wanted = cross.map(|x| -x);
            wanted[0] += target;
            w.apply_inverse(&quotient(&wanted, &w.apply(&cell.dual[c])))
        });
        cell.dual_step = pull;
        for (step, dual) in cell.dual_step.iter_mut().zip(&cell.dual) {
            step.iter_mut().zip(dual).for_each(|(step, dual)| *step -= dual);
        }
        let adjoint = K::adjoint(cell.frame, &pull);
        let e = &cell.elimination;
        let share = adjoint.epigraph * e.inverse;
        let q = std::array::from_fn(|k| adjoint.q[k] - e.row[k] * share);
        tally.corner += adjoint.bound - e.border * share;
        cell.eliminated = adjoint.epigraph;
        vector_back(t, cell.scale, &q, local);
    }))
}

/// The corrected step; tallies its reach.
pub(super) fn corrected_steps<const D: usize, const C: usize, K: Cones<D, C>>(
    problem: &LayoutProblem,
    cells: &mut [Cell<D, C>],
    dz: &[Complex64],
    bound_step: f64,
) -> Tally {
    Tally::of(problem.visit(cells, |t, cell, tally: &mut Tally| {
        let dq = cell.parts(t, dz);
        cell.set_slack_step::<K>(&dq, bound_step);
        for c in 0..C {
            let scaled = cell.scaled_slack_step(c);
            cell.dual_step[c].iter_mut().zip(scaled).for_each(|(d, s)| *d -= s);
            tally.reach(&cell.slack[c], &cell.slack_step[c], 0);
            tally.reach(&cell.dual[c], &cell.dual_step[c], 1);
        }
    }))
}

/// Takes the step in epigraph variables and duals.
pub(super) fn move_on<const D: usize, const C: usize>(
    problem: &LayoutProblem,
    cells: &mut [Cell<D, C>],
    primal: f64,
    dual: f64,
) {
    problem.visit(cells, |_, cell, (): &mut ()| {
        cell.epigraph += primal * cell.epigraph_step;
        for (l, step) in cell.dual.iter_mut().zip(&cell.dual_step) {
            l.iter_mut().zip(step).for_each(|(l, d)| *l += dual * d);
        }
    });
}
