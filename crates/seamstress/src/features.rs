//! Features as found on a surface, and what became of them in a map.

use crate::error::{Error, Stage};
use crate::feature_edges::Namer;
use crate::feature_sources::{FeatureSource, Features};
use crate::grid_size::GridSize;
use crate::surface::Surface;
use seamstress_mesh::features::{EdgeSet, FeatureGraph, NodeKind};
use seamstress_mesh::{TriMesh, Vertex};
use seamstress_parametrize::{
    Alignment, ReleaseReason, ReleasedFeature, SeamlessMap, Tolerance, Violations,
};
use seamstress_quads::Extraction;
use serde::Serialize;
use std::collections::BTreeSet;

/// The feature edges of a surface and the curves that they form.
#[derive(Debug, Clone)]
pub struct FeatureCurves {
    pub(crate) edges: EdgeSet,
    pairs: Vec<[u32; 2]>,
    corners: Vec<u32>,
    open_ends: Vec<u32>,
    report: FeatureReport,
}

/// Features in numbers, with vertices of the surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FeatureReport {
    /// The sources, with the edges that each named.
    pub sources: Vec<FeatureSourceReport>,
    /// Whether the boundary is among them.
    pub align_boundary: bool,
    /// Edges in all.
    pub edges: usize,
    /// Those of them on the boundary.
    pub boundary_edges: usize,
    /// Their length, mesh units.
    pub length: f64,
    /// Curves that close.
    pub loops: usize,
    /// Vertices at which a curve turns.
    pub turns: usize,
    /// Vertices at which three or more curves meet.
    pub junctions: usize,
    /// Vertices at which a curve ends inside the surface.
    pub open_ends: usize,
    /// Vertices at which a curve ends on the boundary.
    pub boundary_ends: usize,
    /// All of these vertices.
    pub nodes: Vec<FeatureNode>,
    /// The curves between them.
    pub curves: Vec<FeatureCurve>,
    /// Edges that are aligned, in a map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kept: Option<usize>,
    /// Edges that are not, each with the reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dropped: Option<Vec<ReleasedFeature>>,
    /// The certificate of alignment of the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alignment: Option<Alignment>,
}

/// A source of features and what it named.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FeatureSourceReport {
    /// The source.
    pub source: String,
    /// Its edges.
    pub edges: usize,
}

/// A vertex at which feature curves turn, meet or end.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FeatureNode {
    /// The vertex.
    pub vertex: u32,
    /// Feature edges there.
    pub degree: usize,
    /// What it is: `open-end`, `boundary-end`, `turn` or `junction`.
    pub kind: &'static str,
}

/// A curve of feature edges.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FeatureCurve {
    /// Its vertices in order.
    pub vertices: Vec<u32>,
    /// Whether it closes.
    #[serde(rename = "loop")]
    pub is_loop: bool,
    /// Its edges on the boundary.
    pub boundary_edges: usize,
    /// Its length, mesh units.
    pub length: f64,
}

impl FeatureCurves {
    fn new(surface: &Surface, edges: EdgeSet, sources: Vec<FeatureSourceReport>) -> Self {
        let with_boundary = [FeatureSource::Boundary, FeatureSource::Auto].map(|s| s.to_string());
        let align_boundary = sources.iter().any(|s| with_boundary.contains(&s.source));
        let graph = FeatureGraph::new(surface.mesh(), surface.metric(), &edges);
        let pairs = edges.vertex_pairs(surface.mesh());
        let nodes = |of_kind: &dyn Fn(NodeKind) -> bool| {
            let nodes = graph.nodes.iter().filter(|node| of_kind(node.kind));
            nodes.map(|node| node.vertex.0).collect()
        };
        let report = FeatureReport {
            // The boundary is told apart from the sources.
            sources: sources
                .into_iter()
                .filter(|s| s.source != FeatureSource::Boundary.to_string())
                .collect(),
            align_boundary,
            edges: edges.len(),
            boundary_edges: graph.curves.iter().map(|curve| curve.boundary_edges).sum(),
            length: graph.length(),
            loops: graph.n_loops(),
            turns: graph.count(NodeKind::Turn),
            junctions: graph.count(NodeKind::Junction),
            open_ends: graph.count(NodeKind::OpenEnd),
            boundary_ends: graph.count(NodeKind::BoundaryEnd),
            nodes: graph.nodes.iter().map(feature_node).collect(),
            curves: graph.curves.iter().map(feature_curve).collect(),
            kept: None,
            dropped: None,
            alignment: None,
        };
        Self {
            corners: nodes(&|kind| kind != NodeKind::OpenEnd),
            open_ends: nodes(&|kind| kind == NodeKind::OpenEnd),
            edges,
            pairs,
            report,
        }
    }

    /// These curves on a finer mesh of their surface.
    pub(crate) fn on(&self, finer: &Surface, edges: EdgeSet) -> Self {
        let mut sources = self.report.sources.clone();
        if self.report.align_boundary {
            let source = FeatureSource::Boundary.to_string();
            sources.push(FeatureSourceReport { source, edges: self.report.boundary_edges });
        }
        Self::new(finer, edges, sources)
    }

    /// These curves without some edges.
    pub(crate) fn without(&self, surface: &Surface, edges: &EdgeSet) -> Self {
        let mesh = surface.mesh();
        self.on(surface, self.edges.without(mesh, edges.edges().iter().copied()))
    }

    /// The edges by their ends, vertices of the surface.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Vertices at which curves meet or turn, or end on the boundary.
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// Vertices at which curves end inside the surface.
    pub fn open_ends(&self) -> &[u32] {
        &self.open_ends
    }

    /// Their numbers.
    pub fn report(&self) -> &FeatureReport {
        &self.report
    }

    /// Those that quads follow, by their ends; the report names the others, dropped for that reason.
    pub(crate) fn followed_by(&self, extraction: &Extraction) -> (Vec<[u32; 2]>, FeatureReport) {
        let on_lines: BTreeSet<[u32; 2]> =
            extraction.edges_on_grid_lines.iter().copied().map(ordered).collect();
        let is_followed = |pair: &[u32; 2]| on_lines.contains(&ordered(*pair));
        let (kept, others): (Vec<_>, Vec<_>) = self.pairs.iter().copied().partition(is_followed);
        let dropped = |vertices| ReleasedFeature::new(vertices, ReleaseReason::NotInMap);
        let mut report = self.report.clone();
        report.kept = Some(kept.len());
        report.dropped = Some(others.into_iter().map(dropped).collect());
        (kept, report)
    }
}

impl FeatureReport {
    /// Renames the vertices.
    pub(crate) fn rename(&mut self, new: impl Fn(u32) -> u32) {
        self.nodes.iter_mut().for_each(|node| node.vertex = new(node.vertex));
        let of_curves = self.curves.iter_mut().flat_map(|curve| &mut curve.vertices);
        of_curves.for_each(|v| *v = new(*v));
        for feature in self.dropped.iter_mut().flatten() {
            feature.vertices = feature.vertices.map(&new);
        }
    }
}

fn feature_node(node: &seamstress_mesh::features::Node) -> FeatureNode {
    let kind = match node.kind {
        NodeKind::OpenEnd => "open-end",
        NodeKind::BoundaryEnd => "boundary-end",
        NodeKind::Turn => "turn",
        NodeKind::Junction => "junction",
        _ => "other",
    };
    FeatureNode { vertex: node.vertex.0, degree: node.degree, kind }
}

fn feature_curve(curve: &seamstress_mesh::features::Curve) -> FeatureCurve {
    FeatureCurve {
        vertices: curve.vertices.iter().map(|v| v.0).collect(),
        is_loop: curve.is_loop,
        boundary_edges: curve.boundary_edges,
        length: curve.length,
    }
}

/// What became of features in a map: aligned, or dropped for a reason.
#[derive(Debug, Clone)]
pub(crate) struct AlignedFeatures {
    /// The ends of those that are aligned.
    pub(crate) kept: Vec<[u32; 2]>,
    pub(crate) dropped: Vec<ReleasedFeature>,
    pub(crate) report: FeatureReport,
}

impl AlignedFeatures {
    /// Certifies that every feature is aligned in a map that is not named as dropped.
    ///
    /// # Errors
    /// What is not aligned.
    pub(crate) fn certify(
        mesh: &TriMesh,
        asked: FeatureCurves,
        map: &SeamlessMap,
        dropped: &[ReleasedFeature],
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        let gone: BTreeSet<[u32; 2]> = dropped.iter().map(|f| ordered(f.vertices)).collect();
        let is_kept = |pair: &[u32; 2]| !gone.contains(&ordered(*pair));
        let kept: Vec<[u32; 2]> = asked.pairs.iter().copied().filter(is_kept).collect();
        let alignment = map.alignment(mesh, &kept, tolerance)?;
        let mut report = asked.report;
        report.kept = Some(kept.len());
        report.dropped = Some(dropped.to_vec());
        report.alignment = Some(alignment);
        Ok(Self { kept, dropped: dropped.to_vec(), report })
    }

    /// The same in another map that keeps them, whose certificate of alignment it has.
    ///
    /// # Errors
    /// What is not aligned there.
    pub(crate) fn certified_in(
        mut self,
        mesh: &TriMesh,
        map: &SeamlessMap,
    ) -> Result<Self, Violations> {
        let tolerance = Tolerance::default();
        self.report.alignment = Some(map.alignment(mesh, &self.kept, &tolerance)?);
        Ok(self)
    }

    /// The same as part of more features that were asked for, of which some were given up before.
    pub(crate) fn among(self, asked: &FeatureCurves, given_up: Vec<ReleasedFeature>) -> Self {
        let mut dropped = self.dropped;
        dropped.extend(given_up);
        let mut report = asked.report.clone();
        report.kept = Some(self.kept.len());
        report.dropped = Some(dropped.clone());
        report.alignment = self.report.alignment;
        Self { kept: self.kept, dropped, report }
    }

    /// The ends of the features that are not aligned.
    #[cfg(feature = "render")]
    pub(crate) fn dropped_pairs(&self) -> Vec<[u32; 2]> {
        self.dropped.iter().map(|feature| feature.vertices).collect()
    }
}

/// The ends of an edge, ascending.
pub(crate) fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The set of edges with these ends.
pub(crate) fn edges_of(mesh: &TriMesh, pairs: &[[u32; 2]]) -> EdgeSet {
    let edge = |&[a, b]: &[u32; 2]| mesh.edge_between(Vertex(a), Vertex(b));
    EdgeSet::new(mesh, pairs.iter().filter_map(edge))
}

impl Surface {
    /// Finds features and the curves that they form.
    ///
    /// # Errors
    /// [`BadFeatures`](crate::ErrorKind::BadFeatures) where a source names what is not an edge, and
    /// [`Unreadable`](crate::ErrorKind::Unreadable).
    pub fn features(&self, features: &Features) -> Result<FeatureCurves, Error> {
        self.features_for(features, GridSize::default())
    }

    /// The same for a grid: creases that are short for its cells are not found.
    pub(crate) fn features_for(
        &self,
        features: &Features,
        size: GridSize,
    ) -> Result<FeatureCurves, Error> {
        let namer = Namer::new(self, size);
        let mut edges = EdgeSet::new(self.mesh(), []);
        let mut sources = Vec::new();
        for source in features.sources() {
            let found =
                namer.edges_of(source).map_err(|error| error.at_stage(Some(Stage::Features)))?;
            sources.push(FeatureSourceReport { source: source.to_string(), edges: found.len() });
            edges = edges.union(self.mesh(), &found);
        }
        Ok(FeatureCurves::new(self, edges, sources))
    }
}
