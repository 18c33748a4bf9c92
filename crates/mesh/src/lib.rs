//! Triangle meshes for Seamstress: connectivity, checks, repairs and intrinsic geometry.
//!
//! * [`soup`]: triangles as they come from a file; every fault found and named, harmless ones
//!   repaired on request.
//! * [`TriMesh`]: half-edge connectivity of an oriented manifold, no geometry.
//! * [`Metric`]: edge lengths and what follows from them: angles, areas, flat corners, curvature.
//! * [`Geometry`]: positions, and the sizes of cells there, of which a metric is made.
//! * [`features`]: edges that lines of a map should follow, and the curves they form.
//! * [`coarse`]: a coarser mesh of nearly the same surface.
//! * [`components`]: the connected pieces of a soup, each a mesh of its own.
//! * [`symmetry`]: planes of symmetry and the side of a mesh over one.
//! * [`attributes`]: what a mesh carries: values of vertices, corners and faces.
//!
//! Nothing here reads files, solves systems or prints.

pub mod attributes;
pub mod coarse;
pub mod components;
mod directed;
pub mod features;
mod flat;
mod geometry;
pub mod ids;
mod mesh;
mod metric;
pub mod refine;
pub mod soup;
pub mod symmetry;
mod vector;

pub use components::Component;
pub use geometry::{Geometry, PieceGeometry, edge_scale};
pub use ids::{Face, FaceData, Halfedge, HalfedgeData, Vertex, VertexData};
pub use mesh::{MeshError, TriMesh};
pub use metric::Metric;
pub use num_complex::Complex64;
