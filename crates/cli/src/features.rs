//! Features as asked for on the command line, and as found on a mesh.

use crate::input::LoadedMesh;
use crate::outcome::Failure;
use crate::report;
use seamstress_io::{read_pairs, read_sharp};
use seamstress_mesh::features::{
    EdgeFinder, EdgeNameError, EdgeSet, FeatureGraph, NodeKind, sharp_edges,
};
use seamstress_mesh::{Halfedge, Metric, TriMesh, Vertex};
use seamstress_parametrize::map::edges_along_axes;
use seamstress_parametrize::{
    Alignment, AlignmentTolerance, ReleasedFeature, SeamlessMap, Violations,
};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Faulty lines of a file that are shown.
const SHOWN_FAULTS: usize = 5;

/// Where feature edges come from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FeatureSource {
    /// The angle between the normals of two faces, in degrees, from which their edge is sharp.
    Angle(f64),
    /// The `l` elements of the OBJ file of the mesh.
    Lines,
    /// A file of vertex pairs.
    Pairs(PathBuf),
    /// A `.sharp` file of QuadWild.
    Sharp(PathBuf),
}

impl FeatureSource {
    /// The file it is read from, other than the mesh.
    pub(crate) fn file(&self) -> Option<&Path> {
        match self {
            Self::Pairs(file) | Self::Sharp(file) => Some(file),
            Self::Angle(_) | Self::Lines => None,
        }
    }
}

impl FromStr for FeatureSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        match (kind, rest) {
            ("lines", "") => Ok(Self::Lines),
            ("angle", degrees) => match degrees.parse::<f64>() {
                Ok(degrees) if degrees > 0.0 && degrees <= 180.0 => Ok(Self::Angle(degrees)),
                _ => Err("expected degrees, more than 0 and at most 180, after `angle:`".into()),
            },
            ("pairs", file) if !file.is_empty() => Ok(Self::Pairs(file.into())),
            ("sharp", file) if !file.is_empty() => Ok(Self::Sharp(file.into())),
            _ => Err("expected angle:DEGREES, lines, pairs:FILE or sharp:FILE".into()),
        }
    }
}

impl fmt::Display for FeatureSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Angle(degrees) => write!(f, "angle:{degrees}"),
            Self::Lines => f.write_str("lines"),
            Self::Pairs(file) => write!(f, "pairs:{}", file.display()),
            Self::Sharp(file) => write!(f, "sharp:{}", file.display()),
        }
    }
}

/// The feature edges of a mesh.
#[derive(Debug)]
pub(crate) struct Features {
    /// Those of all sources, and the boundary if it is to be aligned.
    pub(crate) edges: EdgeSet,
    /// The same as vertex pairs.
    pub(crate) pairs: Vec<[u32; 2]>,
    pub(crate) graph: FeatureGraph,
    /// Each source and the number of its edges.
    pub(crate) sources: Vec<(String, usize)>,
    pub(crate) align_boundary: bool,
}

impl Features {
    /// Finds the edges that sources name on a mesh without faults.
    ///
    /// # Errors
    /// If a file cannot be read, or names what is not an edge.
    pub(crate) fn resolve(
        sources: &[FeatureSource],
        align_boundary: bool,
        mesh: &LoadedMesh,
        connectivity: &TriMesh,
    ) -> Result<Self, Failure> {
        let namer = Namer::new(mesh, connectivity);
        let mut edges = EdgeSet::new(connectivity, []);
        let mut counts = Vec::new();
        for source in sources {
            let found = namer.edges_of(source)?;
            counts.push((source.to_string(), found.len()));
            edges = edges.union(connectivity, &found);
        }
        if align_boundary {
            edges = edges.union(connectivity, &EdgeSet::boundary(connectivity));
        }
        let metric = Metric::from_positions(connectivity, &mesh.soup.positions);
        let graph = FeatureGraph::new(connectivity, &metric, &edges);
        let pairs = edges.vertex_pairs(connectivity);
        Ok(Self { edges, pairs, graph, sources: counts, align_boundary })
    }

    /// Those that run along the axes of a map.
    pub(crate) fn aligned_in(
        mut self,
        map: &SeamlessMap,
        mesh: &LoadedMesh,
        connectivity: &TriMesh,
    ) -> Self {
        let tolerance = AlignmentTolerance::default();
        self.pairs = edges_along_axes(connectivity, map, &self.pairs, &tolerance);
        self.edges = edges_of(connectivity, &self.pairs);
        let metric = Metric::from_positions(connectivity, &mesh.soup.positions);
        self.graph = FeatureGraph::new(connectivity, &metric, &self.edges);
        self
    }

    /// Number of edges on the boundary of the mesh.
    pub(crate) fn boundary_edges(&self) -> usize {
        self.graph.curves.iter().map(|curve| curve.boundary_edges).sum()
    }

    /// The vertices at which curves meet or turn, or end on the boundary.
    pub(crate) fn corners(&self) -> Vec<u32> {
        self.nodes(|kind| kind != NodeKind::OpenEnd)
    }

    /// The vertices at which curves end inside the surface.
    pub(crate) fn open_ends(&self) -> Vec<u32> {
        self.nodes(|kind| kind == NodeKind::OpenEnd)
    }

    fn nodes(&self, of_kind: impl Fn(NodeKind) -> bool) -> Vec<u32> {
        let nodes = self.graph.nodes.iter().filter(|node| of_kind(node.kind));
        nodes.map(|node| node.vertex.0).collect()
    }

    pub(crate) fn json(&self) -> Value {
        let source =
            |(source, edges): &(String, usize)| json!({ "source": source, "edges": edges });
        let graph = &self.graph;
        json!({
            "sources": self.sources.iter().map(source).collect::<Vec<_>>(),
            "align_boundary": self.align_boundary,
            "edges": self.edges.len(),
            "boundary_edges": self.boundary_edges(),
            "length": graph.length(),
            "loops": graph.n_loops(),
            "turns": graph.count(NodeKind::Turn),
            "junctions": graph.count(NodeKind::Junction),
            "open_ends": graph.count(NodeKind::OpenEnd),
            "boundary_ends": graph.count(NodeKind::BoundaryEnd),
            "nodes": graph.nodes.iter().map(|node| json!({
                "vertex": node.vertex.0,
                "degree": node.degree,
                "kind": kind_name(node.kind),
            })).collect::<Vec<_>>(),
            "curves": graph.curves.iter().map(|curve| json!({
                "vertices": curve.vertices.iter().map(|v| v.0).collect::<Vec<_>>(),
                "loop": curve.is_loop,
                "boundary_edges": curve.boundary_edges,
                "length": curve.length,
            })).collect::<Vec<_>>(),
        })
    }
}

fn kind_name(kind: NodeKind) -> &'static str {
    match kind {
        NodeKind::OpenEnd => "open-end",
        NodeKind::BoundaryEnd => "boundary-end",
        NodeKind::Turn => "turn",
        NodeKind::Junction => "junction",
        _ => "other",
    }
}

/// What became of features: aligned, or released for a reason.
#[derive(Debug)]
pub(crate) struct AlignedFeatures {
    pub(crate) asked: Features,
    /// The ends of those that are aligned.
    pub(crate) kept: Vec<[u32; 2]>,
    pub(crate) released: Vec<ReleasedFeature>,
    pub(crate) alignment: Alignment,
}

impl AlignedFeatures {
    /// Certifies that every feature is aligned in a map that is not named as released.
    ///
    /// # Errors
    /// What is not aligned.
    pub(crate) fn certify(
        connectivity: &TriMesh,
        asked: Features,
        map: &SeamlessMap,
        released: &[ReleasedFeature],
    ) -> Result<Self, Violations> {
        let ordered = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let released = released.to_vec();
        let gone: BTreeSet<[u32; 2]> = released.iter().map(|f| ordered(f.vertices)).collect();
        let is_kept = |pair: &[u32; 2]| !gone.contains(&ordered(*pair));
        let kept: Vec<[u32; 2]> = asked.pairs.iter().copied().filter(is_kept).collect();
        let tolerance = AlignmentTolerance::default();
        let alignment = Alignment::certify(connectivity, map, &kept, &tolerance)?;
        Ok(Self { asked, kept, released, alignment })
    }

    /// The ends of the features that are not aligned.
    pub(crate) fn released_pairs(&self) -> Vec<[u32; 2]> {
        self.released.iter().map(|feature| feature.vertices).collect()
    }

    pub(crate) fn json(&self) -> Value {
        let mut value = self.asked.json();
        value["kept"] = self.kept.len().into();
        value["released"] = json!(self.released);
        value["alignment"] = report::alignment_json(&self.alignment);
        value
    }
}

/// The set of edges with these ends.
pub(crate) fn edges_of(connectivity: &TriMesh, pairs: &[[u32; 2]]) -> EdgeSet {
    let edge = |&[a, b]: &[u32; 2]| connectivity.edge_between(Vertex(a), Vertex(b));
    EdgeSet::new(connectivity, pairs.iter().filter_map(edge))
}

/// Turns the names of a source into edges.
struct Namer<'a> {
    mesh: &'a LoadedMesh,
    connectivity: &'a TriMesh,
    finder: EdgeFinder<'a>,
}

/// An edge by the vertices of the file, and what to call it in a message.
struct Named {
    pair: Result<[u32; 2], EdgeNameError>,
    name: String,
}

impl<'a> Namer<'a> {
    fn new(mesh: &'a LoadedMesh, connectivity: &'a TriMesh) -> Self {
        let finder = match &mesh.vertex_origin {
            Some(origin) => EdgeFinder::after_repair(connectivity, origin, mesh.n_read[0]),
            None => EdgeFinder::new(connectivity),
        };
        Self { mesh, connectivity, finder }
    }

    fn edges_of(&self, source: &FeatureSource) -> Result<EdgeSet, Failure> {
        match source {
            FeatureSource::Angle(degrees) => {
                let positions = &self.mesh.soup.positions;
                Ok(sharp_edges(self.connectivity, positions, degrees.to_radians()))
            }
            FeatureSource::Lines => self.find(&self.mesh.path, self.lines()?),
            FeatureSource::Pairs(file) => {
                let lines = read_pairs(file)?.into_iter();
                let named = lines.map(|l| Named { pair: Ok(l.vertices), name: at_line(l.line) });
                self.find(file, named.collect())
            }
            FeatureSource::Sharp(file) => {
                let lines = read_sharp(file)?.into_iter();
                let named =
                    lines.map(|l| Named { pair: self.side(l.face, l.side), name: at_line(l.line) });
                self.find(file, named.collect())
            }
        }
    }

    fn lines(&self) -> Result<Vec<Named>, Failure> {
        if self.mesh.lines.is_empty() {
            let text = "`--features lines` needs an OBJ file with `l` elements, and this has none";
            let file = self.mesh.path.clone();
            return Err(Failure::BadFeatures { file, text: text.into() });
        }
        let named = |&pair: &[u32; 2]| Named { pair: Ok(pair), name: "an `l` element".into() };
        Ok(self.mesh.lines.iter().map(named).collect())
    }

    /// The ends of a side of a polygon of the file.
    fn side(&self, face: u32, side: u32) -> Result<[u32; 2], EdgeNameError> {
        let polygons = &self.mesh.polygons;
        if face as usize >= polygons.len() {
            return Err(EdgeNameError::NoSuchFace { face, n_faces: polygons.len() });
        }
        let polygon = polygons.get(face as usize);
        let n_sides = polygon.len();
        match polygon.get(side as usize) {
            Some(&from) => Ok([from, polygon[(side as usize + 1) % n_sides]]),
            None => Err(EdgeNameError::NoSuchSide { face, side, n_sides }),
        }
    }

    fn find(&self, file: &Path, named: Vec<Named>) -> Result<EdgeSet, Failure> {
        let mut edges: Vec<Halfedge> = Vec::new();
        let mut faults = Vec::new();
        for Named { pair, name } in named {
            match pair.and_then(|pair| self.finder.find(pair)) {
                Ok(found) => edges.extend(found),
                Err(error) => faults.push(format!("{name}: {error}")),
            }
        }
        if faults.is_empty() {
            return Ok(EdgeSet::new(self.connectivity, edges));
        }
        let more = faults.len().saturating_sub(SHOWN_FAULTS);
        faults.truncate(SHOWN_FAULTS);
        if more > 0 {
            faults.push(format!("and {more} more"));
        }
        let text = format!("not edges of {}:\n  {}", self.mesh.path.display(), faults.join("\n  "));
        Err(Failure::BadFeatures { file: file.to_owned(), text })
    }
}

fn at_line(line: usize) -> String {
    format!("line {line}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_read_and_written_alike() {
        for text in ["angle:40", "angle:0.5", "lines", "pairs:a b.txt", "sharp:C:\\x.sharp"] {
            let source: FeatureSource = text.parse().unwrap();
            assert_eq!(source.to_string(), text);
        }
        for text in [
            "",
            "angle",
            "angle:0",
            "angle:181",
            "angle:nan",
            "lines:3",
            "pairs",
            "pairs:",
            "edges:x",
        ] {
            assert!(text.parse::<FeatureSource>().is_err(), "{text}");
        }
    }
}
