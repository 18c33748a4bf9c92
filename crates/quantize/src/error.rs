//! Why there is no integer-grid map.

use crate::gauss::Overflow;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::components::{self, FailedComponent};
use seamstress_mesh::{Component, Vertex};
use seamstress_parametrize::map::{Violations, first_in_words, in_whole};
use seamstress_parametrize::progress::Cancelled;

/// Pairs of vertices that a message lists.
const LISTED: usize = 5;

/// Why there is no integer-grid map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum QuantizeError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The size of the grid is not a positive number.
    #[error("the size of the grid is not a positive number")]
    BadSize,
    /// Positions or UVs do not fit the mesh.
    #[error(
        "{positions} positions and {corners} corners of UVs for a mesh of {vertices} vertices and {faces} faces"
    )]
    Mismatch {
        /// Positions given.
        positions: usize,
        /// UVs given.
        corners: usize,
        /// Vertices of the mesh.
        vertices: usize,
        /// Faces of the mesh.
        faces: usize,
    },
    /// Components have no integer-grid map on this grid, nor on finer ones.
    #[error("{}", components::listed(.0))]
    Components(Vec<FailedComponent<QuantizationFailure>>),
    /// The edges given are not aligned in the map.
    #[error("the map is not aligned: {}", first_in_words(&.0.0))]
    Misaligned(#[source] Violations),
    /// The result did not pass the certificate. Nothing is returned then.
    #[error("the integer-grid map failed its certificate: {}", first_in_words(&.0.0))]
    Uncertified(#[from] Violations),
}

/// Why a component has no integer-grid map; elements are those of the whole mesh.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum QuantizationFailure {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The relations of the seams do not fit into 64-bit integers.
    #[error(transparent)]
    Overflow(#[from] Overflow),
    /// A linear system could not be solved.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
    /// The given map flips when its seams are closed exactly.
    #[error(
        "the map has triangles too thin to close its seams exactly; collapse them, or make another map"
    )]
    Unreadable,
    /// Lines between cones, corners or isolines would vanish or turn around, or two edges of quads would join the same
    /// points.
    #[error(
        "the grid is too coarse: {count} pairs of cones or feature lines would merge or swap{}; ask for more quads",
        listed(.pairs)
    )]
    TooCoarse {
        /// How many.
        count: usize,
        /// The vertices at the ends of such lines.
        pairs: Vec<[u32; 2]>,
    },
    /// Triangles would collapse while the layout moves to the integers.
    #[error(
        "the layout cannot be moved to the rounded positions without collapsing triangles near face {face} \
         (stopped at {:.0} %); ask for more quads",
        100.0 * .reached
    )]
    Blocked {
        /// A face among those that collapse.
        face: u32,
        /// Share of the distance that could be gone.
        reached: f64,
        /// The vertices at the ends of lines that are much shorter than a cell, in the whole component: what leaves
        /// integers little room.
        pairs: Vec<[u32; 2]>,
    },
    /// The caller refused the map of every grid tried.
    #[error("no grid gave an acceptable map: {0}; ask for more quads")]
    Refused(#[source] Refusal),
    /// The result fails its certificate.
    #[error("{}", first_in_words(&.0.0))]
    Uncertified(#[from] Violations),
}

/// Why a caller refuses the map of a component.
#[derive(Debug, Clone, Default, thiserror::Error)]
#[error("{reason}")]
pub struct Refusal {
    /// What is wrong with it.
    pub reason: String,
    /// Faces of the whole mesh where that is.
    pub faces: Vec<u32>,
}

impl QuantizationFailure {
    /// With the elements of the whole mesh in place of those of a piece of it.
    pub(crate) fn in_whole(self, piece: &Component) -> Self {
        match self {
            // The caller has named its faces.
            refused @ Self::Refused(_) => refused,
            other => other.renamed(|v| piece.vertices[Vertex(v)].0, |f| piece.faces[f as usize].0),
        }
    }

    /// With other names of vertices and faces.
    #[must_use]
    pub fn renamed(self, vertex: impl Fn(u32) -> u32, face: impl Fn(u32) -> u32) -> Self {
        let renamed = |pairs: Vec<[u32; 2]>| {
            pairs.into_iter().map(|pair| pair.map(&vertex)).collect::<Vec<_>>()
        };
        match self {
            Self::TooCoarse { count, pairs } => Self::TooCoarse { count, pairs: renamed(pairs) },
            Self::Blocked { face: at, reached, pairs } => {
                Self::Blocked { face: face(at), reached, pairs: renamed(pairs) }
            }
            Self::Refused(Refusal { reason, faces }) => {
                Self::Refused(Refusal { reason, faces: faces.into_iter().map(face).collect() })
            }
            Self::Uncertified(violations) => Self::Uncertified(in_whole(violations, face, vertex)),
            other => other,
        }
    }

    /// Whether another grid may help.
    pub(crate) fn is_of_grid(&self) -> bool {
        matches!(
            self,
            Self::TooCoarse { .. } | Self::Blocked { .. } | Self::Refused(_) | Self::Uncertified(_)
        )
    }
}

/// The first pairs of vertices, in words.
fn listed(pairs: &[[u32; 2]]) -> String {
    let shown: Vec<String> =
        pairs.iter().take(LISTED).map(|[a, b]| format!("{a} and {b}")).collect();
    match pairs.len() {
        0 => String::new(),
        n if n > LISTED => format!(" (vertices {}, ...)", shown.join(", ")),
        _ => format!(" (vertices {})", shown.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_elements_and_what_helps() {
        let pairs = vec![[3, 17], [3, 3]];
        let text = QuantizationFailure::TooCoarse { count: 2, pairs }.to_string();
        assert_eq!(
            text,
            "the grid is too coarse: 2 pairs of cones or feature lines would merge or swap (vertices 3 and 17, \
             3 and 3); ask for more quads"
        );
        let text = QuantizationFailure::Blocked { face: 8, reached: 0.374, pairs: vec![[1, 2]] };
        let text = text.to_string();
        assert!(text.contains("near face 8 (stopped at 37 %)"), "{text}");
    }
}
