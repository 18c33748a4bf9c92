//! As-rigid-as-possible layout by local and global steps, and the Poisson layout for given frames.

use super::problem::LayoutProblem;
use crate::chebyshev::accelerated;
use crate::energy::Triangle;
use crate::progress::{Cancelled, Watch};
use crate::quarter::direction;
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_parallel::prelude::*;

/// Shift of the Dirichlet form, as a part of its mean diagonal: nothing else holds turns where no seam does.
const SHIFT: f64 = 1e-10;
/// Steps of iterative refinement; each gains some six digits on what the shift cost.
const REFINEMENTS: usize = 2;

/// Rotation of a triangle's Jacobian (polar decomposition): the *local step*, eq. (4) of Levi 2021.
pub fn frame(triangle: &Triangle, z: &[Complex64]) -> Complex64 {
    direction(triangle.jacobian(z).similar)
}

/// Frames of all triangles.
pub fn frames(triangles: &[Triangle], z: &[Complex64]) -> Vec<Complex64> {
    triangles.par_iter().with_min_len(4096).map(|t| frame(t, z)).collect()
}

/// Mean squared distance `|J - R|^2` of a layout's Jacobians to rotations, the energy of eq. (6).
pub fn distance_to_frames(triangles: &[Triangle], frames: &[Complex64], z: &[Complex64]) -> f64 {
    let distance = |(t, r): (&Triangle, &Complex64)| {
        let j = t.jacobian(z);
        2.0 * t.weight * ((j.similar - r).norm_sqr() + j.anti.norm_sqr())
    };
    triangles.iter().zip(frames).map(distance).sum()
}

/// Layouts that follow given Jacobians as well as the space allows; one factorisation for many.
pub struct Poisson<'p> {
    problem: &'p mut LayoutProblem,
}

impl<'p> Poisson<'p> {
    /// Factors the Dirichlet form of the problem.
    ///
    /// # Errors
    /// When it cannot be factored.
    pub fn new(problem: &'p mut LayoutProblem) -> Result<Self, NotPositiveDefinite> {
        problem.assemble_dirichlet();
        problem.factorize(SHIFT)?;
        Ok(Self { problem })
    }

    /// The problem.
    pub fn problem(&self) -> &LayoutProblem {
        self.problem
    }

    /// The unknowns that minimise `sum of area |J - A|^2`, eq. (6), for a target `A` per triangle given
    /// by the images of the two axes.
    pub fn solve(&mut self, targets: &[[Complex64; 2]]) -> Vec<f64> {
        let mut b = vec![Complex64::ZERO; self.problem.space().n_wedges()];
        for (t, a) in self.problem.triangles().iter().zip(targets) {
            for (w, g) in t.wedges.iter().zip(t.gradients) {
                b[*w as usize] += t.weight * (a[0] * g[0] + a[1] * g[1]);
            }
        }
        let mut y = self.problem.space().pull_back(&b);
        self.problem.solve(&mut y);
        y
    }

    /// Like [`Self::solve`], refined until targets that some layout has are met to rounding: the shift of
    /// the factored form is felt on large meshes otherwise.
    pub fn follow(&mut self, targets: &[[Complex64; 2]]) -> Vec<f64> {
        let mut y = self.solve(targets);
        for _ in 0..REFINEMENTS {
            let z = self.problem.space().expand(&y);
            let left = |(t, a): (&Triangle, &[Complex64; 2])| {
                let now = t.axes(t.corners(&z));
                [a[0] - now[0], a[1] - now[1]]
            };
            let left: Vec<_> = self.problem.triangles().iter().zip(targets).map(left).collect();
            let correction = self.solve(&left);
            y.iter_mut().zip(correction).for_each(|(y, d)| *y += d);
        }
        y
    }

    /// Local/global iterations (Liu et al. 2008) from frames, accelerated; returns the unknowns.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn arap(
        &mut self,
        mut now: Vec<Complex64>,
        iterations: usize,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Vec<f64>, Cancelled> {
        let mut y = self.follow_frames(&now);
        let mut before = now.clone();
        for step in accelerated().take(iterations) {
            watch.pulse()?;
            let z = self.problem.space().expand(&y);
            let turned = now.iter_mut().zip(&mut before).zip(frames(self.problem.triangles(), &z));
            for ((now, before), best) in turned {
                step.turn(now, before, best);
            }
            y = self.follow_frames(&now);
        }
        Ok(y)
    }

    /// The unknowns of the layout nearest to these frames.
    pub fn follow_frames(&mut self, frames: &[Complex64]) -> Vec<f64> {
        let targets: Vec<_> = frames.iter().map(|&r| [r, r * Complex64::I]).collect();
        self.solve(&targets)
    }
}
