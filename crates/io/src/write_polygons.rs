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
    /// Writes the mesh as OBJ (`v` and `f`), OFF, PLY (binary, little-endian, positions as doubles) or STL
    /// (binary).
    ///
    /// Vertices and polygons keep their order, and every number reads back as the same double. Not so in STL,
    /// which has triangles only (the fan around the first corner of each polygon, of a quad the diagonal that
    /// is shorter) and rounds positions to single precision.
    ///
    /// # Errors
    /// Of the writer, and [`io::ErrorKind::InvalidInput`], before anything is written, if a polygon names no
    /// vertex, a position is not finite, or STL has no number for it.
    pub fn write(&self, writer: &mut impl Write, format: Format) -> io::Result<()> {
        self.check()?;
        match format {
            Format::Obj => self.write_obj(writer),
            Format::Off => self.write_off(writer),
            Format::Ply => self.write_ply(writer),
            Format::Stl => self.write_stl(writer),
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

    fn write_off(&self, writer: &mut impl Write) -> io::Result<()> {
        writeln!(writer, "OFF")?;
        for line in self.comment_lines() {
            writeln!(writer, "# {line}")?;
        }
        writeln!(writer, "{} {} 0", self.positions.len(), self.polygons.len())?;
        for &[x, y, z] in self.positions {
            writeln!(writer, "{} {} {}", Number(x), Number(y), Number(z))?;
        }
        for polygon in self.polygons {
            write!(writer, "{N}")?;
            for &v in polygon {
                write!(writer, " {v}")?;
            }
            writeln!(writer)?;
        }
        Ok(())
    }

    fn write_stl(&self, writer: &mut impl Write) -> io::Result<()> {
        /// Bytes before the number of triangles.
        const HEADER: usize = 80;
        let invalid = |message: String| io::Error::new(io::ErrorKind::InvalidInput, message);
        let single = |p: &[f64; 3]| p.map(|x| x as f32);
        let positions: Vec<[f32; 3]> = self.positions.iter().map(single).collect();
        if let Some(v) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(invalid(format!("the position of vertex {v} is too large for STL")));
        }
        let count = self.polygons.len() * N.saturating_sub(2);
        let count = u32::try_from(count)
            .map_err(|_| invalid(format!("{count} triangles are too many for STL")))?;
        let mut header = [0; HEADER];
        // A reader takes a header that begins with `solid` for text.
        let title = self.comment_lines().next().unwrap_or_default().bytes().take(HEADER);
        header.iter_mut().zip(title).for_each(|(to, from)| *to = from);
        writer.write_all(&header)?;
        writer.write_all(&count.to_le_bytes())?;
        for triangle in self.polygons.iter().flat_map(|polygon| self.triangles(polygon)) {
            // No normal: readers derive it from the corners.
            writer.write_all(&[0; 12])?;
            for x in triangle.iter().flat_map(|&v| positions[v as usize]) {
                writer.write_all(&x.to_le_bytes())?;
            }
            writer.write_all(&[0; 2])?;
        }
        Ok(())
    }

    fn triangles(&self, polygon: &[u32; N]) -> impl Iterator<Item = [u32; 3]> {
        let square = |i: usize, j: usize| -> f64 {
            let [p, q] = [i, j].map(|k| self.positions[polygon[k % N] as usize]);
            (0..3).map(|axis| (p[axis] - q[axis]).powi(2)).sum()
        };
        let start = usize::from(N == 4 && square(1, 3) < square(0, 2));
        let corner = move |polygon: &[u32; N], k: usize| polygon[(start + k) % N];
        let polygon = *polygon;
        (1..N - 1).map(move |k| [0, k, k + 1].map(|k| corner(&polygon, k)))
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
    fn quads_read_back_exactly() {
        let comments = ["by hand\nf 1 1 1".to_owned()];
        for format in [Format::Obj, Format::Off, Format::Ply] {
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
        assert_eq!(error(&POSITIONS, Format::Stl), "the position of vertex 2 is too large for STL");
    }

    #[test]
    fn stl_has_the_triangles_of_the_quads() {
        let positions = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [4.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let polygons = [[0, 1, 2, 3], [3, 2, 1, 0]];
        let comments = ["by hand".to_owned()];
        let mut bytes = Vec::new();
        let mesh = Polymesh { positions: &positions, polygons: &polygons, comments: &comments };
        mesh.write(&mut bytes, Format::Stl).unwrap();
        assert_eq!(bytes.len(), 84 + 4 * 50);
        let read = parse_mesh(&bytes, Some(Format::Stl), "quads").unwrap();
        // The diagonal from 1 to 3 is the shorter one.
        let expected = [1, 2, 3, 1, 3, 0, 3, 2, 1, 3, 1, 0].map(|v| positions[v]);
        let corners = read.polygons.corners().iter().map(|&v| read.positions[v as usize]);
        assert_eq!(corners.collect::<Vec<_>>(), expected);
    }
}
