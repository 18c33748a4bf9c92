//! From a flip-free layout to one of low distortion.

use crate::energy::{Energy, PowerOfDirichlet, SymmetricDirichlet};
use crate::features::Sectors;
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
    /// Minimises the symmetric Dirichlet energy.
    pub(super) fn relaxed(mut laid: Laid, watch: &mut Watch<'_, '_>) -> Result<Self, Cancelled> {
        let solution = laid.layout.minimize(laid.y, &SymmetricDirichlet, &SETTLE, watch)?;
        let iterations = laid.homotopy_steps + solution.iterations;
        let (symmetric_dirichlet, tau) = laid.layout.distortion(&solution.y);
        laid.y = solution.y.clone();
        Ok(Self { laid, relaxed: solution.y, symmetric_dirichlet, tau, iterations })
    }

    /// What clean-up is judged by: the relaxed layout, sharpened too unless edges are aligned. Then each
    /// iteration costs more, and sharpening waits until the cones are final.
    pub(super) fn judged(
        sectors: &Sectors<'_>,
        laid: Laid,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Self, Cancelled> {
        let mut finished = Self::relaxed(laid, watch)?;
        if !sectors.any_aligned() {
            finished.sharpen(watch)?;
        }
        Ok(finished)
    }

    /// Minimises growing powers of the energy from the relaxed layout; keeps the best compromise on the
    /// way. [`Finished::polish`] does better.
    pub(super) fn sharpen(&mut self, watch: &mut Watch<'_, '_>) -> Result<(), Cancelled> {
        let Self { laid, symmetric_dirichlet, tau, iterations, .. } = self;
        let mut y = self.relaxed.clone();
        for p in POWERS {
            let z = laid.layout.expand(&y);
            let worst = laid.layout.problem().triangles().iter().map(|t| {
                let (s1, s2) = t.jacobian(&z).singular_values();
                SymmetricDirichlet.value(s1, s2)
            });
            let energy = PowerOfDirichlet { p, bound: worst.fold(4.0, f64::max) };
            let solution = laid.layout.minimize(y, &energy, &POLISH, watch)?;
            *iterations += solution.iterations;
            y = solution.y;
            let (energy, worst) = laid.layout.distortion(&y);
            if regret(energy, worst) < regret(*symmetric_dirichlet, *tau) {
                (*symmetric_dirichlet, *tau) = (energy, worst);
                laid.y = y.clone();
            }
        }
        Ok(())
    }

    /// Whether sharpening has raised the energy by more than the polish may. It hardly ever finds
    /// anything then.
    pub(super) fn has_risen_beyond(&self, options: &PolishOptions) -> bool {
        let (least, _) = self.laid.layout.distortion(&self.relaxed);
        self.symmetric_dirichlet > (1.0 + options.max_energy_rise) * least
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
