//! Moving the integral part of a layout without flipping a triangle.

use crate::energy::couple;
use seamstress_parametrize::energy::{SymmetricDirichlet, largest_step};
use seamstress_parametrize::layout::newton::{NewtonOptions, minimize};
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::progress::{Cancelled, Watch};

/// Most moves. Paths that arrive take up to 28 on the meshes measured, nearly all of them fewer than 10.
const MOST_MOVES: usize = 30;
/// Share of the largest flip-free step that is taken: the rest keeps triangles from being nearly flat.
const STEP_FRACTION: f64 = 0.9;
/// A step that raises the energy too much is cut to this share.
const BACKTRACKING: f64 = 0.6;
/// What a move may raise the energy to: by this factor, or by 1 (an isometry has 4).
const ENERGY_GROWTH: f64 = 1.6;
/// Moves shorter than this share of the rest are followed by centring steps.
const SHORT_MOVE: f64 = 0.5;
/// A few Newton steps that spread the strain of a short move.
const CENTRING: NewtonOptions = NewtonOptions { max_iterations: 2, tolerance: 1e-4 };
/// The path is blocked after a number of moves of less than this share of the rest in a row that raise the energy.
const TINY_MOVE: f64 = 0.02;
/// That number.
const MOST_TINY_MOVES: usize = 6;
/// A move of a smaller share of the rest is none.
const SMALLEST_MOVE: f64 = 1e-6;
/// The path is also blocked where the layout becomes flat: where with this share left a short move raises an
/// energy above HIGH by the factor STEEP.
const CLOSE: f64 = 0.1;
/// Mean energies above this are far from any layout wanted; the worst accepted one measured has 9.
const HIGH: f64 = 20.0;
/// The factor by which the energy rises from one short move to the next where the layout becomes flat.
const STEEP: f64 = 1.1;
/// Shift of the Hessian, as a share of its diagonal.
pub(crate) const SHIFT: f64 = 1e-8;

/// How far the integral part came.
#[derive(Debug, Clone)]
pub(crate) struct Advance {
    /// The unknowns there, flip-free.
    pub(crate) y: Vec<f64>,
    /// Share of the distance; 1 is the target, to the last bit.
    pub(crate) reached: f64,
    /// Number of moves.
    pub(crate) moves: usize,
}

/// Moves the held unknowns to `target`, the free ones along with them, as far as triangles let them.
///
/// Each move is the Newton step of the symmetric Dirichlet energy under the condition that the held part
/// goes all the way to the target, `H_xx dx = -(g + H d)_x`, cut short of the first collapse and where the energy
/// would rise too much; after a short one, Newton steps centre the rest.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn advance(
    problem: &mut LayoutProblem,
    mut y: Vec<f64>,
    target: &[f64],
    watch: &mut Watch<'_, '_>,
) -> Result<Advance, Cancelled> {
    let n_free = problem.n_free();
    let (mut rest, mut tiny, mut moves) = (1.0, 0, 0);
    let mut energy = f64::INFINITY;
    while moves < MOST_MOVES && tiny < MOST_TINY_MOVES {
        watch.pulse()?;
        let Some(taken) = advance_once(problem, &mut y, target) else { break };
        moves += 1;
        rest *= 1.0 - taken;
        if taken == 1.0 {
            // To the last bit.
            y[n_free..].copy_from_slice(target);
            break;
        }
        let before = energy;
        if taken < SHORT_MOVE {
            y = minimize(problem, y, &SymmetricDirichlet, &CENTRING, watch)?.y;
            energy = problem.value(&SymmetricDirichlet, &problem.space().expand(&y));
            if rest < CLOSE && energy > HIGH.max(STEEP * before) {
                break;
            }
        }
        tiny = if taken < TINY_MOVE && energy > STEEP * before { tiny + 1 } else { 0 };
    }
    Ok(Advance { y, reached: 1.0 - rest, moves })
}

/// One move; the share of the rest of the path that was taken.
fn advance_once(problem: &mut LayoutProblem, y: &mut [f64], target: &[f64]) -> Option<f64> {
    let n_free = problem.n_free();
    let z = problem.space().expand(y);
    let energy = problem.value(&SymmetricDirichlet, &z);
    let mut step = problem.linearize(&SymmetricDirichlet, &z);
    problem.factorize(SHIFT).ok()?;
    let rest: Vec<f64> = target.iter().zip(&y[n_free..]).map(|(t, y)| t - y).collect();
    for (s, coupled) in step.iter_mut().zip(couple(problem, &rest)) {
        *s = -(*s + coupled);
    }
    problem.solve(&mut step);
    step[n_free..].copy_from_slice(&rest);
    let dz = problem.space().expand(&step);
    let largest = STEP_FRACTION * largest_step(problem.triangles(), &z, &dz);
    let cap = (ENERGY_GROWTH * energy).max(energy + 1.0);
    let mut t = largest.min(1.0);
    while t > SMALLEST_MOVE {
        let moved: Vec<_> = z.iter().zip(&dz).map(|(z, d)| z + d * t).collect();
        if problem.value(&SymmetricDirichlet, &moved) < cap {
            y.iter_mut().zip(&step).for_each(|(y, s)| *y += t * s);
            return Some(t);
        }
        t *= BACKTRACKING;
    }
    None
}
