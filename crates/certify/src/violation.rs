//! What can be wrong with a map or a quad mesh.

use std::fmt;

/// What a violation and its fields are called is what it says of them: each kind is written once, with its fields, the
/// names that their numbers have in its text, and the text.
macro_rules! violations {
    ($($(#[$doc:meta])* $kind:ident { $($field:ident: $type:ty = $name:pat),* } $text:literal)*) => {
        /// One reason why a map is not a seamless map, naming its element (ids from 0).
        #[derive(Debug, Clone, PartialEq, serde::Serialize)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        #[non_exhaustive]
        pub enum Violation {
            $($(#[$doc])* $kind { $(#[doc = concat!("Of the text: ", $text)] $field: $type),* }),*
        }

        impl fmt::Display for Violation {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match *self {
                    $(Self::$kind { $($field: $name),* } => write!(f, $text)),*
                }
            }
        }

        impl Violation {
            /// With the ids of the vertices and faces in its fields changed; quads have ids of their own.
            fn renumber(&mut self, face_of: &impl Fn(u32) -> u32, vertex_of: &impl Fn(u32) -> u32) {
                match self {
                    $(Self::$kind { $($field),* } => {
                        $(renumber!($field $field, face_of, vertex_of);)*
                    })*
                }
            }
        }
    };
}

/// Changes the ids of a field by its name.
macro_rules! renumber {
    (face $id:ident, $face_of:ident, $vertex_of:ident) => {
        *$id = $face_of(*$id)
    };
    (vertex $id:ident, $face_of:ident, $vertex_of:ident) => {
        *$id = $vertex_of(*$id)
    };
    (faces $ids:ident, $face_of:ident, $vertex_of:ident) => {
        *$ids = $ids.map($face_of)
    };
    (vertices $ids:ident, $face_of:ident, $vertex_of:ident) => {
        *$ids = $ids.map($vertex_of)
    };
    (between $ids:ident, $face_of:ident, $vertex_of:ident) => {
        *$ids = $ids.map($vertex_of)
    };
    ($other:ident $number:ident, $face_of:ident, $vertex_of:ident) => {
        let _ = $number;
    };
}

violations! {
    /// The map has another number of vertices than the source.
    VertexCount { source_count: usize = source, map: usize = map }
    "the map has {map} vertices, the source {source}"
    /// The map has another number of faces than the source.
    FaceCount { source_count: usize = source, map: usize = map }
    "the map has {map} faces, the source {source}"
    /// A vertex was moved, by a distance in mesh units.
    MovedVertex { vertex: u32 = v, distance: f64 = x } "vertex {v} was moved by {x:e}"
    /// A face has other vertices, or the same in another order.
    ChangedFace { face: u32 = face } "face {face} is not the source's face"
    /// The number of UVs does not fit the faces: three of each.
    UvCount { expected: usize = expected, found: usize = found }
    "{found} corner UVs for {expected} corners"
    /// A UV is not finite.
    NonFiniteUv { face: u32 = face } "face {face} has a UV that is not finite"
    /// A triangle of negative orientation.
    FlippedTriangle { face: u32 = face } "face {face} is flipped"
    /// A triangle without area.
    CollapsedTriangle { face: u32 = face } "face {face} is collapsed"
    /// The two images of an edge do not differ by a quarter turn and a translation. The mismatch is in lengths of the edge,
    /// of the longer of its two images.
    OpenSeam { vertices: [u32; 2] = [a, b], faces: [u32; 2] = [left, right], residual: f64 = x }
    "edge {a}-{b} between faces {left} and {right} does not close: off by {x:e} of its length"
    /// An interior angle sum that is not a positive multiple of a quarter turn.
    ConeAngle { vertex: u32 = v, quarters: f64 = x } "vertex {v} has an angle of {x} quarter turns"
    /// The two images of an edge differ in the last bits from a quarter turn and a translation.
    InexactEdge { vertices: [u32; 2] = [a, b], faces: [u32; 2] = [left, right] }
    "edge {a}-{b} between faces {left} and {right} does not fit to the last bit"
    /// A translation across an edge, from left to right, is not integral.
    FractionalTranslation { vertices: [u32; 2] = [a, b], faces: [u32; 2] = [left, right],
        translation: [f64; 2] = [u, v] }
    "edge {a}-{b} between faces {left} and {right} has the translation ({u}, {v}), which is not integral"
    /// A cone is not at a grid point in one of its faces.
    FractionalCone { vertex: u32 = vertex, uv: [f64; 2] = [u, v] }
    "the cone at vertex {vertex} lies at ({u}, {v}), which is not a grid point"
    /// A vertex at which aligned edges turn is not at a grid point in one of its faces.
    FractionalCorner { vertex: u32 = vertex, uv: [f64; 2] = [u, v] }
    "the corner at vertex {vertex} lies at ({u}, {v}), which is not a grid point"
    /// The image of an aligned edge, in the face on one side, does not lie on an isoline at an integer.
    OffIsoline { vertices: [u32; 2] = [a, b], face: u32 = face }
    "edge {a}-{b} is not at an integer in face {face}"
    /// The indices of a component (in order of first faces) do not add up to four times its Euler characteristic.
    PoincareHopf { component: usize = component, sum: f64 = sum, expected: i64 = expected }
    "the indices of component {component} sum to {sum}, not to {expected}"
    /// A pair of vertices that should name an aligned edge does not.
    NotAnEdge { vertices: [u32; 2] = [a, b] }
    "no edge joins the vertices {a} and {b}, which should be aligned"
    /// The image of an aligned edge, in the face on one side, is not parallel to an axis.
    OffAxis { vertices: [u32; 2] = [a, b], face: u32 = face, degrees: f64 = x }
    "edge {a}-{b} is {x:e} degrees off the axes in face {face}"
    /// The angle between two aligned edges is not a positive multiple of a quarter turn. They are named by their other ends,
    /// counter-clockwise: the same vertex for the full turn at the end of a single edge.
    SectorAngle { vertex: u32 = v, between: [u32; 2] = [a, b], quarters: f64 = x }
    "at vertex {v} the angle between the aligned edges to {a} and {b} is {x} quarter turns"
    /// A face names a vertex that is not there, or one twice.
    BadFace { face: u32 = face } "face {face} has a vertex that is not there, or one twice"
    /// More than two faces share an edge, or two run along it in the same direction.
    RepeatedEdge { vertices: [u32; 2] = [a, b] }
    "the faces at edge {a}-{b} do not lie on its two sides, one on each"
    /// The faces around a vertex do not form one fan.
    SplitVertex { vertex: u32 = v } "the faces around vertex {v} do not form one fan"
    /// A quad joins points of several components of the surface.
    StrayQuad { quad: u32 = quad } "quad {quad} joins several components of the surface"
    /// The quads of a component of the surface are not in one piece.
    QuadPieces { component: usize = component, pieces: usize = pieces }
    "the quads of component {component} are in {pieces} pieces"
    /// The quads of a component of the surface have another topology.
    QuadTopology { component: usize = component, quads: i64 = quads, surface: i64 = surface }
    "the quads of component {component} have the Euler characteristic {quads}, the surface {surface}"
    /// Of a component of the surface and its quads, only one is closed.
    QuadBoundary { component: usize = component }
    "of component {component} and its quads only one is closed"
    /// The irregular vertices of quads are not the cones of their map: so many off the boundary have an index, in quarters.
    QuadIndex { index: i32 = index, irregular: usize = irregular, cones: usize = cones }
    "{irregular} irregular vertices have the index {index}, {cones} cones"
    /// The number of quads is not the area of their map, in grid units.
    QuadCount { quads: usize = quads, area: f64 = area }
    "{quads} quads cover a map with an area of {area}"
}

/// All violations found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Violations(pub Vec<Violation>);

impl Violations {
    /// An error with these, if there is any.
    pub(crate) fn unless_none(found: impl IntoIterator<Item = Violation>) -> Result<(), Self> {
        let found: Vec<_> = found.into_iter().collect();
        if found.is_empty() { Ok(()) } else { Err(Self(found)) }
    }

    /// Those of a piece of a map in the ids of the whole.
    #[must_use]
    pub fn in_whole(
        mut self,
        face_of: impl Fn(u32) -> u32,
        vertex_of: impl Fn(u32) -> u32,
    ) -> Self {
        self.0.iter_mut().for_each(|violation| violation.renumber(&face_of, &vertex_of));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_have_the_ids_of_the_whole() {
        let of_piece = vec![
            Violation::OpenSeam { vertices: [1, 2], faces: [3, 4], residual: 0.5 },
            Violation::OffAxis { vertices: [1, 2], face: 3, degrees: 2.0 },
            Violation::SectorAngle { vertex: 1, between: [2, 3], quarters: 0.5 },
            Violation::FractionalCone { vertex: 1, uv: [0.5, 2.0] },
            Violation::BadFace { face: 7 },
            // Neither vertices nor faces of the piece.
            Violation::StrayQuad { quad: 5 },
            Violation::QuadIndex { index: 1, irregular: 2, cones: 3 },
            Violation::UvCount { expected: 6, found: 5 },
        ];
        let found = Violations(of_piece).in_whole(|face| face + 100, |vertex| vertex + 20);
        let expected = [
            Violation::OpenSeam { vertices: [21, 22], faces: [103, 104], residual: 0.5 },
            Violation::OffAxis { vertices: [21, 22], face: 103, degrees: 2.0 },
            Violation::SectorAngle { vertex: 21, between: [22, 23], quarters: 0.5 },
            Violation::FractionalCone { vertex: 21, uv: [0.5, 2.0] },
            Violation::BadFace { face: 107 },
            Violation::StrayQuad { quad: 5 },
            Violation::QuadIndex { index: 1, irregular: 2, cones: 3 },
            Violation::UvCount { expected: 6, found: 5 },
        ];
        assert_eq!(found.0, expected);
    }

    #[test]
    fn texts_name_elements_and_numbers() {
        let seam = Violation::OpenSeam { vertices: [1, 2], faces: [3, 4], residual: 2.5e-7 };
        let text = "edge 1-2 between faces 3 and 4 does not close: off by 2.5e-7 of its length";
        assert_eq!(seam.to_string(), text);
        let cone = Violation::FractionalCone { vertex: 8, uv: [0.5, -3.0] };
        let of_cone = "the cone at vertex 8 lies at (0.5, -3), which is not a grid point";
        assert_eq!(cone.to_string(), of_cone);
        assert_eq!(Violations(vec![]).to_string(), "no violation");
        assert_eq!(Violations(vec![cone.clone()]).to_string(), of_cone);
        let all = Violations(vec![seam, cone.clone(), cone]);
        assert_eq!(all.to_string(), format!("{text} (and 2 more violations)"));
    }
}
