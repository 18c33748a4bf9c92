//! Features as asked for, as found on a surface, and what became of them in a map.

use crate::error::{Error, ErrorKind, Stage};
use crate::finding::Elements;
use crate::grid_size::GridSize;
use crate::surface::Surface;
#[cfg(feature = "io")]
use seamstress_io::Attribute;
use seamstress_mesh::features::{
    EdgeFinder, EdgeNameError, EdgeSet, FeatureGraph, NodeKind, creases, sharp_edges,
};
use seamstress_mesh::{Halfedge, TriMesh, Vertex};
use seamstress_parametrize::{
    Alignment, AlignmentTolerance, ReleaseReason, ReleasedFeature, SeamlessMap, Violations,
};
use seamstress_quads::Extraction;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Faulty names of a source that its error lists.
const LISTED: usize = 5;

/// Where feature edges come from.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum FeatureSource {
    /// The boundary, and creases found by the shape of the surface: `auto`.
    Auto,
    /// Edges at which the surface bends by this many degrees or more: `angle:40`.
    Angle(f64),
    /// The boundary: `boundary`.
    Boundary,
    /// The `l` elements of the OBJ file of the surface: `lines`.
    Lines,
    /// Edges between faces of different materials in the OBJ file of the surface: `material`.
    Material,
    /// Edges between faces of different groups or objects: `group`.
    Group,
    /// Edges between faces of different smoothing groups: `smoothing`.
    Smoothing,
    /// Edges at which the texture coordinates of the OBJ file of the surface differ on both sides: `uv-seams`.
    UvSeams,
    /// Edges by their ends, vertices of the input counted from 0: `edges:0-1,1-5`.
    Edges(Vec<[u32; 2]>),
    /// A file of two vertices a line: `pairs:FILE`.
    Pairs(PathBuf),
    /// A `.sharp` file of QuadWild: `sharp:FILE`.
    Sharp(PathBuf),
}

impl FeatureSource {
    /// The file it is read from, other than that of the surface.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Pairs(file) | Self::Sharp(file) => Some(file),
            _ => None,
        }
    }
}

impl FromStr for FeatureSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        match (kind, rest) {
            ("auto", "") => Ok(Self::Auto),
            ("lines", "") => Ok(Self::Lines),
            ("boundary", "") => Ok(Self::Boundary),
            ("material", "") => Ok(Self::Material),
            ("group", "") => Ok(Self::Group),
            ("smoothing", "") => Ok(Self::Smoothing),
            ("uv-seams", "") => Ok(Self::UvSeams),
            ("angle", degrees) => match degrees.parse::<f64>() {
                Ok(degrees) if degrees > 0.0 && degrees <= 180.0 => Ok(Self::Angle(degrees)),
                _ => Err("expected degrees, more than 0 and at most 180, after `angle:`".into()),
            },
            ("edges", edges) => {
                edges.split(',').map(edge).collect::<Result<_, _>>().map(Self::Edges)
            }
            ("pairs", file) if !file.is_empty() => Ok(Self::Pairs(file.into())),
            ("sharp", file) if !file.is_empty() => Ok(Self::Sharp(file.into())),
            _ => {
                Err("expected auto, angle:DEGREES, boundary, lines, material, group, smoothing, uv-seams, edges:A-B, pairs:FILE or sharp:FILE"
                    .into())
            }
        }
    }
}

fn edge(text: &str) -> Result<[u32; 2], String> {
    let ends = text.split_once('-');
    let parsed = ends.and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    parsed.ok_or_else(|| "expected edges such as 0-1,1-5 after `edges:`".into())
}

impl fmt::Display for FeatureSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Angle(degrees) => write!(f, "angle:{degrees}"),
            Self::Boundary => f.write_str("boundary"),
            Self::Lines => f.write_str("lines"),
            Self::Material => f.write_str("material"),
            Self::Group => f.write_str("group"),
            Self::Smoothing => f.write_str("smoothing"),
            Self::UvSeams => f.write_str("uv-seams"),
            Self::Edges(edges) => {
                let edges: Vec<String> = edges.iter().map(|[a, b]| format!("{a}-{b}")).collect();
                write!(f, "edges:{}", edges.join(","))
            }
            Self::Pairs(file) => write!(f, "pairs:{}", file.display()),
            Self::Sharp(file) => write!(f, "sharp:{}", file.display()),
        }
    }
}

impl Serialize for FeatureSource {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for FeatureSource {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "FeatureSource".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "type": "string",
            "description": "auto, angle:DEGREES, boundary, lines, material, group, smoothing, uv-seams, edges:A-B,C-D, pairs:FILE or sharp:FILE",
        })
    }
}

impl<'de> Deserialize<'de> for FeatureSource {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// Edges that a map, and quads, should follow: those of all sources.
///
/// The default leaves the choice to what is made: quad meshes and integer-grid maps of a mesh follow those of
/// [`FeatureSource::Auto`], all else none.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct Features {
    sources: Option<Vec<FeatureSource>>,
}

impl Features {
    /// No features, not even by default.
    pub fn none() -> Self {
        Self { sources: Some(Vec::new()) }
    }

    /// The boundary, and creases found by the shape of the surface.
    pub fn auto() -> Self {
        Self::none().and(FeatureSource::Auto)
    }

    /// Edges at which the surface bends by this many degrees or more.
    pub fn angle(degrees: f64) -> Self {
        Self::none().and(FeatureSource::Angle(degrees))
    }

    /// Edges by their ends, vertices of the input counted from 0.
    pub fn edges(edges: impl Into<Vec<[u32; 2]>>) -> Self {
        Self::none().and(FeatureSource::Edges(edges.into()))
    }

    /// The boundary as well.
    pub fn with_boundary(self) -> Self {
        self.and(FeatureSource::Boundary)
    }

    /// Those of another source as well.
    pub fn and(mut self, source: FeatureSource) -> Self {
        let sources = self.sources.get_or_insert_default();
        if !sources.contains(&source) {
            sources.push(source);
        }
        self
    }

    /// The sources.
    pub fn sources(&self) -> &[FeatureSource] {
        self.sources.as_deref().unwrap_or_default()
    }

    /// Whether none is asked for.
    pub fn is_none(&self) -> bool {
        self.sources().is_empty()
    }

    /// These, or others where the choice was left open.
    pub(crate) fn or(&self, default: Self) -> Self {
        if self.sources.is_some() { self.clone() } else { default }
    }
}

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
    ) -> Result<Self, Violations> {
        let gone: BTreeSet<[u32; 2]> = dropped.iter().map(|f| ordered(f.vertices)).collect();
        let is_kept = |pair: &[u32; 2]| !gone.contains(&ordered(*pair));
        let kept: Vec<[u32; 2]> = asked.pairs.iter().copied().filter(is_kept).collect();
        let alignment = Alignment::certify(mesh, map, &kept, &AlignmentTolerance::default())?;
        let mut report = asked.report;
        report.kept = Some(kept.len());
        report.dropped = Some(dropped.to_vec());
        report.alignment = Some(alignment);
        Ok(Self { kept, dropped: dropped.to_vec(), report })
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
    /// [`ErrorKind::BadFeatures`] where a source names what is not an edge, and [`ErrorKind::Unreadable`].
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

/// The edges that sources name on a surface, for other uses than features.
///
/// # Errors
/// If a file cannot be read, or a source names what is not an edge.
#[cfg(feature = "lab")]
pub(crate) fn named_edges(surface: &Surface, sources: &[FeatureSource]) -> Result<EdgeSet, Error> {
    let namer = Namer::new(surface, GridSize::default());
    sources.iter().try_fold(EdgeSet::new(surface.mesh(), []), |edges, source| {
        Ok(edges.union(surface.mesh(), &namer.edges_of(source)?))
    })
}

/// Turns the names of a source into edges.
struct Namer<'a> {
    surface: &'a Surface,
    finder: EdgeFinder<'a>,
    /// Edge length of the cells that are to follow features, mesh units.
    cell: f64,
}

/// An edge by the vertices of the input, and what to call it in a message.
struct Named {
    pair: Result<[u32; 2], EdgeNameError>,
    name: String,
}

impl<'a> Namer<'a> {
    fn new(surface: &'a Surface, size: GridSize) -> Self {
        let cell = size.to_quantize().cell(surface.metric().side());
        let finder = match surface.parts().vertex_origin.as_deref() {
            Some(origin) => {
                EdgeFinder::after_repair(surface.mesh(), origin, surface.parts().n_input_vertices)
            }
            None => EdgeFinder::new(surface.mesh()),
        };
        Self { surface, finder, cell }
    }

    fn edges_of(&self, source: &FeatureSource) -> Result<EdgeSet, Error> {
        let (surface, mesh) = (self.surface, self.surface.mesh());
        match source {
            FeatureSource::Auto => {
                let found = creases(mesh, surface.positions(), surface.metric(), self.cell);
                Ok(found.union(mesh, &EdgeSet::boundary(mesh)))
            }
            FeatureSource::Angle(degrees) => {
                Ok(sharp_edges(mesh, surface.positions(), degrees.to_radians()))
            }
            FeatureSource::Boundary => Ok(EdgeSet::boundary(mesh)),
            FeatureSource::Lines => self.find(surface.input(), self.lines()?),
            FeatureSource::Edges(edges) => {
                let named =
                    |&[a, b]: &[u32; 2]| Named { pair: Ok([a, b]), name: format!("edge {a}-{b}") };
                self.find(surface.input(), edges.iter().map(named).collect())
            }
            #[cfg(feature = "io")]
            FeatureSource::Pairs(file) => {
                let lines = seamstress_io::read_pairs(file)?.into_iter();
                let named = lines.map(|l| Named { pair: Ok(l.vertices), name: at_line(l.line) });
                self.find(Some(&file.display().to_string()), named.collect())
            }
            #[cfg(feature = "io")]
            FeatureSource::Sharp(file) => {
                let lines = seamstress_io::read_sharp(file)?.into_iter();
                let named =
                    lines.map(|l| Named { pair: self.side(l.face, l.side), name: at_line(l.line) });
                self.find(Some(&file.display().to_string()), named.collect())
            }
            #[cfg(feature = "io")]
            FeatureSource::Material => self.borders(Attribute::Material, "`usemtl` statements"),
            #[cfg(feature = "io")]
            FeatureSource::Group => self.borders(Attribute::Group, "`g` or `o` statements"),
            #[cfg(feature = "io")]
            FeatureSource::Smoothing => self.borders(Attribute::Smoothing, "`s` statements"),
            #[cfg(feature = "io")]
            FeatureSource::UvSeams => {
                self.borders(Attribute::Uvs, "a texture coordinate at every corner")
            }
            #[cfg(not(feature = "io"))]
            _ => Err(Error::options(format!("features: {source} needs the feature `io`"))),
        }
    }

    fn lines(&self) -> Result<Vec<Named>, Error> {
        let lines = &self.surface.parts().lines;
        if lines.is_empty() {
            let text = "features from lines need an OBJ file with `l` elements, and this has none";
            return Err(Error::new(ErrorKind::BadFeatures, text).of(self.surface.input()));
        }
        let named = |&pair: &[u32; 2]| Named { pair: Ok(pair), name: "an `l` element".into() };
        Ok(lines.iter().map(named).collect())
    }

    /// The edges at which an attribute differs on both sides.
    #[cfg(feature = "io")]
    fn borders(&self, attribute: Attribute, statements: &str) -> Result<EdgeSet, Error> {
        let parts = self.surface.parts();
        if !parts.attributes.has(attribute) {
            let text =
                format!("these features need an OBJ file with {statements}, and this has none");
            return Err(Error::new(ErrorKind::BadFeatures, text).of(self.surface.input()));
        }
        let merged = parts.merged_into.as_deref();
        let now = |&v: &u32| merged.map_or(v, |into| into[v as usize]);
        let polygons: Vec<Vec<u32>> =
            parts.polygons.iter().map(|polygon| polygon.iter().map(now).collect()).collect();
        let borders = parts.attributes.borders(polygons.iter().map(Vec::as_slice), attribute);
        // Repairs may have dropped a polygon at such an edge.
        let edges = borders.into_iter().filter_map(|pair| self.finder.find(pair).ok()).flatten();
        Ok(EdgeSet::new(self.surface.mesh(), edges))
    }

    /// The ends of a side of a polygon of the input.
    #[cfg(feature = "io")]
    fn side(&self, face: u32, side: u32) -> Result<[u32; 2], EdgeNameError> {
        let polygons = &self.surface.parts().polygons;
        let Some(polygon) = polygons.get(face as usize) else {
            return Err(EdgeNameError::NoSuchFace { face, n_faces: polygons.len() });
        };
        let n_sides = polygon.len();
        match polygon.get(side as usize) {
            Some(&from) => Ok([from, polygon[(side as usize + 1) % n_sides]]),
            None => Err(EdgeNameError::NoSuchSide { face, side, n_sides }),
        }
    }

    /// What the ends of an edge are merged into.
    fn merged(&self, pair: [u32; 2]) -> [u32; 2] {
        let into = self.surface.parts().merged_into.as_deref().unwrap_or_default();
        pair.map(|v| into.get(v as usize).copied().unwrap_or(v))
    }

    fn find(&self, source: Option<&str>, named: Vec<Named>) -> Result<EdgeSet, Error> {
        let mut edges: Vec<Halfedge> = Vec::new();
        let mut faults = Vec::new();
        let mut elements = Elements::default();
        for Named { pair, name } in named {
            match pair.clone().and_then(|pair| self.finder.find(self.merged(pair))) {
                Ok(found) => edges.extend(found),
                Err(error) => {
                    elements.edges.extend(pair);
                    faults.push(format!("{name}: {error}"));
                }
            }
        }
        if faults.is_empty() {
            return Ok(EdgeSet::new(self.surface.mesh(), edges));
        }
        let more = faults.len().saturating_sub(LISTED);
        faults.truncate(LISTED);
        if more > 0 {
            faults.push(format!("and {more} more"));
        }
        let of = self.surface.input().map_or(String::from("the surface"), str::to_owned);
        let text = format!("not edges of {of}:\n  {}", faults.join("\n  "));
        Err(Error::new(ErrorKind::BadFeatures, text).of(source).with_elements(elements))
    }
}

#[cfg(feature = "io")]
fn at_line(line: usize) -> String {
    format!("line {line}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_read_and_written_alike() {
        let good = [
            "auto",
            "angle:40",
            "angle:0.5",
            "boundary",
            "lines",
            "material",
            "group",
            "smoothing",
            "uv-seams",
            "edges:0-1,4-2",
            "pairs:a b.txt",
            "sharp:C:\\x.sharp",
        ];
        for text in good {
            let source: FeatureSource = text.parse().unwrap();
            assert_eq!(source.to_string(), text);
        }
        let bad = [
            "",
            "auto:1",
            "angle",
            "angle:0",
            "angle:181",
            "angle:nan",
            "lines:3",
            "pairs",
            "pairs:",
            "edges:x",
            "edges:1",
            "edges:1-2-3",
            "boundary:1",
        ];
        for text in bad {
            assert!(text.parse::<FeatureSource>().is_err(), "{text}");
        }
    }

    #[test]
    fn features_are_a_list_of_sources_in_json() {
        let features = Features::angle(40.0).with_boundary();
        let text = serde_json::to_string(&features).unwrap();
        assert_eq!(text, r#"["angle:40","boundary"]"#);
        assert_eq!(serde_json::from_str::<Features>(&text).unwrap(), features);
        assert!(serde_json::from_str::<Features>(r#"["angle:0"]"#).is_err());
    }
}
