//! Matchings per edge: `.matching`.

use crate::ReadError;
use crate::error::{Fault, ReadErrorKind};
use crate::numbers::{DEGREE, begin, count, degree, end, integer, next, read, small};
use std::io::{self, Write};
use std::path::Path;

/// A row of a `.matching` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MatchingRow {
    /// The faces of the edge; -1 beyond the boundary.
    pub faces: [i64; 2],
    /// Its ends.
    pub vertices: [u32; 2],
    /// Direction `k` of the first face continues as direction `k + matching` of the second.
    pub matching: i32,
}

/// Reads the matchings in a file; see [`parse_matching`].
///
/// # Errors
/// [`ReadError`].
pub fn read_matching(path: &Path, n_faces: usize) -> Result<Vec<MatchingRow>, ReadError> {
    read(path, |bytes, name| parse_matching(bytes, name, n_faces))
}

/// Reads `.matching` text (libdirectional): `4 edges faces`, then `face face vertex vertex matching` per
/// row. Whether the rows are edges of the mesh is not judged here.
///
/// # Errors
/// [`ReadError`] with the line at fault.
pub fn parse_matching(
    bytes: &[u8],
    name: &str,
    n_faces: usize,
) -> Result<Vec<MatchingRow>, ReadError> {
    let parse = || {
        let mut text = begin(bytes)?;
        degree(&mut text)?;
        let announced = integer(&mut text, "the number of edges")?;
        let line = text.here();
        count(&mut text, "faces", n_faces)?;
        // A triangle has three edges.
        let n_edges = usize::try_from(announced).ok().filter(|&n| n <= 3 * n_faces);
        let Some(n_edges) = n_edges else {
            let (what, found) = ("faces", format!("{announced} edges of"));
            let kind = ReadErrorKind::OtherMesh { what, expected: n_faces, found };
            return Err(Fault::at(line, kind));
        };
        let mut rows = Vec::with_capacity(n_edges);
        for row in 0..n_edges {
            next(&mut text, "edges", n_edges, row)?;
            let faces = [integer(&mut text, "a face")?, integer(&mut text, "a face")?];
            let mut vertices = [0; 2];
            for vertex in &mut vertices {
                let found = integer(&mut text, "a vertex")?;
                *vertex = u32::try_from(found)
                    .map_err(|_| Fault::syntax(text.here(), "a vertex", format!("`{found}`")))?;
            }
            rows.push(MatchingRow { faces, vertices, matching: small(&mut text, "a matching")? });
        }
        end(&mut text, "edges", n_edges)?;
        Ok(rows)
    };
    parse().map_err(|fault: Fault| fault.named(name))
}

/// Writes `.matching` text; see [`parse_matching`].
///
/// # Errors
/// Of the writer.
pub fn write_matching(
    writer: &mut impl Write,
    n_faces: usize,
    rows: &[MatchingRow],
) -> io::Result<()> {
    writeln!(writer, "{DEGREE} {} {n_faces}", rows.len())?;
    for MatchingRow { faces: [f, g], vertices: [v, w], matching } in rows {
        writeln!(writer, "{f} {g} {v} {w} {matching}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matchings_read_back() {
        let row = |faces, vertices, matching| MatchingRow { faces, vertices, matching };
        let rows = [row([0, 1], [0, 2], 3), row([1, -1], [2, 3], 0)];
        let mut bytes = Vec::new();
        write_matching(&mut bytes, 2, &rows).unwrap();
        assert_eq!(bytes, b"4 2 2\n0 1 0 2 3\n1 -1 2 3 0\n");
        assert_eq!(parse_matching(&bytes, "m", 2).unwrap(), rows);
    }

    #[test]
    fn broken_files_are_named() {
        let error = |text: &str| parse_matching(text.as_bytes(), "m", 2).unwrap_err().to_string();
        assert_eq!(error("4 1 9\n"), "m, line 1: the file is for 9 faces, and the mesh has 2");
        let edges = "m, line 1: the file is for 99 edges of faces, and the mesh has 2";
        assert_eq!(error("4 99 2\n"), edges);
        let short = "m, line 2: the file ends too early: expected 2 edges, found 1";
        assert_eq!(error("4 2 2\n0 1 0 2 3\n"), short);
        assert_eq!(error("4 1 2\n0 1 0 -2 3\n"), "m, line 2: expected a vertex, found `-2`");
        assert_eq!(error("4 1 2\n0 1 0 2 x\n"), "m, line 2: expected a matching, found `x`");
        let more = "m, line 3: the header announces 1 edges, but the file goes on with `7`";
        assert_eq!(error("4 1 2\n0 1 0 2 3\n7\n"), more);
    }
}
