//! glTF 2.0: the triangles of a scene, in its space.
//!
//! glTF has a vertex for each set of values at corners; those in the same place of one object become one vertex, and
//! the values those of corners.

mod buffers;
mod document;
mod matrix;

use crate::error::{Count, Fault, Missing, Parsed, ReadErrorKind, check_room};
use crate::labels::Labels;
use crate::text::quote;
use crate::{Format, Note, PolygonMesh};
use buffers::{Array, Buffers};
use document::{Document, Node, Primitive, get};
use matrix::Matrix;
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

/// Ways to draw triangles.
const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;
/// Corners at most for each byte of the file: objects may share one mesh, in reason.
const MOST_CORNERS_PER_BYTE: usize = 64;
/// Marks a corner without values.
const NONE: u32 = u32::MAX;

/// Whether content starts like glTF.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF") || bytes.trim_ascii_start().starts_with(b"{")
}

/// Reads glTF, as JSON or in one binary file; buffers in files of their own are looked for in a folder.
pub(crate) fn parse(bytes: &[u8], folder: Option<&Path>) -> Parsed<PolygonMesh> {
    let (document, binary) = Document::parse(bytes)?;
    let buffers = Buffers::new(&document, binary, folder)?;
    let mut reader = Reader::new(&document, &buffers, bytes.len());
    reader.scene()?;
    reader.finish()
}

struct Reader<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    mesh: PolygonMesh,
    materials: Labels,
    objects: Labels,
    columns: BTreeMap<String, Column>,
    /// Corners in all, and the most that there may be.
    corners: usize,
    most_corners: usize,
    other_primitives: usize,
    ignored: BTreeSet<String>,
}

/// The values of an attribute of all objects.
struct Column {
    kind: AttributeKind,
    width: usize,
    values: Vec<f64>,
    /// The row of each corner.
    rows: Vec<u32>,
}

impl<'a> Reader<'a> {
    fn new(document: &'a Document, buffers: &'a Buffers<'a>, size: usize) -> Self {
        Self {
            document,
            buffers,
            mesh: PolygonMesh::new(Format::Gltf),
            materials: Labels::default(),
            objects: Labels::default(),
            columns: BTreeMap::new(),
            corners: 0,
            most_corners: MOST_CORNERS_PER_BYTE.saturating_mul(size + buffers.size()),
            other_primitives: 0,
            ignored: BTreeSet::new(),
        }
    }

    /// Reads all objects of the scene, each once.
    fn scene(&mut self) -> Parsed<()> {
        let mut seen = vec![false; self.document.nodes.len()];
        let mut open: Vec<(usize, Matrix)> =
            self.document.roots()?.into_iter().map(|root| (root, Matrix::default())).collect();
        open.reverse();
        while let Some((number, parent)) = open.pop() {
            let node = get(&self.document.nodes, number, "node")?;
            if std::mem::replace(&mut seen[number], true) {
                let found = format!("node {number} below two others, or below itself");
                return Err(syntax("nodes that form trees", found));
            }
            let place = parent.times(&node.matrix());
            self.object(number, node, &place)?;
            open.extend(node.children.iter().rev().map(|&child| (child, place.clone())));
        }
        Ok(())
    }

    fn object(&mut self, number: usize, node: &Node, place: &Matrix) -> Parsed<()> {
        let Some(mesh) = node.mesh else { return Ok(()) };
        let mesh = get(&self.document.meshes, mesh, "mesh")?;
        let name = node.name.as_ref().or(mesh.name.as_ref());
        let name = name.cloned().unwrap_or_else(|| format!("node {number}"));
        self.objects.set(name.as_bytes());
        // What a skeleton moves is placed by it alone.
        let still = Matrix::default();
        let place = if node.skin.is_some() { &still } else { place };
        let mut vertices = HashMap::new();
        mesh.primitives.iter().try_for_each(|p| self.primitive(p, place, &mut vertices))
    }

    fn primitive(
        &mut self,
        primitive: &Primitive,
        place: &Matrix,
        vertices: &mut HashMap<[u64; 3], u32>,
    ) -> Parsed<()> {
        let mode = primitive.mode.unwrap_or(TRIANGLES);
        let (TRIANGLES..=FAN, Some(&positions)) = (mode, primitive.attributes.get("POSITION"))
        else {
            self.other_primitives += 1;
            return Ok(());
        };
        let positions = self.buffers.array(positions)?.of_width(3, "positions")?;
        let count = positions.count;
        let indices = match primitive.indices {
            Some(accessor) => self.buffers.indices(accessor, count)?,
            None => (0..count as u32).collect(),
        };
        let mut triangles = triangles(&indices, mode);
        if place.mirrors() {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        self.corners += 3 * triangles.len() + count;
        if self.corners > self.most_corners {
            let what = "the objects of the scene are too many copies of large meshes";
            return Err(Fault::unsupported(None, what));
        }
        let mut of_position = Vec::with_capacity(count);
        for row in positions.values.chunks_exact(3) {
            let position = place.point([row[0], row[1], row[2]]);
            if !position.iter().all(|x| x.is_finite()) {
                let found = quote(format!("{position:?}").as_bytes());
                return Err(Fault::whole_file(ReadErrorKind::NonFinite { found }));
            }
            // Zero has two forms.
            let key = position.map(|x| (x + 0.0).to_bits());
            of_position.push(match vertices.entry(key) {
                Entry::Occupied(entry) => *entry.get(),
                Entry::Vacant(entry) => {
                    check_room(self.mesh.positions.len())?;
                    self.mesh.positions.push(position);
                    *entry.insert(self.mesh.positions.len() as u32 - 1)
                }
            });
        }
        match primitive.material {
            Some(material) => {
                let named = get(&self.document.materials, material, "material")?;
                let name = named.name.clone().unwrap_or_else(|| format!("material {material}"));
                self.materials.set(name.as_bytes());
            }
            None => self.materials.unset(),
        }
        for triangle in &triangles {
            self.mesh.polygons.push(&triangle.map(|v| of_position[v as usize]));
            self.materials.push();
            self.objects.push();
        }
        self.attributes(primitive, place, count, triangles.as_flattened())
    }

    /// Keeps what a primitive says of its vertices, of which each corner is one.
    fn attributes(
        &mut self,
        primitive: &Primitive,
        place: &Matrix,
        n_vertices: usize,
        corners: &[u32],
    ) -> Parsed<()> {
        let n_corners = self.mesh.polygons.corners().len();
        for (name, &accessor) in primitive.attributes.iter().filter(|(name, _)| *name != "POSITION")
        {
            let Some(kind) = kind(name) else {
                self.ignored.insert(name.clone());
                continue;
            };
            let mut array = self.buffers.array(accessor)?;
            if array.count != n_vertices {
                let found = Count(array.count, "row").to_string();
                let expected = format!("as many rows of `{name}` as positions, {n_vertices}");
                return Err(syntax(expected, found));
            }
            match kind {
                AttributeKind::Uv => {
                    array = array.of_width(2, "texture coordinates")?;
                    array.values.chunks_exact_mut(2).for_each(|uv| uv[1] = 1.0 - uv[1]);
                }
                AttributeKind::Normal => {
                    array = array.of_width(3, "normals")?;
                    array
                        .values
                        .as_chunks_mut::<3>()
                        .0
                        .iter_mut()
                        .for_each(|n| *n = place.normal(*n));
                }
                AttributeKind::Color => array = array.with_opacity()?,
                _ => {}
            }
            let Array { width, values, .. } = array;
            let column = self.columns.entry(name.clone()).or_insert_with(|| Column {
                kind,
                width,
                values: Vec::new(),
                rows: Vec::new(),
            });
            if column.width != width {
                let found = format!("{width} numbers in `{name}`");
                return Err(syntax(format!("{} as in another primitive", column.width), found));
            }
            let first = (column.values.len() / width) as u32;
            column.values.extend(values);
            column.rows.resize(n_corners - corners.len(), NONE);
            column.rows.extend(corners.iter().map(|v| first + v));
        }
        Ok(())
    }

    fn finish(mut self) -> Parsed<PolygonMesh> {
        if self.mesh.polygons.is_empty() {
            let vertices = self.mesh.positions.len();
            let missing =
                if vertices > 0 { Missing::Faces { vertices } } else { Missing::Vertices };
            return Err(Fault::whole_file(ReadErrorKind::Empty(missing)));
        }
        let n_corners = self.mesh.polygons.corners().len();
        let mut columns: Vec<(String, Column)> =
            std::mem::take(&mut self.columns).into_iter().collect();
        // Texture coordinates by their numbers, as their names are sorted; what has a meaning before the rest.
        columns.sort_by_key(|(name, _)| name.starts_with('_'));
        for (name, column) in columns {
            self.keep(&name, column, n_corners);
        }
        let labels = [self.materials.finish("material"), self.objects.finish("object")];
        self.mesh.attributes.all.extend(labels.into_iter().flatten());
        let notes = &mut self.mesh.notes;
        if self.other_primitives > 0 {
            let kind = "primitive without triangles".to_owned();
            let kind = if self.other_primitives == 1 {
                kind
            } else {
                "primitive of points or line".into()
            };
            notes.push(Note::ElementsIgnored { kind, count: self.other_primitives });
        }
        if !self.ignored.is_empty() {
            let names = self.ignored.iter().map(|name| quote(name.as_bytes()).replace('`', ""));
            let element = "vertex".to_owned();
            notes.push(Note::PropertiesIgnored { element, names: names.collect() });
        }
        Ok(self.mesh)
    }

    /// Keeps the values of an attribute if every corner has some; where a colour is missing it is white.
    fn keep(&mut self, name: &str, mut column: Column, n_corners: usize) {
        column.rows.resize(n_corners, NONE);
        let without = column.rows.iter().filter(|&&row| row == NONE).count();
        let is_finite = column.values.iter().all(|x| x.is_finite());
        if without > 0 && column.kind == AttributeKind::Color {
            let white = (column.values.len() / column.width) as u32;
            column.values.extend(std::iter::repeat_n(1.0, column.width));
            column.rows.iter_mut().filter(|row| **row == NONE).for_each(|row| *row = white);
        } else if without > 0 || !is_finite {
            self.mesh.notes.push(match column.kind {
                AttributeKind::Uv if is_finite => {
                    Note::TextureCoordinatesIncomplete { without, corners: n_corners }
                }
                AttributeKind::Normal if is_finite => {
                    Note::NormalsIgnored { count: column.values.len() / column.width }
                }
                _ => {
                    self.ignored.insert(name.to_owned());
                    return;
                }
            });
            return;
        }
        let Column { kind, mut width, mut values, rows } = column;
        if !is_finite {
            self.ignored.insert(name.to_owned());
            return;
        }
        if kind == AttributeKind::Color && values.iter().skip(3).step_by(4).all(|&a| a == 1.0) {
            values = values.chunks_exact(4).flat_map(|row| &row[..3]).copied().collect();
            width = 3;
        }
        let name = match (kind, name.rsplit_once('_')) {
            (AttributeKind::Uv, Some((_, "0"))) => "uv".to_owned(),
            (AttributeKind::Uv, Some((_, number))) => format!("uv{number}"),
            (AttributeKind::Color, Some((_, "0"))) => "color".to_owned(),
            (AttributeKind::Color, Some((_, number))) => format!("color{number}"),
            (AttributeKind::Normal, _) => "normal".to_owned(),
            _ => quote(name.as_bytes()).replace('`', ""),
        };
        let attribute = Attribute::new(name, AttributeDomain::Corner, kind, width, values);
        self.mesh.attributes.all.push(attribute.with_rows(rows));
    }
}

/// What an attribute of a vertex is; none for those of skeletons, and what follows from others.
fn kind(name: &str) -> Option<AttributeKind> {
    match name {
        "NORMAL" => Some(AttributeKind::Normal),
        _ if name.starts_with("TEXCOORD_") => Some(AttributeKind::Uv),
        _ if name.starts_with("COLOR_") => Some(AttributeKind::Color),
        _ if name.starts_with('_') => Some(AttributeKind::Number),
        _ => None,
    }
}

/// The triangles of a list, a strip or a fan; those of strips and fans that only carry them on are left out.
fn triangles(indices: &[u32], mode: u32) -> Vec<[u32; 3]> {
    let carries_on = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    let keep = |triangle: &[u32; 3]| !carries_on(triangle);
    match mode {
        STRIP => {
            let turned = |(i, w): (usize, &[u32])| match i % 2 {
                0 => [w[0], w[1], w[2]],
                _ => [w[1], w[0], w[2]],
            };
            indices.windows(3).enumerate().map(turned).filter(keep).collect()
        }
        FAN => {
            let rest = indices.get(1..).unwrap_or_default();
            rest.windows(2).map(|w| [indices[0], w[0], w[1]]).filter(keep).collect()
        }
        _ => indices.chunks_exact(3).map(|w| [w[0], w[1], w[2]]).collect(),
    }
}

#[cold]
fn syntax(expected: impl Into<String>, found: impl Into<String>) -> Fault {
    let (expected, found) = (expected.into(), found.into());
    Fault::whole_file(ReadErrorKind::Syntax { expected, found })
}

#[cfg(test)]
mod tests;
