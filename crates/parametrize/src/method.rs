//! The direct method on one page (Levi 2021): unfold, round, clean up, lay out, relax, polish, certify.
//!
//! [`parametrize`] runs it on a connected mesh. Every stage takes values and returns new ones. The mesh comes with
//! the edges that are to run along the axes ([`Domain`]); a stage that fails near some of them returns a domain
//! with fewer. Around the page: what a map starts from (`start`), what is tried when a component fails
//! (`component`), all components side by side (`maps`), and what is done to maps that are there (`relayout`).

mod baseline;
mod certify;
mod clean_up;
mod component;
mod components;
mod domain;
mod error;
mod finish;
mod lay_out;
mod log;
mod maps;
mod options;
mod placement;
mod relaxed;
mod relayout;
mod round;
mod scout;
mod solution;
mod start;
mod whole;

pub use baseline::{FieldMap, FieldMapOptions, UncertifiedMap, make_field_map};
pub use error::{MapError, MethodError};
pub use maps::{make_aligned_map, make_map, make_map_from};
pub use options::{MapOptions, Purpose};
pub use relayout::{Relayout, RelayoutOptions, RelayoutStats, lay_out_disk, relayout};
pub use solution::{ComponentStats, MapSolution, StageStats};
pub use start::Start;

use crate::cut::Unfolding;
use crate::layout::ladder::LayoutEffort;
use crate::progress::{Stage, Watch};
use certify::{ComponentMap, last_certified};
use clean_up::clean_up;
use domain::Domain;
use finish::{in_surface_metric, minimize};
use lay_out::lay_out;
use log::StageLog;
use relaxed::polish;
use round::round;
use scout::{LaidOut, scout};

/// The seamless map of a connected mesh.
///
/// # Errors
/// [`MethodError`]; never an uncertified map.
fn parametrize(
    domain: Domain<'_>,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ComponentMap, MethodError> {
    let mut log = StageLog::default();

    // Unfold the faces along a tree, without distortion: every edge off the tree is a seam that turns by some angle.
    log.enter(Stage::Cut, watch)?;
    let unfolding = domain.unfold();

    // Lay out and relax with the cones of a coarser mesh, found in a part of the time; where that is not as good as
    // expected, or where a coarser mesh would not do, directly.
    let scouted = scout(&domain, &unfolding, start, options, &mut log, watch)?;
    let effort = LayoutEffort::Thorough;
    let directly =
        |domain| lay_out_directly(domain, unfolding, effort, start, options, &mut log, watch);
    let (domain, rounding, relaxed) = match scouted {
        Some(scouted) => scouted.or_better(domain, directly)?,
        None => directly(domain)?,
    };

    // Polish: lower the worst distortion for a bounded rise of the mean.
    log.enter(Stage::Polish, watch)?;
    let (layout, iterations) = polish(relaxed, options.polish(domain.guide.is_some()), watch)?;
    log.count(iterations);
    let route = layout.route;
    let mut candidates = vec![domain.corner_uvs(&layout)];
    // Where edges were made longer to open thin triangles, back to their own lengths.
    let layout = in_surface_metric(&domain, layout, watch)?;
    candidates.push(domain.corner_uvs(&layout));
    if let Some(objective) = options.objective {
        log.enter(Stage::Objective, watch)?;
        let (layout, iterations) = minimize(&domain, layout, objective, watch)?;
        log.count(iterations);
        candidates.push(domain.corner_uvs(&layout));
    }

    // Certify: the thinnest triangles may flip when a layout is scaled and moved, so the last that passes is taken.
    let certified = last_certified(&domain, candidates, &options.tolerance)?;
    Ok(ComponentMap::new(domain, certified, rounding, route, log))
}

/// The relaxed layout with cones found on the mesh itself; so much is tried for them as they were rounded.
///
/// # Errors
/// [`MethodError`].
fn lay_out_directly<'m>(
    domain: Domain<'m>,
    unfolding: Unfolding,
    effort: LayoutEffort,
    start: &Start,
    options: &MapOptions,
    log: &mut StageLog,
    watch: &mut Watch<'_, '_>,
) -> Result<LaidOut<'m>, MethodError> {
    // Round the turns of the seams to whole quarters.
    log.enter(Stage::Rounding, watch)?;
    let (domain, rounding) = round(domain, unfolding, start, options, watch)?;
    log.count(rounding.stats.layouts);

    // Clean up: fewer cones, as far as an estimate of the distortion pays for it.
    log.enter(Stage::CleanUp, watch)?;
    let cleaned = clean_up(&domain, &rounding.start, &domain.nowhere(), start, options, watch)?;

    // Lay out with seams that close exactly, no flipped triangle and no wrong angle; and relax to the smallest mean
    // distortion.
    log.enter(Stage::Layout, watch)?;
    let (domain, rounding, relaxed) =
        lay_out(domain, rounding, cleaned, effort, start, options, watch)?;
    log.count(relaxed.iterations);
    Ok((domain, rounding.stats, relaxed))
}
