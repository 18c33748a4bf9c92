//! Feature edges that no map can align, or only at a price nobody wants to pay.

use super::sectors::Sectors;
use crate::ordered::Ordered;
use seamstress_mesh::features::{EdgeSet, dihedral_angle};
use seamstress_mesh::{Face, Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData};
use std::f64::consts::FRAC_PI_2;

/// Why a feature edge is not aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ReleaseReason {
    /// All three edges of a triangle were to be aligned: it would have to be a point.
    ThreeInTriangle,
    /// It made a sector of less than a fifth of a quarter turn with another edge, which would have to
    /// open to a whole one.
    Needle,
    /// It made a sector with too few triangles for its angle.
    Cap,
    /// The layout had flipped triangles or wrong angles near it.
    NoLayout,
    /// The map that was given does not follow it.
    NotInMap,
    /// Lines of the grid asked for would meet there that have to stay apart.
    Crowded,
    /// Quads are symmetric, and no feature is at its image on the side that was made.
    OneSided,
}

impl std::fmt::Display for ReleaseReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::ThreeInTriangle => "third feature edge of a triangle",
            Self::Needle => "needle between two feature edges",
            Self::Cap => "too few triangles between two feature edges",
            Self::NoLayout => "no layout near it",
            Self::NotInMap => "the map given does not follow it",
            Self::Crowded => "too close to others for the grid",
            Self::OneSided => "no feature at its image on the side that was made",
        })
    }
}

/// A feature edge that is not aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ReleasedFeature {
    /// Its ends.
    pub vertices: [u32; 2],
    /// Why.
    pub reason: ReleaseReason,
}

impl ReleasedFeature {
    /// An edge that is not aligned for a reason.
    pub fn new(vertices: [u32; 2], reason: ReleaseReason) -> Self {
        Self { vertices, reason }
    }
}

/// Sectors narrower than this, in quarters, count as needles: they come from the noise of slivers.
const NEEDLE: f64 = 0.2;

/// Removes features that contradict each other: of three in a triangle the flattest; of the two that bound
/// a needle or a cap the weaker one (dihedral angle times length). Boundary edges go last.
pub(crate) fn drop_conflicts(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    metric: &Metric,
    features: EdgeSet,
) -> (EdgeSet, Vec<ReleasedFeature>) {
    if features.edges().is_empty() {
        return (features, Vec::new());
    }
    let angle = |h| dihedral_angle(mesh, positions, h).unwrap_or(0.0);
    let dihedral: HalfedgeData<f64> = mesh.halfedges().map(angle).collect();
    let flat = |h: &Halfedge| (mesh.twin(*h).is_none(), Ordered(dihedral[*h]));
    let full = mesh.faces().map(Face::halfedges);
    let full = full.filter(|sides| sides.iter().all(|&h| features.contains(h)));
    let flattest: Vec<Halfedge> =
        full.filter_map(|sides| sides.into_iter().min_by_key(flat)).collect();
    let dropped = EdgeSet::new(mesh, flattest);
    let mut released = released(mesh, dropped.edges(), ReleaseReason::ThreeInTriangle);
    let mut kept = features.without(mesh, dropped.edges().iter().copied());
    for reason in [ReleaseReason::Needle, ReleaseReason::Cap] {
        // Each round removes an edge of every bad sector; there are no more rounds than edges.
        loop {
            let weaker = weaker_edges(mesh, metric, &dihedral, &kept, reason);
            if weaker.is_empty() {
                break;
            }
            released.extend(self::released(mesh, &weaker, reason));
            kept = kept.without(mesh, weaker);
        }
    }
    (kept, released)
}

/// Edges that are dropped for a reason, by their ends.
pub(crate) fn released(
    mesh: &TriMesh,
    edges: &[Halfedge],
    reason: ReleaseReason,
) -> Vec<ReleasedFeature> {
    let ends = |h: Halfedge| [mesh.origin(h).0, mesh.tip(h).0];
    edges.iter().map(|&h| ReleasedFeature { vertices: ends(h), reason }).collect()
}

/// The weaker of the two edges of every needle or cap; sectors that share an edge with one before them
/// wait for the next round.
fn weaker_edges(
    mesh: &TriMesh,
    metric: &Metric,
    dihedral: &HalfedgeData<f64>,
    features: &EdgeSet,
    reason: ReleaseReason,
) -> Vec<Halfedge> {
    let sectors = Sectors::new(mesh, metric, features);
    let slit = sectors.slit();
    let curvature = metric.curvature(slit);
    let mut degree = VertexData::filled(mesh.n_vertices(), 0);
    for &h in features.edges() {
        degree[mesh.origin(h)] += 1;
        degree[mesh.tip(h)] += 1;
    }
    let is_bad = |s: Vertex| {
        let quarters = sectors.quarters(s, curvature[s] / FRAC_PI_2);
        let most = sectors.quarters(s, f64::from(sectors.bounds(s).0));
        match reason {
            ReleaseReason::Needle => quarters < NEEDLE,
            _ => quarters.round() > most,
        }
    };
    let mut taken = HalfedgeData::filled(mesh.n_halfedges(), false);
    let mut weaker = Vec::new();
    for s in slit.vertices().filter(|&s| sectors.is_corner(s) && is_bad(s)) {
        let fan: Vec<Halfedge> = slit.outgoing(s).collect();
        let (Some(first), Some(last)) = (fan.first(), fan.last()) else { continue };
        let sides = [*first, last.prev()].map(|h| mesh.twin(h).map_or(h, |t| h.min(t)));
        if sides.iter().any(|&h| taken[h]) {
            continue;
        }
        sides.iter().for_each(|&h| taken[h] = true);
        let rank = |h: &Halfedge| {
            let (o, d) = (mesh.origin(*h), mesh.tip(*h));
            let far = if o == sectors.vertex(s) { d } else { o };
            let leaves_open_end = reason == ReleaseReason::Needle && degree[far] == 2;
            let strength = Ordered(dihedral[*h] * metric.length[*h]);
            (mesh.twin(*h).is_none(), leaves_open_end, strength, *h)
        };
        weaker.extend(sides.into_iter().min_by_key(rank));
    }
    weaker
}

/// A set of vertices widened by some rings of faces.
pub(crate) fn widened(mesh: &TriMesh, mut set: VertexData<bool>, rings: usize) -> VertexData<bool> {
    for _ in 0..rings {
        let inner = set.clone();
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f);
            if corners.iter().any(|&v| inner[v]) {
                corners.iter().for_each(|&v| set[v] = true);
            }
        }
    }
    set
}

/// Removes the features at the vertices of a set widened by some rings of faces.
pub(crate) fn release_near(
    mesh: &TriMesh,
    near: VertexData<bool>,
    rings: usize,
    features: &EdgeSet,
) -> (EdgeSet, Vec<ReleasedFeature>) {
    let near = widened(mesh, near, rings);
    let touches = |h: &Halfedge| near[mesh.origin(*h)] || near[mesh.tip(*h)];
    let touched: Vec<Halfedge> = features.edges().iter().copied().filter(touches).collect();
    let released = released(mesh, &touched, ReleaseReason::NoLayout);
    (features.without(mesh, touched), released)
}
