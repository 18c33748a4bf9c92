//! The convex program of one global step: its data, and its value at a layout.

pub(super) use crate::energy::extremes;
use crate::energy::{Jacobian, Triangle};
use crate::layout::problem::LayoutProblem;
use num_complex::Complex64;

/// What is bounded over all triangles. With z and w the similarity and anti-similarity parts of a
/// triangle's (scaled) Jacobian and R its frame, the Jacobian's singular values are `|z| + |w|` and
/// `|z| - |w|`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProgramKind {
    /// Eq. (9) with `mu_2 = 1`, which homogeneity permits: the minimum of `mu` with `|z| + |w| <= mu` and
    /// `|w| <= Re(z conj R) - 1`. The value is `mu`, a bound on `sigma_1 max / sigma_2 min`.
    Stretch,
    /// Eq. (8): the minimum of `mu` with `2 |z - R|^2 + 2 |w|^2 <= mu`, which is `|J - R|_F^2`.
    Deviation,
}

/// What is adapted to the iterate within the interior point; the program then changes on the way, and the
/// method is a heuristic ("fused" local and global steps).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Renewal {
    /// Nothing: the program is solved as it stands.
    Never,
    /// Frames, by polar decomposition.
    Frames,
    /// Frames and scales.
    FramesAndScales,
}

/// A convex program over the layouts of a [`LayoutProblem`]: everything but the unknowns is given.
#[derive(Debug, Clone)]
pub struct Program {
    /// What is bounded.
    pub kind: ProgramKind,
    /// Frame of each triangle, a unit complex number.
    pub frames: Vec<Complex64>,
    /// Factor of each triangle's Jacobian: `s_t` of eq. (12), or `1 / s_t` of eq. (11). None: all 1.
    pub scales: Option<Vec<f64>>,
}

impl Program {
    /// Factor of the Jacobian of triangle `t`.
    pub(super) fn scale(&self, t: usize) -> f64 {
        self.scales.as_ref().map_or(1.0, |scales| scales[t])
    }

    /// The Jacobian that the program sees on triangle `t`.
    pub fn jacobian(&self, t: usize, triangle: &Triangle, z: &[Complex64]) -> Jacobian {
        let Jacobian { similar, anti } = triangle.jacobian(z);
        let scale = self.scale(t);
        Jacobian { similar: similar * scale, anti: anti * scale }
    }

    /// The smallest `mu` with which a layout satisfies the program, infinite if there is none; for
    /// [`ProgramKind::Stretch`] after scaling it to `mu_2 = 1`.
    pub fn value(&self, problem: &LayoutProblem, z: &[Complex64]) -> f64 {
        let worst = |t: usize, triangle: &Triangle| {
            let Jacobian { similar, anti } = self.jacobian(t, triangle, z);
            let (frame, anti) = (self.frames[t], anti.norm());
            match self.kind {
                ProgramKind::Stretch => (similar.norm() + anti, (similar * frame.conj()).re - anti),
                ProgramKind::Deviation => {
                    (2.0 * ((similar - frame).norm_sqr() + anti * anti), f64::INFINITY)
                }
            }
        };
        let (largest, smallest) = extremes(problem.triangles(), worst);
        match self.kind {
            ProgramKind::Stretch if smallest > 0.0 => largest / smallest,
            ProgramKind::Stretch => f64::INFINITY,
            ProgramKind::Deviation => largest,
        }
    }
}
