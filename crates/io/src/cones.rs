//! Cones of a mesh: `.sing` files, and files of one angle per vertex.

use crate::ReadError;
use crate::error::{Fault, Parsed, ReadErrorKind};
use crate::numbers::{DEGREE, begin, degree, element, end, integer, next, read, small};
use crate::text::Text;
use crate::vertex_values::vertex_values;
use std::io::{self, Write};
use std::path::Path;

/// Cones as files hold them.
#[derive(Debug, Clone, PartialEq)]
pub enum Cones {
    /// Vertices and their indices in quarters.
    Listed(Vec<(u32, i32)>),
    /// The total angle of every vertex, radians.
    Angles(Vec<f64>),
}

/// Reads the cones in a file; see [`parse_cones`].
///
/// # Errors
/// [`ReadError`].
pub fn read_cones(path: &Path, n_vertices: usize) -> Result<Cones, ReadError> {
    read(path, |bytes, name| parse_cones(bytes, name, n_vertices))
}

/// Reads cones: `.sing` text (libdirectional), `4 count`, then a vertex (from 0) and its index in
/// quarters per row; or the target angles of the conformal and Penner programs (`_Th_hat`), one total
/// angle in radians per vertex and row. The first line tells which: two numbers, or one.
///
/// # Errors
/// [`ReadError`] with the line at fault.
pub fn parse_cones(bytes: &[u8], name: &str, n_vertices: usize) -> Result<Cones, ReadError> {
    let parse = || {
        let text = begin(bytes)?;
        match text.clone().skip_tokens() {
            1 => vertex_values(text, n_vertices, "an angle in radians").map(Cones::Angles),
            _ => singularities(text, n_vertices).map(Cones::Listed),
        }
    };
    parse().map_err(|fault| fault.named(name))
}

fn singularities(mut text: Text<'_>, n_vertices: usize) -> Parsed<Vec<(u32, i32)>> {
    degree(&mut text)?;
    let announced = integer(&mut text, "the number of cones")?;
    let count = usize::try_from(announced).ok().filter(|&count| count <= n_vertices);
    let Some(count) = count else {
        let found = announced.to_string();
        let kind = ReadErrorKind::OtherMesh { what: "vertices", expected: n_vertices, found };
        return Err(Fault::at(text.here(), kind));
    };
    let mut cones = Vec::with_capacity(count);
    for row in 0..count {
        next(&mut text, "cones", count, row)?;
        let vertex = element(&mut text, "vertex", n_vertices)?;
        cones.push((vertex, small(&mut text, "an index in quarters")?));
    }
    end(&mut text, "cones", count)?;
    Ok(cones)
}

/// Writes cones as `.sing` text: vertices (from 0) and their indices in quarters.
///
/// # Errors
/// Of the writer.
pub fn write_singularities(writer: &mut impl Write, cones: &[(u32, i32)]) -> io::Result<()> {
    writeln!(writer, "{DEGREE} {}", cones.len())?;
    for (vertex, index) in cones {
        writeln!(writer, "{vertex} {index}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singularities_read_back() {
        let cones = vec![(0, 1), (17, -1)];
        let mut bytes = Vec::new();
        write_singularities(&mut bytes, &cones).unwrap();
        assert_eq!(bytes, b"4 2\n0 1\n17 -1\n");
        assert_eq!(parse_cones(&bytes, "c", 18).unwrap(), Cones::Listed(cones));
        assert_eq!(parse_cones(b"4 0\n", "c", 3).unwrap(), Cones::Listed(vec![]));
    }

    #[test]
    fn angles_are_one_to_a_line() {
        let read = parse_cones(b"6.5\n3.25\n", "c", 2).unwrap();
        assert_eq!(read, Cones::Angles(vec![6.5, 3.25]));
    }

    #[test]
    fn broken_files_are_named() {
        let error = |text: &str| parse_cones(text.as_bytes(), "c", 2).unwrap_err().to_string();
        assert_eq!(error("\n# none\n"), "c: the file is empty");
        assert_eq!(error("4 3\n"), "c, line 1: the file is for 3 vertices, and the mesh has 2");
        let range =
            "c, line 2: vertex index 2 is out of range: the file has 2 vertices, counted from 0";
        assert_eq!(error("4 1\n2 1\n"), range);
        let short = "c, line 2: the file ends too early: expected 2 cones, found 1";
        assert_eq!(error("4 2\n0 1\n"), short);
        assert_eq!(error("4 1\n0 x\n"), "c, line 2: expected an index in quarters, found `x`");
        let large = "c, line 2: expected an index in quarters, found `99999999999`";
        assert_eq!(error("4 1\n0 99999999999\n"), large);
        let more = "c, line 3: the header announces 1 cones, but the file goes on with `1`";
        assert_eq!(error("4 1\n0 1\n1 1\n"), more);
        assert!(error("6 1\n0 1\n").contains("degree 6"));
        assert_eq!(error("6.28\n"), "c, line 1: the file is for 1 vertices, and the mesh has 2");
        let many = "c, line 3: the file is for more than 2 vertices, and the mesh has 2";
        assert_eq!(error("1\n2\n3\n"), many);
        assert_eq!(error("1\ninf\n"), "c, line 2: expected a finite number, found `inf`");
    }
}
