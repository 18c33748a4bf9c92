//! Stanford PLY: turns the rows of its elements into a mesh.

use crate::error::{Fault, Missing, Parsed, ReadErrorKind, check_room};
use crate::ply_data::{Ascii, Binary, Source};
use crate::ply_header::{Element, Encoding, Header, Kind};
use crate::text::refuse_nul;
use crate::{Format, Note, PolygonMesh};

/// Names of the list of a face's corners.
const CORNER_LISTS: [&str; 3] = ["vertex_indices", "vertex_index", "vertex_indexes"];
/// The elements that are read.
const SURFACE: [&str; 3] = ["vertex", "face", STRIPS];
/// What ends a strip and begins the next one in a list of strips.
const RESTART: f64 = -1.0;
/// The element of triangle strips.
const STRIPS: &str = "tristrips";

/// Reads a PLY file, ASCII or binary.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<PolygonMesh> {
    let header = Header::parse(bytes)?;
    check_contents(&header)?;
    match header.encoding {
        Encoding::Ascii => {
            refuse_nul(bytes)?;
            read(&header, &mut Ascii::new(header.data.clone()))
        }
        Encoding::Binary(order) => {
            read(&header, &mut Binary::new(bytes, header.data.offset(), order))
        }
    }
}

/// Refuses headers without a surface.
fn check_contents(header: &Header<'_>) -> Parsed<()> {
    let count = |name| header.element(name).map_or(0, |element| element.count);
    let (vertices, faces) = (count("vertex"), count("face") + count(STRIPS));
    if vertices == 0 {
        return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Vertices)));
    }
    if faces == 0 {
        if header.element("face").is_none() {
            let what = "the file has points but no surface (no `face` element)";
            return Err(Fault::unsupported(None, what));
        }
        let vertices = usize::try_from(vertices).unwrap_or(usize::MAX);
        return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Faces { vertices })));
    }
    Ok(())
}

fn read(header: &Header<'_>, source: &mut impl Source) -> Parsed<PolygonMesh> {
    let mut mesh = PolygonMesh::new(Format::Ply);
    for element in &header.elements {
        // Without properties an element has no data, whatever its count.
        if element.properties.is_empty() && !SURFACE.contains(&element.name.as_str()) {
            continue;
        }
        source.start_element(element);
        match element.name.as_str() {
            "vertex" => vertices(element, source, &mut mesh)?,
            "face" | STRIPS => {
                // The vertices may come later, so their announced count decides; it is checked there.
                let vertices = header.element("vertex").map_or(0, |vertex| vertex.count);
                faces(element, vertices, source, &mut mesh)?;
            }
            _ => skip(element, source, &mut mesh)?,
        }
    }
    source.finish()?;
    Ok(mesh)
}

fn vertices(element: &Element, source: &mut impl Source, mesh: &mut PolygonMesh) -> Parsed<()> {
    let mut axes = Vec::with_capacity(element.properties.len());
    for property in &element.properties {
        axes.push(["x", "y", "z"].iter().position(|&name| property.name == name));
    }
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let place = axes.iter().position(|&found| found == Some(axis));
        if !place.is_some_and(|place| matches!(element.properties[place].kind, Kind::Scalar(_))) {
            return Err(Fault::syntax(
                element.position(),
                format!("a vertex property `{name}`"),
                "none",
            ));
        }
    }
    for _ in 0..element.count {
        check_room(mesh.positions.len())?;
        source.start_row()?;
        let mut position = [0.0; 3];
        for (property, axis) in element.properties.iter().zip(&axes) {
            match (property.kind, axis) {
                (Kind::Scalar(scalar), Some(axis)) => {
                    let value: f64 = source.value(scalar)?;
                    if !value.is_finite() {
                        let found = source.last_value(value);
                        return Err(Fault::at(
                            source.position(),
                            ReadErrorKind::NonFinite { found },
                        ));
                    }
                    position[*axis] = value;
                }
                (kind, _) => source.skip(kind)?,
            }
        }
        source.end_row()?;
        mesh.positions.push(position);
    }
    note_ignored(element, |name| matches!(name, "x" | "y" | "z"), mesh);
    Ok(())
}

fn faces(
    element: &Element,
    vertices: u64,
    source: &mut impl Source,
    mesh: &mut PolygonMesh,
) -> Parsed<()> {
    let list = element.properties.iter().find_map(|property| match property.kind {
        Kind::List { item, .. } if CORNER_LISTS.contains(&property.name.as_str()) => {
            Some((&property.name, item))
        }
        _ => None,
    });
    let Some((list, item)) = list else {
        return Err(Fault::syntax(
            element.position(),
            "a face property list `vertex_indices`",
            "none",
        ));
    };
    if !item.is_integer() {
        return Err(Fault::syntax(
            element.position(),
            "vertex indices of an integer type",
            "a floating-point type",
        ));
    }
    let is_strip = element.name == STRIPS;
    let mut corners = Vec::new();
    for _ in 0..element.count {
        source.start_row()?;
        for property in &element.properties {
            match property.kind {
                Kind::List { count, item } if &property.name == list => {
                    corners.clear();
                    let length = source.length(count)?;
                    if !is_strip && length < 3 {
                        let found = usize::try_from(length).unwrap_or_default();
                        return Err(Fault::at(
                            source.position(),
                            ReadErrorKind::TooFewCorners { found },
                        ));
                    }
                    for _ in 0..length {
                        let value = source.value(item)?;
                        match is_strip && value == RESTART {
                            true => push_strip(&mut corners, mesh),
                            false => corners.push(vertex_index(value, vertices, source)?),
                        }
                    }
                }
                kind => source.skip(kind)?,
            }
        }
        source.end_row()?;
        match is_strip {
            true => push_strip(&mut corners, mesh),
            false => mesh.polygons.push(&corners),
        }
    }
    note_ignored(element, |name| name == list, mesh);
    Ok(())
}

/// Adds the triangles of a strip, every second turned over, and clears it. Triangles that use a vertex twice
/// only carry the strip on to another place.
fn push_strip(strip: &mut Vec<u32>, mesh: &mut PolygonMesh) {
    for (i, corners) in strip.windows(3).enumerate() {
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        if a != b && b != c && c != a {
            mesh.polygons.push(&if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
        }
    }
    strip.clear();
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is a checked index"
)]
fn vertex_index(value: f64, vertices: u64, source: &impl Source) -> Parsed<u32> {
    if value.fract() != 0.0 {
        return Err(Fault::syntax(source.position(), "a vertex index", source.last_value(value)));
    }
    if value >= 0.0 && value <= f64::from(u32::MAX) && (value as u64) < vertices {
        return Ok(value as u32);
    }
    let index = source.last_value(value).replace('`', "");
    let count = usize::try_from(vertices).unwrap_or(usize::MAX);
    Err(Fault::at(
        source.position(),
        ReadErrorKind::IndexOutOfRange { what: "vertex", index, count, base: 0 },
    ))
}

fn skip(element: &Element, source: &mut impl Source, mesh: &mut PolygonMesh) -> Parsed<()> {
    for _ in 0..element.count {
        source.start_row()?;
        for property in &element.properties {
            source.skip(property.kind)?;
        }
        source.end_row()?;
    }
    if element.count > 0 {
        let count = usize::try_from(element.count).unwrap_or(usize::MAX);
        mesh.notes
            .push(Note::ElementsIgnored { kind: format!("`{}` element", element.name), count });
    }
    Ok(())
}

fn note_ignored(element: &Element, kept: impl Fn(&str) -> bool, mesh: &mut PolygonMesh) {
    let ignored =
        element.properties.iter().map(|property| &property.name).filter(|name| !kept(name));
    let names: Vec<String> = ignored.cloned().collect();
    if !names.is_empty() {
        mesh.notes.push(Note::PropertiesIgnored { element: element.name.clone(), names });
    }
}

#[cfg(test)]
mod tests;
