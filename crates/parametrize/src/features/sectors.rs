//! Sectors: the fans of corners between aligned edges, on which indices live.

use super::bounds::index_bounds;
use super::corners::{CornerRule, CornerTurn, Curves};
use seamstress_linalg::ordering::{Dissection, Graph};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData};
use std::borrow::Cow;
use std::sync::OnceLock;

/// What the layout asks of the angle of a sector.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A vertex no aligned edge ends at: a whole number of quarters, four unless it is a cone.
    Interior,
    /// It touches a boundary edge that is not aligned: anything.
    Free,
    /// The whole fan of a vertex where one aligned edge ends: a whole number of quarters, best four.
    OpenEnd,
    /// The fan between two aligned edges: a whole number of quarters, best the nearest to its angle.
    Corner,
}

/// A mesh slit along its aligned edges.
///
/// A *sector* is a vertex of the slit mesh: the fan of corners between two aligned edges, or a whole
/// vertex where there are none. Cones, corners of the model, corners of the boundary and open ends of
/// features are all sectors whose angle, a whole number of quarters, is not the ordinary one. The *index*
/// of a sector with angle S quarters is 4 - S if it is interior to the slit mesh and 2 - S on its
/// boundary, so that the indices of all sectors follow the same rule of transport: turning one side of
/// an edge against the other by a quarter moves one unit from its origin to its tip.
#[derive(Debug, Clone)]
pub struct Sectors<'m> {
    mesh: &'m TriMesh,
    slit: Cow<'m, TriMesh>,
    vertex: VertexData<Vertex>,
    aligned: HalfedgeData<bool>,
    kind: VertexData<Kind>,
    /// The index that costs nothing.
    wanted: VertexData<CornerTurn>,
    largest_index: i32,
    dissection: OnceLock<Dissection>,
}

/// An edge along which a unit of index can leave a sector.
#[derive(Debug, Clone, Copy)]
pub struct Road {
    /// The sector at its other end.
    pub to: Vertex,
    /// Half-edge of the slit mesh along it.
    pub halfedge: Halfedge,
    /// 1 if the half-edge leads away from the sector, -1 if towards it.
    pub sign: i32,
}

impl<'m> Sectors<'m> {
    /// Nothing aligned: every vertex is a sector, and those on the boundary are free.
    #[must_use]
    pub fn unaligned(mesh: &'m TriMesh) -> Self {
        let kind = |v| if mesh.is_boundary(v) { Kind::Free } else { Kind::Interior };
        Self {
            mesh,
            slit: Cow::Borrowed(mesh),
            vertex: mesh.vertices().collect(),
            aligned: HalfedgeData::filled(mesh.n_halfedges(), false),
            kind: mesh.vertices().map(kind).collect(),
            wanted: VertexData::filled(mesh.n_vertices(), CornerTurn::exactly(0)),
            largest_index: LARGEST_INDEX,
            dissection: OnceLock::new(),
        }
    }

    /// Slits a mesh along its feature edges; the metric tells which angles the corners would like.
    #[must_use]
    pub fn new(mesh: &'m TriMesh, metric: &Metric, features: &EdgeSet) -> Self {
        Self::with_corners(mesh, metric, features, CornerRule::default())
    }

    /// The same with corners by a rule.
    #[must_use]
    pub fn with_corners(
        mesh: &'m TriMesh,
        metric: &Metric,
        features: &EdgeSet,
        rule: CornerRule,
    ) -> Self {
        if features.is_empty() {
            return Self::unaligned(mesh);
        }
        let aligned: HalfedgeData<bool> = mesh.halfedges().map(|h| features.contains(h)).collect();
        let (slit, vertex) = mesh.slit(&aligned);
        let mut degree = VertexData::filled(mesh.n_vertices(), 0);
        for &h in features.edges() {
            degree[mesh.origin(h)] += 1;
            degree[mesh.tip(h)] += 1;
        }
        let is_loose = |h: Halfedge| slit.twin(h).is_none() && !aligned[h];
        let kind = slit.vertices().map(|s| {
            if slit.outgoing(s).any(|h| is_loose(h) || is_loose(h.prev())) {
                return Kind::Free;
            }
            match degree[vertex[s]] {
                0 => Kind::Interior,
                1 => Kind::OpenEnd,
                _ => Kind::Corner,
            }
        });
        let kind: VertexData<Kind> = kind.collect();
        let turn = metric.curvature(&slit);
        let goes_on = slit.vertices().map(|s| kind[s] == Kind::Corner && degree[vertex[s]] == 2);
        let goes_on: VertexData<bool> = goes_on.collect();
        let curves = Curves { slit: &slit, metric, turn: &turn, goes_on: &goes_on };
        let wanted = slit.vertices().map(|s| {
            let (low, high) = bounds(&slit, s);
            match kind[s] {
                Kind::Interior | Kind::Free => CornerTurn::exactly(0),
                Kind::OpenEnd => CornerTurn::exactly(-2).clamp(low, high),
                Kind::Corner => curves.quarters(s, rule).clamp(low, high),
            }
        });
        let wanted = wanted.collect();
        let slit = Cow::Owned(slit);
        let (largest_index, dissection) = (LARGEST_INDEX, OnceLock::new());
        Self { mesh, slit, vertex, aligned, kind, wanted, largest_index, dissection }
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &'m TriMesh {
        self.mesh
    }

    /// The mesh slit along the aligned edges; its vertices are the sectors, its half-edges and faces are
    /// those of the mesh.
    #[must_use]
    pub fn slit(&self) -> &TriMesh {
        &self.slit
    }

    /// An order of the vertices of the mesh in which factors of its systems stay sparse.
    pub(crate) fn dissection(&self) -> &Dissection {
        let edges = || self.mesh.edges().map(|h| (self.mesh.origin(h).0, self.mesh.tip(h).0));
        let graph = || Graph::from_edges(self.mesh.n_vertices(), edges());
        self.dissection.get_or_init(|| Dissection::new(&graph()))
    }

    /// An elimination order of the sectors, for systems that couple the ends of edges.
    pub(crate) fn order(&self) -> Vec<u32> {
        let lies = self.vertex.enumerate().map(|(s, v)| (s.0, v.0));
        self.dissection().induced(self.vertex.len(), lies)
    }

    /// An elimination order of `n` unknowns, for systems that couple faces across edges; the faces come first among them.
    pub(crate) fn order_of_faces(&self, n: usize) -> Vec<u32> {
        // A face is where its two corners are that go first.
        let dissection = self.dissection();
        let corners = self.mesh.faces().flat_map(|f| {
            let mut corners = self.mesh.face_vertices(f).map(|v| v.0);
            corners.sort_unstable_by_key(|&v| dissection.place(v));
            [(f.0, corners[0]), (f.0, corners[1])]
        });
        dissection.induced(n, corners)
    }

    /// The vertex of the mesh a sector is a part of.
    #[must_use]
    pub fn vertex(&self, sector: Vertex) -> Vertex {
        self.vertex[sector]
    }

    /// Whether the edge of a half-edge is aligned.
    #[inline]
    #[must_use]
    pub fn is_aligned(&self, h: Halfedge) -> bool {
        self.aligned[h]
    }

    /// All aligned half-edges, ascending.
    pub fn aligned(&self) -> impl Iterator<Item = Halfedge> + '_ {
        self.aligned.enumerate().filter(|(_, aligned)| **aligned).map(|(h, _)| h)
    }

    /// The interior aligned edges by their half-edges on both sides.
    pub fn aligned_pairs(&self) -> impl Iterator<Item = [Halfedge; 2]> + '_ {
        let pair = |h| self.mesh.twin(h).filter(|&t| h < t).map(|t| [h, t]);
        self.aligned().filter_map(pair)
    }

    /// Whether any edge is aligned.
    #[must_use]
    pub fn any_aligned(&self) -> bool {
        matches!(self.slit, Cow::Owned(_))
    }

    /// Whether the angle of a sector may be anything.
    #[inline]
    #[must_use]
    pub fn is_free(&self, sector: Vertex) -> bool {
        self.kind[sector] == Kind::Free
    }

    /// Whether a sector lies between two aligned edges (and is not free).
    #[inline]
    #[must_use]
    pub fn is_corner(&self, sector: Vertex) -> bool {
        self.kind[sector] == Kind::Corner
    }

    /// The index at which a sector costs nothing: zero for an ordinary vertex, that nearest to its own
    /// angle for a corner, a full turn for an open end.
    #[inline]
    #[must_use]
    pub fn preferred(&self, sector: Vertex) -> i32 {
        self.wanted[sector].nearest
    }

    /// The least and the largest index that cost nothing: more than one where the angle of a corner is about as near to
    /// either.
    #[inline]
    #[must_use]
    pub fn preferences(&self, sector: Vertex) -> [i32; 2] {
        self.wanted[sector].range
    }

    /// How far each sector is from flat, radians: an ordinary vertex from a full turn, one at a feature from
    /// a half; zero where it is free.
    #[must_use]
    pub fn bend(&self, metric: &Metric) -> VertexData<f64> {
        let bend = |(s, k): (Vertex, &f64)| if self.is_free(s) { 0.0 } else { k.abs() };
        metric.curvature(self.slit()).enumerate().map(bend).collect()
    }

    /// The same with no cone of a larger index.
    #[must_use]
    pub fn with_largest_index(mut self, largest: i32) -> Self {
        self.largest_index = largest;
        self
    }

    /// Smallest and largest index of a sector that triangles can make; see [`index_bounds`].
    #[must_use]
    pub fn bounds(&self, sector: Vertex) -> (i32, i32) {
        let (low, high) = bounds(&self.slit, sector);
        let largest = match self.kind[sector] {
            Kind::Interior => self.largest_index,
            // Its angle is counted from half a turn.
            Kind::OpenEnd => (self.largest_index - 2).max(low),
            Kind::Free | Kind::Corner => high,
        };
        (low, high.min(largest))
    }

    /// Angle of a sector of given index, quarters.
    #[inline]
    #[must_use]
    pub fn quarters(&self, sector: Vertex, index: f64) -> f64 {
        base(&self.slit, sector) - index
    }

    /// Matchings of the mesh from those of the slit mesh, which hold minus the direction of aligned edges:
    /// across an interior feature whose sides have directions a and b it is `b + 2 - a`.
    #[must_use]
    pub fn glue(&self, slit_matching: &HalfedgeData<i32>) -> HalfedgeData<i32> {
        let mut matching = slit_matching.clone();
        for h in self.aligned() {
            matching[h] = 0;
        }
        for [h, t] in self.aligned_pairs() {
            matching[h] = slit_matching[h] - slit_matching[t] + 2;
            matching[t] = -matching[h];
        }
        matching
    }

    /// The ways out of a sector: all its edges but those of an unaligned boundary.
    pub fn roads(&self, sector: Vertex) -> impl Iterator<Item = Road> + '_ {
        let slit = self.slit();
        slit.outgoing(sector).flat_map(move |h| {
            let away = Road { to: slit.tip(h), halfedge: h, sign: 1 };
            let last = h.prev();
            // The last edge of a fan that is not closed has no half-edge that leads away.
            let back = Road { to: slit.origin(last), halfedge: last, sign: -1 };
            let is_road = slit.twin(h).is_some() || self.aligned[h];
            let is_last = slit.twin(last).is_none() && self.aligned[last];
            is_road.then_some(away).into_iter().chain(is_last.then_some(back))
        })
    }
}

/// A cone keeps a quarter turn at least.
pub(crate) const LARGEST_INDEX: i32 = 3;

fn base(slit: &TriMesh, sector: Vertex) -> f64 {
    if slit.is_boundary(sector) { 2.0 } else { 4.0 }
}

fn bounds(slit: &TriMesh, sector: Vertex) -> (i32, i32) {
    let (low, high) = index_bounds(slit.valence(sector));
    if slit.is_boundary(sector) { (low - 2, high - 2) } else { (low, high) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit::disk_grid;

    #[test]
    fn the_largest_index_holds_at_open_ends_too() {
        let grid = disk_grid(4, 4);
        let mesh = TriMesh::from_faces(grid.positions.len(), &grid.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &grid.positions);
        let inner =
            |&h: &Halfedge| !mesh.is_boundary(mesh.origin(h)) && !mesh.is_boundary(mesh.tip(h));
        let edge = mesh.halfedges().find(inner).unwrap();
        let features = EdgeSet::new(&mesh, [edge]);
        let sectors = Sectors::new(&mesh, &metric, &features);
        let ends: Vec<Vertex> =
            sectors.slit().vertices().filter(|&s| sectors.kind[s] == Kind::OpenEnd).collect();
        assert_eq!(ends.len(), 2);
        for largest in [3, 2, 1] {
            let sectors = sectors.clone().with_largest_index(largest);
            for &end in &ends {
                // An index of k at the vertex leaves 4 - k quarters, one of 2 - (4 - k) at the sector.
                let (_, high) = sectors.bounds(end);
                assert_eq!(sectors.quarters(end, f64::from(high)), 4.0 - f64::from(largest));
            }
        }
    }
}
