//! From a flip-free layout to one of low distortion.

use super::MapOptions;
use crate::energy::{DIRECTION_ENERGY, SymmetricDirichlet};
use crate::field::Guide;
use crate::layout::ladder::SeamlessLayout;
use crate::layout::newton::NewtonOptions;
use crate::layout::polish::{PolishOptions, polish as lower_tau};
use crate::progress::{SolveError, Watch};
use crate::quality::Figures;

/// Most layouts are at the minimum after ten iterations. One that lowers the energy by so small a part is followed by hardly
/// any that does as much as a millionth.
const TOLERANCE: f64 = 1e-5;
/// The same where time is to be saved: half of the iterations.
const FAST_TOLERANCE: f64 = 1e-3;

/// A layout of minimum mean symmetric Dirichlet energy, at its best scale.
pub(super) struct RelaxedLayout {
    pub(super) layout: SeamlessLayout,
    symmetric_dirichlet: f64,
    tau: f64,
    /// Newton iterations, those of the layout included.
    pub(super) iterations: usize,
}

impl RelaxedLayout {
    /// The energy beyond that of an isometry.
    pub(super) fn excess(&self) -> f64 {
        self.symmetric_dirichlet - 4.0
    }

    /// Its worst distortion.
    pub(super) fn tau(&self) -> f64 {
        self.tau
    }
}

/// Minimises the energy, together with what lying askew to a guide costs.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn relax(
    mut layout: SeamlessLayout,
    guide: Option<&Guide>,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<RelaxedLayout, SolveError> {
    if let Some(guide) = guide {
        layout.space.problem_mut().follow(guide, DIRECTION_ENERGY);
    }
    let tolerance = if options.fast { FAST_TOLERANCE } else { TOLERANCE };
    let newton = NewtonOptions { max_iterations: 40, tolerance };
    let start = std::mem::take(&mut layout.y);
    let solution = layout.space.minimize(start, &SymmetricDirichlet, &newton, watch)?;
    let figures = layout.space.figures(&solution.y);
    layout.y = solution.y;
    layout.y.iter_mut().for_each(|x| *x *= figures.scale);
    let iterations = layout.steps + solution.iterations;
    let Figures { symmetric_dirichlet, tau, .. } = figures;
    Ok(RelaxedLayout { layout, symmetric_dirichlet, tau, iterations })
}

/// A relaxed layout with its worst triangles polished, at the best global scale; and the iterations it took.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn polish(
    RelaxedLayout { mut layout, .. }: RelaxedLayout,
    options: Option<&PolishOptions>,
    watch: &mut Watch<'_, '_>,
) -> Result<(SeamlessLayout, usize), SolveError> {
    let Some(options) = options else { return Ok((layout, 0)) };
    let polished = lower_tau(&mut layout.space, &layout.y, options, watch)?;
    layout.y = polished.y;
    Ok((layout, polished.iterations))
}
