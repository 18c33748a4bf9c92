//! What a connected mesh is mapped in: its metric, and the edges that are to run along the axes.

use super::MapOptions;
use crate::cut::Unfolding;
use crate::features::{CornerRule, ReleasedFeature, Sectors, drop_conflicts, release_near};
use crate::field::Guide;
use crate::layout::exact::{Defects, ExactLayout};
use crate::layout::ladder::SeamlessLayout;
use num_complex::Complex64;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Geometry, Halfedge, Metric, TriMesh, VertexData};

/// Times that features near defects are dropped, each time with one more ring of faces, before all of them are: eight rings
/// reach across most patches between features.
const DROP_ROUNDS: usize = 8;

/// Slack of the triangle inequality, in mean edge lengths, where triangles are too thin for arithmetic. With the first
/// the others keep their shapes almost; in some 5 % of surfaces all of whose triangles are thin it leaves a layout
/// without flips out of reach, and with the second, which makes most triangles nearly regular, in none.
const SLACKS: [f64; 2] = [0.01, 0.3];

/// A connected mesh in a metric, and the edges on it that are to run along the axes.
#[derive(Debug, Clone)]
pub(super) struct Domain<'m> {
    /// The mesh slit along its aligned edges.
    pub(super) sectors: Sectors<'m>,
    /// Where its vertices are.
    pub(super) geometry: Geometry<'m>,
    /// The metric of the surface.
    pub(super) surface: &'m Metric,
    /// The metric to work in: that of the surface, in which triangles without area are opened, or every edge is longer by
    /// `lengthening`.
    pub(super) metric: Metric,
    /// In mean edge lengths; zero unless the mesh is degenerate.
    pub(super) lengthening: f64,
    /// Features that are not aligned.
    pub(super) released: Vec<ReleasedFeature>,
    /// With so many features released, or more, a map is of no use.
    fewest_unwanted: usize,
    /// Directions to follow.
    pub(super) guide: Option<Guide>,
    /// Largest index of a cone, quarters.
    largest_index: i32,
    /// Where aligned curves have corners.
    corners: CornerRule,
    /// How often features near defects were dropped.
    rounds: usize,
}

impl<'m> Domain<'m> {
    /// In the metric of the surface, along features as far as these do not contradict each other.
    pub(super) fn new(
        mesh: &'m TriMesh,
        geometry: Geometry<'m>,
        surface: &'m Metric,
        features: EdgeSet,
        options: &MapOptions,
    ) -> Self {
        let largest_index = options.largest_index();
        let corners = options.corners(surface);
        let (features, released) = drop_conflicts(mesh, geometry.positions, surface, features);
        let sectors = Sectors::with_corners(mesh, surface, &features, corners)
            .with_largest_index(largest_index);
        let metric = surface.opened(mesh).unwrap_or_else(|| surface.clone());
        let guide = options.guide(&sectors, geometry, &metric);
        Self {
            sectors,
            geometry,
            surface,
            metric,
            guide,
            lengthening: 0.0,
            released,
            fewest_unwanted: usize::MAX,
            largest_index,
            corners,
            rounds: 0,
        }
    }

    /// The mesh.
    pub(super) fn mesh(&self) -> &'m TriMesh {
        self.sectors.mesh()
    }

    /// No vertex.
    pub(super) fn nowhere(&self) -> VertexData<bool> {
        VertexData::filled(self.mesh().n_vertices(), false)
    }

    /// Whether any edge is aligned.
    pub(super) fn any_aligned(&self) -> bool {
        self.sectors.any_aligned()
    }

    /// The aligned edges.
    pub(super) fn features(&self) -> EdgeSet {
        EdgeSet::new(self.mesh(), self.sectors.aligned())
    }

    /// The mesh cut and unfolded.
    pub(super) fn unfold(&self) -> Unfolding {
        Unfolding::through_curved_sectors(&self.sectors, &self.metric)
    }

    /// UVs per corner of a layout, mesh units.
    pub(super) fn corner_uvs(&self, layout: &SeamlessLayout) -> Vec<[f64; 2]> {
        corner_uvs(self.mesh(), self.surface, &layout.space, &layout.y)
    }

    /// The same where a map that releases so many features or more is of no use.
    pub(super) fn releasing_fewer_than(self, fewest_unwanted: usize) -> Self {
        Self { fewest_unwanted, ..self }
    }

    /// What to try where this domain, without a guide, has no map: the same with nothing aligned, then in metrics in which thin
    /// triangles open up, more and more.
    pub(super) fn simpler(&self) -> Option<Self> {
        if self.any_aligned() {
            let everywhere = VertexData::filled(self.mesh().n_vertices(), true);
            let free = self.without_features_near(everywhere, 0);
            return free.is_wanted().then_some(free);
        }
        let lengthenings = SLACKS.map(|slack| self.surface.lengthening(self.mesh(), slack));
        let lengthening = lengthenings.into_iter().find(|&by| by > self.lengthening)?;
        let metric = self.surface.lengthened(self.mesh(), lengthening);
        Some(Self { metric, lengthening, ..self.clone() })
    }

    /// The same with the features dropped near defects; none if nothing is left to align then, if too many are released,
    /// or if that was tried often enough.
    pub(super) fn without_features_at(&self, defects: &Defects) -> Option<Self> {
        let near = defects.vertices(self.mesh());
        let may_drop = self.any_aligned() && self.rounds < DROP_ROUNDS;
        let fewer = may_drop.then(|| self.without_features_near(near, self.rounds))?;
        (fewer.any_aligned() && fewer.is_wanted()).then_some(fewer)
    }

    fn is_wanted(&self) -> bool {
        self.released.len() < self.fewest_unwanted
    }

    fn without_features_near(&self, near: VertexData<bool>, rings: usize) -> Self {
        let (kept, more) = release_near(self.mesh(), near, rings, &self.features());
        let sectors = Sectors::with_corners(self.mesh(), self.surface, &kept, self.corners);
        let sectors = sectors.with_largest_index(self.largest_index);
        let released = [&self.released[..], &more].concat();
        Self { sectors, released, rounds: self.rounds + 1, ..self.clone() }
    }
}

/// UVs per corner in mesh units, the lower left corner of their box at zero.
pub(super) fn corner_uvs(
    mesh: &TriMesh,
    metric: &Metric,
    layout: &ExactLayout,
    y: &[f64],
) -> Vec<[f64; 2]> {
    let z = layout.expand(y);
    let low =
        |coordinate: fn(&Complex64) -> f64| z.iter().map(coordinate).fold(f64::INFINITY, f64::min);
    let corner = Complex64::new(low(|z| z.re), low(|z| z.im));
    let uv = |h: Halfedge| (z[layout.cut.wedge[h] as usize] - corner) * metric.unit;
    mesh.halfedges().map(|h| [uv(h).re, uv(h).im]).collect()
}
