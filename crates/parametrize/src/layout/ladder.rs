//! From rounded matchings to a flip-free exact layout, by the cheapest route that works.

use super::exact::{Defects, ExactLayout};
use super::homotopy::{self, Continuation, PenaltyLayout};
use super::newton::NewtonOptions;
use super::route::Route;
use crate::cut::{DualTree, FramedCut, MatchedCut, flatter_end, regauge};
use crate::energy::{SymmetricDirichlet, Untangling};
use crate::features::Sectors;
use crate::progress::{Cancelled, SolveError, Watch};
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, TriMesh};

/// A flip-free exact layout with the right angles.
pub struct SeamlessLayout {
    /// The matchings it closes up to, over the all-seam cut that gauges refer to.
    pub matched: MatchedCut,
    /// The cut and its exact space.
    pub space: ExactLayout,
    /// The unknowns.
    pub y: Vec<f64>,
    /// How it was reached.
    pub route: Route,
    /// Newton steps of the homotopies tried.
    pub homotopy_steps: usize,
}

const RIGID_ITERATIONS: usize = 20;
/// More flips than this share of the triangles are left to the homotopies.
const UNTANGLE_SHARE: f64 = 0.01;
const UNTANGLE_ROUNDS: usize = 15;
const SNOWFLAKES: [f64; 2] = [0.5, 0.3];
/// Exponents on the way back from a snowflake metric.
const WAY_BACK: [f64; 7] = [0.4, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0];
const SETTLE: NewtonOptions = NewtonOptions { max_iterations: 15, tolerance: 1e-4 };

/// How much to try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutEffort {
    /// Every route.
    Thorough,
    /// No homotopies: for matchings that may as well be given up.
    Brief,
}

/// Lays out matched seams exactly: rigid layout and untangling, barrier homotopy, lifted continuation,
/// the same over a better dual tree, the homotopies in snowflake metrics, in this order, until one has
/// no flip and no wrong angle. (No flip alone is not enough: a vertex may be wound once too often.) With
/// aligned edges the barrier is the last: continuations cost more and gave nothing that dropping an edge
/// does not. The defects of the last route when all of them leave some.
///
/// # Errors
/// [`SolveError`].
pub fn lay_out(
    sectors: &Sectors<'_>,
    metric: &Metric,
    start: &FramedCut,
    effort: LayoutEffort,
    watch: &mut Watch<'_, '_>,
) -> Result<Result<SeamlessLayout, Defects>, SolveError> {
    let FramedCut { matched, frames } = start.clone();
    let mut space = ExactLayout::new(sectors, metric, &matched)?;
    let mesh = sectors.mesh();
    let laid_out = |matched, space, y, route, homotopy_steps| {
        Ok(Ok(SeamlessLayout { matched, space, y, route, homotopy_steps }))
    };
    if matched.unfolding.cut.seams.is_empty() && !sectors.any_aligned() {
        let z = matched.unfolding.positions(sectors, metric);
        let y = space.adopt(&matched.unfolding.cut, &z);
        if space.defects(sectors, &y).none() {
            return laid_out(matched, space, y, Route::Isometric, 0);
        }
    }
    let y = space.arap(&frames, RIGID_ITERATIONS)?;
    let defects = space.defects(sectors, &y);
    if defects.none() {
        return laid_out(matched, space, y, Route::Rigid, 0);
    }
    if (defects.flips.len() as f64) < UNTANGLE_SHARE * mesh.n_faces() as f64 {
        let (y, steps) = untangle(&mut space, y, watch)?;
        if space.defects(sectors, &y).none() {
            return laid_out(matched, space, y, Route::Untangled, steps);
        }
    }
    if effort == LayoutEffort::Brief {
        return Ok(Err(defects));
    }
    let mut tried = Homotopies { steps: 0, last: Defects::default() };
    let matched = match tried.run(sectors, metric, matched, watch)? {
        Attempt::Layout(layout) => return Ok(Ok(*layout)),
        Attempt::Failed(matched) => *matched,
    };
    if sectors.any_aligned() {
        // With aligned edges, dropping one is the better way out.
        return Ok(Err(tried.last));
    }
    for exponent in SNOWFLAKES {
        let snowflake = metric.snowflake(mesh, exponent);
        let over = matched.with_metric(sectors, &snowflake);
        if let Attempt::Layout(mut layout) = tried.run(sectors, &snowflake, over, watch)? {
            layout.y = way_back(mesh, metric, &mut layout.space, layout.y, exponent, watch)?;
            layout.matched = layout.matched.with_metric(sectors, metric);
            layout.route = Route::Snowflake { exponent };
            let defects = layout.space.defects(sectors, &layout.y);
            if defects.none() {
                return Ok(Ok(*layout));
            }
            tried.last = defects;
        }
    }
    Ok(Err(tried.last))
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
    Layout(Box<SeamlessLayout>),
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
    ) -> Result<Attempt, SolveError> {
        let settings = Continuation::default();
        let closed = homotopy::barrier(sectors, metric, &matched, watch)?;
        let matched = match self.accept(sectors, metric, matched, closed, Route::Barrier)? {
            Attempt::Failed(matched) => *matched,
            layout => return Ok(layout),
        };
        if sectors.any_aligned() {
            // The next one takes several times as long; releasing an edge is the better way out.
            return Ok(Attempt::Failed(Box::new(matched)));
        }
        let closed = homotopy::continuation(sectors, metric, &matched, &settings, watch)?;
        let matched = match self.accept(sectors, metric, matched, closed, Route::Continuation)? {
            Attempt::Failed(matched) => *matched,
            layout => return Ok(layout),
        };
        let other = retree(sectors, metric, &matched);
        let closed = homotopy::continuation(sectors, metric, &other, &settings, watch)?;
        Ok(match self.accept(sectors, metric, other, closed, Route::Retreed)? {
            Attempt::Failed(_) => Attempt::Failed(Box::new(matched)),
            layout => layout,
        })
    }

    /// Projects a nearly closed layout into the exact space and looks at what comes out.
    fn accept(
        &mut self,
        sectors: &Sectors<'_>,
        metric: &Metric,
        matched: MatchedCut,
        closed: PenaltyLayout,
        route: Route,
    ) -> Result<Attempt, SolveError> {
        self.steps += closed.steps;
        let mut space = ExactLayout::new(sectors, metric, &matched)?;
        let y = space.project(sectors.mesh(), &matched.unfolding.cut, &closed.z)?;
        let defects = space.defects(sectors, &y);
        if defects.none() {
            let homotopy_steps = self.steps;
            let layout = SeamlessLayout { matched, space, y, route, homotopy_steps };
            return Ok(Attempt::Layout(Box::new(layout)));
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
    let unfolding = &matched.unfolding;
    let turning = unfolding.turning.iter().zip(&unfolding.isometric);
    for ((&h, &r0), excess) in turning.zip(matched.excess()) {
        let d = excess.abs();
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
    let unfolding = &other.unfolding;
    for &f in &unfolding.tree.order {
        if let Some(h) = unfolding.tree.ground[f] {
            turn[f] = isometric[h];
        }
        if let Some(h) = unfolding.tree.parent[f] {
            turn[f] = turn[h.face()] - isometric[h];
        }
    }
    for (e, &h) in unfolding.turning.iter().enumerate() {
        let right = slit.twin(h).map_or(0.0, |t| turn[t.face()]);
        let lifted = isometric[h] + right - turn[h.face()];
        // `lifted` and the new isometric rotation agree modulo 4; keep the lift of the matchings.
        let shift = (unfolding.isometric[e] - lifted).round() as i32;
        other.matching[e] = regauged[h] + shift;
    }
    other
}
