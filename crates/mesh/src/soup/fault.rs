//! What can be wrong with a soup, each fault naming its elements.

use std::fmt::Write as _;

/// Whether a fault keeps the soup from being a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// A map can still be made.
    Warning,
    /// The soup is no oriented manifold.
    Error,
}

/// One thing wrong with a soup of triangles or polygons. Indices count from 0; an edge is named by
/// its two vertices, the smaller first.
#[derive(Debug, Clone, PartialEq, Eq, Hash, thiserror::Error, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Fault {
    /// There is nothing to work on.
    #[error("the mesh has no faces")]
    NoFaces,
    /// More faces than [`MAX_FACES`](super::MAX_FACES).
    #[error("the mesh has {n_faces} faces, more than the {limit} that can be numbered")]
    TooManyFaces {
        /// Number of faces given.
        n_faces: usize,
        /// Largest number allowed.
        limit: usize,
    },
    /// More vertices than [`MAX_VERTICES`](super::MAX_VERTICES).
    #[error("the mesh has {n_vertices} vertices, more than the {limit} that can be numbered")]
    TooManyVertices {
        /// Number of vertices given.
        n_vertices: usize,
        /// Largest number allowed.
        limit: usize,
    },
    /// A polygon with fewer than three corners.
    #[error("face {face} has {corners} corners, a face needs at least 3")]
    TooFewCorners {
        /// The polygon.
        face: u32,
        /// Its number of corners.
        corners: usize,
    },
    /// A face refers to a vertex that does not exist.
    #[error("face {face} refers to vertex {index}, the mesh has {n_vertices} vertices")]
    IndexOutOfRange {
        /// The face.
        face: u32,
        /// The vertex it asks for.
        index: u32,
        /// Number of vertices there are.
        n_vertices: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} has a coordinate that is not a finite number")]
    NonFiniteCoordinate {
        /// The vertex.
        vertex: u32,
    },
    /// A face uses one vertex for two of its corners.
    #[error("face {face} uses vertex {vertex} more than once")]
    RepeatedVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// A face has the vertices and the orientation of an earlier one.
    #[error("face {face} is a copy of face {first}")]
    DuplicateFace {
        /// The later face.
        face: u32,
        /// The first of its kind.
        first: u32,
    },
    /// A face is the reverse of an earlier one, and the pair shares an edge with other faces. (Two
    /// such faces alone are a closed surface, and no fault.)
    #[error("face {face} is the reverse of face {first}, and other faces share their edges")]
    OppositeFace {
        /// The later face.
        face: u32,
        /// The earlier face.
        first: u32,
    },
    /// More than two faces share an edge. Copies of a face do not count.
    #[error("edge {}-{} has {} faces: {}", vertices[0], vertices[1], faces.len(), list(faces))]
    NonManifoldEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// All its faces, in increasing order.
        faces: Vec<u32>,
    },
    /// The faces at a vertex form several fans that meet in the vertex alone.
    #[error("vertex {vertex} joins {fans} fans of faces that share no edge")]
    NonManifoldVertex {
        /// The vertex.
        vertex: u32,
        /// Number of fans.
        fans: usize,
    },
    /// The two faces of an edge run along it in the same direction.
    #[error(
        "faces {} and {} at edge {}-{} have opposite orientations",
        faces[0], faces[1], edge[0], edge[1]
    )]
    InconsistentOrientation {
        /// Ends of the edge.
        edge: [u32; 2],
        /// Its two faces, in increasing order.
        faces: [u32; 2],
    },
    /// No choice of orientations makes all faces of a component agree, as on a Möbius band.
    #[error(
        "the component of face {face} cannot be oriented: its faces cannot agree across edge {}-{}",
        edge[0], edge[1]
    )]
    NonOrientable {
        /// Lowest face of the component.
        face: u32,
        /// An edge that closes an orientation-reversing loop.
        edge: [u32; 2],
    },
    /// A triangle is no higher than the rounding of its coordinates.
    #[error("face {face} has zero area")]
    ZeroAreaFace {
        /// The face.
        face: u32,
    },
    /// The ends of an edge have the same position.
    #[error("edge {}-{} has zero length", vertices[0], vertices[1])]
    ZeroLengthEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
    },
    /// No face uses a vertex.
    #[error("vertex {vertex} belongs to no face")]
    UnreferencedVertex {
        /// The vertex.
        vertex: u32,
    },
}

impl Fault {
    /// How bad this fault is.
    #[must_use]
    pub fn severity(&self) -> Severity {
        match self {
            Self::ZeroAreaFace { .. }
            | Self::ZeroLengthEdge { .. }
            | Self::UnreferencedVertex { .. } => Severity::Warning,
            _ => Severity::Error,
        }
    }
}

impl Fault {
    /// The same fault with its faces renamed, such as by
    /// [`Triangulation::polygon_of_face`](super::Triangulation::polygon_of_face): triangles are
    /// checked, but a user knows the polygons of the file.
    #[must_use]
    pub fn with_faces_renamed(mut self, rename: impl Fn(u32) -> u32) -> Self {
        match &mut self {
            Self::TooFewCorners { face, .. }
            | Self::IndexOutOfRange { face, .. }
            | Self::RepeatedVertex { face, .. }
            | Self::NonOrientable { face, .. }
            | Self::ZeroAreaFace { face } => *face = rename(*face),
            Self::DuplicateFace { face, first } | Self::OppositeFace { face, first } => {
                (*face, *first) = (rename(*face), rename(*first));
            }
            Self::NonManifoldEdge { faces, .. } => {
                faces.iter_mut().for_each(|face| *face = rename(*face));
            }
            Self::InconsistentOrientation { faces, .. } => *faces = faces.map(rename),
            Self::NoFaces
            | Self::TooManyFaces { .. }
            | Self::TooManyVertices { .. }
            | Self::NonFiniteCoordinate { .. }
            | Self::NonManifoldVertex { .. }
            | Self::ZeroLengthEdge { .. }
            | Self::UnreferencedVertex { .. } => {}
        }
        self
    }

    /// The same fault with its vertices renamed, such as by
    /// [`Repaired::vertex_origin`](super::Repaired::vertex_origin).
    #[must_use]
    pub fn with_vertices_renamed(mut self, rename: impl Fn(u32) -> u32) -> Self {
        match &mut self {
            Self::NonFiniteCoordinate { vertex }
            | Self::RepeatedVertex { vertex, .. }
            | Self::NonManifoldVertex { vertex, .. }
            | Self::UnreferencedVertex { vertex } => *vertex = rename(*vertex),
            Self::NonManifoldEdge { vertices: edge, .. }
            | Self::InconsistentOrientation { edge, .. }
            | Self::NonOrientable { edge, .. }
            | Self::ZeroLengthEdge { vertices: edge } => {
                *edge = edge.map(rename);
                edge.sort_unstable();
            }
            Self::NoFaces
            | Self::TooManyFaces { .. }
            | Self::TooManyVertices { .. }
            | Self::TooFewCorners { .. }
            | Self::IndexOutOfRange { .. }
            | Self::DuplicateFace { .. }
            | Self::OppositeFace { .. }
            | Self::ZeroAreaFace { .. } => {}
        }
        self
    }
}

/// Longest list of elements written out in a message.
const LISTED: usize = 8;

/// "1, 2, 3", shortened to "1, 2, ... (40 in all)" when long.
pub(super) fn list(elements: &[u32]) -> String {
    let mut text = String::new();
    for (i, element) in elements.iter().take(LISTED).enumerate() {
        let separator = if i == 0 { "" } else { ", " };
        // Writing to a string cannot fail.
        let _ = write!(text, "{separator}{element}");
    }
    if elements.len() > LISTED {
        let _ = write!(text, ", ... ({} in all)", elements.len());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Fault, Severity, list};

    #[test]
    fn messages_name_their_elements() {
        let cases = [
            (
                Fault::IndexOutOfRange { face: 12, index: 9, n_vertices: 8 },
                "face 12 refers to vertex 9, the mesh has 8 vertices",
            ),
            (
                Fault::NonManifoldEdge { vertices: [3, 7], faces: vec![0, 4, 5] },
                "edge 3-7 has 3 faces: 0, 4, 5",
            ),
            (
                Fault::InconsistentOrientation { edge: [0, 2], faces: [1, 8] },
                "faces 1 and 8 at edge 0-2 have opposite orientations",
            ),
            (
                Fault::NonManifoldVertex { vertex: 3, fans: 2 },
                "vertex 3 joins 2 fans of faces that share no edge",
            ),
            (
                Fault::NonOrientable { face: 0, edge: [1, 4] },
                "the component of face 0 cannot be oriented: \
                 its faces cannot agree across edge 1-4",
            ),
            (
                Fault::TooManyFaces { n_faces: 800_000_000, limit: 715_827_882 },
                "the mesh has 800000000 faces, more than the 715827882 that can be numbered",
            ),
        ];
        for (fault, text) in cases {
            assert_eq!(fault.to_string(), text);
        }
    }

    #[test]
    fn only_geometry_and_spare_vertices_are_warnings() {
        assert_eq!(Fault::ZeroAreaFace { face: 0 }.severity(), Severity::Warning);
        assert_eq!(Fault::ZeroLengthEdge { vertices: [0, 1] }.severity(), Severity::Warning);
        assert_eq!(Fault::UnreferencedVertex { vertex: 0 }.severity(), Severity::Warning);
        assert_eq!(Fault::NoFaces.severity(), Severity::Error);
        assert!(Severity::Error > Severity::Warning);
    }

    #[test]
    fn faces_are_renamed_and_vertices_are_not() {
        let halved = |fault: Fault| fault.with_faces_renamed(|face| face / 2).to_string();
        let edge = Fault::NonManifoldEdge { vertices: [3, 7], faces: vec![0, 4, 5] };
        assert_eq!(halved(edge), "edge 3-7 has 3 faces: 0, 2, 2");
        let copy = Fault::DuplicateFace { face: 9, first: 6 };
        assert_eq!(halved(copy), "face 4 is a copy of face 3");
        let corner = Fault::RepeatedVertex { face: 9, vertex: 6 };
        assert_eq!(halved(corner), "face 4 uses vertex 6 more than once");
        let bowtie = Fault::NonManifoldVertex { vertex: 8, fans: 2 };
        assert_eq!(bowtie.clone().with_faces_renamed(|_| 0), bowtie);
    }

    #[test]
    fn vertices_are_renamed_and_the_ends_of_edges_stay_in_order() {
        let edge = Fault::ZeroLengthEdge { vertices: [1, 2] };
        let renamed = edge.with_vertices_renamed(|v| [0, 9, 4][v as usize]);
        assert_eq!(renamed, Fault::ZeroLengthEdge { vertices: [4, 9] });
        let face = Fault::ZeroAreaFace { face: 1 };
        assert_eq!(face.clone().with_vertices_renamed(|_| 0), face);
    }

    #[test]
    fn long_lists_are_cut_short() {
        assert_eq!(list(&[4, 5]), "4, 5");
        let many: Vec<u32> = (0..40).collect();
        assert_eq!(list(&many), "0, 1, 2, 3, 4, 5, 6, 7, ... (40 in all)");
    }
}
