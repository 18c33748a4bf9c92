//! Mending the worst quads along a surface.

mod restart;

use crate::badness;
use crate::constraints::{Constraints, Domain};
use crate::smooth::SmoothError;
use crate::surface::{Surface, distance_to_triangle};
use crate::vector::{Point, add, cross, dot, norm, scale, sub, unit};
use crate::{QuadConnectivity, QuadMesh};
use seamstress_parallel::prelude::*;
use std::collections::BTreeSet;

/// What to mend.
#[derive(Debug, Clone, PartialEq)]
pub struct MendOptions {
    /// Quads with a corner further from a right angle than this are mended, degrees.
    pub deviation: f64,
    /// How often each vertex of such quads is moved, at most, in each pass; there are four, and one for each new start.
    pub rounds: u32,
    /// Vertices that stay where they are, or on a curve.
    pub constraints: Constraints,
}

impl Default for MendOptions {
    fn default() -> Self {
        Self { deviation: 45.0, rounds: 40, constraints: Constraints::default() }
    }
}

/// A mended mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Mended {
    /// The mesh, with the quads as they were.
    pub mesh: QuadMesh,
    /// Vertices that were moved.
    pub moved: usize,
    /// The largest distance of a vertex from where it was, mesh units.
    pub largest_move: f64,
}

/// The shape of the quads around a vertex is the sum of this power of their corners' badness: high enough
/// for the worst to lead, low enough for the others to have a say.
const POWER: i32 = 8;
/// Lengths tried of a move, as parts of the mean edge at the vertex.
const STEPS: [f64; 4] = [0.4, 0.2, 0.08, 0.03];
/// Directions tried.
const DIRECTIONS: usize = 8;
/// A move has to gain this part of the shape's badness.
const LEAST_GAIN: f64 = 1e-3;
/// The quads around a vertex stay this close to the point it comes from, in mean edges there: no tip or crease is
/// cut off.
const STRAY: f64 = 0.1;
/// The same for quads that nothing else helped, step by step.
const FURTHER_STRAYS: [f64; 2] = [0.4, 1.0];
/// Normals before and after a move have at least this cosine: beyond lies the other side of a thin wall. Quads
/// that nothing else helped may lie on a knife's edge; they may go there.
const OTHER_SIDE: f64 = -0.7;

/// Moves the vertices of badly shaped quads along a surface until their corners are better.
///
/// Where a quad is turned against the surface, or has a corner further from a right angle than asked for,
/// its vertices are moved: each to the best of some points around it, projected to the surface, by the
/// badness of all corners around it. No quad becomes worse than it was, or than the bound, and the quads
/// stay near the point each vertex comes from. All other vertices stay, and fixed ones; irregular ones and
/// those on curves are moved only when the others did not help, and only quads with reflex corners may
/// then stray further. Quads that are inverted, crossed or reflex after all that start over from elsewhere.
///
/// Vertices are moved one by one in their order: the result does not depend on the number of threads.
///
/// # Errors
/// If the quads are no manifold or the surface has no triangle.
pub fn mend(
    mesh: &QuadMesh,
    surface: (&[Point], &[[u32; 3]]),
    options: &MendOptions,
) -> Result<Mended, SmoothError> {
    let connectivity = mesh.connectivity()?;
    let surface = Surface::new(surface.0, surface.1).map_err(SmoothError::BadSurface)?;
    let n_vertices = mesh.positions().len() as u32;
    let domain = Domain::new(surface, &connectivity, n_vertices as usize, &options.constraints);
    let positions = mesh.positions().to_vec();
    let normals = positions.par_iter().map(|&p| domain.normal(p)).collect();
    let bound = options.deviation.to_radians().sin();
    let (connectivity, quads) = (&connectivity, mesh.quads());
    let homes = mesh.positions();
    let mut state =
        State { connectivity, quads, domain: &domain, homes, positions, normals, bound };

    let is_regular = |v: u32| connectivity.valence(v) == 4 && domain.is_free(v);
    for phase in phases(bound) {
        let may_move = |&v: &u32| !domain.is_fixed(v) && (phase.with_irregular || is_regular(v));
        let movable: BTreeSet<u32> = (0..n_vertices).filter(may_move).collect();
        state.run(&phase, &movable, options.rounds);
    }
    state.restart(options.rounds);
    let moves: Vec<f64> = state
        .positions
        .iter()
        .zip(mesh.positions())
        .map(|(&to, &from)| norm(sub(to, from)))
        .collect();
    Ok(Mended {
        moved: moves.iter().filter(|&&length| length > 0.0).count(),
        largest_move: moves.into_iter().fold(0.0, f64::max),
        mesh: QuadMesh::from_parts(state.positions, mesh.quads().to_vec()),
    })
}

/// A part of the work: which vertices are moved, and how far.
struct Phase {
    with_irregular: bool,
    /// Only vertices around which the badness is more than this are moved.
    worse_than: f64,
    /// The quads around a vertex stay this close to the point it comes from, as a part of the mean edge there.
    stray: f64,
    /// Least cosine of the normals before and after a move.
    least_cosine: f64,
}

/// Irregular vertices come second; what then is still reflex or inverted may stray further.
fn phases(bound: f64) -> [Phase; 4] {
    let near = |with_irregular| Phase {
        with_irregular,
        worse_than: bound,
        stray: STRAY,
        least_cosine: OTHER_SIDE,
    };
    let further = |stray| Phase { worse_than: 1.0, stray, least_cosine: -1.0, ..near(true) };
    let [far, furthest] = FURTHER_STRAYS.map(further);
    [near(false), near(true), far, furthest]
}

struct State<'a> {
    connectivity: &'a QuadConnectivity,
    quads: &'a [[u32; 4]],
    domain: &'a Domain,
    /// Where the vertices come from.
    homes: &'a [Point],
    positions: Vec<Point>,
    /// Of the surface, where the vertices are.
    normals: Vec<Point>,
    bound: f64,
}

/// How bad the corners around a vertex are.
#[derive(Clone, Copy)]
struct Shape {
    worst: f64,
    sum: f64,
}

impl State<'_> {
    /// Moves vertices in rounds, while there is a gain.
    fn run(&mut self, phase: &Phase, movable: &BTreeSet<u32>, rounds: u32) {
        let mut due = movable.clone();
        for _ in 0..rounds {
            let due_now: Vec<u32> = std::mem::take(&mut due).into_iter().collect();
            let is_bad = |&v: &u32| self.worst(v) > phase.worse_than;
            let bad: Vec<u32> = due_now.into_par_iter().filter(is_bad).collect();
            for v in bad {
                if self.improve(v, phase) {
                    // Only where something has changed can be a gain next time.
                    due.extend(self.quads_around(v).flatten().filter(|w| movable.contains(w)));
                }
            }
        }
    }

    fn quads_around(&self, v: u32) -> impl Iterator<Item = [u32; 4]> + '_ {
        self.connectivity.outgoing(v).map(|h| self.quads[(h / 4) as usize])
    }

    fn worst(&self, v: u32) -> f64 {
        self.shape(v, self.positions[v as usize], self.normals[v as usize]).worst
    }

    /// The shape around a vertex, were it elsewhere.
    fn shape(&self, v: u32, at: Point, normal: Point) -> Shape {
        let mut shape = Shape { worst: 0.0, sum: 0.0 };
        for quad in self.quads_around(v) {
            let points = quad.map(|w| if w == v { at } else { self.positions[w as usize] });
            let normals = quad.map(|w| if w == v { normal } else { self.normals[w as usize] });
            for bad in badness::on_surface(points, normals) {
                shape.worst = shape.worst.max(bad);
                shape.sum += bad.powi(POWER);
            }
        }
        shape
    }

    /// Moves a vertex to the best point found near it, if one is better than where it is.
    fn improve(&mut self, v: u32, phase: &Phase) -> bool {
        let (here, normal) = (self.positions[v as usize], self.normals[v as usize]);
        let before = self.shape(v, here, normal);
        let most = before.worst.max(self.bound);
        let mut best = (before.sum * (1.0 - LEAST_GAIN), None);
        let (length, targets) = self.targets(v);
        for target in targets {
            let at = self.domain.nearest(v, target);
            let normal_there = self.domain.normal(at);
            if dot(normal, normal_there) < phase.least_cosine {
                continue;
            }
            let shape = self.shape(v, at, normal_there);
            let is_better = shape.sum < best.0 && shape.worst <= most;
            if is_better && self.stray(v, at) <= phase.stray * length {
                best = (shape.sum, Some((at, normal_there)));
            }
        }
        let Some((at, normal)) = best.1 else { return false };
        self.positions[v as usize] = at;
        self.normals[v as usize] = normal;
        true
    }

    /// The mean length of the edges at a vertex.
    fn mean_edge(&self, v: u32) -> f64 {
        let here = self.positions[v as usize];
        let edge = |w: u32| norm(sub(self.positions[w as usize], here));
        let share = 1.0 / self.connectivity.neighbours(v).count() as f64;
        share * self.connectivity.neighbours(v).map(edge).sum::<f64>()
    }

    /// How far the quads around a vertex, were it elsewhere, are from the point it comes from.
    fn stray(&self, v: u32, at: Point) -> f64 {
        let halves = self.quads_around(v).flat_map(|quad| {
            let first = quad.iter().position(|&w| w == v).unwrap_or(0);
            let [b, c, d] = [1, 2, 3].map(|k| self.positions[quad[(first + k) % 4] as usize]);
            [[at, b, c], [at, c, d]]
        });
        let home = self.homes[v as usize];
        halves.map(|half| distance_to_triangle(home, half)).fold(f64::INFINITY, f64::min)
    }

    /// The mean edge at a vertex, and points to try: some around it in its tangent plane, and the mean of its
    /// neighbours.
    fn targets(&self, v: u32) -> (f64, Vec<Point>) {
        let here = self.positions[v as usize];
        let neighbours: Vec<Point> = self
            .connectivity
            .neighbours(v)
            .map(|w| sub(self.positions[w as usize], here))
            .collect();
        let share = 1.0 / neighbours.len() as f64;
        let length = self.mean_edge(v);
        let mean = scale(neighbours.iter().copied().fold([0.0; 3], add), share);
        let mut targets = vec![add(here, mean), add(here, scale(mean, 0.5))];
        let Some(normal) = unit(self.normals[v as usize]) else { return (length, targets) };
        let along = |d: &Point| unit(sub(*d, scale(normal, dot(*d, normal))));
        let Some(x) = neighbours.iter().find_map(along) else {
            return (length, targets);
        };
        let y = cross(normal, x);
        for k in 0..DIRECTIONS {
            let (sin, cos) = (k as f64 * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
            let direction = add(scale(x, cos), scale(y, sin));
            targets.extend(STEPS.map(|step| add(here, scale(direction, step * length))));
        }
        (length, targets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints::SlideCurve;
    use crate::quality::{Angles, Orientation};
    use seamstress_testkit::{Rng, disk_grid};

    fn grid() -> (Vec<Point>, Vec<[u32; 3]>, Vec<[u32; 4]>) {
        let grid = disk_grid(8, 8);
        let faces = grid.faces.chunks(2);
        let quads = faces.map(|pair| [pair[0][0], pair[0][1], pair[0][2], pair[1][2]]).collect();
        (grid.positions, grid.faces, quads)
    }

    fn angles(mesh: &QuadMesh) -> Angles {
        Angles::new(mesh.positions(), mesh.quads().iter().map(<[u32; 4]>::as_slice))
    }

    #[test]
    fn a_tangled_grid_is_untangled_and_the_rest_stays() {
        let (positions, faces, quads) = grid();
        let surface = (positions.as_slice(), faces.as_slice());
        let side = 0.25;
        for seed in 0..20 {
            let mut rng = Rng::new(seed);
            let mut tangled = positions.clone();
            let centre = positions.iter().position(|p| p[0] == 0.0 && p[1] == 0.0).unwrap();
            for x in &mut tangled[centre][..2] {
                *x += side * (3.0 * rng.unit() - 1.5);
            }
            let before = QuadMesh::new(tangled, quads.clone()).unwrap();
            let mended = mend(&before, surface, &MendOptions::default()).unwrap();
            let after = angles(&mended.mesh);
            assert!(after.min >= 44.9 && after.max <= 135.1, "{seed}: {after:?}");
            let polygons = mended.mesh.quads().iter().map(<[u32; 4]>::as_slice);
            let side = Orientation::new(mended.mesh.positions(), polygons, surface).unwrap();
            assert_eq!(side, Orientation::default());
            // Only around the centre, of 81.
            assert!(mended.moved <= 25, "{seed}: {} moved", mended.moved);
        }
    }

    #[test]
    fn knots_that_single_moves_do_not_open_are_opened() {
        let (positions, faces, quads) = grid();
        let surface = (positions.as_slice(), faces.as_slice());
        let inner = |p: &Point| p[0].abs() < 0.6 && p[1].abs() < 0.6;
        let block: Vec<usize> = (0..positions.len()).filter(|&v| inner(&positions[v])).collect();
        for seed in 0..5 {
            let mut knotted = positions.clone();
            for (k, &from) in Rng::new(seed).permutation(block.len()).iter().enumerate() {
                knotted[block[k]] = positions[block[from as usize]];
            }
            let knotted = QuadMesh::new(knotted, quads.clone()).unwrap();
            let mended = mend(&knotted, surface, &MendOptions::default()).unwrap().mesh;
            let polygons = mended.quads().iter().map(<[u32; 4]>::as_slice);
            let side = Orientation::new(mended.positions(), polygons, surface).unwrap();
            // Of 17 at first.
            assert_eq!(side.faults(), 0, "{seed}");
        }
    }

    #[test]
    fn good_quads_and_fixed_vertices_stay() {
        let (positions, faces, quads) = grid();
        let surface = (positions.as_slice(), faces.as_slice());
        let good = QuadMesh::new(positions.clone(), quads.clone()).unwrap();
        let mended = mend(&good, surface, &MendOptions::default()).unwrap();
        assert_eq!((mended.mesh, mended.moved, mended.largest_move), (good, 0, 0.0));
        let mut tangled = positions.clone();
        let centre = positions.iter().position(|p| p[0] == 0.0 && p[1] == 0.0).unwrap();
        tangled[centre][0] += 0.3;
        let bad = QuadMesh::new(tangled, quads.clone()).unwrap();
        let fixed = quads.iter().flatten().copied().collect();
        let constraints = Constraints { fixed, ..Constraints::default() };
        let options = MendOptions { constraints, ..MendOptions::default() };
        assert_eq!(mend(&bad, surface, &options).unwrap().moved, 0);
    }

    #[test]
    fn vertices_on_a_curve_slide_along_it() {
        let (positions, faces, quads) = grid();
        let surface = (positions.as_slice(), faces.as_slice());
        // The middle row, and the lower side of the rim.
        for height in [0.0, -1.0] {
            let row: Vec<u32> =
                (0..).zip(&positions).filter(|(_, p)| p[1] == height).map(|(v, _)| v).collect();
            let points = vec![[-1.0, height, 0.0], [1.0, height, 0.0]];
            let (ends, inner) = ([row[0], row[8]], row[1..8].to_vec());
            let middle = row[4];
            let mut bad = positions.clone();
            // Past the next one.
            bad[middle as usize][0] += 0.3;
            let bad = QuadMesh::new(bad, quads.clone()).unwrap();
            let curves = vec![SlideCurve { points, vertices: inner.clone() }];
            let constraints = Constraints { fixed: ends.to_vec(), curves };
            let options = MendOptions { constraints, ..MendOptions::default() };
            let mended = mend(&bad, surface, &options).unwrap().mesh;
            let after = angles(&mended);
            assert!(angles(&bad).max > 140.0 && after.max <= 135.1, "{after:?}");
            let at = |&v: &u32| mended.positions()[v as usize];
            assert!(inner.iter().all(|v| at(v)[1] == height));
            assert!(ends.iter().all(|v| at(v) == positions[*v as usize]));
        }
    }

    #[test]
    fn tips_are_not_cut_off() {
        // A pyramid whose sides are cut into grids, one line slanted; its apex is the only vertex on top.
        let apex = [0.0, 0.0, 3.0];
        let n = 4i32;
        let mut positions = Vec::new();
        for y in -n..=n {
            for x in -n..=n {
                let height = 3.0 * (1.0 - f64::from(x.abs().max(y.abs())) / f64::from(n));
                positions.push([f64::from(x), f64::from(y), height]);
            }
        }
        let at = |x: i32, y: i32| ((y + n) * (2 * n + 1) + x + n) as u32;
        let cells = (-n..n).flat_map(|y| (-n..n).map(move |x| (x, y)));
        let quads: Vec<[u32; 4]> =
            cells.map(|(x, y)| [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]).collect();
        let base = [[-4.0, -4.0, 0.0], [4.0, -4.0, 0.0], [4.0, 4.0, 0.0], [-4.0, 4.0, 0.0], apex];
        let sides = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        positions[at(1, 0) as usize] = [0.1, 0.0, 2.925];
        let bad = QuadMesh::new(positions, quads).unwrap();
        let mended = mend(&bad, (&base, &sides), &MendOptions::default()).unwrap();
        let (before, after) = (angles(&bad), angles(&mended.mesh));
        assert!(before.max > 138.0 && after.max <= 135.1, "{before:?} {after:?}");
        // The apex may slide, but not off the top.
        let at = |v: u32| mended.mesh.positions()[v as usize];
        let halves =
            mended.mesh.quads().iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
        let gaps = halves.map(|half| distance_to_triangle(apex, half.map(at)));
        let gap = gaps.fold(f64::INFINITY, f64::min);
        assert!(gap < 0.2, "{gap}");
    }

    #[test]
    fn what_cannot_be_mended_is_refused() {
        let (positions, faces, quads) = grid();
        let mesh = QuadMesh::new(positions.clone(), quads).unwrap();
        let error = mend(&mesh, (&positions, &[]), &MendOptions::default()).unwrap_err();
        assert!(matches!(error, SmoothError::BadSurface(_)), "{error}");
        let bow = QuadMesh::new(vec![[0.0; 3]; 7], vec![[0, 1, 2, 3], [2, 4, 5, 6]]).unwrap();
        let error = mend(&bow, (&positions, &faces), &MendOptions::default()).unwrap_err();
        assert!(matches!(error, SmoothError::NoManifold(_)), "{error}");
    }
}
