//! A small checker of seamless maps, integer-grid maps and quad meshes.
//!
//! It shares no code with what makes them, and takes nothing on trust but the numbers of a result: faces, one UV per
//! corner, and which edges should be aligned. Which side of an edge a point lies on, into which quadrant an edge
//! points and by how many quarters the faces around a vertex turn are decided without rounding.
//!
//! * [`Map`]: a map of a triangle mesh; [`Map::seamless`], [`Map::alignment`] and [`Map::integers`] certify it.
//! * [`Quads`]: quads against the surface and the map that they come from.
//! * [`compare_source`]: a map against the mesh it was made from.
//! * [`Obj`]: what a file says.
//!
//! `docs/theory/03-certificate.md` explains the checks and their tolerances.

mod exact;
mod file;
mod grid;
mod manifold;
mod map;
mod plane;
mod quads;
mod seamless;
mod verdict;

pub use file::{Obj, Triangles, compare_source};
pub use grid::{Alignment, IntegerCertificate};
pub use map::Map;
pub use quads::{QuadCertificate, Quads};
pub use seamless::{Certificate, Cone, Seam, Seamless};
pub use verdict::{Checked, Tolerance, Violation, Violations};
