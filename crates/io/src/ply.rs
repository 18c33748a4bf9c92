//! Stanford PLY: turns the rows of its elements into a mesh.

use crate::error::{Fault, Missing, Parsed, ReadErrorKind, check_room};
use crate::ply_attributes::{Table, default_name};
use crate::ply_data::{Ascii, Binary, Source};
use crate::ply_header::{Element, Encoding, Header, Kind, Property};
use crate::text::refuse_nul;
use crate::{Format, Note, PolygonMesh};
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};

/// Names of the list of a face's corners.
const CORNER_LISTS: [&str; 3] = ["vertex_indices", "vertex_index", "vertex_indexes"];
/// The list of the texture coordinates of a face's corners.
const CORNER_UVS: &str = "texcoord";
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
    // Where some faces come in strips the others alone have values.
    let (n_faces, n_corners) = (mesh.polygons.len(), mesh.polygons.corners().len());
    mesh.attributes.all.retain(|attribute| match attribute.domain {
        AttributeDomain::Vertex => true,
        AttributeDomain::Corner => attribute.rows.len() == n_corners,
        AttributeDomain::Face => attribute.rows.len() == n_faces,
    });
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
    let mut table = Table::new(&element.properties, |name| matches!(name, "x" | "y" | "z"));
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
                (Kind::Scalar(scalar), None) => table.push(source.value(scalar)?),
                (kind, _) => source.skip(kind)?,
            }
        }
        source.end_row()?;
        mesh.positions.push(position);
    }
    let (attributes, not_finite) = table.finish(AttributeDomain::Vertex);
    mesh.attributes.all.extend(attributes);
    note_ignored(element, &not_finite, |_| false, mesh);
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
    // The triangles of a strip have no properties of their own.
    let mut table = Table::new(&element.properties, |_| is_strip);
    let (mut corners, mut uvs) = (Vec::new(), CornerUvs::new(is_strip));
    for _ in 0..element.count {
        source.start_row()?;
        uvs.start_row();
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
                Kind::List { count, item } if property.name == CORNER_UVS && !is_strip => {
                    for _ in 0..source.length(count)? {
                        uvs.values.push(source.value(item)?);
                    }
                }
                Kind::Scalar(scalar) if !is_strip => table.push(source.value(scalar)?),
                kind => source.skip(kind)?,
            }
        }
        source.end_row()?;
        uvs.end_row(corners.len());
        match is_strip {
            true => push_strip(&mut corners, mesh),
            false => mesh.polygons.push(&corners),
        }
    }
    let (attributes, mut ignored) = table.finish(AttributeDomain::Face);
    if is_strip {
        let scalars = element.properties.iter().filter(|p| matches!(p.kind, Kind::Scalar(_)));
        ignored.extend(scalars.map(|property| property.name.clone()));
    }
    mesh.attributes.all.extend(attributes);
    let kept = uvs.finish();
    let has_uvs = kept.is_some();
    mesh.attributes.all.extend(kept);
    note_ignored(element, &ignored, |name| name == list || has_uvs && name == CORNER_UVS, mesh);
    Ok(())
}

/// Texture coordinates of corners: two numbers for each corner of a face.
struct CornerUvs {
    values: Vec<f64>,
    /// Where the row begins.
    start: usize,
    is_complete: bool,
}

impl CornerUvs {
    fn new(is_strip: bool) -> Self {
        Self { values: Vec::new(), start: 0, is_complete: !is_strip }
    }

    fn start_row(&mut self) {
        self.start = self.values.len();
    }

    fn end_row(&mut self, corners: usize) {
        self.is_complete &= self.values.len() - self.start == 2 * corners;
    }

    /// The attribute, if every corner has its two finite numbers.
    fn finish(self) -> Option<Attribute> {
        let is_good = self.is_complete && self.values.iter().all(|x| x.is_finite());
        let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Uv);
        is_good.then(|| {
            Attribute::new(default_name(kind), domain, kind, 2, Vec::new())
                .with_values(domain, &self.values)
        })
    }
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

/// Names the properties that are not kept: some of the single numbers, and lists other than those kept.
fn note_ignored(
    element: &Element,
    numbers: &[String],
    kept: impl Fn(&str) -> bool,
    mesh: &mut PolygonMesh,
) {
    let is_ignored = |property: &&Property| match property.kind {
        Kind::Scalar(_) => numbers.contains(&property.name),
        Kind::List { .. } => !kept(&property.name),
    };
    let ignored = element.properties.iter().filter(is_ignored);
    let names: Vec<String> = ignored.map(|property| property.name.clone()).collect();
    if !names.is_empty() {
        mesh.notes.push(Note::PropertiesIgnored { element: element.name.clone(), names });
    }
}

#[cfg(test)]
mod tests;
