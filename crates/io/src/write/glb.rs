//! Writing glTF as one binary file: triangles, a vertex for each set of values, a primitive for each material.

use super::{Polymesh, invalid, label, one_line};
use seamstress_mesh::attributes::{Attribute, AttributeKind};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, HashMap};
use std::io::{self, Write};

/// Numbers of glTF for the types of components and the use of buffers.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The binary part and what describes it.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds an array; returns the number of its accessor.
    fn push(&mut self, bytes: &[u8], target: u32, mut accessor: Value) -> usize {
        let view = json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target,
        });
        self.bytes.extend_from_slice(bytes);
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(view);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn push_floats(&mut self, values: &[f32], width: usize, with_bounds: bool) -> usize {
        let kind = ["SCALAR", "SCALAR", "VEC2", "VEC3", "VEC4"][width.min(4)];
        let count = values.len() / width;
        let mut accessor = json!({ "componentType": FLOAT, "count": count, "type": kind });
        if with_bounds {
            let column = |k: usize| values.iter().skip(k).step_by(width).copied();
            let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..width).filter_map(|k| column(k).reduce(pick)).collect()
            };
            accessor["min"] = json!(bound(f32::min));
            accessor["max"] = json!(bound(f32::max));
        }
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.push(&bytes, ARRAY_BUFFER, accessor)
    }
}

impl<const N: usize> Polymesh<'_, N> {
    pub(super) fn write_glb(&self, writer: &mut impl Write) -> io::Result<()> {
        let positions = self.single_positions("glTF")?;
        let held = self.semantics();
        let materials = self.attributes.labels("material");
        let mut known: HashMap<Vec<u32>, u32> = HashMap::new();
        // The corner that each vertex stands for.
        let mut corners: Vec<(usize, usize)> = Vec::new();
        let mut indices: BTreeMap<u32, Vec<u8>> = BTreeMap::new();
        for (p, polygon) in self.polygons.iter().enumerate() {
            let material = materials.map_or(0, |materials| materials.rows[p]);
            let numbers = std::array::from_fn::<u32, N, _>(|k| {
                let rows = held.iter().map(|(_, attribute)| self.row(attribute, p, k));
                let key = std::iter::once(polygon[k]).chain(rows).collect();
                *known.entry(key).or_insert_with(|| {
                    corners.push((p, k));
                    corners.len() as u32 - 1
                })
            });
            let of_material = indices.entry(material).or_default();
            for k in self.triangles(polygon).flatten() {
                of_material.extend(numbers[k].to_le_bytes());
            }
        }
        let mut buffer = Buffer::default();
        let mut attributes = Map::new();
        let at = |&(p, k): &(usize, usize)| positions[self.polygons[p][k] as usize];
        let values: Vec<f32> = corners.iter().flat_map(at).collect();
        attributes.insert("POSITION".into(), buffer.push_floats(&values, 3, true).into());
        for (name, attribute) in &held {
            let row = |&(p, k): &(usize, usize)| values_of(attribute, self.row(attribute, p, k));
            let values: Vec<f32> = corners.iter().flat_map(row).collect();
            let accessor = buffer.push_floats(&values, attribute.width, false);
            attributes.insert(name.clone(), accessor.into());
        }
        let mut primitives = Vec::new();
        for (material, bytes) in &indices {
            let accessor = json!({
                "componentType": UNSIGNED_INT, "count": bytes.len() / 4, "type": "SCALAR",
            });
            let accessor = buffer.push(bytes, ELEMENT_ARRAY_BUFFER, accessor);
            let mut primitive = json!({ "attributes": attributes, "indices": accessor });
            if materials.is_some_and(|materials| !label(materials, *material).is_empty()) {
                primitive["material"] = json!(material);
            }
            primitives.push(primitive);
        }
        let mut root = json!({
            "asset": { "version": "2.0", "generator": self.comment_lines().collect::<Vec<_>>().join("; ") },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0, "name": self.object_name() }],
            "meshes": [{ "primitives": primitives }],
            "accessors": buffer.accessors,
            "bufferViews": buffer.views,
            "buffers": [{ "byteLength": buffer.bytes.len() }],
        });
        if let Some(materials) = materials {
            let rows = 0..materials.n_rows() as u32;
            let material = |row| json!({ "name": one_line(&label(materials, row)) });
            root["materials"] = rows.map(material).collect();
        }
        write_chunks(writer, &root, buffer.bytes)
    }

    /// The attributes that are held, by the names they have there.
    fn semantics(&self) -> Vec<(String, &Attribute)> {
        let of_kind = |kind| self.attributes.of_kind(kind);
        let uvs = of_kind(AttributeKind::Uv).filter(|a| a.width == 2);
        let mut held: Vec<(String, &Attribute)> =
            uvs.enumerate().map(|(k, a)| (format!("TEXCOORD_{k}"), a)).collect();
        let normal = of_kind(AttributeKind::Normal).find(|a| a.width == 3);
        held.extend(normal.map(|normal| ("NORMAL".into(), normal)));
        let colors = of_kind(AttributeKind::Color).filter(|a| matches!(a.width, 3 | 4));
        held.extend(colors.enumerate().map(|(k, a)| (format!("COLOR_{k}"), a)));
        for number in of_kind(AttributeKind::Number).filter(|a| (1..=4).contains(&a.width)) {
            let letter =
                |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
            let name: String = number.name.chars().map(letter).collect();
            let name = format!("_{}", name.trim_start_matches('_'));
            if held.iter().all(|(other, _)| *other != name) {
                held.push((name, number));
            }
        }
        held
    }

    /// The name of the object, if all polygons are of one.
    fn object_name(&self) -> String {
        let objects = self.attributes.labels("object");
        let name = objects.and_then(|objects| {
            let (first, others) = objects.rows.split_first()?;
            let is_one = others.iter().all(|row| row == first);
            is_one.then(|| one_line(&label(objects, *first)))
        });
        name.unwrap_or_else(|| "mesh".into())
    }
}

/// A row as glTF has it: v downwards, normals of length one, all in the range of single precision.
fn values_of(attribute: &Attribute, row: u32) -> Vec<f32> {
    let row = attribute.row(row);
    let single = |x: f64| (x as f32).clamp(f32::MIN, f32::MAX);
    match attribute.kind {
        AttributeKind::Uv => vec![single(row[0]), single(1.0 - row[1])],
        AttributeKind::Normal => {
            let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
            let scale = if length > 0.0 { 1.0 / length } else { 1.0 };
            row.iter().map(|x| single(x * scale)).collect()
        }
        _ => row.iter().map(|&x| single(x)).collect(),
    }
}

fn write_chunks(writer: &mut impl Write, root: &Value, mut binary: Vec<u8>) -> io::Result<()> {
    /// Bytes of the head of the file, and of each chunk.
    const HEADS: usize = 12 + 8 + 8;
    let mut text = serde_json::to_vec(root).map_err(io::Error::other)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let size = |bytes: usize| {
        u32::try_from(bytes).map_err(|_| invalid("the mesh is too large for GLB".into()))
    };
    let whole = size(HEADS + text.len() + binary.len())?;
    writer.write_all(b"glTF")?;
    writer.write_all(&2u32.to_le_bytes())?;
    writer.write_all(&whole.to_le_bytes())?;
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        writer.write_all(&size(chunk.len())?.to_le_bytes())?;
        writer.write_all(kind)?;
        writer.write_all(&chunk)?;
    }
    Ok(())
}
