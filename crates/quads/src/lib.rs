//! Quad meshes: from integer maps, laid out in the plane, and measured.

mod badness;
mod connectivity;
mod constraints;
mod curve;
pub mod extract;
pub mod layout;
mod manifold;
mod mesh;
mod moves;
mod pinches;
pub mod quality;
pub mod smooth;
mod spacing;
mod split;
mod stretch;
mod surface;
mod surface_point;
mod symmetric;
mod transfer;
mod untangle;
mod vector;

pub use connectivity::{IrregularVertex, QuadConnectivity, QuadFault, QuadFaults};
pub use constraints::{Constraints, SlideCurve};
pub use extract::{ExtractError, ExtractOptions, Extraction, extract};
pub use manifold::{GoesOn, ManifoldError, ManifoldQuads, manifold_quads};
pub use mesh::{QuadMesh, QuadMeshError};
pub use smooth::{SmoothError, SmoothOptions, Smoothed, smooth};
pub use surface::locate;
pub use symmetric::{Planes, Symmetric, symmetric};
pub use transfer::Transfer;
pub use untangle::{UntangleOptions, Untangling, untangle};
