//! What may follow the polish: the metric of the surface, and another objective.

use super::MethodError;
use super::domain::Domain;
use crate::layout::ladder::{SeamlessLayout, way_back};
use crate::layout::objective::{Objective, ObjectiveOptions, optimize};
use crate::progress::{SolveError, Watch};

/// The layout brought from the metric of a domain to that of the surface.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn in_surface_metric(
    domain: &Domain<'_>,
    mut layout: SeamlessLayout,
    watch: &mut Watch<'_, '_>,
) -> Result<SeamlessLayout, SolveError> {
    if domain.exponent < 1.0 {
        let (mesh, surface) = (domain.mesh(), domain.surface);
        let y = std::mem::take(&mut layout.y);
        layout.y = way_back(mesh, surface, &mut layout.space, y, domain.exponent, watch)?;
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
