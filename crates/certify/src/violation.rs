//! What can be wrong with a map or a quad mesh.

use std::fmt;

/// One reason why a map is not a seamless map, naming its element (ids from 0).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Violation {
    /// The map has another number of vertices than the source.
    VertexCount {
        /// In the source.
        source_count: usize,
        /// In the map.
        map: usize,
    },
    /// The map has another number of faces than the source.
    FaceCount {
        /// In the source.
        source_count: usize,
        /// In the map.
        map: usize,
    },
    /// A vertex was moved.
    MovedVertex {
        /// The vertex.
        vertex: u32,
        /// How far, mesh units.
        distance: f64,
    },
    /// A face has other vertices, or the same in another order.
    ChangedFace {
        /// The face.
        face: u32,
    },
    /// The number of UVs does not fit the faces.
    UvCount {
        /// Three per face.
        expected: usize,
        /// Given.
        found: usize,
    },
    /// A UV is not finite.
    NonFiniteUv {
        /// The face.
        face: u32,
    },
    /// A triangle of negative orientation.
    FlippedTriangle {
        /// The face.
        face: u32,
    },
    /// A triangle without area.
    CollapsedTriangle {
        /// The face.
        face: u32,
    },
    /// The two images of an edge do not differ by a quarter turn and a translation.
    OpenSeam {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
        /// Mismatch in lengths of the edge, of the longer of its two images.
        residual: f64,
    },
    /// An interior angle sum that is not a positive multiple of a quarter turn.
    ConeAngle {
        /// The vertex.
        vertex: u32,
        /// Its angle sum, quarter turns.
        quarters: f64,
    },
    /// The two images of an edge differ in the last bits from a quarter turn and a translation.
    InexactEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
    },
    /// A translation across an edge is not integral.
    FractionalTranslation {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
        /// The translation from left to right.
        translation: [f64; 2],
    },
    /// A cone is not at a grid point.
    FractionalCone {
        /// The vertex.
        vertex: u32,
        /// Where it lies in one of its faces.
        uv: [f64; 2],
    },
    /// A vertex at which aligned edges turn is not at a grid point.
    FractionalCorner {
        /// The vertex.
        vertex: u32,
        /// Where it lies in one of its faces.
        uv: [f64; 2],
    },
    /// The image of an aligned edge does not lie on an isoline at an integer.
    OffIsoline {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// The face on the side of this image.
        face: u32,
    },
    /// The indices of a component do not add up to four times its Euler characteristic.
    PoincareHopf {
        /// The component, in order of first faces.
        component: usize,
        /// Sum of the indices, quarters.
        sum: f64,
        /// 4 chi.
        expected: i64,
    },
    /// A pair of vertices that should name an aligned edge does not.
    NotAnEdge {
        /// The pair.
        vertices: [u32; 2],
    },
    /// The image of an aligned edge is not parallel to an axis.
    OffAxis {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// The face on the side of this image.
        face: u32,
        /// Angle to the nearer axis, degrees.
        degrees: f64,
    },
    /// The angle between two aligned edges is not a positive multiple of a quarter turn.
    SectorAngle {
        /// The vertex.
        vertex: u32,
        /// The other ends of the two edges, counter-clockwise; the same vertex for the full turn at
        /// the end of a single edge.
        between: [u32; 2],
        /// The angle, quarter turns.
        quarters: f64,
    },
    /// A face names a vertex that is not there, or one twice.
    BadFace {
        /// The face.
        face: u32,
    },
    /// More than two faces share an edge, or two run along it in the same direction.
    RepeatedEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
    },
    /// The faces around a vertex do not form one fan.
    SplitVertex {
        /// The vertex.
        vertex: u32,
    },
    /// A quad joins points of several components of the surface.
    StrayQuad {
        /// The quad.
        face: u32,
    },
    /// The quads of a component of the surface are not in one piece.
    QuadPieces {
        /// The component, in order of first faces.
        component: usize,
        /// Pieces.
        pieces: usize,
    },
    /// The quads of a component of the surface have another topology.
    QuadTopology {
        /// The component, in order of first faces.
        component: usize,
        /// Euler characteristic of the quads.
        quads: i64,
        /// Euler characteristic of the component.
        surface: i64,
    },
    /// Of a component of the surface and its quads, only one is closed.
    QuadBoundary {
        /// The component, in order of first faces.
        component: usize,
    },
    /// The irregular vertices of quads are not the cones of their map.
    QuadIndex {
        /// The index, in quarters.
        index: i32,
        /// Interior vertices of it.
        vertices: usize,
        /// Cones of it.
        cones: usize,
    },
    /// The number of quads is not the area of their map, in grid units.
    QuadCount {
        /// Quads.
        quads: usize,
        /// The area.
        area: f64,
    },
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::VertexCount { source_count, map } => {
                write!(f, "the map has {map} vertices, the source {source_count}")
            }
            Self::FaceCount { source_count, map } => {
                write!(f, "the map has {map} faces, the source {source_count}")
            }
            Self::MovedVertex { vertex, distance } => {
                write!(f, "vertex {vertex} was moved by {distance:e}")
            }
            Self::ChangedFace { face } => write!(f, "face {face} is not the source's face"),
            Self::UvCount { expected, found } => {
                write!(f, "{found} corner UVs for {expected} corners")
            }
            Self::NonFiniteUv { face } => write!(f, "face {face} has a UV that is not finite"),
            Self::FlippedTriangle { face } => write!(f, "face {face} is flipped"),
            Self::CollapsedTriangle { face } => write!(f, "face {face} is collapsed"),
            Self::OpenSeam { vertices: [a, b], faces: [left, right], residual } => write!(
                f,
                "edge {a}-{b} between faces {left} and {right} does not close: off by {residual:e} of its length"
            ),
            Self::ConeAngle { vertex, quarters } => {
                write!(f, "vertex {vertex} has an angle of {quarters} quarter turns")
            }
            Self::InexactEdge { vertices: [a, b], faces: [left, right] } => {
                write!(
                    f,
                    "edge {a}-{b} between faces {left} and {right} does not fit to the last bit"
                )
            }
            Self::FractionalTranslation {
                vertices: [a, b],
                faces: [left, right],
                translation: [u, v],
            } => write!(
                f,
                "edge {a}-{b} between faces {left} and {right} has the translation ({u}, {v}), which is not integral"
            ),
            Self::FractionalCone { vertex, uv: [u, v] } => {
                write!(
                    f,
                    "the cone at vertex {vertex} lies at ({u}, {v}), which is not a grid point"
                )
            }
            Self::FractionalCorner { vertex, uv: [u, v] } => write!(
                f,
                "the corner at vertex {vertex} lies at ({u}, {v}), which is not a grid point"
            ),
            Self::OffIsoline { vertices: [a, b], face } => {
                write!(f, "edge {a}-{b} is not at an integer in face {face}")
            }
            Self::PoincareHopf { component, sum, expected } => {
                write!(f, "the indices of component {component} sum to {sum}, not to {expected}")
            }
            Self::NotAnEdge { vertices: [a, b] } => {
                write!(f, "no edge joins the vertices {a} and {b}, which should be aligned")
            }
            Self::OffAxis { vertices: [a, b], face, degrees } => {
                write!(f, "edge {a}-{b} is {degrees:e} degrees off the axes in face {face}")
            }
            Self::SectorAngle { vertex, between: [a, b], quarters } => write!(
                f,
                "at vertex {vertex} the angle between the aligned edges to {a} and {b} is {quarters} quarter turns"
            ),
            Self::BadFace { face } => {
                write!(f, "face {face} has a vertex that is not there, or one twice")
            }
            Self::RepeatedEdge { vertices: [a, b] } => {
                write!(f, "the faces at edge {a}-{b} do not lie on its two sides, one on each")
            }
            Self::SplitVertex { vertex } => {
                write!(f, "the faces around vertex {vertex} do not form one fan")
            }
            Self::StrayQuad { face } => {
                write!(f, "quad {face} joins several components of the surface")
            }
            Self::QuadPieces { component, pieces } => {
                write!(f, "the quads of component {component} are in {pieces} pieces")
            }
            Self::QuadTopology { component, quads, surface } => write!(
                f,
                "the quads of component {component} have the Euler characteristic {quads}, the surface {surface}"
            ),
            Self::QuadBoundary { component } => {
                write!(f, "of component {component} and its quads only one is closed")
            }
            Self::QuadIndex { index, vertices, cones } => {
                write!(f, "{vertices} irregular vertices have the index {index}, {cones} cones")
            }
            Self::QuadCount { quads, area } => {
                write!(f, "{quads} quads cover a map with an area of {area}")
            }
        }
    }
}

/// All violations found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Violations(pub Vec<Violation>);

impl Violations {
    /// An error with these, if there is any.
    pub(crate) fn unless_none(found: Vec<Violation>) -> Result<(), Self> {
        if found.is_empty() { Ok(()) } else { Err(Self(found)) }
    }

    /// Those of a piece of a map in the ids of the whole.
    #[must_use]
    pub fn in_whole(
        mut self,
        face_of: impl Fn(u32) -> u32,
        vertex_of: impl Fn(u32) -> u32,
    ) -> Self {
        let faces_of = |faces: &mut [u32]| faces.iter_mut().for_each(|f| *f = face_of(*f));
        let vertices_of =
            |vertices: &mut [u32]| vertices.iter_mut().for_each(|v| *v = vertex_of(*v));
        for violation in &mut self.0 {
            match violation {
                Violation::NonFiniteUv { face }
                | Violation::FlippedTriangle { face }
                | Violation::CollapsedTriangle { face }
                | Violation::ChangedFace { face }
                | Violation::BadFace { face } => faces_of(std::slice::from_mut(face)),
                Violation::ConeAngle { vertex, .. }
                | Violation::FractionalCone { vertex, .. }
                | Violation::FractionalCorner { vertex, .. }
                | Violation::SplitVertex { vertex }
                | Violation::MovedVertex { vertex, .. } => vertices_of(std::slice::from_mut(vertex)),
                Violation::OpenSeam { vertices, faces, .. }
                | Violation::InexactEdge { vertices, faces }
                | Violation::FractionalTranslation { vertices, faces, .. } => {
                    vertices_of(vertices);
                    faces_of(faces);
                }
                Violation::NotAnEdge { vertices } | Violation::RepeatedEdge { vertices } => {
                    vertices_of(vertices);
                }
                Violation::OffAxis { vertices, face, .. }
                | Violation::OffIsoline { vertices, face } => {
                    vertices_of(vertices);
                    faces_of(std::slice::from_mut(face));
                }
                Violation::SectorAngle { vertex, between, .. } => {
                    vertices_of(std::slice::from_mut(vertex));
                    vertices_of(between);
                }
                Violation::VertexCount { .. }
                | Violation::FaceCount { .. }
                | Violation::UvCount { .. }
                | Violation::PoincareHopf { .. }
                // Quads have ids of their own.
                | Violation::StrayQuad { .. }
                | Violation::QuadPieces { .. }
                | Violation::QuadTopology { .. }
                | Violation::QuadBoundary { .. }
                | Violation::QuadIndex { .. }
                | Violation::QuadCount { .. } => {}
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
