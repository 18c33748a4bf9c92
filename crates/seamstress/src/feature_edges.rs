//! The edges of a surface that sources of features name.

use crate::error::{Error, ErrorKind};
use crate::feature_sources::FeatureSource;
use crate::finding::Elements;
use crate::grid_size::GridSize;
use crate::surface::Surface;
use seamstress_mesh::Halfedge;
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};
use seamstress_mesh::features::{EdgeFinder, EdgeNameError, EdgeSet, creases, sharp_edges};

/// Faulty names of a source that its error lists.
const LISTED: usize = 5;

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
pub(crate) struct Namer<'a> {
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
    pub(crate) fn new(surface: &'a Surface, size: GridSize) -> Self {
        let cell = size.to_quantize().cell(surface.metric().side());
        let finder = match surface.parts().vertex_origin.as_deref() {
            Some(origin) => {
                EdgeFinder::after_repair(surface.mesh(), origin, surface.parts().n_input_vertices)
            }
            None => EdgeFinder::new(surface.mesh()),
        };
        Self { surface, finder, cell }
    }

    pub(crate) fn edges_of(&self, source: &FeatureSource) -> Result<EdgeSet, Error> {
        let (surface, mesh) = (self.surface, self.surface.mesh());
        match source {
            FeatureSource::Auto => {
                let found = creases(mesh, surface.positions(), surface.metric(), self.cell);
                // Where sheets were cut apart, all of them keep their common curve.
                let junctions = &surface.report().junction_edges;
                let junctions = junctions.iter().filter_map(|&pair| self.finder.find(pair).ok());
                let junctions = EdgeSet::new(mesh, junctions.flatten());
                Ok(found.union(mesh, &EdgeSet::boundary(mesh)).union(mesh, &junctions))
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
            FeatureSource::Material => self.label_borders(&["material"], "materials"),
            FeatureSource::Group => self.label_borders(&["group", "object"], "groups or objects"),
            FeatureSource::Smoothing => self.label_borders(&["smoothing"], "smoothing groups"),
            FeatureSource::UvSeams => {
                let uvs = surface.attributes().of_kind(AttributeKind::Uv).next();
                self.borders(uvs, "a texture coordinate at every corner")
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

    /// The edges at which labels of these names differ on both sides.
    fn label_borders(&self, names: &[&str], what: &str) -> Result<EdgeSet, Error> {
        let attributes = self.surface.attributes();
        self.borders(names.iter().filter_map(|name| attributes.labels(name)), what)
    }

    /// The edges at which one of some attributes differs on both sides.
    fn borders<'b>(
        &self,
        attributes: impl IntoIterator<Item = &'b Attribute>,
        what: &str,
    ) -> Result<EdgeSet, Error> {
        let parts = self.surface.parts();
        let mut attributes = attributes.into_iter().peekable();
        if attributes.peek().is_none() {
            let text = format!("these features need a mesh with {what}, and this has none");
            return Err(Error::new(ErrorKind::BadFeatures, text).of(self.surface.input()));
        }
        let merged = parts.merged_into.as_deref();
        let now = |&v: &u32| merged.map_or(v, |into| into[v as usize]);
        let polygons: Vec<Vec<u32>> =
            parts.polygons.iter().map(|polygon| polygon.iter().map(now).collect()).collect();
        let borders = attributes.flat_map(|attribute| {
            let corners = parts.polygons.corners().iter().map(|&v| v as usize);
            let attribute = match attribute.domain {
                AttributeDomain::Vertex => &attribute.on(AttributeDomain::Corner, corners),
                _ => attribute,
            };
            attribute.borders(polygons.iter().map(Vec::as_slice))
        });
        // Repairs may have dropped a polygon at such an edge.
        let edges = borders.filter_map(|pair| self.finder.find(pair).ok()).flatten();
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
