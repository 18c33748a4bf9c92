//! What can be wrong with a map.

use seamstress_mesh::{Component, Vertex};
use std::fmt;

/// One reason why a map is not a seamless map, naming its element (ids from 0).
#[derive(Debug, Clone, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Violation {
    /// The map has another number of vertices than the source.
    #[error("the map has {map} vertices, the source {source_count}")]
    VertexCount {
        /// In the source.
        source_count: usize,
        /// In the map.
        map: usize,
    },
    /// The map has another number of faces than the source.
    #[error("the map has {map} faces, the source {source_count}")]
    FaceCount {
        /// In the source.
        source_count: usize,
        /// In the map.
        map: usize,
    },
    /// A vertex was moved.
    #[error("vertex {vertex} was moved by {distance:e}")]
    MovedVertex {
        /// The vertex.
        vertex: u32,
        /// How far, mesh units.
        distance: f64,
    },
    /// A face has other vertices, or the same in another order.
    #[error("face {face} is not the source's face")]
    ChangedFace {
        /// The face.
        face: u32,
    },
    /// The number of UVs does not fit the faces.
    #[error("{found} corner UVs for {expected} corners")]
    UvCount {
        /// Three per face.
        expected: usize,
        /// Given.
        found: usize,
    },
    /// A UV is not finite.
    #[error("face {face} has a UV that is not finite")]
    NonFiniteUv {
        /// The face.
        face: u32,
    },
    /// A triangle of negative orientation.
    #[error("face {face} is flipped")]
    FlippedTriangle {
        /// The face.
        face: u32,
    },
    /// A triangle without area.
    #[error("face {face} is collapsed")]
    CollapsedTriangle {
        /// The face.
        face: u32,
    },
    /// The two images of an edge do not differ by a quarter turn and a translation.
    #[error(
        "edge {}-{} between faces {} and {} does not close: off by {residual:e} of its length",
        vertices[0], vertices[1], faces[0], faces[1]
    )]
    OpenSeam {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
        /// Mismatch in lengths of the edge, of the longer of its two images.
        residual: f64,
    },
    /// An interior angle sum that is not a positive multiple of a quarter turn.
    #[error("vertex {vertex} has an angle of {quarters} quarter turns")]
    ConeAngle {
        /// The vertex.
        vertex: u32,
        /// Its angle sum, quarter turns.
        quarters: f64,
    },
    /// The two images of an edge differ in the last bits from a quarter turn and a translation.
    #[error("edge {}-{} between faces {} and {} does not fit to the last bit",
        vertices[0], vertices[1], faces[0], faces[1])]
    InexactEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
    },
    /// A translation across an edge is not integral.
    #[error("edge {}-{} between faces {} and {} has the translation ({}, {}), which is not integral",
        vertices[0], vertices[1], faces[0], faces[1], translation[0], translation[1])]
    FractionalTranslation {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
        /// The translation from left to right.
        translation: [f64; 2],
    },
    /// A cone is not at a grid point.
    #[error("the cone at vertex {vertex} lies at ({}, {}), which is not a grid point", uv[0], uv[1])]
    FractionalCone {
        /// The vertex.
        vertex: u32,
        /// Where it lies in one of its faces.
        uv: [f64; 2],
    },
    /// A vertex at which aligned edges turn is not at a grid point.
    #[error("the corner at vertex {vertex} lies at ({}, {}), which is not a grid point", uv[0], uv[1])]
    FractionalCorner {
        /// The vertex.
        vertex: u32,
        /// Where it lies in one of its faces.
        uv: [f64; 2],
    },
    /// The image of an aligned edge does not lie on an isoline at an integer.
    #[error("edge {}-{} is not at an integer in face {face}", vertices[0], vertices[1])]
    OffIsoline {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// The face on the side of this image.
        face: u32,
    },
    /// The indices of a component do not add up to four times its Euler characteristic.
    #[error("the indices of component {component} sum to {sum}, not to {expected}")]
    PoincareHopf {
        /// The component, in order of first faces.
        component: usize,
        /// Sum of the indices, quarters.
        sum: f64,
        /// 4 chi.
        expected: i64,
    },
    /// A pair of vertices that should name an aligned edge does not.
    #[error("no edge joins the vertices {} and {}, which should be aligned", vertices[0], vertices[1])]
    NotAnEdge {
        /// The pair.
        vertices: [u32; 2],
    },
    /// The image of an aligned edge is not parallel to an axis.
    #[error("edge {}-{} is {degrees:e} degrees off the axes in face {face}", vertices[0], vertices[1])]
    OffAxis {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// The face on the side of this image.
        face: u32,
        /// Angle to the nearer axis, degrees.
        degrees: f64,
    },
    /// The angle between two aligned edges is not a positive multiple of a quarter turn.
    #[error(
        "at vertex {vertex} the angle between the aligned edges to {} and {} is {quarters} quarter turns",
        between[0], between[1]
    )]
    SectorAngle {
        /// The vertex.
        vertex: u32,
        /// The other ends of the two edges, counter-clockwise; the same vertex for the full turn at
        /// the end of a single edge.
        between: [u32; 2],
        /// The angle, quarter turns.
        quarters: f64,
    },
}

/// All violations found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Violations(pub Vec<Violation>);

impl Violations {
    /// Those of one component in the ids of the whole mesh.
    pub fn in_whole(mut self, piece: &Component) -> Self {
        let face_of = |f: &mut u32| *f = piece.faces[*f as usize].0;
        let vertex_of = |v: &mut u32| *v = piece.vertices[Vertex(*v)].0;
        for violation in &mut self.0 {
            match violation {
                Violation::NonFiniteUv { face }
                | Violation::FlippedTriangle { face }
                | Violation::CollapsedTriangle { face }
                | Violation::ChangedFace { face } => face_of(face),
                Violation::ConeAngle { vertex, .. }
                | Violation::FractionalCone { vertex, .. }
                | Violation::FractionalCorner { vertex, .. }
                | Violation::MovedVertex { vertex, .. } => vertex_of(vertex),
                Violation::OpenSeam { vertices, faces, .. }
                | Violation::InexactEdge { vertices, faces }
                | Violation::FractionalTranslation { vertices, faces, .. } => {
                    vertices.iter_mut().for_each(vertex_of);
                    faces.iter_mut().for_each(face_of);
                }
                Violation::NotAnEdge { vertices } => vertices.iter_mut().for_each(vertex_of),
                Violation::OffAxis { vertices, face, .. }
                | Violation::OffIsoline { vertices, face } => {
                    vertices.iter_mut().for_each(vertex_of);
                    face_of(face);
                }
                Violation::SectorAngle { vertex, between, .. } => {
                    vertex_of(vertex);
                    between.iter_mut().for_each(vertex_of);
                }
                Violation::VertexCount { .. }
                | Violation::FaceCount { .. }
                | Violation::UvCount { .. }
                | Violation::PoincareHopf { .. } => {}
            }
        }
        self
    }
}

impl fmt::Display for Violations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.as_slice() {
            [] => write!(f, "no violation"),
            [one] => one.fmt(f),
            [first, rest @ ..] => write!(f, "{first} (and {} more violations)", rest.len()),
        }
    }
}

impl std::error::Error for Violations {}
