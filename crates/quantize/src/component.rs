//! An integer map of one connected mesh.

use super::barrier::{Advance, advance};
use super::certificate::IntegerMap;
use super::connections::connections;
use super::faces::{PointFace, point_faces};
use super::gauss::{Gauss, Overflow};
use super::grids::{Care, grids};
use super::isolines::turning_points;
use super::moves::Moves;
use super::outcome::{IntegerFailure, IntegerStats};
use super::rays::ways_to_isolines;
use super::reduced::{Dense, couple, schur_complement};
use super::rounding::{Constraint, Room, RoundingProblem, round_constrained, round_greedily};
use super::scene::{Connection, Scene, distinct};
use super::snap::snap;
use super::space::{GridNeeds, IntegerSpace};
use super::walls::walls;
use super::{IntegerOptions, IntegerRounding};
use num_complex::Complex64;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use seamstress_parametrize::cut::Cut;
use seamstress_parametrize::energy::SymmetricDirichlet;
use seamstress_parametrize::energy::triangles;
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::layout::newton::{NewtonOptions, minimize};
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::map::SeamlessMap;
use seamstress_parametrize::progress::Watch;
use web_time::Instant;

/// Connections of cones shorter than this are constrained, grid units.
const CONSTRAINED_LENGTH: f64 = 2.5;
/// Roundings on one grid, each but the first with the walls that the one before ran into.
const MOST_ROUNDS: usize = 9;
const SHIFT: f64 = 1e-8;
const POLISH: NewtonOptions = NewtonOptions { max_iterations: 20, tolerance: 1e-5 };

/// Corner UVs in grid units, and how they were made.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    /// One per corner.
    pub(super) corner_uvs: Vec<[f64; 2]>,
    /// Width of their box, a whole number; the box begins at the column asked for.
    pub(super) columns: i64,
    /// How.
    pub(super) stats: IntegerStats,
}

/// A component ready to be rounded to any grid.
pub(super) struct IntegerProblem<'a> {
    mesh: &'a TriMesh,
    options: &'a IntegerOptions,
    cut: Cut,
    matching: HalfedgeData<i32>,
    /// The ends of the aligned edges.
    aligned: Vec<[u32; 2]>,
    needs: GridNeeds,
    space: IntegerSpace,
    problem: LayoutProblem,
    /// The unknowns of the seamless map, in mean edge lengths.
    y: Vec<f64>,
    /// Its integral coordinates, not integral as yet.
    coordinates: Vec<f64>,
    matrix: Dense,
    moves: Moves,
    /// Connections and ways to isolines up to a radius.
    near: (f64, Vec<Connection>),
    faces: Vec<PointFace>,
    /// Mesh length of a mean edge.
    unit: f64,
    seconds: f64,
}

impl<'a> IntegerProblem<'a> {
    /// Reads a seamless map of a connected mesh with its aligned edges, and reduces the energy around it to
    /// the integers.
    ///
    /// # Errors
    /// [`IntegerFailure`].
    pub(super) fn new(
        mesh: &'a TriMesh,
        metric: &Metric,
        map: &SeamlessMap,
        aligned: &EdgeSet,
        options: &'a IntegerOptions,
    ) -> Result<Self, IntegerFailure> {
        let start = Instant::now();
        let (layout, mut y) = ExactLayout::from_map(mesh, metric, map)?;
        layout.rescale(&mut y);
        let z = layout.expand(&y);
        let is_cone: VertexData<bool> = layout.index.iter().map(|&k| k != 0).collect();
        let ExactLayout { cut, matching, .. } = layout;
        let needs = grid_needs(mesh, is_cone, aligned, |h| z[cut.wedge[h] as usize]);
        let space = IntegerSpace::new(mesh, &cut, &matching, &needs)?;
        let (coordinates, y) = space.read(&z);
        let (linear, triangles) = (space.linear()?, triangles(mesh, metric, &cut));
        let mut problem = LayoutProblem::with_held(linear, triangles, space.n_free())?;
        let z = problem.space().expand(&y);
        if !problem.value(&SymmetricDirichlet, &z).is_finite() {
            return Err(IntegerFailure::Unreadable);
        }
        match options.rounding {
            IntegerRounding::Constrained => {
                problem.linearize(&SymmetricDirichlet, &z);
            }
            IntegerRounding::Greedy => problem.assemble_dirichlet(),
        }
        problem.factorize(SHIFT)?;
        let matrix = normalized(schur_complement(&problem, &space)?);
        let turning = match aligned.is_empty() {
            true => turned(&coordinates),
            false => vec![0.0; coordinates.len()],
        };
        let moves = Moves::reduced(&matrix, &turning);
        let seconds = start.elapsed().as_secs_f64();
        let scene =
            Scene { mesh, cut: &cut, matching: &matching, needs: &needs, space: &space, z: &z };
        let faces = point_faces(&scene)?;
        let near = (0.0, Vec::new());
        let unit = metric.unit;
        Ok(Self {
            mesh,
            options,
            cut,
            matching,
            aligned: aligned.vertex_pairs(mesh),
            needs,
            space,
            problem,
            y,
            coordinates,
            moves,
            matrix,
            near,
            faces,
            unit,
            seconds,
        })
    }

    /// The problem with the size of the map itself, where the metric's is of no use; UVs in mesh units.
    pub(super) fn with_size_of(mut self, map: &SeamlessMap) -> Self {
        let doubled = |uvs: &[[f64; 2]]| {
            let [a, b, c] = [uvs[0], uvs[1], uvs[2]].map(|[u, v]| Complex64::new(u, v) / self.unit);
            ((b - a).conj() * (c - a)).im
        };
        let area = 0.5 * map.corner_uvs().chunks_exact(3).map(doubled).sum::<f64>();
        self.unit *= area.sqrt() * self.unit / self.side();
        self
    }

    /// Side of a square with the area of the seamless map, mesh units.
    pub(super) fn side(&self) -> f64 {
        let z = self.problem.space().expand(&self.y);
        let doubled = self.problem.triangles().iter().map(|t| t.doubled_area(&z));
        (0.5 * doubled.sum::<f64>()).sqrt() * self.unit
    }

    /// The integer map for cells of a size in mesh units, or of the first other one that works, nearby or,
    /// if it may be, finer; its UVs begin at a column.
    ///
    /// # Errors
    /// [`IntegerFailure`], of the first grid.
    pub(super) fn solve(
        &mut self,
        cell: f64,
        may_be_finer: bool,
        column: i64,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Placed, IntegerFailure> {
        let mut stats = IntegerStats {
            faces: self.mesh.n_faces(),
            integers: self.coordinates.len(),
            seconds_reduction: self.seconds,
            ..Default::default()
        };
        let mut first = None;
        for group in grids(self.options.rounding, may_be_finer) {
            for grid in group {
                (stats.nudges, stats.refinements) = (grid.nudges, grid.refinements);
                let h = grid.share.sqrt() * cell / self.unit;
                match self.attempt(h, grid.care, column, &mut stats, watch) {
                    Ok((corner_uvs, columns)) => {
                        stats.refined_because = first.map(|f: IntegerFailure| f.to_string());
                        return Ok(Placed { corner_uvs, columns, stats });
                    }
                    Err(failure) if !failure.asks_for_finer_grid() => return Err(failure),
                    Err(failure) => {
                        let is_hopeless = failure.is_hopeless();
                        first.get_or_insert(failure);
                        if is_hopeless {
                            break;
                        }
                    }
                }
            }
        }
        Err(first.unwrap_or(IntegerFailure::Unreadable))
    }

    /// One grid: rounds, moves to the integers, polishes, writes in exact numbers and certifies.
    fn attempt(
        &mut self,
        h: f64,
        care: Care,
        column: i64,
        stats: &mut IntegerStats,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(Vec<[f64; 2]>, i64), IntegerFailure> {
        let (held, y) = match self.options.rounding {
            IntegerRounding::Constrained => self.round_and_move(h, care, stats, watch)?,
            IntegerRounding::Greedy => {
                let rounding = self.rounding_problem(h, care)?;
                let held = self.space.expand(&round_greedily(&rounding)?.x)?;
                let y = self.follow(&in_layout(&held, h));
                (held, y)
            }
        };
        let (corner_uvs, columns) = self.corner_uvs(&held, &y, h, column)?;
        let tolerance = &self.options.tolerance;
        let map = IntegerMap::certify_aligned(self.mesh, corner_uvs, &self.aligned, tolerance)?;
        stats.quads = map.certificate().area;
        Ok((map.corner_uvs().to_vec(), columns))
    }

    /// Rounds, moves there and polishes.
    fn round_and_move(
        &mut self,
        h: f64,
        care: Care,
        stats: &mut IntegerStats,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(Vec<i64>, Vec<f64>), IntegerFailure> {
        let mut rounding = self.rounding_problem(h, care)?;
        stats.walls = 0;
        let mut rounds = 1;
        let (held, y) = loop {
            watch.tick(0.1)?;
            let clock = Instant::now();
            let rounded = round_constrained(&rounding, watch)?;
            let held = self.space.expand(&rounded.x)?;
            stats.constraints = rounding.constraints.len();
            stats.restarts += rounded.restarts;
            stats.seconds_rounding += clock.elapsed().as_secs_f64();
            if rounded.violated > 0 {
                return Err(IntegerFailure::Conflict { violated: rounded.violated });
            }
            watch.tick(0.4)?;
            let clock = Instant::now();
            let target = in_layout(&held, h);
            let Advance { y, reached, moves } =
                advance(&mut self.problem, self.y.clone(), &target, watch)?;
            stats.seconds_moving += clock.elapsed().as_secs_f64();
            stats.moves = moves;
            if reached == 1.0 {
                break (held, y);
            }
            let z = self.problem.space().expand(&y);
            let walls = walls(&self.scene(&z), self.problem.triangles())?;
            if rounds == MOST_ROUNDS || walls.is_empty() {
                return Err(IntegerFailure::Blocked { reached });
            }
            rounds += 1;
            stats.walls += walls.len();
            let here = self.space.read(&z).0;
            for wall in &walls {
                let (ways, room) = wall.beyond(&rounded.x, &here, h);
                rounding.add(ways, room);
            }
        };
        let clock = Instant::now();
        let polished = minimize(&mut self.problem, y, &SymmetricDirichlet, &POLISH, watch)?;
        stats.seconds_polish += clock.elapsed().as_secs_f64();
        stats.polish = polished.iterations;
        Ok((held, polished.y))
    }

    fn connections(&self, z: &[Complex64], radius: f64) -> Result<Vec<Connection>, Overflow> {
        let scene = self.scene(z);
        let mut all = connections(&scene, radius)?;
        if !self.aligned.is_empty() {
            all.extend(ways_to_isolines(&scene, radius)?);
            all = distinct(all);
        }
        Ok(all)
    }

    fn rounding_problem(&mut self, h: f64, care: Care) -> Result<RoundingProblem, Overflow> {
        let radius = CONSTRAINED_LENGTH * h;
        if radius > self.near.0 {
            let z = self.problem.space().expand(&self.y);
            self.near = (radius, self.connections(&z, radius)?);
        }
        let mean: Vec<f64> = self.coordinates.iter().map(|x| x / h).collect();
        let short = self.near.1.iter().filter(|c| c.length < radius);
        let constraint = |c: &Connection| {
            let least = match care {
                Care::Cones => 1,
                Care::Manifold => c.least,
            };
            Constraint { least, ..Constraint::new(c, &self.coordinates, h) }
        };
        let constraints: Vec<Constraint> = short.map(constraint).collect();
        let (matrix, moves) = (self.matrix.clone(), self.moves.clone());
        let mut rounding = RoundingProblem { matrix, moves, mean, constraints, spans: Vec::new() };
        for face in self.faces.iter().filter(|face| face.extent < radius) {
            let ways = face.ways.iter().map(|c| Constraint::new(c, &self.coordinates, h));
            rounding.add(ways.collect(), Room::Face);
        }
        Ok(rounding)
    }

    /// A layout of the component.
    fn scene<'s>(&'s self, z: &'s [Complex64]) -> Scene<'s> {
        let (mesh, cut, matching) = (self.mesh, &self.cut, &self.matching);
        Scene { mesh, cut, matching, needs: &self.needs, space: &self.space, z }
    }

    /// Where the free unknowns go when the held ones move to a target and the last factored energy, a
    /// quadratic one, is minimised.
    fn follow(&mut self, target: &[f64]) -> Vec<f64> {
        let held = self.problem.n_free();
        let way: Vec<f64> = target.iter().zip(&self.y[held..]).map(|(t, y)| t - y).collect();
        let mut step = couple(&self.problem, &way);
        step.resize(self.y.len(), 0.0);
        self.problem.solve(&mut step);
        let mut y: Vec<f64> = self.y.iter().zip(&step).map(|(y, s)| y - s).collect();
        y[held..].copy_from_slice(target);
        y
    }

    /// Exact corner UVs in grid units, their box beginning at a column and at row 0, and its width.
    fn corner_uvs(
        &self,
        held: &[i64],
        y: &[f64],
        h: f64,
        column: i64,
    ) -> Result<(Vec<[f64; 2]>, i64), Overflow> {
        let free: Vec<f64> = y[..self.problem.n_free()].iter().map(|x| x / h).collect();
        let z = self.problem.space().expand(y);
        let bound = |start: f64, pick: fn(f64, f64) -> f64, part: fn(&Complex64) -> f64| {
            z.iter().map(part).fold(start, pick) / h
        };
        let (re, im) = (|z: &Complex64| z.re, |z: &Complex64| z.im);
        let [left, bottom] =
            [re, im].map(|part| bound(f64::INFINITY, f64::min, part).floor() as i64);
        let right = bound(f64::NEG_INFINITY, f64::max, re).ceil() as i64;
        let shift = Gauss { re: column, im: 0 }.plus(Gauss { re: left, im: bottom }.negated())?;
        let z = snap(&self.space, held, &free, shift)?;
        let uv = |&w: &u32| [z[w as usize].re, z[w as usize].im];
        Ok((self.cut.wedge.iter().map(uv).collect(), right - left))
    }
}

/// What has to come to lie on the grid: cones, and with aligned edges their corners and isolines.
fn grid_needs(
    mesh: &TriMesh,
    is_cone: VertexData<bool>,
    aligned: &EdgeSet,
    position: impl Fn(Halfedge) -> Complex64,
) -> GridNeeds {
    let mut needs = GridNeeds::cones(is_cone);
    if aligned.is_empty() {
        return needs;
    }
    let turns = turning_points(mesh, aligned, &position);
    mesh.vertices().filter(|&v| turns[v]).for_each(|v| needs.is_point[v] = true);
    if !needs.is_point.iter().any(|&is_point| is_point) {
        // Translations are then free along the isolines: hold a vertex on one of them.
        aligned.edges().iter().take(1).for_each(|&h| needs.is_point[mesh.origin(h)] = true);
    }
    let sides = mesh.halfedges().filter(|&h| aligned.contains(h));
    needs.levels = sides
        .map(|h| {
            let way = position(h.next()) - position(h);
            (h, u32::from(way.re.abs() > way.im.abs()))
        })
        .collect();
    needs
}

/// Real and imaginary parts by turns, turned by a quarter.
fn turned(parts: &[f64]) -> Vec<f64> {
    parts.chunks(2).flat_map(|z| [-z[1], z[0]]).collect()
}

/// Integers in the units of the layout.
fn in_layout(held: &[i64], h: f64) -> Vec<f64> {
    held.iter().map(|&x| x as f64 * h).collect()
}

/// Scaled to a mean diagonal of one.
fn normalized(mut matrix: Dense) -> Dense {
    let n = matrix.order;
    let trace: f64 = (0..n).map(|k| matrix.row(k)[k]).sum();
    if trace > 0.0 {
        let scale = n as f64 / trace;
        matrix.values.iter_mut().for_each(|x| *x *= scale);
    }
    matrix
}
