//! Quad meshes: from integer maps, laid out in the plane, and measured.

mod connectivity;
pub mod extract;
pub mod layout;
mod mesh;
mod pinches;
pub mod quality;
pub mod smooth;

pub use connectivity::{IrregularVertex, QuadConnectivity, QuadFault, QuadFaults};
pub use extract::{ExtractError, ExtractOptions, Extraction, extract};
pub use mesh::{QuadMesh, QuadMeshError};
pub use smooth::{SmoothError, SmoothOptions, Smoothed, smooth};
