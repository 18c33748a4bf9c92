//! Writing meshes of polygons with one number of corners: triangles, quads.

use crate::Format;
use crate::write::Number;
use std::io::{self, Write};

/// A mesh of polygons with `N` corners each.
#[derive(Clone, Copy, Debug)]
pub struct Polymesh<'a, const N: usize> {
    /// One point per vertex.
    pub positions: &'a [[f64; 3]],
    /// The polygons.
    pub polygons: &'a [[u32; N]],
    /// Comments for the start of the file.
    pub comments: &'a [String],
}

impl<const N: usize> Polymesh<'_, N> {
    /// Writes the mesh as OBJ (`v` and `f`) or PLY (binary, little-endian, positions as doubles).
    ///
    /// Vertices and polygons keep their order, and every number reads back as the same double.
    ///
    /// # Errors
    /// Of the writer; [`io::ErrorKind::Unsupported`] for another format, and
    /// [`io::ErrorKind::InvalidInput`], before anything is written, if a polygon names no vertex or a
    /// position is not finite.
    pub fn write(&self, writer: &mut impl Write, format: Format) -> io::Result<()> {
        self.check()?;
        match format {
            Format::Obj => self.write_obj(writer),
            Format::Ply => self.write_ply(writer),
            other => {
                let message = format!("polygons are written as OBJ or PLY, not {other}");
                Err(io::Error::new(io::ErrorKind::Unsupported, message))
            }
        }
    }

    fn check(&self) -> io::Result<()> {
        let invalid = |message: String| Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        let n = self.positions.len();
        let is_bad = |polygon: &[u32; N]| polygon.iter().any(|&v| v as usize >= n);
        if let Some(polygon) = self.polygons.iter().position(is_bad) {
            return invalid(format!("polygon {polygon} names a vertex that does not exist"));
        }
        if let Some(vertex) = self.positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return invalid(format!("the position of vertex {vertex} is not finite"));
        }
        Ok(())
    }

    fn comment_lines(&self) -> impl Iterator<Item = &str> {
        self.comments.iter().flat_map(|comment| comment.split(['\n', '\r']))
    }

    fn write_obj(&self, writer: &mut impl Write) -> io::Result<()> {
        for line in self.comment_lines() {
            writeln!(writer, "# {line}")?;
        }
        for &[x, y, z] in self.positions {
            writeln!(writer, "v {} {} {}", Number(x), Number(y), Number(z))?;
        }
        for polygon in self.polygons {
            write!(writer, "f")?;
            for &v in polygon {
                write!(writer, " {}", u64::from(v) + 1)?;
            }
            writeln!(writer)?;
        }
        Ok(())
    }

    fn write_ply(&self, writer: &mut impl Write) -> io::Result<()> {
        writeln!(writer, "ply\nformat binary_little_endian 1.0")?;
        for line in self.comment_lines() {
            writeln!(writer, "comment {line}")?;
        }
        writeln!(writer, "element vertex {}", self.positions.len())?;
        for axis in ["x", "y", "z"] {
            writeln!(writer, "property double {axis}")?;
        }
        writeln!(writer, "element face {}", self.polygons.len())?;
        writeln!(writer, "property list uchar uint vertex_indices\nend_header")?;
        for x in self.positions.as_flattened() {
            writer.write_all(&x.to_le_bytes())?;
        }
        let corners = u8::try_from(N).map_err(io::Error::other)?;
        for polygon in self.polygons {
            writer.write_all(&[corners])?;
            for v in polygon {
                writer.write_all(&v.to_le_bytes())?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_mesh;

    const POSITIONS: [[f64; 3]; 6] = [
        [0.0, 0.1, -1.0 / 3.0],
        [1.0, 0.0, 5e-324],
        [1.0, 1.0, f64::MAX],
        [0.0, 1e17, 0.0],
        [2.0, 0.0, -0.0],
        [2.0, 1.0, 1e-7],
    ];
    const QUADS: [[u32; 4]; 2] = [[0, 1, 2, 3], [1, 4, 5, 2]];

    fn mesh<'a>(positions: &'a [[f64; 3]], comments: &'a [String]) -> Polymesh<'a, 4> {
        Polymesh { positions, polygons: &QUADS, comments }
    }

    #[test]
    fn quads_read_back_exactly_in_both_formats() {
        let comments = ["by hand\nf 1 1 1".to_owned()];
        for format in [Format::Obj, Format::Ply] {
            let mut bytes = Vec::new();
            mesh(&POSITIONS, &comments).write(&mut bytes, format).unwrap();
            let read = parse_mesh(&bytes, Some(format), "quads").unwrap();
            let bits = |points: &[[f64; 3]]| {
                points.iter().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>()
            };
            assert_eq!(bits(&read.positions), bits(&POSITIONS));
            assert_eq!(read.polygons.len(), 2);
            assert_eq!(read.polygons.corners(), QUADS.as_flattened());
            assert!(read.notes.is_empty(), "{:?}", read.notes);
        }
    }

    #[test]
    fn what_cannot_be_read_back_is_not_written() {
        let error = |positions: &[[f64; 3]], format| {
            let mut bytes = Vec::new();
            let error = mesh(positions, &[]).write(&mut bytes, format).unwrap_err();
            assert!(bytes.is_empty());
            error.to_string()
        };
        assert_eq!(
            error(&POSITIONS[..5], Format::Obj),
            "polygon 1 names a vertex that does not exist"
        );
        let mut far = POSITIONS;
        far[3][0] = f64::NAN;
        assert_eq!(error(&far, Format::Ply), "the position of vertex 3 is not finite");
        assert!(error(&POSITIONS, Format::Stl).contains("as OBJ or PLY"));
    }
}
