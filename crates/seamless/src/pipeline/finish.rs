//! From a flip-free layout to one of low distortion.

use crate::layout::energy::{Energy, PowerOfDirichlet, SymmetricDirichlet};
use crate::layout::newton::NewtonOptions;
use crate::layout::polish::{PolishOptions, polish};
use crate::layout::safeguards::Laid;
use crate::progress::{Cancelled, Watch};

/// Exponents of the energy, in turn: the higher, the more the worst triangles count.
const POWERS: [i32; 5] = [2, 4, 8, 16, 32];
const SETTLE: NewtonOptions = NewtonOptions { max_iterations: 40, tolerance: 1e-6 };
const POLISH: NewtonOptions = NewtonOptions { max_iterations: 10, tolerance: 1e-3 };

/// A layout of low symmetric Dirichlet energy with its worst triangles polished.
pub(super) struct Finished {
    pub(super) laid: Laid,
    /// The layout of least energy.
    relaxed: Vec<f64>,
    pub(super) symmetric_dirichlet: f64,
    pub(super) tau: f64,
    /// Newton iterations in all, those of the layout included.
    pub(super) iterations: usize,
}

impl Finished {
    /// Minimises the symmetric Dirichlet energy, then growing powers of it; keeps the best
    /// compromise on the way. Cheap enough to judge clean-up by; [`Finished::polish`] does better.
    pub(super) fn new(mut laid: Laid, watch: &mut Watch<'_, '_>) -> Result<Self, Cancelled> {
        let solution = laid.layout.minimize(laid.y, &SymmetricDirichlet, &SETTLE, watch)?;
        let mut iterations = laid.homotopy_steps + solution.iterations;
        let mut y = solution.y;
        let (mut symmetric_dirichlet, mut tau) = laid.layout.distortion(&y);
        laid.y = y.clone();
        let relaxed = y.clone();
        for p in POWERS {
            let z = laid.layout.expand(&y);
            let worst = laid.layout.problem().triangles().iter().map(|t| {
                let (s1, s2) = t.jacobian(&z).singular_values();
                SymmetricDirichlet.value(s1, s2)
            });
            let energy = PowerOfDirichlet { p, bound: worst.fold(4.0, f64::max) };
            let solution = laid.layout.minimize(y, &energy, &POLISH, watch)?;
            iterations += solution.iterations;
            y = solution.y;
            let (energy, worst) = laid.layout.distortion(&y);
            if regret(energy, worst) < regret(symmetric_dirichlet, tau) {
                (symmetric_dirichlet, tau) = (energy, worst);
                laid.y = y.clone();
            }
        }
        Ok(Self { laid, relaxed, symmetric_dirichlet, tau, iterations })
    }

    /// Lowers tau; returns the iterations taken.
    pub(super) fn polish(
        &mut self,
        options: &PolishOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<usize, Cancelled> {
        let laid = &mut self.laid;
        let polished = polish(&mut laid.layout, &self.relaxed, &laid.y, options, watch)?;
        Ok(polished.map_or(0, |polished| {
            laid.y = polished.y;
            polished.iterations
        }))
    }
}

/// What the polish lowers on the whole: a fall of `tau - 1` by one part in a hundred may cost a rise of
/// the mean excess energy by four.
fn regret(symmetric_dirichlet: f64, tau: f64) -> f64 {
    (tau - 1.0).max(1e-9).ln() + 0.25 * (symmetric_dirichlet - 4.0).max(1e-9).ln()
}
