//! The distance to similarities: ASAP at fixed size.
//!
//! The energy (10) alone is least when everything shrinks to a point. Held against the mean square of the
//! triangles' scales `s = (sigma_1 + sigma_2) / 2` it is a quotient of two quadratic forms, which orders
//! layouts as the measure does: that divides by `(sigma_1^2 + sigma_2^2) / 2`, the square of s and half the
//! energy. Local and global steps with a rescaling between them are the power method for its smallest
//! eigenvalue; inverse iteration finds the same eigenvector in a few steps (spectral conformal maps, Mullen
//! et al. 2008).

use super::guarded::FADE;
use super::{Ending, Found, ObjectiveOptions, OptimizeError};
use crate::energy::Jacobian;
use crate::energy::{Asap, Guarded};
use crate::features::Sectors;
use crate::layout::exact::ExactLayout;
use crate::layout::newton::{NewtonOptions, minimize};
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};
use num_complex::Complex64;

/// Shift of the conformal form against rotations of a free boundary, as a fraction of its mean diagonal.
const SHIFT: f64 = 1e-11;
/// Refinements of each solution: the shift is felt on meshes with needles otherwise.
const REFINEMENTS: usize = 2;

/// Inverse iteration until the quotient settles. Where it ends with flips, Newton steps from the start
/// behind a barrier.
pub(super) fn asap(
    sectors: &Sectors<'_>,
    layout: &mut ExactLayout,
    start: Vec<f64>,
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Found, OptimizeError> {
    let problem = layout.problem_mut();
    let (mut y, mut quotient) = normalized(problem, start.clone());
    let mut ending = Ending::Stopped;
    let mut iterations = 0;
    problem.assemble_conformal();
    problem.factorize(SHIFT)?;
    while iterations < options.max_iterations {
        watch.pulse()?;
        let (next, value) = step(problem, &y);
        iterations += 1;
        let fall = quotient - value;
        if fall > 0.0 {
            (y, quotient) = (next, value);
        }
        if fall < options.tolerance * value {
            ending = Ending::Converged;
            break;
        }
    }
    let defects = layout.defects(sectors, &y);
    if !defects.none() {
        let (guarded, more) = behind_barrier(layout.problem_mut(), start, watch)?;
        y = guarded;
        iterations += more;
        ending = Ending::Guarded { flips: defects.flips.len() };
    }
    Ok(Found::new(y, iterations, ending))
}

/// Solves with the conformal form for the gradient of the other one.
fn step(problem: &mut LayoutProblem, y: &[f64]) -> (Vec<f64>, f64) {
    let goal = gradient(problem, y, |j, g| j.similar * g);
    let mut next = goal.clone();
    problem.solve(&mut next);
    for _ in 0..REFINEMENTS {
        let reached = gradient(problem, &next, |j, g| 2.0 * j.anti * g.conj());
        let mut correction: Vec<f64> = goal.iter().zip(&reached).map(|(b, c)| b - c).collect();
        problem.solve(&mut correction);
        next.iter_mut().zip(correction).for_each(|(y, d)| *y += d);
    }
    normalized(problem, next)
}

/// Gradient in the unknowns of a function of the Jacobians, from its part in each corner with hat
/// function gradient `g`.
fn gradient(
    problem: &LayoutProblem,
    y: &[f64],
    part: impl Fn(&Jacobian, Complex64) -> Complex64,
) -> Vec<f64> {
    let z = problem.space().expand(y);
    let mut b = vec![Complex64::ZERO; problem.space().n_wedges()];
    for t in problem.triangles() {
        let jacobian = t.jacobian(&z);
        for (w, g) in t.wedges.iter().zip(t.gradients) {
            b[*w as usize] += t.weight * part(&jacobian, Complex64::new(g[0], g[1]));
        }
    }
    problem.space().pull_back(&b)
}

/// The unknowns scaled to triangles of mean square scale 1, and the energy then.
fn normalized(problem: &LayoutProblem, mut y: Vec<f64>) -> (Vec<f64>, f64) {
    let z = problem.space().expand(&y);
    let (energy, size) = problem.triangles().iter().fold((0.0, 0.0), |(energy, size), t| {
        let j = t.jacobian(&z);
        (energy + 2.0 * t.weight * j.anti.norm_sqr(), size + t.weight * j.similar.norm_sqr())
    });
    let scale = 1.0 / size.sqrt();
    y.iter_mut().for_each(|x| *x *= scale);
    (y, energy / size)
}

/// Rounds for each weight of the barrier.
const ROUNDS: usize = 10;
const ROUND: NewtonOptions = NewtonOptions { max_iterations: 3, tolerance: 1e-6 };
/// A round that lowers the quotient by less than this fraction ends its weight.
const SETTLED: f64 = 1e-4;
/// The quotient counts as this at least.
const LEAST_QUOTIENT: f64 = 1e-9;

/// Lowers the quotient `q` of energy and area over layouts without flips; it orders layouts as the quotient
/// above does, since area is mean square scale minus half the energy.
///
/// With area 1, stationary points of `ln(energy) - (1 - a) ln(area) - a mean(ln(det))` are those of
/// `energy - (1 - a) q area - a q mean(ln(det))`, whose `q` is renewed in every round (Dinkelbach's method).
fn behind_barrier(
    problem: &mut LayoutProblem,
    mut y: Vec<f64>,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<f64>, usize), Cancelled> {
    let mut iterations = 0;
    for share in FADE.into_iter().skip(1) {
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            let q = to_unit_area(problem, &mut y).max(LEAST_QUOTIENT);
            if before - q < SETTLED * q {
                break;
            }
            before = q;
            let energy = Guarded { energy: Asap { reward: (1.0 - share) * q }, weight: share * q };
            let solution = minimize(problem, y, &energy, &ROUND, watch)?;
            y = solution.y;
            iterations += solution.iterations;
        }
    }
    Ok((y, iterations))
}

/// Scales the unknowns to mean determinant 1; returns the energy then.
fn to_unit_area(problem: &LayoutProblem, y: &mut [f64]) -> f64 {
    let z = problem.space().expand(y);
    let (energy, area) = problem.triangles().iter().fold((0.0, 0.0), |(energy, area), t| {
        let j = t.jacobian(&z);
        let (similar, anti) = (j.similar.norm_sqr(), j.anti.norm_sqr());
        (energy + 2.0 * t.weight * anti, area + t.weight * (similar - anti))
    });
    let scale = 1.0 / area.sqrt();
    y.iter_mut().for_each(|x| *x *= scale);
    energy / area
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::Arap;
    use crate::layout::disk::embed_disk;
    use crate::layout::objective::guarded::minimize_guarded;
    use crate::layout::objective::rigid;
    use crate::{SeamlessMap, Tolerance};
    use seamstress_mesh::{Metric, TriMesh};
    use seamstress_testkit as kit;
    use std::ops::ControlFlow;

    fn disk() -> (TriMesh, ExactLayout, Vec<f64>) {
        let soup = kit::saddle(6);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let uvs = embed_disk(&mesh, &metric).unwrap();
        let map = SeamlessMap::certify(&mesh, uvs, &Tolerance::default()).unwrap();
        let (layout, y) = ExactLayout::from_map(&mesh, &metric, &map).unwrap();
        (mesh, layout, y)
    }

    #[test]
    fn inverse_iteration_and_the_barrier_agree() {
        let (mesh, mut layout, y) = disk();
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let options = ObjectiveOptions::default();
        let found =
            asap(&Sectors::unaligned(&mesh), &mut layout, y.clone(), &options, &mut watch).unwrap();
        assert_eq!(found.ending, Ending::Converged);
        let (_, spectral) = normalized(layout.problem(), found.y);
        let (slow, _) = behind_barrier(layout.problem_mut(), y, &mut watch).unwrap();
        let (_, guarded) = normalized(layout.problem(), slow);
        assert!(
            spectral <= guarded * (1.0 + 1e-9) && guarded < 1.05 * spectral,
            "{spectral} {guarded}"
        );
    }

    #[test]
    fn a_barrier_that_fades_out_changes_nothing_where_it_is_not_needed() {
        let (_, mut layout, y) = disk();
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let options = ObjectiveOptions::default();
        let plain = rigid::newton_steps(&mut layout, y.clone(), &options, &mut watch).unwrap();
        let problem = layout.problem_mut();
        let (guarded, _) = minimize_guarded(problem, y, Arap, &mut watch).unwrap();
        let energy = |y: &[f64]| problem.value(&Arap, &problem.space().expand(y));
        let (a, b) = (energy(&plain.y), energy(&guarded));
        assert!((a - b).abs() < 1e-3 * a, "{a} {b}");
    }
}
