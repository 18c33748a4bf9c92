//! Files that name feature edges: vertex pairs, and the `.sharp` files of QuadWild.

use crate::ReadError;
use crate::error::{Count, Fault, Parsed, ReadErrorKind};
use crate::text::{Text, quote, refuse_nul};
use std::fs;
use std::path::Path;

/// A line of a file of vertex pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairLine {
    /// The ends of the edge, counted from 0.
    pub vertices: [u32; 2],
    /// The line of the file, counted from 1.
    pub line: usize,
}

/// A line of a `.sharp` file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SharpLine {
    /// Whether the surface is convex there, by what the file says.
    pub is_convex: bool,
    /// The face, counted from 0.
    pub face: u32,
    /// The side of the face: side `k` runs from its `k`-th to its next vertex, counted from 0.
    pub side: u32,
    /// The line of the file, counted from 1.
    pub line: usize,
}

/// Reads a file of vertex pairs: two vertices a line, counted from 0; `#` starts a comment.
///
/// # Errors
/// [`ReadError`], with the line, if the file cannot be read or a line is not a pair.
pub fn read_pairs(path: &Path) -> Result<Vec<PairLine>, ReadError> {
    read(path, pairs)
}

/// Reads vertex pairs from memory; `name` stands for the data in error messages.
///
/// # Errors
/// As [`read_pairs`].
pub fn parse_pairs(bytes: &[u8], name: &str) -> Result<Vec<PairLine>, ReadError> {
    pairs(bytes).map_err(|fault| fault.named(name))
}

/// Reads the sharp edges of QuadWild: their number, then `type,face,side` a line, type 1 for a convex
/// and 0 for a concave edge. An edge may be named from both of its faces.
///
/// # Errors
/// [`ReadError`], with the line, if the file cannot be read, a line is not of that form, or their
/// number is not the one announced.
pub fn read_sharp(path: &Path) -> Result<Vec<SharpLine>, ReadError> {
    read(path, sharp)
}

/// Reads sharp edges from memory; `name` stands for the data in error messages.
///
/// # Errors
/// As [`read_sharp`].
pub fn parse_sharp(bytes: &[u8], name: &str) -> Result<Vec<SharpLine>, ReadError> {
    sharp(bytes).map_err(|fault| fault.named(name))
}

fn read<T>(path: &Path, parse: fn(&[u8]) -> Parsed<T>) -> Result<T, ReadError> {
    let name = path.display().to_string();
    let bytes =
        fs::read(path).map_err(|error| Fault::whole_file(ReadErrorKind::Io(error)).named(&name))?;
    parse(&bytes).map_err(|fault| fault.named(&name))
}

fn pairs(bytes: &[u8]) -> Parsed<Vec<PairLine>> {
    const FORM: &str = "two vertices, counted from 0";
    refuse_nul(bytes)?;
    let mut text = Text::new(bytes);
    let mut lines = Vec::new();
    while text.seek() {
        let line = text.line();
        let tokens = rest_of_line(&mut text);
        let vertices = numbers(&tokens)
            .ok_or_else(|| Fault::syntax(text.here(), FORM, quote(&tokens.join(&b' '))))?;
        lines.push(PairLine { vertices, line });
        text.next_line();
    }
    Ok(lines)
}

fn sharp(bytes: &[u8]) -> Parsed<Vec<SharpLine>> {
    const COUNT: &str = "the number of sharp edges";
    refuse_nul(bytes)?;
    let mut text = Text::new(bytes);
    if !text.seek() {
        return Err(text.missing(COUNT));
    }
    let tokens = rest_of_line(&mut text);
    let [announced] = numbers(&tokens)
        .ok_or_else(|| Fault::syntax(text.here(), COUNT, quote(&tokens.join(&b' '))))?;
    text.next_line();
    let mut lines = Vec::new();
    while text.seek() {
        let line = sharp_line(&mut text)?;
        if lines.len() == announced as usize {
            let announced = Count(announced as usize, "sharp edge").to_string();
            let found = format!("`{},{},{}`", u32::from(line.is_convex), line.face, line.side);
            let kind = ReadErrorKind::CountMismatch { announced, found };
            return Err(Fault::at(text.here(), kind));
        }
        lines.push(line);
        text.next_line();
    }
    if lines.len() < announced as usize {
        let announced = Count(announced as usize, "sharp edge");
        return Err(text.missing(&format!("{announced}, found {}", lines.len())));
    }
    Ok(lines)
}

fn sharp_line(text: &mut Text) -> Parsed<SharpLine> {
    const FORM: &str = "`type,face,side` with a type of 0 or 1";
    let line = text.line();
    let tokens = rest_of_line(text);
    let fields: Vec<&[u8]> = tokens
        .iter()
        .flat_map(|token| token.split(|&byte| byte == b','))
        .filter(|field| !field.is_empty())
        .collect();
    match numbers(&fields) {
        Some([kind, face, side]) if kind <= 1 => {
            Ok(SharpLine { is_convex: kind == 1, face, side, line })
        }
        _ => Err(Fault::syntax(text.here(), FORM, quote(&tokens.join(&b' ')))),
    }
}

fn rest_of_line<'a>(text: &mut Text<'a>) -> Vec<&'a [u8]> {
    std::iter::from_fn(|| text.token()).collect()
}

/// Exactly `N` whole numbers.
fn numbers<const N: usize>(fields: &[&[u8]]) -> Option<[u32; N]> {
    let parse = |field: &&[u8]| -> Option<u32> { std::str::from_utf8(field).ok()?.parse().ok() };
    let numbers: Option<Vec<u32>> = fields.iter().map(parse).collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair_fault(text: &str) -> String {
        parse_pairs(text.as_bytes(), "a").unwrap_err().to_string()
    }

    fn sharp_fault(text: &str) -> String {
        parse_sharp(text.as_bytes(), "a").unwrap_err().to_string()
    }

    #[test]
    fn pairs_with_comments_and_empty_lines() {
        let lines = parse_pairs(b"# creases\n\n3 4\r\n 0\t17 # the rim\n", "a").unwrap();
        let expected = [([3, 4], 3), ([0, 17], 4)];
        assert_eq!(lines, expected.map(|(vertices, line)| PairLine { vertices, line }));
        assert_eq!(parse_pairs(b"", "a").unwrap(), []);
    }

    #[test]
    fn faulty_pairs_are_named_by_their_line() {
        let wants = "expected two vertices, counted from 0, found";
        for line in ["7", "1 2 3", "1 -2", "a b", "1 2.0", "1,2", "1 4294967296"] {
            assert_eq!(
                pair_fault(&format!("0 1\n{line}\n")),
                format!("a, line 2: {wants} `{line}`")
            );
        }
    }

    #[test]
    fn sharp_edges_in_the_form_of_quadwild() {
        let lines = parse_sharp(b"2\n1,4,2\n0, 1664 ,1\n", "a").unwrap();
        let expected = [
            SharpLine { is_convex: true, face: 4, side: 2, line: 2 },
            SharpLine { is_convex: false, face: 1664, side: 1, line: 3 },
        ];
        assert_eq!(lines, expected);
        assert_eq!(parse_sharp(b"0\n", "a").unwrap(), []);
    }

    #[test]
    fn faulty_sharp_edges_are_named_by_their_line() {
        let form = "expected `type,face,side` with a type of 0 or 1, found";
        for line in ["1,2", "2,0,0", "1,-2,0", "1,0,0,0", "1;0;0"] {
            assert_eq!(sharp_fault(&format!("1\n{line}\n")), format!("a, line 2: {form} `{line}`"));
        }
        let count = "expected the number of sharp edges, found";
        assert_eq!(sharp_fault("1,4,2\n"), format!("a, line 1: {count} `1,4,2`"));
        assert!(sharp_fault("").contains("expected the number of sharp edges"));
    }

    #[test]
    fn the_number_of_sharp_edges_must_be_the_one_announced() {
        assert_eq!(
            sharp_fault("1\n1,0,0\n1,0,1\n"),
            "a, line 3: the header announces 1 sharp edge, but the file goes on with `1,0,1`"
        );
        assert_eq!(
            sharp_fault("3\n1,0,0\n1,0,1\n"),
            "a, line 3: the file ends too early: expected 3 sharp edges, found 2"
        );
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = read_pairs(Path::new("no/such/pairs.txt")).unwrap_err();
        assert!(error.to_string().starts_with("no/such/pairs.txt: cannot be read: "), "{error}");
        assert!(read_sharp(Path::new("no/such/edges.sharp")).is_err());
    }
}
