//! Cross fields as directions per face: `.rawfield` and `.rosy`.

use crate::ReadError;
use crate::error::Parsed;
use crate::numbers::{begin, count, degree, end, next, read};
use crate::text::Text;
use crate::write::Number;
use std::io::{self, Write};
use std::path::Path;

/// Directions of each face: four counter-clockwise, or one of the four.
pub type Directions = Vec<Vec<[f64; 3]>>;

/// Reads the field in a `.rosy` file, or in a `.rawfield` file of any other name.
///
/// # Errors
/// [`ReadError`] if the file cannot be read, or is no cross field with a value for each of `n_faces`.
pub fn read_field(path: &Path, n_faces: usize) -> Result<Directions, ReadError> {
    let is_rosy = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("rosy"));
    let parse = if is_rosy { parse_rosy } else { parse_rawfield };
    read(path, |bytes, name| parse(bytes, name, n_faces))
}

/// Reads `.rawfield` text (libdirectional): `4 faces`, then a row of four directions per face,
/// counter-clockwise.
///
/// # Errors
/// [`ReadError`] with the line at fault.
pub fn parse_rawfield(bytes: &[u8], name: &str, n_faces: usize) -> Result<Directions, ReadError> {
    let parse = || {
        let mut text = begin(bytes)?;
        degree(&mut text)?;
        count(&mut text, "faces", n_faces)?;
        rows(&mut text, n_faces, 4)
    };
    parse().map_err(|fault| fault.named(name))
}

/// Reads `.rosy` text with a vector per face (QuadWild): `faces`, `4`, then one direction of the cross per
/// face.
///
/// # Errors
/// [`ReadError`] with the line at fault.
pub fn parse_rosy(bytes: &[u8], name: &str, n_faces: usize) -> Result<Directions, ReadError> {
    let parse = || {
        let mut text = begin(bytes)?;
        count(&mut text, "faces", n_faces)?;
        degree(&mut text)?;
        rows(&mut text, n_faces, 1)
    };
    parse().map_err(|fault| fault.named(name))
}

fn rows(text: &mut Text<'_>, n_faces: usize, per_face: usize) -> Parsed<Directions> {
    // What the header announces was compared with the mesh, so it can be trusted with memory.
    let mut directions = Vec::with_capacity(n_faces);
    for face in 0..n_faces {
        let mut row = Vec::with_capacity(per_face);
        for _ in 0..per_face {
            let mut direction = [0.0; 3];
            for coordinate in &mut direction {
                next(text, "faces", n_faces, face)?;
                *coordinate = text.finite("a coordinate of a direction")?;
            }
            row.push(direction);
        }
        directions.push(row);
    }
    end(text, "faces", n_faces)?;
    Ok(directions)
}

/// Writes `.rawfield` text; see [`parse_rawfield`].
///
/// # Errors
/// Of the writer.
pub fn write_rawfield(writer: &mut impl Write, crosses: &[[[f64; 3]; 4]]) -> io::Result<()> {
    writeln!(writer, "4 {}", crosses.len())?;
    for cross in crosses {
        row(writer, cross.as_flattened())?;
    }
    Ok(())
}

/// Writes `.rosy` text with the first direction of each face; see [`parse_rosy`].
///
/// # Errors
/// Of the writer.
pub fn write_rosy(writer: &mut impl Write, crosses: &[[[f64; 3]; 4]]) -> io::Result<()> {
    writeln!(writer, "{}\n4", crosses.len())?;
    for cross in crosses {
        row(writer, &cross[0])?;
    }
    Ok(())
}

fn row(writer: &mut impl Write, numbers: &[f64]) -> io::Result<()> {
    for (k, &x) in numbers.iter().enumerate() {
        write!(writer, "{}{}", if k == 0 { "" } else { " " }, Number(x))?;
    }
    writeln!(writer)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CROSSES: [[[f64; 3]; 4]; 2] = [
        [[0.1, 0.0, 1e-17], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
        [[1.0 / 3.0, 0.0, 2.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 1e30], [0.0, -1.0, 0.0]],
    ];

    #[test]
    fn fields_read_back_exactly() {
        let mut raw = Vec::new();
        write_rawfield(&mut raw, &CROSSES).unwrap();
        assert!(raw.starts_with(b"4 2\n0.1 0 1e-17 0 1 0 -1 0 0 0 -1 0\n"));
        let read = parse_rawfield(&raw, "a", 2).unwrap();
        assert_eq!(read, CROSSES.map(|cross| cross.to_vec()));
        let mut rosy = Vec::new();
        write_rosy(&mut rosy, &CROSSES).unwrap();
        assert!(rosy.starts_with(b"2\n4\n0.1 0 1e-17\n"));
        let read = parse_rosy(&rosy, "a", 2).unwrap();
        assert_eq!(read, CROSSES.map(|cross| vec![cross[0]]));
    }

    #[test]
    fn broken_fields_are_named() {
        let raw = |text: &str| parse_rawfield(text.as_bytes(), "f", 1).unwrap_err().to_string();
        assert_eq!(raw(""), "f: the file is empty");
        assert_eq!(raw("4 7\n"), "f, line 1: the file is for 7 faces, and the mesh has 1");
        assert_eq!(raw("4 -1\n"), "f, line 1: the file is for -1 faces, and the mesh has 1");
        let degree = "f, line 1: a field of degree 2; cross fields have degree 4";
        assert_eq!(raw("2 1\n"), degree);
        assert_eq!(raw("4 x\n"), "f, line 1: expected the number of faces, found `x`");
        let short = "f, line 2: the file ends too early: expected 1 faces, found 0";
        assert_eq!(raw("4 1\n1 0 0 0 1 0 -1 0 0\n"), short);
        let nan = "f, line 2: expected a finite number, found `nan`";
        assert_eq!(raw("4 1\n1 0 nan 0 1 0 -1 0 0 0 -1 0\n"), nan);
        let long = "f, line 3: the header announces 1 faces, but the file goes on with `5`";
        assert_eq!(raw("4 1\n1 0 0 0 1 0 -1 0 0 0 -1 0\n5\n"), long);
        let rosy = |text: &str| parse_rosy(text.as_bytes(), "f", 1).unwrap_err().to_string();
        assert_eq!(rosy("2\n4\n"), "f, line 1: the file is for 2 faces, and the mesh has 1");
        assert!(rosy("1\n6\n1 0 0\n").contains("line 2: a field of degree 6"));
    }
}
