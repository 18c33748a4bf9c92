//! Wavefront OBJ.

use crate::attributes::Labels;
use crate::error::{Fault, Missing, Parsed, Position, ReadErrorKind, check_room};
use crate::obj_index::{Corner, References};
use crate::text::{Text, quote, refuse_nul};
use crate::{CornerUvs, FaceAttributes, Format, Note, PolygonMesh};

/// Marks a corner without texture coordinate.
const NO_UV: u32 = u32::MAX;

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
    refuse_nul(bytes)?;
    let mut text = Text::new(bytes).with_continuation();
    let mut reader = Reader::new();
    while text.seek() {
        reader.statement(&mut text)?;
        text.next_line();
    }
    reader.finish()
}

/// The rest of a line: a name, or several.
fn rest(text: &mut Text<'_>) -> Vec<u8> {
    let names: Vec<&[u8]> = std::iter::from_fn(|| text.token()).collect();
    names.join(&b' ')
}

struct Reader<'a> {
    mesh: PolygonMesh,
    uvs: CornerUvs,
    /// Corners that name a `vt` before there is any, with a relative index.
    dangling_uvs: usize,
    uv_not_finite: Option<usize>,
    vertex_references: References<'a>,
    uv_references: References<'a>,
    polygon: Vec<u32>,
    materials: Labels,
    object: Vec<u8>,
    group: Vec<u8>,
    groups: Labels,
    smoothing: Labels,
    left_out: LeftOut,
}

/// What the notes will tell.
#[derive(Default)]
struct LeftOut {
    vertex_columns: usize,
    normals: usize,
    points: usize,
    free_form: usize,
    unknown: usize,
    first_unknown: Option<(usize, String)>,
}

impl<'a> Reader<'a> {
    fn new() -> Self {
        Self {
            mesh: PolygonMesh::new(Format::Obj),
            uvs: CornerUvs::default(),
            dangling_uvs: 0,
            uv_not_finite: None,
            vertex_references: References::new("vertex"),
            uv_references: References::new("texture coordinate"),
            polygon: Vec::new(),
            materials: Labels::default(),
            object: Vec::new(),
            group: Vec::new(),
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
            b"vn" => {
                self.left_out.normals += 1;
                text.skip_tokens();
            }
            b"p" => self.left_out.points += text.skip_tokens(),
            b"usemtl" => self.materials.set(rest(text)),
            b"s" => self.smoothing.set(match rest(text) {
                off if off == b"off" => b"0".to_vec(),
                group => group,
            }),
            b"o" => {
                self.object = rest(text);
                self.groups.set(self.path());
            }
            b"g" => {
                self.group = rest(text);
                self.groups.set(self.path());
            }
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

    /// The names of the object and the groups of the next polygon.
    fn path(&self) -> Vec<u8> {
        [&self.object[..], &self.group].join(&b'\n')
    }

    fn vertex(&mut self, text: &mut Text<'a>) -> Parsed<()> {
        check_room(self.mesh.positions.len())?;
        let mut position = [0.0; 3];
        for coordinate in &mut position {
            *coordinate = text.finite("three coordinates after `v`")?;
        }
        self.mesh.positions.push(position);
        let mut extra = false;
        while text.optional_number("a weight or colour")?.is_some() {
            extra = true;
        }
        self.left_out.vertex_columns += usize::from(extra);
        Ok(())
    }

    fn texture_coordinate(&mut self, text: &mut Text<'a>) -> Parsed<()> {
        check_room(self.uvs.coordinates.len())?;
        let u = text.number("a texture coordinate")?;
        let v = text.optional_number("a texture coordinate")?.unwrap_or(0.0);
        if !(u.is_finite() && v.is_finite()) {
            self.uv_not_finite.get_or_insert(text.line());
        }
        self.uvs.coordinates.push([u, v]);
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
                None => NO_UV,
                Some(index) => {
                    let count = self.uvs.coordinates.len();
                    match self.uv_references.resolve(index, token, count, text.here()) {
                        // Some programs write `1/1` without any `vt`: that is no reason to refuse.
                        Err(_) if count == 0 => {
                            self.dangling_uvs += 1;
                            NO_UV
                        }
                        resolved => resolved?,
                    }
                }
            };
            self.uvs.corners.push(uv);
        }
        if self.polygon.len() < 3 {
            let found = self.polygon.len();
            return Err(Fault::at(Position::Line(line), ReadErrorKind::TooFewCorners { found }));
        }
        self.mesh.polygons.push(&self.polygon);
        for labels in [&mut self.materials, &mut self.groups, &mut self.smoothing] {
            labels.push();
        }
        Ok(())
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

    fn finish(mut self) -> Parsed<PolygonMesh> {
        let vertices = self.mesh.positions.len();
        self.vertex_references.check(vertices)?;
        if self.mesh.polygons.is_empty() {
            return Err(self.nothing(vertices));
        }
        self.keep_uvs()?;
        self.write_notes();
        self.mesh.attributes = FaceAttributes {
            materials: self.materials.finish(),
            groups: self.groups.finish(),
            smoothing: self.smoothing.finish(),
            uvs: None,
        };
        Ok(self.mesh)
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
        let count = self.uvs.coordinates.len();
        let without = self.uvs.corners.iter().filter(|&&corner| corner == NO_UV).count();
        let corners = self.uvs.corners.len();
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
            self.mesh.corner_uvs = Some(std::mem::take(&mut self.uvs));
            return Ok(());
        };
        self.mesh.notes.push(note);
        Ok(())
    }

    fn write_notes(&mut self) {
        let left_out = std::mem::take(&mut self.left_out);
        let notes = &mut self.mesh.notes;
        if left_out.vertex_columns > 0 {
            notes.push(Note::VertexColumnsIgnored { count: left_out.vertex_columns });
        }
        if left_out.normals > 0 {
            notes.push(Note::NormalsIgnored { count: left_out.normals });
        }
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
