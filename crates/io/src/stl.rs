//! Stereolithography, ASCII and binary; corners at the same position become one vertex.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::error::{Fault, Missing, Parsed, Position, ReadErrorKind, check_room};
use crate::text::{Text, quote, refuse_nul};
use crate::{Format, Note, PolygonMesh};

/// Bytes before the first facet of a binary file: a free header and the number of facets.
const HEADER: usize = 84;
/// Bytes of a facet: normal, three corners and an attribute.
const FACET: usize = 50;

/// Whether the size is what the count of a binary header asks for.
pub(crate) fn has_binary_size(bytes: &[u8]) -> bool {
    announced(bytes)
        .is_some_and(|facets| bytes.len() as u64 == HEADER as u64 + FACET as u64 * facets)
}

/// The number of facets in a binary header.
fn announced(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    Some(u64::from(u32::from_le_bytes(count.try_into().ok()?)))
}

/// Whether the file starts like ASCII STL.
pub(crate) fn looks_ascii(bytes: &[u8]) -> bool {
    let mut text = Text::new(bytes).without_comments();
    text.seek();
    if !text.token().is_some_and(|token| token.eq_ignore_ascii_case(b"solid")) {
        return false;
    }
    let head = &bytes[..bytes.len().min(1024)];
    if head.contains(&0) {
        return false;
    }
    text.next_line();
    text.seek();
    let second = text.token().unwrap_or_default();
    second.is_empty()
        || [&b"facet"[..], b"endsolid"].iter().any(|word| second.eq_ignore_ascii_case(word))
}

/// Reads an STL file.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<PolygonMesh> {
    if bytes.is_empty() {
        return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Content)));
    }
    let binary = has_binary_size(bytes) || (bytes.contains(&0) && !looks_ascii(bytes));
    if binary { parse_binary(bytes) } else { parse_ascii(bytes) }
}

fn parse_binary(bytes: &[u8]) -> Parsed<PolygonMesh> {
    let end = Position::Byte(bytes.len());
    let Some(facets) = announced(bytes) else {
        return Err(Fault::truncated(end, format!("a header of {HEADER} bytes")));
    };
    let data = &bytes[HEADER..];
    let mut weld = Weld::default();
    let mut found = 0;
    for (i, facet) in data.chunks_exact(FACET).enumerate() {
        if found == facets {
            break;
        }
        let mut corners = [[0.0; 3]; 3];
        for (k, coordinate) in corners.as_flattened_mut().iter_mut().enumerate() {
            let at = 12 + 4 * k;
            let mut value = [0; 4];
            value.copy_from_slice(&facet[at..at + 4]);
            let value = f32::from_le_bytes(value);
            if !value.is_finite() {
                let place = Position::Byte(HEADER + FACET * i + at);
                return Err(Fault::at(
                    place,
                    ReadErrorKind::NonFinite { found: value.to_string() },
                ));
            }
            *coordinate = f64::from(value);
        }
        weld.facet(corners)?;
        found += 1;
    }
    if found < facets {
        return Err(Fault::truncated(end, format!("{facets} facets, found {found}")));
    }
    let used = usize::try_from(found).unwrap_or(usize::MAX).saturating_mul(FACET);
    let rest = data.len().saturating_sub(used);
    if rest >= FACET && rest.is_multiple_of(FACET) {
        let (announced, found) = (format!("{facets} facets"), format!("{} more", rest / FACET));
        return Err(Fault::at(
            Position::Byte(HEADER + used),
            ReadErrorKind::CountMismatch { announced, found },
        ));
    }
    let mut mesh = weld.finish()?;
    if rest > 0 {
        mesh.notes.push(Note::TrailingBytes { count: rest });
    }
    Ok(mesh)
}

fn parse_ascii(bytes: &[u8]) -> Parsed<PolygonMesh> {
    refuse_nul(bytes)?;
    let mut text = Text::new(bytes).without_comments();
    if !text.seek() {
        return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Content)));
    }
    let mut weld = Weld::default();
    while text.seek() {
        expect(&mut text, "solid")?;
        // The rest of the line is a name.
        text.next_line();
        solid(&mut text, &mut weld)?;
    }
    weld.finish()
}

/// Reads the facets of a solid and its end.
fn solid(text: &mut Text<'_>, weld: &mut Weld) -> Parsed<()> {
    loop {
        let word = word(text, "`facet` or `endsolid`")?;
        if word.eq_ignore_ascii_case(b"endsolid") {
            text.next_line();
            return Ok(());
        }
        if !word.eq_ignore_ascii_case(b"facet") {
            return Err(Fault::syntax(text.here(), "`facet` or `endsolid`", quote(word)));
        }
        // The normal follows from the corners; files give it carelessly, so it is not read.
        text.next_line();
        expect(text, "outer")?;
        expect(text, "loop")?;
        let mut corners = [[0.0; 3]; 3];
        for corner in &mut corners {
            expect(text, "vertex")?;
            for coordinate in corner {
                *coordinate = text.finite("three coordinates after `vertex`")?;
            }
        }
        expect(text, "endloop")?;
        expect(text, "endfacet")?;
        weld.facet(corners)?;
    }
}

fn word<'a>(text: &mut Text<'a>, expected: &str) -> Parsed<&'a [u8]> {
    if text.seek() {
        Ok(text.token().unwrap_or_default())
    } else {
        Err(Fault::truncated(text.last_line(), expected))
    }
}

fn expect(text: &mut Text<'_>, keyword: &str) -> Parsed<()> {
    if !text.seek() {
        return Err(Fault::truncated(text.last_line(), format!("`{keyword}`")));
    }
    let word = text.token().unwrap_or_default();
    if word.eq_ignore_ascii_case(keyword.as_bytes()) {
        return Ok(());
    }
    Err(Fault::syntax(text.here(), format!("`{keyword}`"), quote(word)))
}

/// Gives corners at equal positions one vertex, in order of appearance.
#[derive(Default)]
struct Weld {
    positions: Vec<[f64; 3]>,
    facets: Vec<[u32; 3]>,
    known: HashMap<[u64; 3], u32>,
    degenerate: usize,
}

impl Weld {
    fn facet(&mut self, corners: [[f64; 3]; 3]) -> Parsed<()> {
        let mut facet = [0; 3];
        for (vertex, corner) in facet.iter_mut().zip(corners) {
            // Adding zero turns -0.0 into 0.0.
            let corner = corner.map(|x| x + 0.0);
            *vertex = match self.known.entry(corner.map(f64::to_bits)) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(place) => {
                    check_room(self.positions.len())?;
                    let next = u32::try_from(self.positions.len()).unwrap_or(u32::MAX);
                    self.positions.push(corner);
                    *place.insert(next)
                }
            };
        }
        let [a, b, c] = facet;
        self.degenerate += usize::from(a == b || b == c || c == a);
        self.facets.push(facet);
        Ok(())
    }

    fn finish(self) -> Parsed<PolygonMesh> {
        if self.facets.is_empty() {
            return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Vertices)));
        }
        let mut mesh = PolygonMesh::new(Format::Stl);
        mesh.polygons = self.facets.iter().map(|facet| &facet[..]).collect();
        mesh.notes.push(Note::VerticesWelded {
            before: 3 * self.facets.len(),
            after: self.positions.len(),
        });
        mesh.positions = self.positions;
        if self.degenerate > 0 {
            mesh.notes.push(Note::DegenerateFacets { count: self.degenerate });
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests;
