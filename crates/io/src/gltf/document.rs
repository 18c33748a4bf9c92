//! The JSON of glTF, as far as it is about triangles.

use super::syntax;
use crate::error::{Fault, Parsed, Position, ReadErrorKind};
use crate::gltf::matrix::Matrix;
use crate::text::quote;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Bytes of the head of a binary file, and of that of a chunk.
const HEAD: usize = 12;
const CHUNK_HEAD: usize = 8;
/// Extensions that hide the triangles of those who do not know them.
const HIDING: [&str; 2] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression"];

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    asset: Asset,
    scene: Option<usize>,
    #[serde(default)]
    scenes: Vec<Scene>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<Mesh>,
    #[serde(default)]
    pub(super) materials: Vec<Named>,
    #[serde(default)]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub(super) buffers: Vec<Buffer>,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Debug, Deserialize)]
struct Asset {
    version: String,
}

#[derive(Debug, Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    #[serde(default)]
    pub(super) children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    #[serde(default)]
    pub(super) attributes: BTreeMap<String, usize>,
    pub(super) indices: Option<usize>,
    pub(super) material: Option<usize>,
    pub(super) mode: Option<u32>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Named {
    pub(super) name: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: usize,
}

impl Document {
    /// Reads the JSON, and finds the binary chunk if there is one.
    pub(super) fn parse(bytes: &[u8]) -> Parsed<(Self, Option<&[u8]>)> {
        let (text, start, binary) = match bytes.starts_with(b"glTF") {
            true => chunks(bytes)?,
            false => (bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None, None),
        };
        let document: Self = serde_json::from_slice(text).map_err(|cause| {
            let position = match start {
                // The JSON of binary files is on one line, as a rule.
                Some(start) => Position::Byte(start + cause.column().saturating_sub(1)),
                None => Position::Line(cause.line()),
            };
            let cause = cause.to_string();
            let cause = cause.split(" at line ").next().unwrap_or_default();
            Fault::syntax(position, "the JSON of glTF", quote(cause.as_bytes()))
        })?;
        let version = &document.asset.version;
        if !version.starts_with("2.") {
            return Err(syntax("version 2 of glTF", quote(version.as_bytes())));
        }
        let hidden = document.extensions_required.iter().find(|e| HIDING.contains(&e.as_str()));
        match hidden {
            Some(extension) => {
                let what = format!(
                    "the triangles are compressed ({extension}); decompress the file first"
                );
                Err(Fault::unsupported(None, what))
            }
            None => Ok((document, binary)),
        }
    }

    /// The nodes that nothing is above, of the scene that is shown first, or of all if there is no scene.
    pub(super) fn roots(&self) -> Parsed<Vec<usize>> {
        match (self.scene, &self.scenes[..]) {
            (None, []) => {
                let mut is_child = vec![false; self.nodes.len()];
                for &child in self.nodes.iter().flat_map(|node| &node.children) {
                    if let Some(is_child) = is_child.get_mut(child) {
                        *is_child = true;
                    }
                }
                Ok((0..self.nodes.len()).filter(|&node| !is_child[node]).collect())
            }
            (scene, scenes) => Ok(get(scenes, scene.unwrap_or_default(), "scene")?.nodes.clone()),
        }
    }
}

impl Node {
    /// From its space to that of the node above.
    pub(super) fn matrix(&self) -> Matrix {
        match self.matrix {
            Some(columns) => Matrix::of_columns(columns),
            None => Matrix::of_parts(
                self.translation.unwrap_or_default(),
                self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
                self.scale.unwrap_or([1.0; 3]),
            ),
        }
    }
}

/// An element by its number.
pub(super) fn get<'a, T>(list: &'a [T], index: usize, what: &'static str) -> Parsed<&'a T> {
    list.get(index).ok_or_else(|| {
        let (index, count) = (index.to_string(), list.len());
        Fault::whole_file(ReadErrorKind::IndexOutOfRange { what, index, count, base: 0 })
    })
}

/// The JSON of a binary file, where it starts, and the binary chunk.
#[expect(clippy::type_complexity, reason = "read in one place")]
fn chunks(bytes: &[u8]) -> Parsed<(&[u8], Option<usize>, Option<&[u8]>)> {
    let truncated = |expected: &str| Fault::truncated(Position::Byte(bytes.len()), expected);
    let number = |at: usize| -> Parsed<usize> {
        let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
        four.map(|four| u32::from_le_bytes(four) as usize)
            .ok_or_else(|| truncated("the head of a chunk"))
    };
    let version = number(4)?;
    if version != 2 {
        let found = version.to_string();
        return Err(Fault::syntax(Position::Byte(4), "version 2 of glTF", found));
    }
    let whole = number(8)?;
    if whole > bytes.len() {
        return Err(truncated(&format!("{whole} bytes, found {}", bytes.len())));
    }
    let mut at = HEAD;
    let mut json = None;
    while at < whole {
        let (length, start) = (number(at)?, at + CHUNK_HEAD);
        let kind = bytes.get(at + 4..start).ok_or_else(|| truncated("the head of a chunk"))?;
        let chunk = start.checked_add(length).and_then(|end| bytes.get(start..end));
        let chunk = chunk.ok_or_else(|| truncated(&format!("a chunk of {length} bytes")))?;
        match (kind, json) {
            (b"JSON", None) => json = Some((chunk, start)),
            (b"BIN\0", Some((text, start))) => return Ok((text, Some(start), Some(chunk))),
            (_, None) => {
                return Err(Fault::syntax(
                    Position::Byte(at + 4),
                    "a chunk of JSON first",
                    quote(kind),
                ));
            }
            _ => {}
        }
        at = start + length;
    }
    match json {
        Some((text, start)) => Ok((text, Some(start), None)),
        None => Err(truncated("a chunk of JSON")),
    }
}
