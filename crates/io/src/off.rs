//! Geomview OFF.

use crate::error::{Count, Fault, Missing, Parsed, Position, ReadErrorKind, check_room};
use crate::text::{Text, parse_integer, quote, refuse_nul};
use crate::{Format, Note, PolygonMesh};

/// The keyword of a file, such as `OFF`, `COFF` or `STCNOFF`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Header {
    /// Points with four coordinates (`4`) or any number (`n`) are not read.
    other_dimension: bool,
    /// Bytes of the token after the keyword: some files write `OFF8 6 12`.
    rest: usize,
}

impl Header {
    /// Reads the keyword at the start of a token.
    pub(crate) fn parse(token: &[u8]) -> Option<Self> {
        let mut rest = token;
        let mut other_dimension = false;
        for (prefix, dimension) in
            [(&b"ST"[..], false), (b"C", false), (b"N", false), (b"4", true), (b"n", true)]
        {
            if let Some(stripped) = rest.strip_prefix(prefix) {
                rest = stripped;
                other_dimension |= dimension;
            }
        }
        let rest = rest.strip_prefix(b"OFF")?;
        (rest.is_empty() || parse_integer(rest).is_some())
            .then_some(Self { other_dimension, rest: rest.len() })
    }
}

/// The counts of a header.
#[derive(Clone, Copy, Debug)]
struct Counts {
    vertices: i64,
    faces: i64,
}

/// Reads OFF text.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<PolygonMesh> {
    let mut text = Text::new(bytes);
    if !text.seek() {
        return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Content)));
    }
    keyword(&mut text)?;
    refuse_nul(bytes)?;
    let counts = counts(&mut text)?;
    let mut mesh = PolygonMesh::new(Format::Off);
    vertices(&mut text, counts, &mut mesh)?;
    faces(&mut text, counts, &mut mesh)?;
    if text.seek() {
        let found = quote(text.token().unwrap_or_default());
        let announced = format!(
            "{} and {}",
            Count(mesh.positions.len(), "vertex"),
            Count(mesh.polygons.len(), "face")
        );
        return Err(Fault::at(text.here(), ReadErrorKind::CountMismatch { announced, found }));
    }
    Ok(mesh)
}

/// Passes the keyword, which may be absent.
fn keyword(text: &mut Text<'_>) -> Parsed<()> {
    let token = text.token().unwrap_or_default();
    let Some(header) = Header::parse(token) else {
        if parse_integer(token).is_some() {
            text.give_back(token.len());
            return Ok(());
        }
        return Err(Fault::syntax(text.here(), "`OFF`", quote(token)));
    };
    if header.other_dimension {
        let what = format!(
            "{} has points that are not three-dimensional, which is not read",
            quote(token)
        );
        return Err(Fault::unsupported(Some(text.here()), what));
    }
    text.give_back(header.rest);
    if header.rest == 0
        && let Some(next) = text.token()
    {
        if next == b"BINARY" {
            return Err(Fault::unsupported(
                Some(text.here()),
                "binary OFF is not read; save it as text",
            ));
        }
        text.give_back(next.len());
    }
    Ok(())
}

/// Reads the numbers of vertices, faces and edges; the last may be absent.
fn counts(text: &mut Text<'_>) -> Parsed<Counts> {
    let vertices = count(text, "the number of vertices")?;
    let faces = count(text, "the number of faces")?;
    if let Some(edges) = text.token() {
        if parse_integer(edges).is_none() {
            return Err(Fault::syntax(text.here(), "the number of edges", quote(edges)));
        }
        if let Some(extra) = text.token() {
            return Err(Fault::syntax(
                text.here(),
                "the end of the line after the counts",
                quote(extra),
            ));
        }
    }
    text.next_line();
    let missing = match (vertices, faces) {
        (0, _) => Missing::Vertices,
        (_, 0) => Missing::Faces { vertices: usize::try_from(vertices).unwrap_or(usize::MAX) },
        _ => return Ok(Counts { vertices, faces }),
    };
    Err(Fault::whole_file(ReadErrorKind::Empty(missing)))
}

fn count(text: &mut Text<'_>, expected: &str) -> Parsed<i64> {
    if !text.seek() {
        return Err(Fault::truncated(text.last_line(), expected));
    }
    let token = text.token().unwrap_or_default();
    match parse_integer(token) {
        Some(count) if count >= 0 => Ok(count),
        _ => Err(Fault::syntax(text.here(), expected, quote(token))),
    }
}

fn vertices(text: &mut Text<'_>, counts: Counts, mesh: &mut PolygonMesh) -> Parsed<()> {
    let mut extra = 0;
    for read in 0..counts.vertices {
        if !text.seek() {
            return Err(ends_early(text, counts.vertices, "vertices", read));
        }
        check_room(mesh.positions.len())?;
        let start = text.line();
        let mut position = [0.0; 3];
        for coordinate in &mut position {
            if !text.seek() {
                return Err(ends_early(text, counts.vertices, "vertices", read));
            }
            *coordinate = text.finite("a vertex coordinate")?;
        }
        let broken = text.line() > start;
        if text.token().is_some() {
            if broken {
                return Err(misplaced_break(start, "three coordinates"));
            }
            extra += 1;
        }
        mesh.positions.push(position);
        text.next_line();
    }
    if extra > 0 {
        mesh.notes.push(Note::VertexColumnsIgnored { count: extra });
    }
    Ok(())
}

/// Reads faces. Colours may follow the corners up to the end of the line; or the corners may be spread
/// over several lines, then nothing may follow them.
fn faces(text: &mut Text<'_>, counts: Counts, mesh: &mut PolygonMesh) -> Parsed<()> {
    let mut colored = 0;
    let mut polygon = Vec::new();
    for read in 0..counts.faces {
        if !text.seek() {
            return Err(ends_early(text, counts.faces, "faces", read));
        }
        let start = text.line();
        let corners = count(text, "the number of corners of a face")?;
        if corners < 3 {
            let found = usize::try_from(corners).unwrap_or_default();
            return Err(Fault::at(Position::Line(start), ReadErrorKind::TooFewCorners { found }));
        }
        polygon.clear();
        for _ in 0..corners {
            if !text.seek() {
                return Err(ends_early(text, counts.faces, "faces", read));
            }
            polygon.push(vertex_index(text, mesh.positions.len())?);
        }
        let broken = text.line() > start;
        if text.token().is_some() {
            if broken {
                return Err(misplaced_break(start, &format!("{corners} corners")));
            }
            colored += 1;
        }
        mesh.polygons.push(&polygon);
        text.next_line();
    }
    if colored > 0 {
        mesh.notes.push(Note::FaceColorsIgnored { count: colored });
    }
    Ok(())
}

fn vertex_index(text: &mut Text<'_>, vertices: usize) -> Parsed<u32> {
    let token = text.token().unwrap_or_default();
    let Some(index) = parse_integer(token) else {
        return Err(Fault::syntax(text.here(), "a vertex index", quote(token)));
    };
    match u32::try_from(index) {
        Ok(vertex) if (vertex as usize) < vertices => Ok(vertex),
        _ => {
            let index = quote(token).replace('`', "");
            let kind =
                ReadErrorKind::IndexOutOfRange { what: "vertex", index, count: vertices, base: 0 };
            Err(Fault::at(text.here(), kind))
        }
    }
}

#[cold]
fn ends_early(text: &Text<'_>, announced: i64, what: &str, read: i64) -> Fault {
    Fault::truncated(text.last_line(), format!("{announced} {what}, found {read}"))
}

/// An element went on into the next line and ended in its middle: its count or its line is wrong.
#[cold]
fn misplaced_break(line: usize, expected: &str) -> Fault {
    Fault::syntax(Position::Line(line), expected, "fewer values in the line")
}

#[cfg(test)]
mod tests;
