//! Untangling of the worst quads along the surface they approximate.
//!
//! Vertices on curves are spaced evenly first ([`evenly_spaced`]). Then quads with a corner far from a right angle, and those turned against the surface, are taken one after the other,
//! each with some rings of quads around it: a [`Patch`]. The movable vertices of a patch minimise a barrier energy of
//! all its corners ([`Energy`]) along the surface, by a quasi-Newton method whose regularisation is lowered step by
//! step ([`untangled`]). A few sweeps over all such quads, from small patches to large ones, bring most of them into
//! shape.

mod descent;
mod energy;
mod patch;
mod score;
#[cfg(test)]
mod tests;

use crate::constraints::{Constraints, Domain};
use crate::smooth::SmoothError;
use crate::spacing::evenly_spaced;
use crate::stretch::{curves, stretches};
use crate::surface::Surface;
use crate::vector::{Point, norm, sub};
use crate::{QuadConnectivity, QuadMesh};
use descent::untangled;
use patch::{CurveEdge, Patch};
use score::worst_corner;
use seamstress_parallel::prelude::*;
use seamstress_parametrize::progress::{Cancelled, Observer, Stage, Watch};
use std::collections::BTreeMap;

/// What to untangle.
#[derive(Debug, Clone, PartialEq)]
pub struct UntangleOptions {
    /// Quads with a corner further from a right angle than this are improved, degrees.
    pub deviation: f64,
    /// Vertices that stay where they are, or on a curve.
    pub constraints: Constraints,
}

impl Default for UntangleOptions {
    fn default() -> Self {
        Self { deviation: 45.0, constraints: Constraints::default() }
    }
}

/// An untangled mesh.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Untangling {
    /// The mesh, with the quads as they were.
    pub mesh: QuadMesh,
    /// Vertices that were moved.
    pub moved: usize,
    /// The largest distance of a vertex from where it was, mesh units.
    pub largest_move: f64,
}

/// How large a patch is, and what it is for.
#[derive(Debug, Clone, Copy)]
struct Reach {
    /// Rings of vertices around the quad that move with its own.
    rings: usize,
    /// How far the quads around a vertex may go from the point it comes from, in mean edges of the patch.
    stray: f64,
    /// Whether every quad beyond the bound is improved, or only those turned against the surface or with a reflex corner.
    for_angles: bool,
}

/// A sweep goes through these. For the sake of an angle no tip or crease is cut off by more than a tenth of an edge;
/// for the sake of validity more is given up, step by step.
const REACHES: [Reach; 5] = [
    Reach { rings: 0, stray: 0.1, for_angles: true },
    Reach { rings: 1, stray: 0.1, for_angles: true },
    Reach { rings: 1, stray: 0.4, for_angles: false },
    Reach { rings: 2, stray: 1.0, for_angles: false },
    Reach { rings: 3, stray: 2.0, for_angles: false },
];
/// Badness of a corner of 180 degrees.
const STRAIGHT: f64 = 1.0;
/// Sweeps, at most. Patches overlap, and one may give another room.
const SWEEPS: usize = 6;

/// Spaces the vertices on curves evenly, and moves those of badly shaped quads along a surface until their corners are
/// better.
///
/// Where edges along a curve differ by more than a factor of two between two vertices that stay, or around a loop along
/// which none does, the vertices slide along the curve, and those around follow, as far as no quad is harmed.
///
/// Quads that are turned against the surface, or have a corner further from a right angle than asked for, are
/// improved together with the quads around them; all other vertices stay, and fixed ones. A patch is changed only
/// if fewer of its quads are inverted or crossed afterwards, or as many and fewer reflex, or as many and fewer too far
/// from a rectangle, or as many and the sum of all corners is clearly better.
///
/// Patches are improved one by one in the order of the quads: the result does not depend on the number of threads.
///
/// # Errors
/// If the quads are no manifold or the surface has no triangle, and where the observer breaks.
///
/// # Source
/// The barrier is that of Garanzha, Kaporin, Kudryavtseva, Protais, Ray and Sokolov 2021, *Foldover-free maps in 50
/// lines of code*, for the corners of quads along a surface.
pub fn untangle(
    mesh: &QuadMesh,
    surface: (&[Point], &[[u32; 3]]),
    options: &UntangleOptions,
    observer: &mut Observer<'_>,
) -> Result<Untangling, SmoothError> {
    untangle_within(mesh, surface, options, &REACHES, observer)
}

fn untangle_within(
    mesh: &QuadMesh,
    surface: (&[Point], &[[u32; 3]]),
    options: &UntangleOptions,
    reaches: &[Reach],
    observer: &mut Observer<'_>,
) -> Result<Untangling, SmoothError> {
    let mut watch = Watch::new(observer, 0, 1);
    watch.enter(Stage::Shaping)?;
    let connectivity = mesh.connectivity()?;
    let surface = Surface::new(surface.0, surface.1).map_err(SmoothError::BadSurface)?;
    let given = mesh.positions();
    let domain = Domain::new(surface, &connectivity, given.len(), &options.constraints);
    let curves = curves(&options.constraints);
    let stretches = stretches(&curves, &domain, &connectivity, given);
    let homes = evenly_spaced(mesh, &connectivity, &domain, &stretches, &mut watch)?;
    let site = |&at: &Point| Site { at, normal: domain.normal(at) };
    let mut state = State {
        connectivity: &connectivity,
        quads: mesh.quads(),
        domain: &domain,
        homes: &homes,
        sites: homes.par_iter().map(site).collect(),
        sides: patch::side_lengths(&connectivity, mesh, &options.constraints),
        curve_edges: patch::curve_edges(&stretches, homes.len()),
        improved: 0,
        moved: vec![0; homes.len()],
        failed: BTreeMap::new(),
    };
    let deviation = options.deviation.to_radians().sin();
    for sweep in 0..SWEEPS {
        watch.tick(sweep as f64 / SWEEPS as f64)?;
        let bound = |reach: &Reach| if reach.for_angles { deviation } else { STRAIGHT };
        let before = state.improved;
        for (number, reach) in reaches.iter().enumerate() {
            state.sweep(number, reach, bound(reach), &mut watch)?;
        }
        if state.improved == before {
            break;
        }
    }
    let positions: Vec<Point> = state.sites.iter().map(|site| site.at).collect();
    let moves = || positions.iter().zip(given).map(|(&to, &from)| norm(sub(to, from)));
    Ok(Untangling {
        moved: moves().filter(|&length| length > 0.0).count(),
        largest_move: moves().fold(0.0, f64::max),
        mesh: QuadMesh::from_parts(positions, mesh.quads().to_vec()),
    })
}

/// Where a vertex is, and the unit normal of the surface there.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Site {
    at: Point,
    normal: Point,
}

/// All quads, and where their vertices are.
struct State<'a> {
    connectivity: &'a QuadConnectivity,
    quads: &'a [[u32; 4]],
    domain: &'a Domain,
    /// Where the vertices come from, evenly spaced.
    homes: &'a [Point],
    sites: Vec<Site>,
    /// The lengths that the sides of each quad should have: of sides 0 and 2, and of sides 1 and 3.
    sides: Vec<[f64; 2]>,
    /// Of each vertex, the edges along curves that start there.
    curve_edges: Vec<Vec<CurveEdge>>,
    /// Patches improved.
    improved: usize,
    /// How many had been improved with the last one that moved a vertex.
    moved: Vec<usize>,
    /// How many had been improved when a quad could not be with a reach: in vain again until something around moves.
    failed: BTreeMap<(u32, usize), usize>,
}

impl State<'_> {
    /// Improves the patches around all quads worse than a bound.
    ///
    /// # Errors
    /// Where the observer breaks.
    fn sweep(
        &mut self,
        number: usize,
        reach: &Reach,
        bound: f64,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), Cancelled> {
        let is_bad = |state: &Self, q: u32| worst_corner(state.corners(q)) > bound;
        let quads: Vec<u32> = (0..self.quads.len() as u32).collect();
        let bad: Vec<u32> = quads.into_par_iter().filter(|&q| is_bad(self, q)).collect();
        for q in bad {
            watch.pulse()?;
            if is_bad(self, q) {
                self.improve(q, number, reach, bound);
            }
        }
        Ok(())
    }

    /// Improves the patch around a quad, unless that was in vain and nothing has moved since.
    fn improve(&mut self, quad: u32, number: usize, reach: &Reach, bound: f64) {
        let patch = Patch::new(self, quad, reach);
        if let Some(&then) = self.failed.get(&(quad, number))
            && patch.vertices.iter().all(|&v| self.moved[v as usize] <= then)
        {
            return;
        }
        let Some(sites) = untangled(self.domain, &patch, bound) else {
            self.failed.insert((quad, number), self.improved);
            return;
        };
        self.improved += 1;
        for (&v, site) in patch.vertices.iter().zip(sites) {
            let v = v as usize;
            if self.sites[v] != site {
                (self.sites[v], self.moved[v]) = (site, self.improved);
            }
        }
    }

    fn corners(&self, quad: u32) -> [Site; 4] {
        self.quads[quad as usize].map(|v| self.sites[v as usize])
    }

    fn quads_around(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        self.connectivity.outgoing(v).map(|h| h / 4)
    }
}
