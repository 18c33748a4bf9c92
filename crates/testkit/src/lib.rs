//! Shapes and generators for the tests of Seamstress (not published).
//!
//! Every function returns a [`TriangleSoup`](seamstress_mesh::soup::TriangleSoup) and is
//! deterministic: what is random comes from a seed. Shapes have faces counter-clockwise seen from
//! outside and lengths of about 1 unless they say otherwise. Arguments out of range panic: this
//! crate serves tests alone.
#![allow(clippy::unwrap_used, clippy::panic)]

mod collection;
mod consistency;
mod data;
mod degenerate;
mod family;
mod flips;
mod integer_maps;
mod modify;
mod parts;
mod patches;
mod quads;
mod random;
mod rng;
mod solids;
mod tori;
mod voxels;

pub use collection::{FOLDER, REQUIRED, in_collection};
pub use consistency::{CheckedSeam, consistency_faults};
pub use data::{DataMesh, PolygonSoup, data_meshes};
pub use degenerate::{with_copied_vertices, with_vertices_on_edges};
pub use family::family;
pub use flips::random_flips;
pub use integer_maps::{IntegerMap, random_voxels, squares};
pub use modify::{
    bumpy, disjoint_union, klee, relabel, remove_faces, scale, stretch, subdivide, with_boundaries,
};
pub use parts::{extruded, parts, pyramid, revolved, ring, sheet};
pub use patches::{annulus, cylinder, disk_grid, fan, graph, monkey_saddle, saddle};
pub use quads::{QuadSoup, random_quads};
pub use random::{random_surface, small_sphere};
pub use rng::Rng;
pub use solids::{crown, cube, icosahedron, icosphere, octahedron, tetrahedron, uv_sphere};
pub use tori::{seven_vertex_torus, torus};
pub use voxels::{double_torus, l_bracket, slab_with_holes, voxel_surface};

#[cfg(test)]
mod testing;
