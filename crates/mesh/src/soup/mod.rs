//! From polygons as read to triangles that are known to form a surface.
//!
//! A [`TriangleSoup`] promises nothing. [`triangulate`] makes one from polygons, [`check`] lists
//! everything that keeps it from being an oriented manifold, and [`repair`] undoes what can be
//! undone without moving or merging a vertex. Before, [`weld`] or [`collapse`] say which vertices of
//! the polygons are to be one, and [`merge`] makes them so. No function here changes its input silently: each
//! returns a record of what it found or did.
//!
//! A soup without errors fits a half-edge structure keyed by directed vertex pairs: every pair
//! `(a, b)` is a side of at most one face, every edge has one or two faces, and the faces around
//! a vertex form a single fan.

mod check;
mod connectivity;
mod copies;
mod ear_clipping;
mod edges;
mod facts;
mod fault;
mod geometry;
mod merge;
mod repair;
pub(crate) mod sets;
mod sheets;
mod topology;
mod triangulate;
mod weld;

pub use check::{Report, check};
pub use facts::{ComponentFacts, Facts};
pub use fault::{Fault, Severity};
pub use merge::{Merged, merge};
pub use repair::{Repair, Repaired, repair};
pub use triangulate::{Triangulation, TriangulationNotes, polygon_faults, triangulate};
pub use weld::{collapse, is_unwelded, weld, weld_tolerance};

/// The most faces a soup may have: each has three sides and may need three more on the boundary,
/// all numbered by `u32`.
pub const MAX_FACES: usize = (u32::MAX / 6) as usize;

/// The most vertices a soup may have.
pub const MAX_VERTICES: usize = u32::MAX as usize;

/// Triangles as read: positions and vertex triples, promising nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleSoup {
    /// One position per vertex, #V by 3, in mesh units.
    pub positions: Vec<[f64; 3]>,
    /// Three vertices per face, #F by 3, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
}
