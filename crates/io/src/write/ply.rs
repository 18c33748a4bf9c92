//! Writing PLY.

use super::{Polymesh, one_line};
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};
use std::borrow::Cow;
use std::collections::HashSet;
use std::io::{self, Write};

/// Numbers of an attribute as properties.
struct Columns<'a> {
    attribute: Cow<'a, Attribute>,
    names: Vec<String>,
    number: Number,
}

/// How a number is stored.
#[derive(Clone, Copy, PartialEq)]
enum Number {
    Byte,
    Int,
    Double,
}

impl<const N: usize> Polymesh<'_, N> {
    pub(super) fn write_ply(&self, writer: &mut impl Write) -> io::Result<()> {
        let of_vertices = self.columns(AttributeDomain::Vertex);
        let of_faces = self.columns(AttributeDomain::Face);
        let is_of_corners = |a: &&Attribute| a.domain == AttributeDomain::Corner;
        let corner_uvs = self.attributes.of_kind(AttributeKind::Uv).find(is_of_corners);
        writeln!(writer, "ply\nformat binary_little_endian 1.0")?;
        for line in self.comment_lines() {
            writeln!(writer, "comment {line}")?;
        }
        for columns in of_vertices.iter().chain(&of_faces) {
            let Columns { attribute, names, .. } = columns;
            for (number, name) in attribute.names.iter().enumerate() {
                writeln!(writer, "comment {} {number} is {}", names[0], one_line(name))?;
            }
        }
        writeln!(writer, "element vertex {}", self.positions.len())?;
        for axis in ["x", "y", "z"] {
            writeln!(writer, "property double {axis}")?;
        }
        declare(writer, &of_vertices)?;
        writeln!(writer, "element face {}", self.polygons.len())?;
        writeln!(writer, "property list uchar uint vertex_indices")?;
        if corner_uvs.is_some() {
            writeln!(writer, "property list uchar float texcoord")?;
        }
        declare(writer, &of_faces)?;
        writeln!(writer, "end_header")?;
        for (v, position) in self.positions.iter().enumerate() {
            for x in position {
                writer.write_all(&x.to_le_bytes())?;
            }
            write_row(writer, &of_vertices, v)?;
        }
        let corners = u8::try_from(N).map_err(io::Error::other)?;
        let numbers = u8::try_from(2 * N).map_err(io::Error::other)?;
        for (face, polygon) in self.polygons.iter().enumerate() {
            writer.write_all(&[corners])?;
            for v in polygon {
                writer.write_all(&v.to_le_bytes())?;
            }
            if let Some(uvs) = corner_uvs {
                writer.write_all(&[numbers])?;
                for x in (0..N).flat_map(|k| uvs.row(self.row(uvs, face, k))) {
                    writer.write_all(&(*x as f32).to_le_bytes())?;
                }
            }
            write_row(writer, &of_faces, face)?;
        }
        Ok(())
    }

    /// The attributes that become properties of vertices, or of faces.
    fn columns(&self, domain: AttributeDomain) -> Vec<Columns<'_>> {
        let mut taken: HashSet<String> = ["x", "y", "z"].map(String::from).into();
        let mut columns = Vec::new();
        for attribute in &self.attributes.all {
            let is_face = attribute.domain == AttributeDomain::Face;
            let can_be_averaged =
                !matches!(attribute.kind, AttributeKind::Uv | AttributeKind::Label);
            let is_held = attribute.domain != AttributeDomain::Corner || can_be_averaged;
            if is_face != (domain == AttributeDomain::Face) || !is_held {
                continue;
            }
            let names = property_names(attribute);
            if names.iter().any(|name| taken.contains(name)) {
                continue;
            }
            taken.extend(names.iter().cloned());
            let attribute = self.at_vertices(attribute);
            let is_int = |x: &f64| {
                x.fract() == 0.0 && f64::from(i32::MIN) <= *x && *x <= f64::from(i32::MAX)
            };
            let number = match attribute.kind {
                AttributeKind::Color => Number::Byte,
                AttributeKind::Label if attribute.values.iter().all(is_int) => Number::Int,
                _ => Number::Double,
            };
            columns.push(Columns { attribute, names, number });
        }
        columns
    }
}

fn declare(writer: &mut impl Write, columns: &[Columns<'_>]) -> io::Result<()> {
    for Columns { names, number, .. } in columns {
        let number = match number {
            Number::Byte => "uchar",
            Number::Int => "int",
            Number::Double => "double",
        };
        for name in names {
            writeln!(writer, "property {number} {name}")?;
        }
    }
    Ok(())
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "colours are clamped, and whole numbers have been checked"
)]
fn write_row(writer: &mut impl Write, columns: &[Columns<'_>], element: usize) -> io::Result<()> {
    for Columns { attribute, number, .. } in columns {
        let row = attribute.rows[element];
        // Names are told by their numbers.
        let named = [f64::from(row)];
        let values = if attribute.width == 0 { &named[..] } else { attribute.row(row) };
        for &x in values {
            match number {
                Number::Byte => {
                    writer.write_all(&[(x * f64::from(u8::MAX)).round().clamp(0.0, 255.0) as u8])
                }
                Number::Int => writer.write_all(&(x as i32).to_le_bytes()),
                Number::Double => writer.write_all(&x.to_le_bytes()),
            }?;
        }
    }
    Ok(())
}

fn property_names(attribute: &Attribute) -> Vec<String> {
    let known: &[&str] = match attribute.kind {
        AttributeKind::Color => &["red", "green", "blue", "alpha"],
        AttributeKind::Normal => &["nx", "ny", "nz"],
        AttributeKind::Uv => &["s", "t"],
        _ => &[],
    };
    if !known.is_empty() && attribute.width <= known.len() {
        return known[..attribute.width].iter().map(ToString::to_string).collect();
    }
    let is_plain = |c: char| c.is_ascii_graphic();
    let name: String = attribute.name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    match attribute.width {
        0 | 1 => vec![name],
        width => (0..width).map(|k| format!("{name}_{k}")).collect(),
    }
}
