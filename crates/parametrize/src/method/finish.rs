//! What may follow the polish: the metric of the surface, and another objective.

use super::MethodError;
use super::domain::Domain;
use crate::energy::SymmetricDirichlet;
use crate::layout::ladder::SeamlessLayout;
use crate::layout::newton::NewtonOptions;
use crate::layout::objective::{Objective, ObjectiveOptions, optimize};
use crate::progress::{SolveError, Watch};

/// Parts of the lengthening on the path back to the metric of the surface; the steps are short where triangles are
/// still thick.
const LENGTHENINGS: [f64; 8] = [1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6];
/// Each is only a step on the path.
const SETTLE: NewtonOptions = NewtonOptions { max_iterations: 15, tolerance: 1e-4 };

/// The layout brought by Newton steps that never flip a triangle from the metric of a domain to that of the surface.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn in_surface_metric(
    domain: &Domain<'_>,
    mut layout: SeamlessLayout,
    watch: &mut Watch<'_, '_>,
) -> Result<SeamlessLayout, SolveError> {
    if domain.lengthening > 0.0 {
        for part in LENGTHENINGS {
            let by = part * domain.lengthening;
            let metric = domain.surface.lengthened(domain.mesh(), by);
            layout.space.set_metric(domain.mesh(), &metric);
            layout.space.rescale(&mut layout.y);
            layout.y = layout.space.minimize(layout.y, &SymmetricDirichlet, &SETTLE, watch)?.y;
        }
        layout.space.set_metric(domain.mesh(), domain.surface);
        layout.space.rescale(&mut layout.y);
        layout.y = layout.space.minimize(layout.y, &SymmetricDirichlet, &SETTLE, watch)?.y;
        layout.space.rescale(&mut layout.y);
    }
    Ok(layout)
}

/// The layout that minimises another objective, and the iterations it took.
///
/// # Errors
/// [`MethodError`].
pub(super) fn minimize(
    domain: &Domain<'_>,
    mut layout: SeamlessLayout,
    objective: Objective,
    watch: &mut Watch<'_, '_>,
) -> Result<(SeamlessLayout, usize), MethodError> {
    let settings = ObjectiveOptions::default();
    let (sectors, y) = (&domain.sectors, std::mem::take(&mut layout.y));
    let best = optimize(sectors, &mut layout.space, y, objective, &settings, watch)?;
    layout.y = best.y;
    Ok((layout, best.iterations))
}
