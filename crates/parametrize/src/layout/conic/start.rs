//! Where the interior point starts.

use super::cells::{Cones, Elimination};
use super::cone::{Scaling, inverse};
use super::element::parts;
use super::passes::Cell;
use super::program::{Program, ProgramKind, extremes};
use crate::layout::problem::LayoutProblem;
use num_complex::Complex64;

/// The layout is scaled so that the smallest singular value exceeds its bound 1 by this factor.
const ROOM_BELOW: f64 = 1.3;
/// The bound exceeds what the layout needs by this factor.
const ROOM_ABOVE: f64 = 1.2;
/// A deviation of zero leaves a cone without inner points: this is added.
const SMALLEST_DEVIATION: f64 = 1e-2;

/// A factor for the layout and a value of mu (of m for [`ProgramKind::Deviation`]) that make it satisfy the
/// program with room; none if no factor does.
pub(super) fn inside(
    problem: &LayoutProblem,
    program: &Program,
    z: &[Complex64],
) -> Option<(f64, f64)> {
    match program.kind {
        ProgramKind::Stretch => {
            let (largest, smallest) = extremes(problem.triangles(), |k, t| {
                let j = program.jacobian(k, t, z);
                let anti = j.anti.norm();
                (j.similar.norm() + anti, (j.similar * program.frames[k].conj()).re - anti)
            });
            let scale = ROOM_BELOW / smallest;
            let bound = ROOM_ABOVE * largest * scale;
            (smallest > 0.0 && bound.is_finite()).then_some((scale, bound))
        }
        ProgramKind::Deviation => {
            let needed = (0.5 * program.value(problem, z)).sqrt();
            needed.is_finite().then_some((1.0, ROOM_ABOVE * needed + SMALLEST_DEVIATION))
        }
    }
}

/// The triangles' state at the start: primal in the middle, dual on the central path up to one factor,
/// which satisfies the dual condition of mu.
pub(super) fn cells<const D: usize, const C: usize, K: Cones<D, C>>(
    problem: &LayoutProblem,
    program: &Program,
    z: &[Complex64],
    bound: f64,
) -> Vec<Cell<D, C>> {
    let cell = |k: usize| {
        let frame = program.frames[k];
        let scale = program.scale(k);
        let q = parts(&problem.triangles()[k], z, scale);
        let epigraph = K::centre(&q, bound);
        let slack = K::slack(frame, &q, epigraph, bound);
        Cell {
            frame,
            scale,
            epigraph,
            epigraph_step: 0.0,
            elimination: Elimination::default(),
            eliminated: 0.0,
            dual: slack.each_ref().map(inverse),
            slack,
            slack_step: [[0.0; D]; C],
            dual_step: [[0.0; D]; C],
            scaling: [Scaling::ONE; C],
        }
    };
    let mut cells: Vec<_> = (0..problem.triangles().len()).map(cell).collect();
    let total: f64 = cells.iter().map(|cell| K::adjoint(cell.frame, &cell.dual).bound).sum();
    for x in cells.iter_mut().flat_map(|cell| cell.dual.as_flattened_mut()) {
        *x /= total;
    }
    cells
}
