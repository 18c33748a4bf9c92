//! Writing OBJ.

use super::{Number, Polymesh, label, one_line};
use seamstress_mesh::attributes::{Attribute, AttributeKind};
use std::io::{self, Write};

/// Labels of faces and the statements for them.
const STATEMENTS: [(&str, &str); 4] =
    [("object", "o"), ("group", "g"), ("material", "usemtl"), ("smoothing", "s")];

impl<const N: usize> Polymesh<'_, N> {
    pub(super) fn write_obj(&self, writer: &mut impl Write) -> io::Result<()> {
        for line in self.comment_lines() {
            writeln!(writer, "# {line}")?;
        }
        for file in &self.attributes.material_files {
            writeln!(writer, "mtllib {}", one_line(file))?;
        }
        let color = self.first_at_vertices(AttributeKind::Color);
        for (v, &[x, y, z]) in self.positions.iter().enumerate() {
            write!(writer, "v {} {} {}", Number(x), Number(y), Number(z))?;
            for &x in color.iter().flat_map(|color| color.of(v)) {
                write!(writer, " {}", Number(x))?;
            }
            writeln!(writer)?;
        }
        let uv = self.attributes.of_kind(AttributeKind::Uv).next();
        let normal = self.attributes.of_kind(AttributeKind::Normal).next();
        write_rows(writer, "vt", uv)?;
        write_rows(writer, "vn", normal)?;
        let labels = STATEMENTS.map(|(name, statement)| (self.attributes.labels(name), statement));
        let mut current = STATEMENTS.map(|_| String::new());
        for (polygon, vertices) in self.polygons.iter().enumerate() {
            for ((labels, statement), current) in labels.iter().zip(&mut current) {
                let Some(labels) = labels else { continue };
                let name = label(labels, labels.rows[polygon]);
                // Before the first statement there is no name.
                if *current != name {
                    writeln!(writer, "{statement} {}", one_line(or_default(&name, statement)))?;
                    *current = name.into_owned();
                }
            }
            write!(writer, "f")?;
            for (k, &v) in vertices.iter().enumerate() {
                let index = |attribute| u64::from(self.row(attribute, polygon, k)) + 1;
                write!(writer, " {}", u64::from(v) + 1)?;
                match (uv.map(index), normal.map(index)) {
                    (None, None) => Ok(()),
                    (Some(uv), None) => write!(writer, "/{uv}"),
                    (None, Some(normal)) => write!(writer, "//{normal}"),
                    (Some(uv), Some(normal)) => write!(writer, "/{uv}/{normal}"),
                }?;
            }
            writeln!(writer)?;
        }
        Ok(())
    }
}

fn write_rows(
    writer: &mut impl Write,
    statement: &str,
    attribute: Option<&Attribute>,
) -> io::Result<()> {
    let rows = attribute.iter().flat_map(|a| a.values.chunks_exact(a.width.max(1)));
    for row in rows {
        write!(writer, "{statement}")?;
        for &x in row {
            write!(writer, " {}", Number(x))?;
        }
        writeln!(writer)?;
    }
    Ok(())
}

/// What stands for having no name after another had one.
fn or_default<'a>(name: &'a str, statement: &str) -> &'a str {
    match (name, statement) {
        ("" | "0", "s") => "off",
        ("", "usemtl") => "(null)",
        ("", _) => "default",
        (name, _) => name,
    }
}
