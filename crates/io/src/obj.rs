//! Wavefront OBJ.

use crate::error::{Fault, Missing, Parsed, Position, ReadErrorKind, check_room};
use crate::labels::Labels;
use crate::numbers::read;
use crate::obj_index::{Corner, References};
use crate::text::{Text, parse_number, quote, refuse_nul};
use crate::{Format, Note, PolygonMesh, ReadError};
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};
use std::path::Path;

/// Marks a corner without texture coordinate or normal.
const NONE: u32 = u32::MAX;

/// Statements that name or group things; the rest of their line is a name.
const GROUPING: [&[u8]; 14] = [
    b"g",
    b"o",
    b"s",
    b"mg",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"shadow_obj",
    b"trace_obj",
];

/// Statements of free-form curves and surfaces.
const FREE_FORM: [&[u8]; 18] = [
    b"vp", b"cstype", b"deg", b"bmat", b"step", b"curv", b"curv2", b"surf", b"parm", b"trim",
    b"hole", b"scrv", b"sp", b"end", b"con", b"ctech", b"stech", b"cdc",
];

/// Whether a token starts a statement of OBJ.
pub(crate) fn is_keyword(token: &[u8]) -> bool {
    matches!(token, b"v" | b"vt" | b"vn" | b"f" | b"fo" | b"l" | b"p")
        || GROUPING.contains(&token)
        || FREE_FORM.contains(&token)
}

/// Reads OBJ text.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<PolygonMesh> {
    read_all(bytes)?.finish()
}

/// Reads the polylines of an OBJ file, which needs no polygons: their segments, by the places of their ends.
///
/// # Errors
/// [`ReadError`], also if there is none.
pub fn read_segments(path: &Path) -> Result<Vec<[[f64; 3]; 2]>, ReadError> {
    read(path, parse_segments)
}

/// Reads the polylines in OBJ text; see [`read_segments`].
///
/// # Errors
/// As [`read_segments`].
pub fn parse_segments(bytes: &[u8], name: &str) -> Result<Vec<[[f64; 3]; 2]>, ReadError> {
    let segments = read_all(bytes).and_then(Reader::segments);
    segments.map_err(|fault| fault.named(name))
}

/// Takes in all statements.
fn read_all(bytes: &[u8]) -> Parsed<Reader<'_>> {
    refuse_nul(bytes)?;
    let mut text = Text::new(bytes).with_continuation();
    let mut reader = Reader::new();
    while text.seek() {
        reader.statement(&mut text)?;
        text.next_line();
    }
    Ok(reader)
}

/// The rest of a line: a name, or several.
fn rest(text: &mut Text<'_>) -> Vec<u8> {
    let names: Vec<&[u8]> = std::iter::from_fn(|| text.token()).collect();
    names.join(&b' ')
}

struct Reader<'a> {
    mesh: PolygonMesh,
    uvs: Vec<[f64; 2]>,
    corner_uvs: Vec<u32>,
    normals: Vec<[f64; 3]>,
    corner_normals: Vec<u32>,
    columns: Columns,
    /// Corners that name a `vt` before there is any, with a relative index.
    dangling_uvs: usize,
    uv_not_finite: Option<usize>,
    vertex_references: References<'a>,
    uv_references: References<'a>,
    polygon: Vec<u32>,
    materials: Labels,
    objects: Labels,
    groups: Labels,
    smoothing: Labels,
    left_out: LeftOut,
}

/// Numbers after the coordinates of vertices.
#[derive(Default)]
struct Columns {
    values: Vec<f64>,
    /// Numbers of the first vertex.
    width: usize,
    /// Vertices with any.
    count: usize,
    is_uneven: bool,
}

/// What the notes will tell.
#[derive(Default)]
struct LeftOut {
    points: usize,
    free_form: usize,
    unknown: usize,
    first_unknown: Option<(usize, String)>,
}

impl<'a> Reader<'a> {
    fn new() -> Self {
        Self {
            mesh: PolygonMesh::new(Format::Obj),
            uvs: Vec::new(),
            corner_uvs: Vec::new(),
            normals: Vec::new(),
            corner_normals: Vec::new(),
            columns: Columns::default(),
            dangling_uvs: 0,
            uv_not_finite: None,
            vertex_references: References::new("vertex"),
            uv_references: References::new("texture coordinate"),
            polygon: Vec::new(),
            materials: Labels::default(),
            objects: Labels::default(),
            groups: Labels::default(),
            smoothing: Labels::default(),
            left_out: LeftOut::default(),
        }
    }

    fn statement(&mut self, text: &mut Text<'a>) -> Parsed<()> {
        let line = text.line();
        match text.token().unwrap_or_default() {
            b"v" => self.vertex(text)?,
            b"vt" => self.texture_coordinate(text)?,
            b"f" | b"fo" => self.face(text, line)?,
            b"l" => self.polyline(text)?,
            b"vn" => self.normal(text),
            b"p" => self.left_out.points += text.skip_tokens(),
            b"usemtl" => self.materials.set(&rest(text)),
            b"mtllib" => {
                let files = String::from_utf8_lossy(text.rest_of_line()).into_owned();
                self.mesh.attributes.material_files.push(files);
            }
            b"s" => self.smoothing.set(match &*rest(text) {
                b"off" => b"0",
                group => group,
            }),
            b"o" => self.objects.set(&rest(text)),
            b"g" => self.groups.set(&rest(text)),
            name if GROUPING.contains(&name) => {}
            keyword if FREE_FORM.contains(&keyword) => {
                self.left_out.free_form +=
                    usize::from(matches!(keyword, b"curv" | b"curv2" | b"surf"));
                text.skip_tokens();
            }
            keyword => self.unknown(keyword, line)?,
        }
        Ok(())
    }

    fn vertex(&mut self, text: &mut Text<'a>) -> Parsed<()> {
        check_room(self.mesh.positions.len())?;
        let mut position = [0.0; 3];
        for coordinate in &mut position {
            *coordinate = text.finite("three coordinates after `v`")?;
        }
        let (vertex, before) = (self.mesh.positions.len(), self.columns.values.len());
        self.mesh.positions.push(position);
        while let Some(number) = text.optional_number("a weight or colour")? {
            self.columns.values.push(number);
        }
        let width = self.columns.values.len() - before;
        if vertex == 0 {
            self.columns.width = width;
        }
        self.columns.count += usize::from(width > 0);
        self.columns.is_uneven |= width != self.columns.width;
        Ok(())
    }

    /// Normals are no reason to refuse a file.
    fn normal(&mut self, text: &mut Text<'a>) {
        let mut numbers = std::iter::from_fn(|| text.token()).map(parse_number);
        let mut next = || numbers.next().and_then(Result::ok).unwrap_or(f64::NAN);
        self.normals.push([next(), next(), next()]);
    }

    fn texture_coordinate(&mut self, text: &mut Text<'a>) -> Parsed<()> {
        check_room(self.uvs.len())?;
        let u = text.number("a texture coordinate")?;
        let v = text.optional_number("a texture coordinate")?.unwrap_or(0.0);
        if !(u.is_finite() && v.is_finite()) {
            self.uv_not_finite.get_or_insert(text.line());
        }
        self.uvs.push([u, v]);
        text.skip_tokens();
        Ok(())
    }

    fn face(&mut self, text: &mut Text<'a>, line: usize) -> Parsed<()> {
        self.polygon.clear();
        while let Some(token) = text.token() {
            let corner = Corner::parse(token, text.here())?;
            let vertex = self.vertex_references.resolve(
                corner.vertex,
                token,
                self.mesh.positions.len(),
                text.here(),
            )?;
            self.polygon.push(vertex);
            let uv = match corner.uv {
                None => NONE,
                Some(index) => {
                    let count = self.uvs.len();
                    match self.uv_references.resolve(index, token, count, text.here()) {
                        // Some programs write `1/1` without any `vt`: that is no reason to refuse.
                        Err(_) if count == 0 => {
                            self.dangling_uvs += 1;
                            NONE
                        }
                        resolved => resolved?,
                    }
                }
            };
            self.corner_uvs.push(uv);
            self.corner_normals.push(self.normal_index(corner.normal));
        }
        if self.polygon.len() < 3 {
            let found = self.polygon.len();
            return Err(Fault::at(Position::Line(line), ReadErrorKind::TooFewCorners { found }));
        }
        self.mesh.polygons.push(&self.polygon);
        let labels =
            [&mut self.materials, &mut self.objects, &mut self.groups, &mut self.smoothing];
        labels.into_iter().for_each(Labels::push);
        Ok(())
    }

    /// The position of a normal, which need not be there.
    fn normal_index(&self, index: Option<i64>) -> u32 {
        let before = i64::try_from(self.normals.len()).unwrap_or(i64::MAX);
        let target = match index {
            Some(index) if index < 0 => before.saturating_add(index),
            Some(index) => index - 1,
            None => return NONE,
        };
        u32::try_from(target).unwrap_or(NONE)
    }

    fn polyline(&mut self, text: &mut Text<'a>) -> Parsed<()> {
        let mut previous = None;
        let mut count = 0;
        while let Some(token) = text.token() {
            let corner = Corner::parse(token, text.here())?;
            let vertex = self.vertex_references.resolve(
                corner.vertex,
                token,
                self.mesh.positions.len(),
                text.here(),
            )?;
            if let Some(start) = previous.replace(vertex) {
                self.mesh.lines.push([start, vertex]);
            }
            count += 1;
        }
        self.left_out.points += usize::from(count == 1);
        Ok(())
    }

    fn unknown(&mut self, keyword: &[u8], line: usize) -> Parsed<()> {
        if keyword.iter().any(u8::is_ascii_control) {
            return Err(Fault::syntax(Position::Line(line), "an OBJ statement", quote(keyword)));
        }
        self.left_out.unknown += 1;
        self.left_out.first_unknown.get_or_insert_with(|| (line, quote(keyword)));
        Ok(())
    }

    /// The segments of polylines alone.
    fn segments(self) -> Parsed<Vec<[[f64; 3]; 2]>> {
        let PolygonMesh { positions, lines, .. } = self.mesh;
        self.vertex_references.check(positions.len())?;
        if lines.is_empty() {
            return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Lines)));
        }
        Ok(lines.iter().map(|ends| ends.map(|v| positions[v as usize])).collect())
    }

    fn finish(mut self) -> Parsed<PolygonMesh> {
        let vertices = self.mesh.positions.len();
        self.vertex_references.check(vertices)?;
        if self.mesh.polygons.is_empty() {
            return Err(self.nothing(vertices));
        }
        self.keep_uvs()?;
        self.keep_colors();
        self.keep_normals();
        self.write_notes();
        let labels = [
            self.materials.finish("material"),
            self.objects.finish("object"),
            self.groups.finish("group"),
            self.smoothing.finish("smoothing"),
        ];
        self.mesh.attributes.all.extend(labels.into_iter().flatten());
        Ok(self.mesh)
    }

    /// Keeps what follows the coordinates if all vertices have as many numbers as a colour.
    fn keep_colors(&mut self) {
        let Columns { values, width, count, is_uneven } = std::mem::take(&mut self.columns);
        if !is_uneven && matches!(width, 3 | 4) && values.iter().all(|x| x.is_finite()) {
            let (domain, kind) = (AttributeDomain::Vertex, AttributeKind::Color);
            self.mesh.attributes.all.push(Attribute::new("color", domain, kind, width, values));
        } else if count > 0 {
            self.mesh.notes.push(Note::VertexColumnsIgnored { count });
        }
    }

    /// Keeps the normals if every corner has one.
    fn keep_normals(&mut self) {
        let count = self.normals.len();
        let all = self.corner_normals.iter().all(|&normal| (normal as usize) < count);
        if all && self.normals.as_flattened().iter().all(|x| x.is_finite()) {
            let values = std::mem::take(&mut self.normals).into_flattened();
            let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Normal);
            let normals = Attribute::new("normal", domain, kind, 3, values);
            let corners = std::mem::take(&mut self.corner_normals);
            self.mesh.attributes.all.push(normals.with_rows(corners));
        } else if count > 0 {
            self.mesh.notes.push(Note::NormalsIgnored { count });
        }
    }

    /// Why there is no mesh in the file.
    fn nothing(self, vertices: usize) -> Fault {
        if vertices > 0 {
            return Fault::whole_file(ReadErrorKind::Empty(Missing::Faces { vertices }));
        }
        match self.left_out.first_unknown {
            Some((line, keyword)) => Fault::syntax(
                Position::Line(line),
                "an OBJ statement such as `v` or `f` (the file has none)",
                keyword,
            ),
            None => Fault::whole_file(ReadErrorKind::Empty(Missing::Vertices)),
        }
    }

    /// Keeps the texture coordinates if every corner has one.
    fn keep_uvs(&mut self) -> Parsed<()> {
        let count = self.uvs.len();
        let without = self.corner_uvs.iter().filter(|&&corner| corner == NONE).count();
        let corners = self.corner_uvs.len();
        if count == 0 {
            let note = Note::TextureCoordinatesIncomplete { without: corners, corners };
            let named = self.dangling_uvs > 0 || without < corners;
            self.mesh.notes.extend(named.then_some(note));
            return Ok(());
        }
        self.uv_references.check(count)?;
        let note = if without == corners && self.dangling_uvs == 0 {
            Note::TextureCoordinatesUnused { count }
        } else if without > 0 {
            Note::TextureCoordinatesIncomplete { without, corners }
        } else if let Some(line) = self.uv_not_finite {
            Note::TextureCoordinatesNotFinite { line }
        } else {
            let values = std::mem::take(&mut self.uvs).into_flattened();
            let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Uv);
            let uvs = Attribute::new("uv", domain, kind, 2, values);
            let corners = std::mem::take(&mut self.corner_uvs);
            self.mesh.attributes.all.push(uvs.with_rows(corners));
            return Ok(());
        };
        self.mesh.notes.push(note);
        Ok(())
    }

    fn write_notes(&mut self) {
        let left_out = std::mem::take(&mut self.left_out);
        let notes = &mut self.mesh.notes;
        for (kind, count) in
            [("point", left_out.points), ("free-form curve or surface", left_out.free_form)]
        {
            if count > 0 {
                notes.push(Note::ElementsIgnored { kind: kind.to_owned(), count });
            }
        }
        if let Some((first_line, keyword)) = left_out.first_unknown {
            notes.push(Note::UnknownKeywords { count: left_out.unknown, first_line, keyword });
        }
    }
}

#[cfg(test)]
mod tests;
