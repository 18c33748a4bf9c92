//! From rounded matchings to a flip-free exact layout, by the cheapest route that works.

use super::exact::{Defects, ExactLayout};
use super::homotopy::{self, Closed, Continuation, HomotopyError};
use super::newton::NewtonOptions;
use super::objective::OptimizeError;
use crate::consistency::ConsistencyError;
use crate::cut::{DualTree, MatchedCut, flatter_end, regauge, unfold};
use crate::energy::{SymmetricDirichlet, Untangling};
use crate::features::Sectors;
use crate::field::{PrescriptionError, SmoothError};
use crate::map::Violations;
use crate::progress::{Cancelled, Watch};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, TriMesh};

/// How a layout was reached; the later, the harder the input.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Route {
    /// The Poisson layout of a field, or local/global iterations from it; it may have flips.
    Poisson,
    /// The isometric layout itself: there was no seam to close.
    Isometric,
    /// As-rigid-as-possible iterations in the exact space.
    Rigid,
    /// The same, and untangling of the few triangles it flipped.
    Untangled,
    /// The barrier homotopy from the isometric layout.
    Barrier,
    /// The lifted continuation from the isometric layout.
    Continuation,
    /// The lifted continuation over a dual tree that avoids what the matchings move.
    Retreed,
    /// The routes before in the snowflake metric with this exponent, then back to the metric asked for.
    Snowflake {
        /// Exponent of the lengths.
        exponent: f64,
    },
}

impl std::fmt::Display for Route {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Route::Poisson => f.write_str("Poisson layout"),
            Route::Isometric => f.write_str("isometric layout"),
            Route::Rigid => f.write_str("rigid layout"),
            Route::Untangled => f.write_str("rigid layout, untangled"),
            Route::Barrier => f.write_str("barrier homotopy"),
            Route::Continuation => f.write_str("lifted continuation"),
            Route::Retreed => f.write_str("lifted continuation over a new tree"),
            Route::Snowflake { exponent } => write!(f, "snowflake metric with exponent {exponent}"),
        }
    }
}

/// A flip-free exact layout with the right angles.
pub struct Laid {
    /// The matchings it closes up to, over the all-seam cut that gauges refer to.
    pub matched: MatchedCut,
    /// The cut and its exact space.
    pub layout: ExactLayout,
    /// The unknowns.
    pub y: Vec<f64>,
    /// How it was reached.
    pub route: Route,
    /// Newton steps of the homotopies tried.
    pub homotopy_steps: usize,
}

/// Why there is no layout.
#[derive(Debug, thiserror::Error)]
pub enum LayoutError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Every route left defects; those of the last one.
    #[error("no route gave a layout without defects; the last one left {0}")]
    Defective(Defects),
    /// The layout stood, but its UVs did not pass the certificate.
    #[error("the component's map failed its certificate: {0}")]
    Uncertified(Violations),
    /// The cones prescribed cannot be had beside free ones.
    #[error(transparent)]
    Cones(#[from] PrescriptionError),
    /// No consistent matchings were found for the map to start from.
    #[error(transparent)]
    Inconsistent(ConsistencyError),
    /// A mesh that must be a disk is none.
    #[error("it is not a disk")]
    NotADisk,
    /// The objective could not be minimised.
    #[error(transparent)]
    Objective(OptimizeError),
    /// A linear system could not be solved.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
}

impl From<OptimizeError> for LayoutError {
    fn from(error: OptimizeError) -> Self {
        match error {
            OptimizeError::Cancelled(cancelled) => cancelled.into(),
            OptimizeError::Numeric(numeric) => numeric.into(),
            error => Self::Objective(error),
        }
    }
}

impl From<HomotopyError> for LayoutError {
    fn from(error: HomotopyError) -> Self {
        match error {
            HomotopyError::Cancelled(cancelled) => cancelled.into(),
            HomotopyError::Numeric(numeric) => numeric.into(),
        }
    }
}

impl From<ConsistencyError> for LayoutError {
    fn from(error: ConsistencyError) -> Self {
        match error {
            ConsistencyError::Cancelled(cancelled) => cancelled.into(),
            ConsistencyError::Numeric(numeric) => numeric.into(),
            other => Self::Inconsistent(other),
        }
    }
}

impl From<SmoothError> for LayoutError {
    fn from(error: SmoothError) -> Self {
        match error {
            SmoothError::Cancelled(cancelled) => cancelled.into(),
            SmoothError::Numeric(numeric) => numeric.into(),
        }
    }
}

const RIGID_ITERATIONS: usize = 20;
/// More flips than this share of the triangles are left to the homotopies.
const UNTANGLE_SHARE: f64 = 0.01;
const UNTANGLE_ROUNDS: usize = 15;
const SNOWFLAKES: [f64; 2] = [0.5, 0.3];
/// Exponents on the way back from a snowflake metric.
const WAY_BACK: [f64; 7] = [0.4, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0];
const SETTLE: NewtonOptions = NewtonOptions { max_iterations: 15, tolerance: 1e-4 };

/// Lays out matched seams exactly: rigid layout and untangling, barrier homotopy, lifted continuation,
/// the same over a better dual tree, the homotopies in snowflake metrics, in this order, until one has
/// no flip and no wrong angle. (No flip alone is not enough: a vertex may be wound once too often.) With
/// aligned edges the barrier is the last: continuations cost more and gave nothing that the release of an edge
/// does not.
///
/// `start`: frames in the gauge of the all-seam cut.
///
/// # Errors
/// [`LayoutError`]; that of the last route with its elements when all of them leave defects.
pub fn lay_out(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: MatchedCut,
    start: Option<&[Complex64]>,
    watch: &mut Watch<'_, '_>,
) -> Result<Laid, LayoutError> {
    lay_out_with(sectors, metric, matched, start, Effort::Thorough, watch)
}

/// How much to try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Every route.
    Thorough,
    /// No homotopies: for matchings that may as well be given up.
    Brief,
}

/// [`lay_out`] with a limited effort.
///
/// # Errors
/// As [`lay_out`].
pub fn lay_out_with(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: MatchedCut,
    start: Option<&[Complex64]>,
    effort: Effort,
    watch: &mut Watch<'_, '_>,
) -> Result<Laid, LayoutError> {
    let mut layout = ExactLayout::new(sectors, metric, &matched)?;
    let mesh = sectors.mesh();
    if matched.cut.seams.is_empty() && !sectors.any_aligned() {
        let z = unfold(mesh, metric, &matched.tree, &matched.cut);
        let y = layout.adopt(&matched.cut, &z);
        if layout.defects(sectors, &y).none() {
            return Ok(Laid { matched, layout, y, route: Route::Isometric, homotopy_steps: 0 });
        }
    }
    if let Some(frames) = start {
        let y = layout.arap(frames, RIGID_ITERATIONS)?;
        let defects = layout.defects(sectors, &y);
        if defects.none() {
            return Ok(Laid { matched, layout, y, route: Route::Rigid, homotopy_steps: 0 });
        }
        if (defects.flips.len() as f64) < UNTANGLE_SHARE * mesh.n_faces() as f64 {
            let (y, homotopy_steps) = untangle(&mut layout, y, watch)?;
            if layout.defects(sectors, &y).none() {
                return Ok(Laid { matched, layout, y, route: Route::Untangled, homotopy_steps });
            }
        }
        if effort == Effort::Brief {
            return Err(LayoutError::Defective(defects));
        }
    }
    let mut tried = Homotopies { steps: 0, last: Defects::default() };
    let plain = tried.run(sectors, metric, matched, watch)?;
    let matched = match plain {
        Attempt::Laid(laid) => return Ok(*laid),
        Attempt::Failed(matched) => *matched,
    };
    if sectors.any_aligned() {
        // With aligned edges, releasing one is the better way out.
        return Err(LayoutError::Defective(tried.last));
    }
    for exponent in SNOWFLAKES {
        let snowflake = metric.snowflake(mesh, exponent);
        let over = matched.with_metric(sectors, &snowflake);
        if let Attempt::Laid(mut laid) = tried.run(sectors, &snowflake, over, watch)? {
            laid.y = way_back(mesh, metric, &mut laid.layout, laid.y, exponent, watch)?;
            laid.matched = laid.matched.with_metric(sectors, metric);
            laid.route = Route::Snowflake { exponent };
            let defects = laid.layout.defects(sectors, &laid.y);
            if defects.none() {
                return Ok(*laid);
            }
            tried.last = defects;
        }
    }
    Err(LayoutError::Defective(tried.last))
}

/// Pulls flipped triangles open by Newton steps on a regularised barrier that sharpens (Garanzha et al.
/// 2021). It may leave wrong angles: check after it.
fn untangle(
    layout: &mut ExactLayout,
    mut y: Vec<f64>,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<f64>, usize), Cancelled> {
    let options = NewtonOptions { max_iterations: 2, tolerance: 1e-6 };
    let least_determinant = |layout: &ExactLayout, y: &[f64]| {
        let z = layout.expand(y);
        let determinants = layout.problem().triangles().iter().map(|t| {
            let (s1, s2) = t.jacobian(&z).singular_values();
            s1 * s2
        });
        determinants.fold(f64::INFINITY, f64::min)
    };
    let mut least = least_determinant(layout, &y);
    let mut eps = (1e-4 + 0.04 * least.min(0.0).powi(2)).sqrt();
    let mut steps = 0;
    for _ in 0..UNTANGLE_ROUNDS {
        watch.tick(0.5)?;
        let energy = Untangling { eps };
        let before = layout.problem().value(&energy, &layout.expand(&y));
        let solution = layout.minimize(y, &energy, &options, watch)?;
        (y, steps) = (solution.y, steps + solution.iterations.max(1));
        least = least_determinant(layout, &y);
        if least > 0.0 {
            break;
        }
        // The paper's rule: shrink eps by as much as the energy fell, so that it keeps falling.
        let fall = (1.0 - solution.energy / before).max(0.1);
        let goal = (1.0 - fall) * energy.chi(least)[0];
        eps = if least < goal { 2.0 * (goal * (goal - least)).sqrt() } else { 1e-9 };
    }
    Ok((y, steps))
}

/// What the homotopies have cost and left so far.
struct Homotopies {
    steps: usize,
    last: Defects,
}

enum Attempt {
    Laid(Box<Laid>),
    /// Gives the matchings back.
    Failed(Box<MatchedCut>),
}

impl Homotopies {
    /// Barrier and, unless edges are aligned, continuation, and continuation over a new tree.
    fn run(
        &mut self,
        sectors: &Sectors<'_>,
        metric: &Metric,
        matched: MatchedCut,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Attempt, LayoutError> {
        let settings = Continuation::default();
        let closed = homotopy::barrier(sectors, metric, &matched, watch)?;
        let matched = match self.accept(sectors, metric, matched, closed, Route::Barrier)? {
            Attempt::Failed(matched) => *matched,
            laid => return Ok(laid),
        };
        if sectors.any_aligned() {
            // The next one takes several times as long; releasing an edge is the better way out.
            return Ok(Attempt::Failed(Box::new(matched)));
        }
        let closed = homotopy::continuation(sectors, metric, &matched, &settings, watch)?;
        let matched = match self.accept(sectors, metric, matched, closed, Route::Continuation)? {
            Attempt::Failed(matched) => *matched,
            laid => return Ok(laid),
        };
        let other = retree(sectors, metric, &matched);
        let closed = homotopy::continuation(sectors, metric, &other, &settings, watch)?;
        Ok(match self.accept(sectors, metric, other, closed, Route::Retreed)? {
            Attempt::Failed(_) => Attempt::Failed(Box::new(matched)),
            laid => laid,
        })
    }

    /// Projects a nearly closed layout into the exact space and looks at what comes out.
    fn accept(
        &mut self,
        sectors: &Sectors<'_>,
        metric: &Metric,
        matched: MatchedCut,
        closed: Closed,
        route: Route,
    ) -> Result<Attempt, LayoutError> {
        self.steps += closed.steps;
        let mut layout = ExactLayout::new(sectors, metric, &matched)?;
        let y = layout.project(sectors.mesh(), &matched.cut, &closed.z)?;
        let defects = layout.defects(sectors, &y);
        if defects.none() {
            let homotopy_steps = self.steps;
            let laid = Laid { matched, layout, y, route, homotopy_steps };
            return Ok(Attempt::Laid(Box::new(laid)));
        }
        self.last = defects;
        Ok(Attempt::Failed(Box::new(matched)))
    }
}

/// Raises the exponent of a layout made in a snowflake metric to 1, by Newton steps that never flip.
///
/// # Errors
/// [`Cancelled`].
pub fn way_back(
    mesh: &TriMesh,
    metric: &Metric,
    layout: &mut ExactLayout,
    mut y: Vec<f64>,
    from: f64,
    watch: &mut Watch<'_, '_>,
) -> Result<Vec<f64>, Cancelled> {
    y = layout.minimize(y, &SymmetricDirichlet, &SETTLE, watch)?.y;
    for exponent in WAY_BACK.into_iter().filter(|&p| p > from) {
        if exponent < 1.0 {
            layout.set_metric(mesh, &metric.snowflake(mesh, exponent));
        } else {
            layout.set_metric(mesh, metric);
        }
        layout.rescale(&mut y);
        y = layout.minimize(y, &SymmetricDirichlet, &SETTLE, watch)?.y;
    }
    Ok(y)
}

/// The same matchings over a dual tree that crosses few edges where they differ from the isometric
/// rotations, lifted so that the differences stay what they are.
pub fn retree(sectors: &Sectors<'_>, metric: &Metric, matched: &MatchedCut) -> MatchedCut {
    let slit = sectors.slit();
    let curvature = flatter_end(slit, sectors.bend(metric));
    let mut transport = HalfedgeData::filled(slit.n_halfedges(), 0.0);
    let mut isometric = HalfedgeData::filled(slit.n_halfedges(), 0.0);
    for ((&h, &r), &r0) in matched.turning.iter().zip(&matched.matching).zip(&matched.isometric) {
        let d = (f64::from(r) - r0).abs();
        (transport[h], isometric[h]) = (d, r0);
        if let Some(t) = slit.twin(h) {
            (transport[t], isometric[t]) = (d, -r0);
        }
    }
    let price = |h: Halfedge| 1e3 * (transport[h] - 0.5).max(0.0);
    let grounding = sectors.aligned().map(|h| (price(h) - metric.length[h], h));
    let tree = DualTree::grounded(slit, grounding, |h| price(h) + curvature(h));
    let full = matched.matching_per_halfedge(sectors);
    let (regauged, _) = regauge(slit, &tree, &full);
    let mut other = MatchedCut::new(sectors, metric, tree);
    // Regauging moves both by whole and real turns along the tree; bring the difference over exactly.
    let mut turn = FaceData::filled(slit.n_faces(), 0.0);
    for &f in &other.tree.order {
        if let Some(h) = other.tree.ground[f] {
            turn[f] = isometric[h];
        }
        if let Some(h) = other.tree.parent[f] {
            turn[f] = turn[h.face()] - isometric[h];
        }
    }
    for (e, &h) in other.turning.iter().enumerate() {
        let right = slit.twin(h).map_or(0.0, |t| turn[t.face()]);
        let lifted = isometric[h] + right - turn[h.face()];
        // `lifted` and the new isometric rotation agree modulo 4; keep the lift of the matchings.
        let shift = (other.isometric[e] - lifted).round() as i32;
        other.matching[e] = regauged[h] + shift;
    }
    other
}
