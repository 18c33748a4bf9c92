//! Files with a number for every vertex.

use crate::ReadError;
use crate::error::{Fault, Parsed, ReadErrorKind};
use crate::numbers::{begin, read};
use crate::text::{Text, parse_number};
use std::path::Path;

/// Reads a number for every vertex; see [`parse_vertex_values`].
///
/// # Errors
/// [`ReadError`].
pub fn read_vertex_values(path: &Path, n_vertices: usize) -> Result<Vec<f64>, ReadError> {
    read(path, |bytes, name| parse_vertex_values(bytes, name, n_vertices))
}

/// Reads a table of one column: a number for every vertex, one a line, after a heading or none; `#` starts a comment.
///
/// # Errors
/// [`ReadError`] with the line at fault.
pub fn parse_vertex_values(
    bytes: &[u8],
    name: &str,
    n_vertices: usize,
) -> Result<Vec<f64>, ReadError> {
    let parse = || {
        let mut text = begin(bytes)?;
        let first = text.clone().token();
        if first.is_some_and(|token| parse_number(token).is_err()) {
            text.next_line();
        }
        vertex_values(text, n_vertices, "a number")
    };
    parse().map_err(|fault| fault.named(name))
}

/// All numbers that are left, one for every vertex.
pub(crate) fn vertex_values(
    mut text: Text<'_>,
    n_vertices: usize,
    expected: &str,
) -> Parsed<Vec<f64>> {
    let mut values = Vec::new();
    while text.seek() {
        if values.len() == n_vertices {
            let found = format!("more than {n_vertices}");
            let kind = ReadErrorKind::OtherMesh { what: "vertices", expected: n_vertices, found };
            return Err(Fault::at(text.here(), kind));
        }
        values.push(text.finite(expected)?);
    }
    if values.len() < n_vertices {
        let found = values.len().to_string();
        let kind = ReadErrorKind::OtherMesh { what: "vertices", expected: n_vertices, found };
        return Err(Fault::at(text.last_line(), kind));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_with_and_without_a_heading() {
        let read = |text: &str| parse_vertex_values(text.as_bytes(), "c.csv", 2);
        for text in ["0.5\n2\n", "size\n0.5\n2\n", "# sizes\n\n0.5\r\n2"] {
            assert_eq!(read(text).unwrap(), [0.5, 2.0], "{text:?}");
        }
        let error = |text| read(text).unwrap_err().to_string();
        assert_eq!(
            error("size\n1\n"),
            "c.csv, line 2: the file is for 1 vertices, and the mesh has 2"
        );
        assert_eq!(error("1\nx\n"), "c.csv, line 2: expected a number, found `x`");
        assert_eq!(
            error("1\n2\n3\n"),
            "c.csv, line 3: the file is for more than 2 vertices, and the mesh has 2"
        );
    }
}
