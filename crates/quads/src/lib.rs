//! Quad meshes: from integer maps, laid out in the plane, and measured.

mod mesh;

pub use mesh::{QuadMesh, QuadMeshError};
