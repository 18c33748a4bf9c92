//! Reading and writing meshes and maps for Seamstress: OBJ, OFF, PLY, STL and glTF.
//!
//! [`read_mesh`] and [`parse_mesh`] turn a file into a neutral [`PolygonMesh`]: positions and
//! polygons exactly as stored (corners of STL and glTF are welded by exact position), and typed [`Note`]s about
//! everything that was left out. Content compressed with gzip is unpacked. Whatever the input, they return a mesh or a [`ReadError`] that names
//! the file, the line or byte, what was found and what was expected; time and memory are linear in
//! the size of the file, whatever its header announces. Geometry and topology are not judged here.
//!
//! [`read_vertex_values`] reads a number for every vertex.
//!
//! [`read_pairs`] and [`read_sharp`] read files that name feature edges, in the same manner.
//!
//! Fields on a mesh are read and written as `.rawfield` and `.rosy` ([`read_field`]), cones as `.sing` or
//! angles ([`read_cones`]), matchings as `.matching` ([`read_matching`]).
//!
//! [`Polymesh`] writes polygons and what they carry, maps among it, and [`AtomicFile`] puts a file in place only when it
//! is complete.
//!
//! The readers are our own because `tobj`, `ply-rs`, `stl_io` and `gltf` do not tell the line or byte of a
//! fault, or trust the counts in a header.
//!
//! ```
//! let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
//! let mesh = seamstress_io::parse_mesh(text, None, "triangle.obj")?;
//! assert_eq!(mesh.polygons.get(0), [0, 1, 2]);
//!
//! let fault = seamstress_io::parse_mesh(b"v 0 0 0\nf 1 2 3\n", None, "broken.obj").unwrap_err();
//! assert_eq!(
//!     fault.to_string(),
//!     "broken.obj, line 2: vertex index 2 is out of range: the file has 1 vertex"
//! );
//! # Ok::<(), seamstress_io::ReadError>(())
//! ```

mod atomic;
mod cones;
mod detect;
mod error;
mod feature_lines;
mod field;
mod format;
mod gltf;
mod labels;
mod matching;
mod mesh;
mod note;
mod numbers;
mod obj;
mod obj_index;
mod off;
mod ply;
mod ply_attributes;
mod ply_data;
mod ply_header;
mod read;
mod stl;
mod temporary;
mod text;
mod vertex_values;
mod write;

pub use atomic::{AtomicFile, WriteError};
pub use cones::{Cones, parse_cones, read_cones, write_singularities};
pub use error::{Missing, Position, ReadError, ReadErrorKind};
pub use feature_lines::{PairLine, SharpLine, parse_pairs, parse_sharp, read_pairs, read_sharp};
pub use field::{Directions, parse_rawfield, parse_rosy, read_field, write_rawfield, write_rosy};
pub use format::{Format, is_compressed};
pub use matching::{MatchingRow, parse_matching, read_matching, write_matching};
pub use mesh::{PolygonMesh, Polygons};
pub use note::Note;
pub use obj::{parse_segments, read_segments};
pub use read::{parse_mesh, read_content, read_mesh, read_mesh_as};
pub use seamstress_mesh::attributes;
pub use vertex_values::{parse_vertex_values, read_vertex_values};
pub use write::Polymesh;
