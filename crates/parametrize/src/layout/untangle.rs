//! Pulling flipped triangles open (Garanzha et al. 2021).

use super::exact::ExactLayout;
use super::newton::NewtonOptions;
use crate::energy::{Triangle, Untangling};
use crate::progress::{Cancelled, Watch};

/// Newton steps at one width of the barrier; it sharpens after them.
const STEPS: NewtonOptions = NewtonOptions { max_iterations: 2, tolerance: 1e-6 };
/// Square of the first width where hardly anything is flipped, and the part of the worst determinant that counts beside
/// it (squared): wide enough to see how to get out, narrow enough that the others stay as they are.
const FIRST_WIDTH: f64 = 1e-4;
const FIRST_SHARE: f64 = 0.04;
/// The paper shrinks the width by as much as the energy fell, so that it keeps falling; by this much at least.
const MINIMUM_FALL: f64 = 0.1;
/// The width once the worst determinant is beyond the goal of the step.
const NARROWEST: f64 = 1e-9;
/// It stalls when the worst determinant has not risen by a tenth in so many widths.
const PATIENCE: usize = 5;
/// Widths in all; none of the surfaces measured took half of them.
const MAX_WIDTHS: usize = 100;

/// Pulls flipped triangles open by Newton steps on a regularised barrier that sharpens, until none is flipped or the
/// worst gets no better; with the steps taken. Vertices may end up wound once too often: angles must be checked.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn untangle(
    space: &mut ExactLayout,
    mut y: Vec<f64>,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<f64>, usize), Cancelled> {
    let mut worst = smallest_determinant(space, &y);
    let mut width = (FIRST_WIDTH + FIRST_SHARE * worst.min(0.0).powi(2)).sqrt();
    let (mut best, mut since_best, mut steps) = (worst, 0, 0);
    for _ in 0..MAX_WIDTHS {
        watch.tick(0.5)?;
        let energy = Untangling { eps: width };
        let before = space.problem().value(&energy, &space.expand(&y));
        let solution = space.minimize(y, &energy, &STEPS, watch)?;
        (y, steps) = (solution.y, steps + solution.iterations.max(1));
        worst = smallest_determinant(space, &y);
        if worst > 0.0 {
            break;
        }
        (best, since_best) = if worst > 0.9 * best { (worst, 0) } else { (best, since_best + 1) };
        if since_best == PATIENCE {
            break;
        }
        let fall = (1.0 - solution.energy / before).max(MINIMUM_FALL);
        let goal = (1.0 - fall) * energy.chi(worst)[0];
        width = if worst < goal { 2.0 * (goal * (goal - worst)).sqrt() } else { NARROWEST };
    }
    Ok((y, steps))
}

fn smallest_determinant(space: &ExactLayout, y: &[f64]) -> f64 {
    let z = space.expand(y);
    let determinant = |t: &Triangle| {
        let (s1, s2) = t.jacobian(&z).singular_values();
        s1 * s2
    };
    space.problem().triangles().iter().map(determinant).fold(f64::INFINITY, f64::min)
}
