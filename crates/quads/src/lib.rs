//! Quad meshes: from integer maps, laid out in the plane, and measured.

pub mod layout;
mod mesh;
pub mod quality;

pub use mesh::{QuadMesh, QuadMeshError};
