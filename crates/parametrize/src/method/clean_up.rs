//! The stage that takes cones away.

use super::domain::Domain;
use super::options::FEWEST_CELLS;
use super::relaxed::RelaxedLayout;
use super::{MapOptions, Purpose, Start};
use crate::cut::FramedCut;
use crate::progress::{SolveError, Watch, unless_cancelled};
use crate::rounding::{self, CleanUpOptions, ConeCount, Holonomy};
use seamstress_mesh::VertexData;

/// Price of a cone of a map that is an end in itself, and how far its index may be from the curvature.
const MAP_PRICE: f64 = 0.0005;
const MAP_DEVIATION: f64 = 1.5;
/// Price of a quarter of a cone of a map for quads, and how many cells it is worth: on the grid a cone bends
/// the cells around it whatever their size, and takes room from its neighbours.
const QUAD_PRICE: f64 = 0.0015;
const QUAD_CELLS: f64 = 4.0;
/// Prices count so many times along a guide, after which there are more cones than a smooth map needs, and are at least this,
/// for maps too: what turns the guide has a price of its own beside it, and the estimate, which knows of no directions, draws
/// cones off their lines where it weighs more.
const GUIDED: f64 = 2.0;
const LEAST_GUIDED_PRICE: f64 = 0.01;
/// Spikes that are small against the cells may be flattened.
const QUAD_DEVIATION: f64 = 3.5;
/// What lowering tau to its e-th part is worth, as mean symmetric Dirichlet energy.
const TAU_WORTH: f64 = 0.005;
/// A layout has 0.65 to 1.2 times the excess energy estimated on most meshes; far more on those with thin blades, or with
/// features close to each other, where the estimate says little about cones.
const TRUST: f64 = 1.3;

/// What fewer cones may cost.
#[derive(Debug, Clone, Copy)]
pub(super) struct CleanUpTerms {
    /// Mean symmetric Dirichlet energy for one cone fewer.
    price: f64,
    count: ConeCount,
    largest_deviation: f64,
}

impl CleanUpTerms {
    /// Those of a component; none if its cones stay as they were rounded.
    fn new(domain: &Domain<'_>, start: &Start, options: &MapOptions) -> Option<Self> {
        let usual = match options.purpose {
            Purpose::Texture => {
                Self { price: MAP_PRICE, count: ConeCount::Cones, largest_deviation: MAP_DEVIATION }
            }
            Purpose::Quads { edge_length } => {
                let cell = (edge_length / domain.surface.side()).powi(2).min(1.0 / FEWEST_CELLS);
                Self {
                    price: QUAD_PRICE.max(QUAD_CELLS * cell),
                    count: ConeCount::Quarters,
                    largest_deviation: QUAD_DEVIATION,
                }
            }
        };
        let usual_price = match domain.guide {
            None => usual.price,
            Some(_) => LEAST_GUIDED_PRICE.max(GUIDED * usual.price),
        };
        let price = options.cone_price.unwrap_or(usual_price);
        let is_wanted = price > 0.0 && start.leaves_cones_free();
        is_wanted.then_some(Self { price, ..usual })
    }
}

/// Matchings with fewer cones.
pub(super) struct Cleaned {
    /// The matchings, with the smoothest frames for them.
    pub(super) start: FramedCut,
    /// The excess energy that a layout is to have.
    estimate: f64,
    /// The excess energy that the cones saved are worth.
    worth: f64,
}

impl Cleaned {
    /// Whether a layout is as good as expected.
    pub(super) fn is_met_by(&self, layout: &RelaxedLayout) -> bool {
        layout.excess() <= TRUST * self.estimate
    }

    /// Whether the cones saved are worth what a layout without them costs more than one with them.
    pub(super) fn is_worth(&self, without: &RelaxedLayout, with: &RelaxedLayout) -> bool {
        let cost = |layout: &RelaxedLayout| layout.excess() + TAU_WORTH * layout.tau().ln();
        cost(without) < cost(with) + self.worth
    }
}

/// Fewer cones than after rounding, as far as an estimate of the distortion pays for it; none if they all stay, as those at
/// vertices held do.
///
/// # Errors
/// [`SolveError`].
pub(super) fn clean_up(
    domain: &Domain<'_>,
    rounded: &FramedCut,
    held: &VertexData<bool>,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Option<Cleaned>, SolveError> {
    let Some(terms) = CleanUpTerms::new(domain, start, options) else { return Ok(None) };
    let (sectors, metric) = (&domain.sectors, &domain.metric);
    let CleanUpTerms { price, count, largest_deviation } = terms;
    let options = CleanUpOptions { price, count, largest_deviation };
    let cleaned =
        rounding::clean_up(sectors, metric, rounded, domain.guide.as_ref(), held, &options, watch);
    let Ok((start, stats)) = unless_cancelled(cleaned)? else { return Ok(None) };
    if stats.cancelled + stats.moved == 0 {
        return Ok(None);
    }
    watch.pulse()?;
    let start = Holonomy::new(sectors, metric, domain.guide.as_ref())?.fix(start);
    watch.pulse()?;
    let worth = price * f64::from(stats.saved);
    Ok(Some(Cleaned { start, estimate: stats.energy, worth }))
}
