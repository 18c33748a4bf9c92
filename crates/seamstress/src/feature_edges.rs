//! The edges of a surface that sources of features name.

use crate::error::{Error, ErrorKind};
use crate::feature_sources::FeatureSource;
use crate::finding::Elements;
use crate::grid_size::GridSize;
use crate::surface::Surface;
#[cfg(feature = "io")]
use seamstress_io::Attribute;
use seamstress_mesh::Halfedge;
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
