//! Writing meshes of polygons with one number of corners, triangles or quads, and what they carry: maps among it,
//! which are triangles with texture coordinates.

mod glb;
mod obj;
mod ply;

use crate::Format;
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind, Attributes};
use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};

/// A mesh of polygons with `N` corners each.
#[derive(Clone, Copy, Debug)]
pub struct Polymesh<'a, const N: usize> {
    /// One point per vertex.
    pub positions: &'a [[f64; 3]],
    /// The polygons.
    pub polygons: &'a [[u32; N]],
    /// What its vertices, corners and polygons carry.
    pub attributes: &'a Attributes,
    /// Comments for the start of the file.
    pub comments: &'a [String],
}

impl<const N: usize> Polymesh<'_, N> {
    /// Writes the mesh as OBJ, OFF, PLY (binary, little-endian, positions as doubles), STL (binary) or glTF (GLB).
    ///
    /// Vertices and polygons keep their order, and every number reads back as the same double. Not so in STL and
    /// GLB, which have triangles only (the fan around the first corner of each polygon, of a quad the diagonal that
    /// is shorter) and round numbers to single precision; GLB has a vertex for each set of values at corners.
    ///
    /// Of the attributes OBJ holds the first texture coordinates, normals, colours of vertices, materials, objects,
    /// groups and smoothing groups; PLY all numbers and labels of vertices and polygons, with colours in bytes, and
    /// the first texture coordinates of corners; GLB all texture coordinates, normals, colours, numbers of one to
    /// four columns and materials; OFF and STL none. Colours and numbers of corners are averaged where there is only
    /// room for those of vertices.
    ///
    /// # Errors
    /// Of the writer, and [`io::ErrorKind::InvalidInput`], before anything is written, if a polygon names no
    /// vertex, an attribute does not fit, a number is not finite, or the format has none as large.
    pub fn write(&self, writer: &mut impl Write, format: Format) -> io::Result<()> {
        self.check()?;
        match format {
            Format::Obj => self.write_obj(writer),
            Format::Off => self.write_off(writer),
            Format::Ply => self.write_ply(writer),
            Format::Stl => self.write_stl(writer),
            Format::Gltf => self.write_glb(writer),
        }
    }

    fn check(&self) -> io::Result<()> {
        let n = self.positions.len();
        let is_bad = |polygon: &[u32; N]| polygon.iter().any(|&v| v as usize >= n);
        if let Some(polygon) = self.polygons.iter().position(is_bad) {
            return Err(invalid(format!("polygon {polygon} names a vertex that does not exist")));
        }
        if let Some(vertex) = self.positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(invalid(format!("the position of vertex {vertex} is not finite")));
        }
        for attribute in &self.attributes.all {
            let n_elements = match attribute.domain {
                AttributeDomain::Vertex => n,
                AttributeDomain::Corner => self.polygons.len() * N,
                AttributeDomain::Face => self.polygons.len(),
            };
            attribute.check(n_elements).map_err(invalid)?;
        }
        Ok(())
    }

    fn comment_lines(&self) -> impl Iterator<Item = &str> {
        self.comments.iter().flat_map(|comment| comment.split(['\n', '\r']))
    }

    /// The row of an attribute of vertices or corners at a corner.
    fn row(&self, attribute: &Attribute, polygon: usize, k: usize) -> u32 {
        match attribute.domain {
            AttributeDomain::Vertex => attribute.rows[self.polygons[polygon][k] as usize],
            AttributeDomain::Corner => attribute.rows[polygon * N + k],
            AttributeDomain::Face => attribute.rows[polygon],
        }
    }

    /// An attribute as one of vertices.
    fn at_vertices<'b>(&self, attribute: &'b Attribute) -> Cow<'b, Attribute> {
        let (corners, n) = (self.polygons.as_flattened(), self.positions.len());
        match attribute.domain {
            AttributeDomain::Corner => Cow::Owned(
                attribute.by_vertex(corners, n).unwrap_or_else(|| attribute.averaged(corners, n)),
            ),
            _ => Cow::Borrowed(attribute),
        }
    }

    /// The first attribute of a kind, as one of vertices.
    fn first_at_vertices(&self, kind: AttributeKind) -> Option<Cow<'_, Attribute>> {
        self.attributes.of_kind(kind).next().map(|attribute| self.at_vertices(attribute))
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
        let positions = self.single_positions("STL")?;
        let count = self.polygons.len() * N.saturating_sub(2);
        let count = u32::try_from(count)
            .map_err(|_| invalid(format!("{count} triangles are too many for STL")))?;
        let mut header = [0; HEADER];
        // A reader takes a header that begins with `solid` for text.
        let title = self.comment_lines().next().unwrap_or_default().bytes().take(HEADER);
        header.iter_mut().zip(title).for_each(|(to, from)| *to = from);
        writer.write_all(&header)?;
        writer.write_all(&count.to_le_bytes())?;
        for polygon in self.polygons {
            for triangle in self.triangles(polygon) {
                // No normal: readers derive it from the corners.
                writer.write_all(&[0; 12])?;
                for x in triangle.iter().flat_map(|&k| positions[polygon[k] as usize]) {
                    writer.write_all(&x.to_le_bytes())?;
                }
                writer.write_all(&[0; 2])?;
            }
        }
        Ok(())
    }

    /// Positions in single precision.
    fn single_positions(&self, format: &str) -> io::Result<Vec<[f32; 3]>> {
        let single = |p: &[f64; 3]| p.map(|x| x as f32);
        let positions: Vec<[f32; 3]> = self.positions.iter().map(single).collect();
        match positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            Some(v) => {
                Err(invalid(format!("the position of vertex {v} is too large for {format}")))
            }
            None => Ok(positions),
        }
    }

    /// The triangles of a polygon, by the numbers of their corners.
    fn triangles(&self, polygon: &[u32; N]) -> impl Iterator<Item = [usize; 3]> {
        let square = |i: usize, j: usize| -> f64 {
            let [p, q] = [i, j].map(|k| self.positions[polygon[k % N] as usize]);
            (0..3).map(|axis| (p[axis] - q[axis]).powi(2)).sum()
        };
        let start = usize::from(N == 4 && square(1, 3) < square(0, 2));
        (1..N - 1).map(move |k| [0, k, k + 1].map(|k| (start + k) % N))
    }
}

fn invalid(message: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

/// What a row of labels is called.
fn label(labels: &Attribute, row: u32) -> Cow<'_, str> {
    match labels.names.get(row as usize) {
        Some(name) => name.into(),
        None => labels.row(row).first().map_or(Cow::Borrowed(""), |x| x.to_string().into()),
    }
}

/// A name on one line.
fn one_line(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Writes a number so that it reads back exactly: plain if short, with an exponent if tiny or huge.
pub(crate) struct Number(pub(crate) f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e17).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests;
