//! The search for the integers of one component: grid by grid, rounding by rounding, nothing learned twice.

use crate::certificate::IntegerGridMap;
use crate::error::{QuantizationFailure, Refusal};
use crate::farkas::farkas_cuts;
use crate::layout::SeamlessLayout;
use crate::obstacles::Obstacles;
use crate::options::{GridSize, QuantizeOptions, RoundingMethod};
use crate::path::{Advance, advance};
use crate::rounding::{
    Constraint, HOPELESS, ReducedEnergy, Rounding, RoundingProblem, improve, round, round_greedily,
};
use crate::stats::QuantizationStats;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Metric};
use seamstress_parametrize::energy::SymmetricDirichlet;
use seamstress_parametrize::layout::newton::{NewtonOptions, minimize};
use seamstress_parametrize::map::SeamlessMap;
use seamstress_parametrize::progress::{Cancelled, Watch};
use std::collections::BTreeSet;
use web_time::Instant;

/// What a caller decides on during the search.
pub trait Decisions {
    /// Whether a component's map will do beyond its certificate, given one UV per corner; if not, the search goes on with
    /// another grid.
    ///
    /// # Errors
    /// [`Refusal`] if it will not.
    fn accept(&mut self, piece: &Component, corner_uvs: &[[f64; 2]]) -> Result<(), Refusal> {
        let _ = (piece, corner_uvs);
        Ok(())
    }

    /// Whether to go on, with finer grids and for longer, where a brief search for a component has found no map; why not
    /// is told in elements of the whole mesh.
    fn goes_on(&mut self, failure: &QuantizationFailure) -> bool {
        let _ = failure;
        true
    }
}

/// Accepts every map, and always goes on.
impl Decisions for () {}

/// Cells tried before finer ones, as shares of the area asked for: all make the number of quads asked for
/// within a few percent, but other integers are near.
const NEARBY: [f64; 7] = [1.0, 0.98, 1.02, 0.99, 1.01, 0.97, 1.03];
/// How many of them where there is a map of another size.
const FEW_NEARBY: usize = 3;
/// What the area of a cell falls by when the grid is made finer.
const REFINEMENT: f64 = 1.1;
/// Finer grids tried, as powers of that: small steps first, since the number of quads asked for is missed by them.
const REFINEMENTS: [i32; 13] = [1, 2, 3, 4, 5, 6, 8, 11, 14, 18, 24, 32, 42];
/// The finest of them that a brief search tries.
const FINEST_BRIEFLY: f64 = 0.8;
/// What the area of a cell falls by at least from one grid to the next where grids take more than a brief search.
const COARSE_REFINEMENT: f64 = 1.4;
/// Passes of roundings that a brief search is worth.
const BRIEF_EFFORT: f64 = 20.0;
/// Passes after which the caller is asked where paths to the integers are blocked.
const BLOCKED_EFFORT: f64 = 30.0;
/// The part of the work that a component is worth that is spent on further sizes.
const SIZES_SHARE: f64 = 0.2;
/// Lines shorter than this had to get much longer, grid units.
const SHORT_LINE: f64 = 0.5;
/// Roundings on one grid, each but the first with the cuts that the one before has taught.
const MOST_ROUNDINGS: usize = 14;
/// Constraints times coordinates of a usual pass of a rounding; a larger one counts as so many of these, since that is what
/// its time is proportional to.
const USUAL_ENTRIES: f64 = 5e5;
/// Faces on which a move along a path, with its centring, takes as long as a usual pass of a rounding.
const USUAL_FACES: f64 = 4e4;
/// Cells of a closed component at a minimum, however coarse the grid asked for: those of a cube with two by two on each
/// side, so that what is smaller than a cell keeps a shape.
const FEWEST_CELLS: f64 = 24.0;
/// Cells of an open component at a minimum.
const FEWEST_OPEN_CELLS: f64 = 4.0;
/// The finish with the integers held: a few Newton steps, since the path ends near the minimum.
const POLISH: NewtonOptions = NewtonOptions { max_iterations: 20, tolerance: 1e-5 };
/// Slack of the triangle inequality, in mean edge lengths, of the metric for meshes with triangles that have no area:
/// most triangles become nearly regular.
const SLACK: f64 = 0.3;

/// A component on a grid.
#[derive(Debug, Clone)]
pub(crate) struct Placement {
    /// One per corner, grid units.
    pub(crate) corner_uvs: Vec<[f64; 2]>,
    /// Width of their box, a whole number; the box begins at the column asked for.
    pub(crate) columns: i64,
    /// Area of the map, grid units.
    pub(crate) quads: f64,
    /// Edge length of a cell, mesh units.
    cell: f64,
    /// That of the cells asked for.
    asked: f64,
    /// Why these would not do, if so.
    refined_because: Option<String>,
}

/// Integers that the layout has reached.
#[derive(Debug, Clone)]
struct Candidate {
    /// Size of a cell, in the layout's units.
    h: f64,
    /// The held unknowns.
    held: Vec<i64>,
    /// All unknowns there, in the layout's units.
    y: Vec<f64>,
}

/// A component with everything the search knows about it.
pub(crate) struct ComponentSearch<'a> {
    piece: &'a Component,
    options: &'a QuantizeOptions,
    layout: SeamlessLayout<'a>,
    energy: ReducedEnergy,
    obstacles: Obstacles,
    /// The coarsest grid with a map.
    coarsest: Option<Candidate>,
    /// With the work done so far.
    stats: QuantizationStats,
    /// Passes of roundings so far and moves along paths, in usual passes.
    work: f64,
    /// The work after which the search ends.
    most_work: f64,
    /// Whether the caller is still to be asked if the search is to go on.
    is_asking: bool,
}

impl<'a> ComponentSearch<'a> {
    /// Reads the part of a seamless map that lies on a component, and reduces the energy around it to the integers.
    ///
    /// # Errors
    /// [`QuantizationFailure`].
    pub(crate) fn new(
        piece: &'a Component,
        metric: &Metric,
        map: &SeamlessMap,
        aligned: &EdgeSet,
        options: &'a QuantizeOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Self, QuantizationFailure> {
        let clock = Instant::now();
        let mut read = |metric: &Metric| {
            SeamlessLayout::new(&piece.mesh, metric, map, aligned, options.alignment, watch)
        };
        let opened = metric.opened(&piece.mesh);
        let mut layout = match read(opened.as_ref().unwrap_or(metric)) {
            // Triangles too thin for arithmetic open up where every edge is longer.
            Err(QuantizationFailure::Unreadable) => {
                let by = metric.lengthening(&piece.mesh, SLACK);
                read(&metric.lengthened(&piece.mesh, by))?.with_size_of(map)
            }
            layout => layout?,
        };
        let energy = match options.rounding {
            RoundingMethod::Constrained => {
                layout.reduced_energy(matches!(options.size, GridSize::Quads(_)), watch)?
            }
            RoundingMethod::Greedy => layout.reduced_dirichlet(watch)?,
        };
        let obstacles = Obstacles::new(&layout, metric)?;
        let stats = QuantizationStats {
            faces: piece.mesh.n_faces(),
            integers: layout.coordinates.len(),
            seconds_reduction: clock.elapsed().as_secs_f64(),
            ..Default::default()
        };
        let (coarsest, work, most_work, is_asking) = (None, 0.0, options.effort as f64, true);
        Ok(Self {
            piece,
            options,
            layout,
            energy,
            obstacles,
            coarsest,
            stats,
            work,
            most_work,
            is_asking,
        })
    }

    /// Side of a square with the area of the component, mesh units.
    pub(crate) fn side(&self) -> f64 {
        self.layout.side()
    }

    /// The map for cells of a size in mesh units; where there is none, that of a grid nearby, or else the coarsest
    /// one that is found. Its UVs begin at a column.
    ///
    /// Errors only as long as no map has been found: later, the coarsest so far takes the place of one.
    ///
    /// # Errors
    /// [`QuantizationFailure`], of the first grid, in elements of the whole mesh.
    pub(crate) fn place(
        &mut self,
        cell: f64,
        column: i64,
        decisions: &mut dyn Decisions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Placement, QuantizationFailure> {
        let is_greedy = self.options.rounding == RoundingMethod::Greedy;
        let asked = self.cell(cell) / self.layout.unit;
        let finer = REFINEMENTS.iter().map(|&k| REFINEMENT.powi(-k));
        let n_shares = match &self.coarsest {
            _ if is_greedy => 1,
            Some(_) => FEW_NEARBY,
            None => usize::MAX,
        };
        let (mut first, mut is_hopeless, mut last) = (None, false, 1.0);
        for (k, share) in NEARBY.into_iter().chain(finer).take(n_shares).enumerate() {
            if let Some(first) = &first {
                let is_brief = share >= FINEST_BRIEFLY && self.work < BRIEF_EFFORT && !is_hopeless;
                if !is_brief {
                    self.ask(first, decisions);
                }
                if self.is_spent() {
                    break;
                }
            }
            let is_near = match self.work < BRIEF_EFFORT {
                true => is_hopeless && k < NEARBY.len(),
                false => share * COARSE_REFINEMENT > last,
            };
            if k > 0 && is_near {
                continue;
            }
            last = share;
            match self.try_grid(share.sqrt() * asked, column, decisions, watch) {
                Ok(placement) => {
                    let first = first.map(|failure| failure.in_whole(self.piece));
                    return Ok(self.placed(placement, asked, first));
                }
                Err(failure) if !failure.is_of_grid() => return Err(failure.in_whole(self.piece)),
                Err(failure) => {
                    is_hopeless = matches!(failure, QuantizationFailure::TooCoarse { count, .. } if count > HOPELESS);
                    first = first.or(Some(failure));
                }
            }
        }
        let first = first.map(|failure| failure.in_whole(self.piece));
        match &self.coarsest {
            None => Err(first.unwrap_or(QuantizationFailure::Refused(Refusal::default()))),
            Some(coarsest) => Ok(self.placed(self.written(coarsest, column)?, asked, first)),
        }
    }

    /// Whether the search has taken all the work that it is worth.
    pub(crate) fn is_spent(&self) -> bool {
        self.work >= self.most_work
    }

    /// Asks the caller, once and only as long as there is no map, whether to go on after a failure; if not, the search is
    /// worth no more work.
    fn ask(&mut self, failure: &QuantizationFailure, decisions: &mut dyn Decisions) {
        if std::mem::take(&mut self.is_asking)
            && !decisions.goes_on(&failure.clone().in_whole(self.piece))
        {
            self.most_work = self.work;
        }
    }

    /// The size of its cells where a size is asked for, both in mesh units: smaller where the component is not much larger.
    fn cell(&self, asked: f64) -> f64 {
        let fewest = match self.piece.mesh.has_boundary() {
            _ if self.options.rounding == RoundingMethod::Greedy => 1.0,
            true => FEWEST_OPEN_CELLS,
            false => FEWEST_CELLS,
        };
        asked.min(self.side() / f64::sqrt(fewest))
    }

    /// The lines that had to get much longer for cells of a size in mesh units, if there are some.
    pub(crate) fn short_lines(&mut self, cell: f64) -> Option<QuantizationFailure> {
        let h = self.cell(cell) / self.layout.unit;
        let pairs = short_lines(&self.obstacles.problem(&self.layout, &self.energy, h).ok()?);
        let count = pairs.len();
        let failure = QuantizationFailure::TooCoarse { count, pairs }.in_whole(self.piece);
        (count > 0).then_some(failure)
    }

    /// A placement, with what was asked for in its stead.
    fn placed(
        &self,
        placement: Placement,
        asked: f64,
        failure: Option<QuantizationFailure>,
    ) -> Placement {
        let refined_because = failure.map(|failure| failure.to_string());
        Placement { asked: asked * self.layout.unit, refined_because, ..placement }
    }

    /// How a placement was made, with all the work done so far.
    pub(crate) fn stats(&self, placement: Placement) -> QuantizationStats {
        let Placement { quads, cell, asked, refined_because, .. } = placement;
        let refinements = (2.0 * (asked / cell).ln() / REFINEMENT.ln()).round().max(0.0) as usize;
        QuantizationStats { quads, cell, refinements, refined_because, ..self.stats.clone() }
    }

    /// One grid: rounds until the layout reaches the integers, polishes it there, writes it in exact numbers,
    /// certifies it and asks the caller.
    ///
    /// # Errors
    /// [`QuantizationFailure`].
    fn try_grid(
        &mut self,
        h: f64,
        column: i64,
        decisions: &mut dyn Decisions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Placement, QuantizationFailure> {
        self.stats.grids += 1;
        let candidate = match self.options.rounding {
            RoundingMethod::Constrained => self.reach(h, decisions, watch)?,
            RoundingMethod::Greedy => self.follow(h)?,
        };
        let placement = self.written(&candidate, column)?;
        decisions
            .accept(self.piece, &placement.corner_uvs)
            .map_err(QuantizationFailure::Refused)?;
        if self.coarsest.is_none() {
            let further = SIZES_SHARE * self.options.effort as f64;
            self.most_work = self.most_work.min(self.work + further);
            self.is_asking = false;
        }
        if self.coarsest.as_ref().is_none_or(|coarsest| coarsest.h < h) {
            self.coarsest = Some(candidate);
        }
        Ok(placement)
    }

    /// Rounding without any heed to constraints, and the layout at once at the integers.
    fn follow(&mut self, h: f64) -> Result<Candidate, QuantizationFailure> {
        let problem = self.obstacles.problem(&self.layout, &self.energy, h)?;
        let held = self.layout.space.expand(&round_greedily(&problem))?;
        let y = self.layout.follow(&in_layout(&held, h));
        Ok(Candidate { h, held, y })
    }

    /// Rounds until the layout can move to the integers, each time with the cuts that the last path has taught.
    ///
    /// # Errors
    /// [`QuantizationFailure`].
    fn reach(
        &mut self,
        h: f64,
        decisions: &mut dyn Decisions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Candidate, QuantizationFailure> {
        let (mut start, mut tried) = (None, BTreeSet::new());
        let mut failure = QuantizationFailure::Refused(Refusal::default());
        for k in 0..MOST_ROUNDINGS {
            if k > 0 && self.work > BLOCKED_EFFORT {
                self.ask(&failure, decisions);
            }
            if k > 0 && self.is_spent() {
                break;
            }
            let clock = Instant::now();
            let problem = self.obstacles.problem(&self.layout, &self.energy, h)?;
            let size = (problem.constraints.len() * problem.mean.len()) as f64 / USUAL_ENTRIES;
            let size = size.max(1.0);
            let passes = ((self.most_work - self.work) / size).max(1.0) as usize;
            let rounding = round_near(&problem, start.take(), passes, watch)?;
            self.work += size * rounding.passes as f64;
            self.stats.roundings += 1;
            self.stats.second_roundings += usize::from(rounding.is_second);
            self.stats.repairs += usize::from(rounding.is_repaired);
            self.stats.constraints = problem.constraints.len();
            self.stats.seconds_rounding += clock.elapsed().as_secs_f64();
            // What a cut asks for beyond what has failed is a guess, and cells for round curves a wish: integers that miss such
            // alone are worth a try.
            if rounding.violated.count > rounding.violated.cuts {
                // Cuts of other grids may contradict each other here.
                let failure = too_coarse(&problem, &rounding);
                if self.obstacles.forget_cuts() == 0 {
                    return Err(failure);
                }
                continue;
            }
            if !tried.insert(rounding.x.clone()) {
                break;
            }

            let clock = Instant::now();
            let held = self.layout.space.expand(&rounding.x)?;
            let (y, target) = (self.layout.y.clone(), in_layout(&held, h));
            let Advance { y, reached, moves } =
                advance(&mut self.layout.problem, y, &target, watch)?;
            self.work += (moves * self.stats.faces) as f64 / USUAL_FACES;
            self.stats.moves = moves;
            self.stats.seconds_moving += clock.elapsed().as_secs_f64();
            if reached == 1.0 {
                let clock = Instant::now();
                let problem = &mut self.layout.problem;
                let polished = minimize(problem, y, &SymmetricDirichlet, &POLISH, watch)?;
                self.stats.polish = polished.iterations;
                self.stats.seconds_polish += clock.elapsed().as_secs_f64();
                return Ok(Candidate { h, held, y: polished.y });
            }

            let z = self.layout.problem.space().expand(&y);
            let cuts = farkas_cuts(&self.layout.scene(&z), self.layout.problem.triangles())?;
            let face = cuts.first().map_or(0, |cut| cut.face.0);
            let pairs = short_lines(&problem);
            failure = QuantizationFailure::Blocked { face, reached, pairs };
            if cuts.is_empty() {
                break;
            }
            let here = self.layout.space.read(&z).0;
            self.stats.cuts += cuts.len();
            self.obstacles.learn(cuts.into_iter().map(|cut| {
                let rule = cut.beyond(&rounding.x, &here, h);
                (cut, rule)
            }));
            start = Some(rounding.x);
        }
        Err(failure)
    }

    /// A candidate in exact numbers, certified.
    fn written(
        &self,
        candidate: &Candidate,
        column: i64,
    ) -> Result<Placement, QuantizationFailure> {
        let Candidate { h, held, y } = candidate;
        let (corner_uvs, columns) = self.layout.corner_uvs(held, y, *h, column)?;
        let (mesh, aligned) = (&self.piece.mesh, &self.layout.aligned);
        let map =
            IntegerGridMap::certify_aligned(mesh, corner_uvs, aligned, &self.options.tolerance)?;
        let (quads, cell) = (map.certificate().area, h * self.layout.unit);
        let corner_uvs = map.corner_uvs().to_vec();
        Ok(Placement { corner_uvs, columns, quads, cell, asked: cell, refined_because: None })
    }
}

/// Held unknowns in the units of the layout, for cells of size `h`.
fn in_layout(held: &[i64], h: f64) -> Vec<f64> {
    held.iter().map(|&x| x as f64 * h).collect()
}

/// Integers near those that taught the last cut, if there are some that satisfy it too, or else new ones.
fn round_near(
    problem: &RoundingProblem<'_>,
    last: Option<Vec<i64>>,
    passes: usize,
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, Cancelled> {
    if let Some(x) = last {
        let near = improve(problem, x, watch)?;
        if near.violated.count == 0 {
            return Ok(near);
        }
    }
    round(problem, passes, watch)
}

/// Names the lines that a rounding has not kept.
fn too_coarse(problem: &RoundingProblem<'_>, rounding: &Rounding) -> QuantizationFailure {
    let involved = rounding.violated.involved.iter().map(|&i| &problem.constraints[i]);
    QuantizationFailure::TooCoarse { count: rounding.violated.count, pairs: ends_of(involved) }
}

/// The ends of lines that have to get much longer.
fn short_lines(problem: &RoundingProblem<'_>) -> Vec<[u32; 2]> {
    let is_short = |c: &&Constraint| c.minimum > 0 && c.length < SHORT_LINE;
    ends_of(problem.constraints.iter().filter(is_short))
}

/// The pairs of vertices that displacements keep apart, each once.
fn ends_of<'c>(constraints: impl Iterator<Item = &'c Constraint>) -> Vec<[u32; 2]> {
    let ends = constraints.filter_map(|c| c.ends.map(|ends| ends.map(|v| v.0)));
    ends.collect::<BTreeSet<_>>().into_iter().collect()
}
