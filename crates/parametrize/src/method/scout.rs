//! Cones found on a coarser mesh.
//!
//! Where cones have to be, and how many are worth their price, is a matter of the shape at large. A mesh of a quarter of
//! the triangles knows it as well, and all that looks for cones takes a quarter of the time there; its vertices are
//! some of the mesh's own.

use super::domain::Domain;
use super::lay_out::lay_out_as_given;
use super::log::StageLog;
use super::relaxed::RelaxedLayout;
use super::start::repaired;
use super::{MapOptions, MethodError, Start, lay_out_directly};
use crate::cut::{FramedCut, MatchedCut, Unfolding};
use crate::layout::ladder::LayoutEffort;
use crate::progress::{Stage, Watch, unless_cancelled};
use crate::rounding::{Holonomy, Rounding, RoundingStats, RoundingStrategy};
use num_complex::Complex64;
use seamstress_mesh::coarse::{Coarsening, coarsen};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Geometry, TriMesh, Vertex, VertexData};
use seamstress_parallel::beside;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// What part of the triangles a coarser mesh has, and how many at least and at most.
struct Share {
    share: f64,
    fewest: usize,
    most: usize,
}

const USUAL: Share = Share { share: 0.25, fewest: 4000, most: 40_000 };
const FAST: Share = Share { share: 0.08, fewest: 2000, most: 20_000 };

impl Share {
    fn new(options: &MapOptions) -> Self {
        if options.fast { FAST } else { USUAL }
    }

    /// The number of triangles of a mesh coarser than one of so many.
    fn of(&self, faces: usize) -> usize {
        ((self.share * faces as f64) as usize).clamp(self.fewest, self.most)
    }
}
/// A vertex with more curvature than this (radians) is nearer to a cone than to none: it stays.
const SPIKE: f64 = FRAC_PI_4;
/// By so much a surplus of index has to fall at least, against rounding errors.
const ROUNDING: f64 = 1e-9;
/// The bias against cones, as a part of the one asked for: a coarser mesh has fewer places for cones as it is.
const BIAS: f64 = 0.2;
/// A layout has 0.75 to 1 times the excess energy of one of a coarser mesh with the same cones.
const TRUST: f64 = 1.3;

/// A relaxed layout with the cones of a coarser mesh.
pub(super) struct Scouted {
    layout: RelaxedLayout,
    /// Of the rounding of the coarser mesh.
    stats: RoundingStats,
    /// Whether it is as good as that of the coarser mesh lets expect, or has to do.
    is_as_expected: bool,
}

/// What a mesh is laid out as: in a domain, after a rounding.
pub(super) type LaidOut<'m> = (Domain<'m>, RoundingStats, RelaxedLayout);

impl Scouted {
    /// This layout if it is as good as was expected; else the better one of it and another way to lay the mesh out.
    ///
    /// # Errors
    /// When the caller asks to stop on that way.
    pub(super) fn or_better<'m>(
        self,
        domain: Domain<'m>,
        other: impl FnOnce(Domain<'m>) -> Result<LaidOut<'m>, MethodError>,
    ) -> Result<LaidOut<'m>, MethodError> {
        if !self.is_as_expected {
            match unless_cancelled(other(domain.clone()))? {
                Ok(better) if better.2.excess() < self.layout.excess() => return Ok(better),
                Ok(_) | Err(_) => {}
            }
        }
        Ok((domain, self.stats, self.layout))
    }
}

/// A layout with the cones of a coarser mesh; none if there is none, or where nothing is gained by it: where the mesh is
/// small, where features or directions have to be known exactly, and where cones are given.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn scout(
    domain: &Domain<'_>,
    unfolding: &Unfolding,
    start: &Start,
    options: &MapOptions,
    log: &mut StageLog,
    watch: &mut Watch<'_, '_>,
) -> Result<Option<Scouted>, MethodError> {
    if !is_worthwhile(domain, start, options) {
        return Ok(None);
    }
    let (sectors, metric) = (&domain.sectors, &domain.metric);
    // The fine mesh will need it, and no other work is as hard to share.
    let mut holonomy = None;
    let coarse = beside(
        || holonomy = Some(Holonomy::new(sectors, metric, None)),
        || coarse_cones(domain, options, log, watch),
    );
    let Some(Coarse { stats, excess, index }) = coarse? else { return Ok(None) };
    log.enter(Stage::Layout, watch)?;
    let index = settled_at_spikes(domain, index);
    let matched = MatchedCut::with_indices(sectors, metric, unfolding.clone(), &index);
    let frames = vec![Complex64::ONE; domain.mesh().n_faces()];
    let placed = Rounding { start: FramedCut { matched, frames }, stats };
    let Ok(Rounding { start, stats }) = repaired(domain, placed) else { return Ok(None) };
    watch.pulse()?;
    let Some(holonomy) = holonomy else { return Ok(None) };
    let start = holonomy?.fix(start);
    let Ok(layout) = lay_out_as_given(domain, &start, options, watch)? else { return Ok(None) };
    log.count(layout.iterations);
    let is_as_expected = options.fast || layout.excess() <= TRUST * excess;
    Ok(Some(Scouted { stats, is_as_expected, layout }))
}

fn is_worthwhile(domain: &Domain<'_>, start: &Start, options: &MapOptions) -> bool {
    let n_faces = domain.mesh().n_faces();
    // Smaller meshes are as coarse as need be.
    n_faces >= 2 * Share::new(options).of(n_faces)
        && !domain.any_aligned()
        && domain.guide.is_none()
        && domain.lengthening == 0.0
        && start.leaves_cones_free()
        && options.cone_price != Some(0.0)
        && options.rounding.strategy == RoundingStrategy::ConeBias
}

/// What is known of a coarser mesh.
struct Coarse {
    /// Of its rounding.
    stats: RoundingStats,
    /// The excess energy of its layout.
    excess: f64,
    /// Its cones, as indices of all vertices of the mesh itself (quarters).
    index: VertexData<i32>,
}

/// Lays out a coarser mesh; none if it has no layout.
///
/// # Errors
/// When the caller asks to stop.
fn coarse_cones(
    domain: &Domain<'_>,
    options: &MapOptions,
    log: &mut StageLog,
    watch: &mut Watch<'_, '_>,
) -> Result<Option<Coarse>, MethodError> {
    let mesh = domain.mesh();
    let faces: Vec<[u32; 3]> = mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.0)).collect();
    let n_faces = Share::new(options).of(faces.len());
    let Geometry { positions, sizes, .. } = domain.geometry;
    let curvature = domain.metric.curvature(mesh);
    let is_spike = |&v: &Vertex| !mesh.is_boundary(v) && curvature[v].abs() > SPIKE;
    let spikes: Vec<u32> = mesh.vertices().filter(is_spike).map(|v| v.0).collect();
    let Coarsening { vertices, faces, .. } = coarsen(positions, &faces, n_faces, &spikes);
    watch.pulse()?;
    let Ok(coarse) = TriMesh::from_faces(vertices.len(), &faces) else { return Ok(None) };
    let positions: Vec<[f64; 3]> = of_vertices(&vertices, positions);
    let sizes = sizes.map(|sizes| of_vertices(&vertices, sizes));
    let geometry = Geometry { positions: &positions, sizes: sizes.as_deref(), directions: None };
    let metric = geometry.metric(&coarse);
    let mut options = *options;
    options.rounding.cone_bias *= BIAS;
    let there = Domain::new(&coarse, geometry, &metric, EdgeSet::new(&coarse, []), &options);
    let unfolding = there.unfold();
    // The barrier, which costs most, would tell less than it takes.
    let effort = LayoutEffort::Brief;
    let laid_out = lay_out_directly(there, unfolding, effort, &Start::Mesh, &options, log, watch);
    let Ok((there, stats, layout)) = unless_cancelled(laid_out)? else { return Ok(None) };
    let found = layout.layout.matched.sector_indices(&there.sectors, &there.metric);
    let mut index = VertexData::filled(mesh.n_vertices(), 0);
    vertices.iter().zip(found.iter()).for_each(|(&v, &k)| index[Vertex(v)] = k);
    Ok(Some(Coarse { stats, excess: layout.excess(), index }))
}

/// Indices that were found for somewhat other curvatures, moved to or from spikes along edges as long as the two ends come
/// nearer to their own curvatures.
///
/// Spikes stay when a mesh is made coarser, but what lies between those next to each other does not.
fn settled_at_spikes(domain: &Domain<'_>, mut index: VertexData<i32>) -> VertexData<i32> {
    let (mesh, curvature) = (domain.mesh(), domain.metric.curvature(domain.mesh()));
    let surplus = |index: i32, v: Vertex| f64::from(index) - curvature[v] / FRAC_PI_2;
    let is_inner = |v: Vertex| !mesh.is_boundary(v);
    let mut waiting: Vec<Vertex> =
        mesh.vertices().filter(|&v| index[v] != 0 && is_inner(v)).collect();
    while let Some(v) = waiting.pop() {
        for w in mesh.outgoing(v).map(|h| mesh.tip(h)).filter(|&w| is_inner(w)) {
            let more = surplus(index[v], v) - surplus(index[w], w);
            let is_at_spike = [v, w].iter().any(|&v| curvature[v].abs() > SPIKE);
            // The sum of the squares falls.
            if is_at_spike && more.abs() > 1.0 + ROUNDING {
                let unit = more.signum() as i32;
                index[v] -= unit;
                index[w] += unit;
                waiting.extend([w, v]);
                break;
            }
        }
    }
    index
}

fn of_vertices<T: Copy>(vertices: &[u32], all: &[T]) -> Vec<T> {
    vertices.iter().map(|&v| all[v as usize]).collect()
}
