//! Feature edges: those that lines of a map should follow, such as creases, rims and boundaries.
//!
//! * [`EdgeSet`]: a set of edges of a mesh, from vertex pairs ([`EdgeFinder`]), from dihedral angles
//!   ([`sharp_edges`]) or the boundary.
//! * [`sectors`]: the fans of corners into which a set of edges parts the surface around a vertex.
//! * [`creases`]: those that the shape of a surface shows.
//! * [`strips`] and [`strips_and_slivers`]: those side by side that a grid has no room for.
//! * [`FeatureGraph`]: corners, curves, loops and open ends of a set.

mod creases;
mod dihedral;
mod edge_set;
mod finder;
mod graph;
mod sector;
mod strips;

pub use creases::creases;
pub use dihedral::{dihedral_angle, sharp_edges};
pub use edge_set::EdgeSet;
pub use finder::{EdgeFinder, EdgeNameError};
pub use graph::{Curve, FeatureGraph, Node, NodeKind};
pub use sector::{Sector, sectors};
pub use strips::{strips, strips_and_slivers};
