//! The maximal measures that conic programs minimise, and the local steps that belong to them.

use super::program::{Program, ProgramKind, extremes};
use crate::energy::{Jacobian, Triangle};
use crate::layout::problem::LayoutProblem;
use crate::quality::Measure;
use crate::quarter::direction;
use num_complex::Complex64;
use seamstress_parallel::prelude::*;

/// A measure whose maximum over the triangles is minimised, at the scale that the layout has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MaximalMeasure {
    /// tau, eq. (3), by programs (9).
    Tau,
    /// `|J - R|_F^2`, eq. (8).
    Arap,
    /// `|J / s - R|_F^2`, eq. (11).
    Asap,
    /// The dilatation `sigma_1 / sigma_2`, by programs (12).
    Dilatation,
}

impl MaximalMeasure {
    /// The values of a triangle: what is minimised is the largest first one, for tau the square root of the
    /// largest first over the smallest second.
    fn values(self, jacobian: &Jacobian) -> (f64, f64) {
        let (s1, s2) = jacobian.singular_values();
        let value = match self {
            Self::Tau => return (s1, s2),
            Self::Arap => Measure::ArapMax.value(s1, s2),
            Self::Asap => Measure::AsapMax.value(s1, s2),
            Self::Dilatation => Measure::Dilatation.value(s1, s2),
        };
        (value, f64::INFINITY)
    }

    /// The measure of a layout: `sqrt(sigma_1 max / sigma_2 min)`, or the largest value of a triangle.
    pub fn of_layout(self, problem: &LayoutProblem, z: &[Complex64]) -> f64 {
        let (largest, smallest) =
            extremes(problem.triangles(), |_, t: &Triangle| self.values(&t.jacobian(z)));
        match self {
            Self::Tau if smallest > 0.0 => (largest / smallest).sqrt(),
            Self::Tau => f64::INFINITY,
            _ => largest,
        }
    }

    /// The local step: the program with the layout's own frames (polar decomposition) and best scales.
    pub fn program(self, problem: &LayoutProblem, z: &[Complex64]) -> Program {
        let triangles = problem.triangles().par_iter().with_min_len(4096);
        let jacobians: Vec<Jacobian> = triangles.map(|t| t.jacobian(z)).collect();
        let scales = |scale: fn(f64, f64) -> f64| {
            let of = |j: &Jacobian| {
                let (s1, s2) = j.singular_values();
                scale(s1, s2)
            };
            Some(jacobians.iter().map(of).collect())
        };
        Program {
            kind: match self {
                Self::Arap | Self::Asap => ProgramKind::Deviation,
                Self::Tau | Self::Dilatation => ProgramKind::Stretch,
            },
            frames: jacobians.iter().map(|j| direction(j.similar)).collect(),
            scales: match self {
                Self::Tau | Self::Arap => None,
                // 1 / s at the minimum of (11) over s
                Self::Asap => scales(|s1, s2| (s1 + s2) / (s1 * s1 + s2 * s2)),
                // eq. (2)
                Self::Dilatation => scales(|s1, s2| 1.0 / (s1 * s2).sqrt()),
            },
        }
    }

    /// Whether a value below 1 proves by itself that no triangle is flipped.
    pub(super) fn proves_injectivity(self) -> bool {
        matches!(self, Self::Arap | Self::Asap)
    }

    /// Whether the size of the layout matters to it.
    pub(super) fn depends_on_scale(self) -> bool {
        self == Self::Arap
    }
}
