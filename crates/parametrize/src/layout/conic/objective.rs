//! The measures that conic programs minimise, and the local steps that belong to them.

use super::program::{Matrix2, Program, ProgramKind, extremes, turned};
use crate::layout::energy::Jacobian;
use crate::layout::problem::LayoutProblem;
use crate::layout::triangle::Triangle;
use crate::quarter::direction;
use num_complex::Complex64;
use seamstress_parallel::prelude::*;

/// What is minimised, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ConicObjective {
    /// tau, eq. (3), by eq. (9).
    Tau,
    /// The same by Algorithm 1 as printed: (9) for given frames, then frames by polar decomposition, in turns.
    TauAlternating,
    /// The largest `|J - R|_F^2`, eq. (8).
    ArapMax,
    /// The largest `|J / s - R|_F^2`, eq. (11).
    AsapMax,
    /// The largest dilatation `sigma_1 / sigma_2`, by eq. (11) and (12).
    Dilatation,
    /// The same by eq. (12) alone, as printed.
    DilatationAlternating,
    /// The same by bisection over bounds (Lipman 2012), frames renewed in between.
    DilatationBisection,
}

impl ConicObjective {
    /// The measure's figure of a triangle: what is minimised is the largest, for tau the square root of
    /// the largest over the smallest.
    fn figures(self, jacobian: &Jacobian) -> (f64, f64) {
        let (s1, s2) = jacobian.singular_values();
        let figure = match self {
            Self::Tau | Self::TauAlternating => return (s1, s2),
            Self::ArapMax => (s1 - 1.0).powi(2) + (s2 - 1.0).powi(2),
            Self::AsapMax => (s1 - s2).powi(2) / (s1 * s1 + s2 * s2),
            _ if s2 > 0.0 => s1 / s2,
            _ => f64::INFINITY,
        };
        (figure, f64::INFINITY)
    }

    /// The measure of a layout: `sqrt(sigma_1 max / sigma_2 min)`, or the largest figure of a triangle.
    pub fn value(self, problem: &LayoutProblem, left: Option<&[Matrix2]>, z: &[Complex64]) -> f64 {
        let (largest, smallest) =
            extremes(problem.triangles(), |k, t| self.figures(&seen(t, z, left.map(|a| &a[k]))));
        match self {
            Self::Tau | Self::TauAlternating if smallest > 0.0 => (largest / smallest).sqrt(),
            Self::Tau | Self::TauAlternating => f64::INFINITY,
            _ => largest,
        }
    }

    /// The local step: the program with the layout's own frames (polar decomposition) and best scales.
    pub fn program(
        self,
        problem: &LayoutProblem,
        left: Option<&[Matrix2]>,
        z: &[Complex64],
    ) -> Program {
        let jacobians: Vec<Jacobian> = problem
            .triangles()
            .par_iter()
            .enumerate()
            .with_min_len(4096)
            .map(|(k, t)| seen(t, z, left.map(|a| &a[k])))
            .collect();
        let scales = |scale: fn(f64, f64) -> f64| {
            let of = |j: &Jacobian| {
                let (s1, s2) = j.singular_values();
                scale(s1, s2)
            };
            Some(jacobians.iter().map(of).collect())
        };
        let kind = match self {
            Self::ArapMax | Self::AsapMax => ProgramKind::Deviation,
            _ => ProgramKind::Stretch,
        };
        Program {
            kind,
            frames: jacobians.iter().map(|j| direction(j.similar)).collect(),
            scales: match self {
                // 1 / s at the minimum of (11) over s
                Self::AsapMax => scales(|s1, s2| (s1 + s2) / (s1 * s1 + s2 * s2)),
                // eq. (2)
                Self::Dilatation | Self::DilatationAlternating => {
                    scales(|s1, s2| 1.0 / (s1 * s2).sqrt())
                }
                _ => None,
            },
            left: left.map(<[Matrix2]>::to_vec),
        }
    }
}

/// The Jacobian seen through a frame's matrix.
fn seen(t: &Triangle, z: &[Complex64], left: Option<&Matrix2>) -> Jacobian {
    let j = t.jacobian(z);
    left.map_or(j, |left| turned(left, &j))
}
