//! What keeps a map from giving quads.

use seamstress_parametrize::progress::Cancelled;
use std::fmt;

/// One reason why UVs are no integer map, naming its element (ids from 0).
#[derive(Debug, Clone, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum MapFault {
    /// The two images of an edge do not differ by a quarter turn and a translation.
    #[error(
        "edge {}-{} between faces {} and {} does not close: off by {gap:.3e} grid units",
        vertices[0], vertices[1], faces[0], faces[1]
    )]
    OpenEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
        /// Mismatch, grid units.
        gap: f64,
    },
    /// A translation that is no integer.
    #[error(
        "edge {}-{} between faces {} and {} has the translation {}, {}, not an integer",
        vertices[0], vertices[1], faces[0], faces[1], translation[0], translation[1]
    )]
    Translation {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// Its faces.
        faces: [u32; 2],
        /// From the first face to the second, grid units.
        translation: [f64; 2],
    },
    /// A cone that is not at a grid point.
    #[error("cone {vertex} of index {index:+} lies at {}, {}, not at a grid point", at[0], at[1])]
    ConeOffGrid {
        /// The vertex.
        vertex: u32,
        /// Its index in quarters.
        index: i32,
        /// Where it lies, in the chart of one of its faces.
        at: [f64; 2],
    },
    /// The transitions around an interior vertex shift it.
    #[error("the faces around vertex {vertex} do not close up")]
    OpenVertex {
        /// The vertex.
        vertex: u32,
    },
}

/// All faults of a map: those of edges, or if there are none those of vertices.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct MapFaults(pub Vec<MapFault>);

impl MapFaults {
    /// Whether the map is seamless, and translations and cones alone are not integral.
    pub fn is_seamless(&self) -> bool {
        let is_integrality = |fault: &MapFault| {
            matches!(fault, MapFault::Translation { .. } | MapFault::ConeOffGrid { .. })
        };
        self.0.iter().all(is_integrality)
    }
}

impl fmt::Display for MapFaults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.as_slice() {
            [] => write!(f, "no fault"),
            [one] => one.fmt(f),
            [first, rest @ ..] => write!(f, "{first} (and {} more faults)", rest.len()),
        }
    }
}

/// Why no quads were extracted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExtractError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The numbers of positions or UVs do not fit the mesh.
    #[error("{found} {what} for a mesh that needs {expected}")]
    WrongCount {
        /// Positions or corner UVs.
        what: &'static str,
        /// As many as the mesh has vertices or corners.
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
    /// A UV beyond what is taken.
    #[error("face {face} has a UV beyond {limit:e} grid units")]
    TooLarge {
        /// The face.
        face: u32,
        /// The largest coordinate allowed.
        limit: f64,
    },
    /// The UVs are no integer map.
    #[error("not an integer map: {0}")]
    NotInteger(MapFaults),
    /// Faces turned over or without area in the plane.
    #[error(
        "the map folds: {} flipped and {} collapsed faces, the first is face {}",
        flipped.len(), collapsed.len(), flipped.iter().chain(collapsed).min().copied().unwrap_or_default()
    )]
    Folds {
        /// Faces of negative orientation, ascending.
        flipped: Vec<u32>,
        /// Faces without area, ascending.
        collapsed: Vec<u32>,
    },
    /// More pieces of cells than are worked on.
    #[error(
        "the faces are cut into {pieces} pieces of cells, more than {limit}: is the map in grid units?"
    )]
    TooFine {
        /// Pieces: a face has one for each cell it meets.
        pieces: u64,
        /// The most allowed.
        limit: u64,
    },
    /// Not one cell is whole.
    #[error("the map has no whole cell ({partial} partial ones): is it in grid units?")]
    NoQuads {
        /// Cells cut by the boundary.
        partial: usize,
    },
}
