//! From a flip-free layout to one of low distortion.

use super::domain::Domain;
use crate::energy::{Energy, PowerOfDirichlet, SymmetricDirichlet};
use crate::layout::exact::ExactLayout;
use crate::layout::ladder::SeamlessLayout;
use crate::layout::newton::NewtonOptions;
use crate::layout::polish::{PolishOptions, polish as lower_tau};
use crate::progress::{SolveError, Watch};

/// Exponents of the energy, in turn: the higher, the more the worst triangles count. Beyond 32 nothing more is gained.
const POWERS: [i32; 5] = [2, 4, 8, 16, 32];
/// To the minimum: most layouts are there after ten iterations, and the energy is compared in the sixth digit.
const SETTLE: NewtonOptions = NewtonOptions { max_iterations: 40, tolerance: 1e-6 };
/// Each power only leads to the next.
const SHARPEN: NewtonOptions = NewtonOptions { max_iterations: 10, tolerance: 1e-3 };

/// A layout of low symmetric Dirichlet energy, and the best compromise with its worst triangles found so far.
pub(super) struct RelaxedLayout {
    /// The compromise.
    pub(super) layout: SeamlessLayout,
    /// Unknowns at the minimum of the energy.
    relaxed: Vec<f64>,
    /// Mean energy of the compromise.
    pub(super) symmetric_dirichlet: f64,
    /// Largest distortion of the compromise.
    pub(super) tau: f64,
    /// Newton iterations in all, those of the layout included.
    pub(super) iterations: usize,
}

/// Minimises the symmetric Dirichlet energy, and sharpens the result unless edges are aligned: then each iteration
/// costs more, and sharpening waits until the cones are final.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn relax(
    domain: &Domain<'_>,
    mut layout: SeamlessLayout,
    watch: &mut Watch<'_, '_>,
) -> Result<RelaxedLayout, SolveError> {
    let start = std::mem::take(&mut layout.y);
    let solution = layout.space.minimize(start, &SymmetricDirichlet, &SETTLE, watch)?;
    let iterations = layout.steps + solution.iterations;
    let (symmetric_dirichlet, tau) = layout.space.distortion(&solution.y);
    layout.y = solution.y.clone();
    let relaxed =
        RelaxedLayout { layout, relaxed: solution.y, symmetric_dirichlet, tau, iterations };
    if domain.any_aligned() { Ok(relaxed) } else { relaxed.sharpened(watch) }
}

/// The layout with its worst triangles polished, at the best global scale; and the iterations it took. With options,
/// what sharpening has raised the energy to is kept only within the rise that they allow.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn polish(
    domain: &Domain<'_>,
    relaxed: RelaxedLayout,
    options: Option<&PolishOptions>,
    watch: &mut Watch<'_, '_>,
) -> Result<(SeamlessLayout, usize), SolveError> {
    let before = relaxed.iterations;
    let relaxed = if domain.any_aligned() { relaxed.sharpened(watch)? } else { relaxed };
    let mut iterations = relaxed.iterations - before;
    let RelaxedLayout { mut layout, relaxed, .. } = relaxed;
    if let Some(options) = options {
        let polished = lower_tau(&mut layout.space, &relaxed, &layout.y, options, watch)?;
        layout.y = polished.y;
        iterations += polished.iterations;
    }
    layout.space.rescale(&mut layout.y);
    Ok((layout, iterations))
}

impl RelaxedLayout {
    /// Minimises growing powers of the energy from the relaxed layout; keeps the best compromise on the
    /// path. [`polish`] does better.
    fn sharpened(mut self, watch: &mut Watch<'_, '_>) -> Result<Self, SolveError> {
        let mut y = self.relaxed.clone();
        for p in POWERS {
            let space = &mut self.layout.space;
            let energy = PowerOfDirichlet { p, bound: largest_energy(space, &y) };
            let solution = space.minimize(y, &energy, &SHARPEN, watch)?;
            self.iterations += solution.iterations;
            y = solution.y;
            let (energy, worst) = space.distortion(&y);
            if regret(energy, worst) < regret(self.symmetric_dirichlet, self.tau) {
                (self.symmetric_dirichlet, self.tau) = (energy, worst);
                self.layout.y = y.clone();
            }
        }
        Ok(self)
    }
}

/// The largest symmetric Dirichlet energy of a triangle, 4 at least.
fn largest_energy(space: &ExactLayout, y: &[f64]) -> f64 {
    let z = space.expand(y);
    let energies = space.problem().triangles().iter().map(|t| {
        let (s1, s2) = t.jacobian(&z).singular_values();
        SymmetricDirichlet.value(s1, s2)
    });
    energies.fold(4.0, f64::max)
}

/// What the polish lowers on the whole: a fall of `tau - 1` by one part in a hundred may cost a rise of
/// the mean excess energy by four.
fn regret(symmetric_dirichlet: f64, tau: f64) -> f64 {
    (tau - 1.0).max(1e-9).ln() + 0.25 * (symmetric_dirichlet - 4.0).max(1e-9).ln()
}
