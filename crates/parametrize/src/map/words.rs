//! What is wrong with a map or a quad mesh, in words, and of which elements of a larger mesh.

use seamstress_certify::{Violation, Violations};

/// What a violation says, with the ids of its elements from 0.
pub fn in_words(violation: &Violation) -> String {
    match *violation {
        Violation::VertexCount { source_count: source, map } => {
            format!("the map has {map} vertices, the source {source}")
        }
        Violation::FaceCount { source_count: source, map } => {
            format!("the map has {map} faces, the source {source}")
        }
        Violation::MovedVertex { vertex: v, distance: x } => {
            format!("vertex {v} was moved by {x:e}")
        }
        Violation::ChangedFace { face } => format!("face {face} is not the source's face"),
        Violation::UvCount { expected, found } => {
            format!("{found} corner UVs for {expected} corners")
        }
        Violation::NonFiniteUv { face } => format!("face {face} has a UV that is not finite"),
        Violation::FlippedTriangle { face } => format!("face {face} is flipped"),
        Violation::CollapsedTriangle { face } => format!("face {face} is collapsed"),
        Violation::OpenSeam { vertices: [a, b], faces: [left, right], residual: x } => format!(
            "edge {a}-{b} between faces {left} and {right} does not close: off by {x:e} of its length"
        ),
        Violation::ConeAngle { vertex: v, quarters: x } => {
            format!("vertex {v} has an angle of {x} quarter turns")
        }
        Violation::InexactEdge { vertices: [a, b], faces: [left, right] } => {
            format!("edge {a}-{b} between faces {left} and {right} does not fit to the last bit")
        }
        Violation::FractionalTranslation {
            vertices: [a, b],
            faces: [left, right],
            translation: [u, v],
        } => format!(
            "edge {a}-{b} between faces {left} and {right} has the translation ({u}, {v}), which is not integral"
        ),
        Violation::FractionalCone { vertex, uv: [u, v] } => {
            format!("the cone at vertex {vertex} lies at ({u}, {v}), which is not a grid point")
        }
        Violation::FractionalCorner { vertex, uv: [u, v] } => {
            format!("the corner at vertex {vertex} lies at ({u}, {v}), which is not a grid point")
        }
        Violation::OffIsoline { vertices: [a, b], face } => {
            format!("edge {a}-{b} is not at an integer in face {face}")
        }
        Violation::PoincareHopf { component, sum, expected } => {
            format!("the indices of component {component} sum to {sum}, not to {expected}")
        }
        Violation::NotAnEdge { vertices: [a, b] } => {
            format!("no edge joins the vertices {a} and {b}, which should be aligned")
        }
        Violation::OffAxis { vertices: [a, b], face, degrees: x } => {
            format!("edge {a}-{b} is {x:e} degrees off the axes in face {face}")
        }
        Violation::SectorAngle { vertex: v, between: [a, b], quarters: x } => format!(
            "at vertex {v} the angle between the aligned edges to {a} and {b} is {x} quarter turns"
        ),
        Violation::BadFace { face } => {
            format!("face {face} has a vertex that is not there, or one twice")
        }
        Violation::RepeatedEdge { vertices: [a, b] } => {
            format!("the faces at edge {a}-{b} do not lie on its two sides, one on each")
        }
        Violation::SplitVertex { vertex: v } => {
            format!("the faces around vertex {v} do not form one fan")
        }
        Violation::StrayQuad { quad } => {
            format!("quad {quad} joins several components of the surface")
        }
        Violation::QuadPieces { component, pieces } => {
            format!("the quads of component {component} are in {pieces} pieces")
        }
        Violation::QuadTopology { component, quads, surface } => format!(
            "the quads of component {component} have the Euler characteristic {quads}, the surface {surface}"
        ),
        Violation::QuadBoundary { component } => {
            format!("of component {component} and its quads only one is closed")
        }
        Violation::QuadIndex { index, irregular, cones } => {
            format!("{irregular} irregular vertices have the index {index}, {cones} cones")
        }
        Violation::QuadCount { quads, area } => {
            format!("{quads} quads cover a map with an area of {area}")
        }
    }
}

/// The first of some violations, and how many more there are.
pub fn first_in_words(violations: &[Violation]) -> String {
    match violations {
        [] => "no violation".into(),
        [one] => in_words(one),
        [first, rest @ ..] => format!("{} (and {} more violations)", in_words(first), rest.len()),
    }
}

/// Violations of a piece of a map in the ids of the whole. Quads have ids of their own.
#[must_use]
pub fn in_whole(
    found: Violations,
    face_of: impl Fn(u32) -> u32,
    vertex_of: impl Fn(u32) -> u32,
) -> Violations {
    use Violation as V;
    let renamed = |mut violation: V| {
        match &mut violation {
            V::ChangedFace { face }
            | V::NonFiniteUv { face }
            | V::FlippedTriangle { face }
            | V::CollapsedTriangle { face }
            | V::BadFace { face } => *face = face_of(*face),
            V::MovedVertex { vertex, .. }
            | V::ConeAngle { vertex, .. }
            | V::FractionalCone { vertex, .. }
            | V::FractionalCorner { vertex, .. }
            | V::SplitVertex { vertex } => *vertex = vertex_of(*vertex),
            V::OpenSeam { vertices, faces, .. }
            | V::InexactEdge { vertices, faces }
            | V::FractionalTranslation { vertices, faces, .. } => {
                *vertices = vertices.map(&vertex_of);
                *faces = faces.map(&face_of);
            }
            V::OffIsoline { vertices, face } | V::OffAxis { vertices, face, .. } => {
                *vertices = vertices.map(&vertex_of);
                *face = face_of(*face);
            }
            V::NotAnEdge { vertices } | V::RepeatedEdge { vertices } => {
                *vertices = vertices.map(&vertex_of);
            }
            V::SectorAngle { vertex, between, .. } => {
                *vertex = vertex_of(*vertex);
                *between = between.map(&vertex_of);
            }
            V::VertexCount { .. }
            | V::FaceCount { .. }
            | V::UvCount { .. }
            | V::PoincareHopf { .. }
            | V::StrayQuad { .. }
            | V::QuadPieces { .. }
            | V::QuadTopology { .. }
            | V::QuadBoundary { .. }
            | V::QuadIndex { .. }
            | V::QuadCount { .. } => {}
        }
        violation
    };
    Violations(found.0.into_iter().map(renamed).collect())
}

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
        let found = in_whole(Violations(of_piece), |face| face + 100, |vertex| vertex + 20);
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
        assert_eq!(in_words(&seam), text);
        let cone = Violation::FractionalCone { vertex: 8, uv: [0.5, -3.0] };
        let of_cone = "the cone at vertex 8 lies at (0.5, -3), which is not a grid point";
        assert_eq!(in_words(&cone), of_cone);
        assert_eq!(first_in_words(&[]), "no violation");
        assert_eq!(first_in_words(std::slice::from_ref(&cone)), of_cone);
        let all = [seam, cone.clone(), cone];
        assert_eq!(first_in_words(&all), format!("{text} (and 2 more violations)"));
    }
}
