#![allow(clippy::panic, reason = "a test")]

use super::*;
use crate::{ReadErrorKind, parse_mesh, read_mesh};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// Triangles of one square, with texture coordinates, normals, colours in bytes and indices of two bytes.
fn square() -> (Value, Vec<u8>) {
    let mut bytes = Vec::new();
    let floats = |bytes: &mut Vec<u8>, values: &[f32]| {
        bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    };
    floats(&mut bytes, &[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    floats(&mut bytes, &[0., 1., 1., 1., 1., 0., 0., 0.]);
    floats(&mut bytes, &[0., 0., 1., 0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    // Four colours of three bytes, four bytes apart.
    bytes.extend([255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9, 51, 51, 51, 9]);
    bytes.extend([0u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes).as_flattened());
    let float = |view: usize, kind: &str| json!({ "bufferView": view, "componentType": 5126, "count": 4, "type": kind });
    let document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "sheet" }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2, "COLOR_0": 3, "TANGENT": 3 },
            "indices": 4,
            "material": 0,
        }] }],
        "materials": [{ "name": "red" }],
        "accessors": [
            float(0, "VEC3"), float(1, "VEC2"), float(2, "VEC3"),
            { "bufferView": 3, "componentType": 5121, "count": 4, "type": "VEC3", "normalized": true },
            { "bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 128, "byteLength": 16, "byteStride": 4 },
            { "buffer": 0, "byteOffset": 144, "byteLength": 12 },
        ],
        "buffers": [{ "byteLength": 156 }],
    });
    (document, bytes)
}

/// The document with its buffer in the text.
fn text(mut document: Value, bytes: &[u8]) -> String {
    document["buffers"][0]["uri"] =
        format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes)).into();
    document.to_string()
}

fn read(document: Value, bytes: &[u8]) -> PolygonMesh {
    parse_mesh(text(document, bytes).as_bytes(), None, "a.gltf").unwrap()
}

fn fault(change: impl FnOnce(&mut Value)) -> String {
    let (mut document, bytes) = square();
    change(&mut document);
    let error = parse_mesh(text(document, &bytes).as_bytes(), None, "a").unwrap_err();
    assert!(!matches!(error.kind, ReadErrorKind::UnknownFormat { .. }));
    error.to_string()
}

fn attribute<'a>(mesh: &'a PolygonMesh, name: &str) -> &'a Attribute {
    mesh.attributes.all.iter().find(|a| a.name == name).unwrap()
}

#[test]
fn a_square_with_all_that_it_carries() {
    let (document, bytes) = square();
    let mesh = read(document, &bytes);
    assert_eq!(mesh.format, Format::Gltf);
    assert_eq!(
        mesh.positions,
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
    );
    assert_eq!(mesh.polygons.corners(), [0, 1, 2, 0, 2, 3]);
    // Upwards.
    assert_eq!(attribute(&mesh, "uv").of(2), [1.0, 1.0]);
    assert_eq!(attribute(&mesh, "uv").of(0), [0.0, 0.0]);
    assert_eq!(attribute(&mesh, "color").of(5), [0.2, 0.2, 0.2]);
    assert_eq!(mesh.attributes.labels("material").unwrap().names, ["red"]);
    assert_eq!(mesh.attributes.labels("object").unwrap().names, ["sheet"]);
    let ignored =
        Note::PropertiesIgnored { element: "vertex".into(), names: vec!["TANGENT".into()] };
    assert_eq!(mesh.notes, [ignored]);
}

#[test]
fn nodes_place_their_meshes() {
    // Above: a shift by 10 along x. Below: a quarter turn about z, and a mirror with twice the size along x.
    let (mut document, bytes) = square();
    let half = 0.5f64.sqrt();
    document["nodes"] = json!([
        { "children": [1, 2], "translation": [10, 0, 0] },
        { "mesh": 0, "name": "turned", "rotation": [0, 0, half, half] },
        { "mesh": 0, "name": "mirrored", "matrix": [-2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1] },
    ]);
    let mesh = read(document, &bytes);
    let near = |v: usize, p: [f64; 3]| {
        let gap = (0..3).map(|k| (mesh.positions[v][k] - p[k]).abs()).fold(0.0, f64::max);
        assert!(gap < 1e-12, "vertex {v}: {:?}, not {p:?}", mesh.positions[v]);
    };
    near(1, [10.0, 1.0, 0.0]);
    near(3, [9.0, 0.0, 0.0]);
    near(5, [8.0, 0.0, 5.0]);
    near(7, [10.0, 1.0, 5.0]);
    // What a mirror turns over is turned back, with its values.
    assert_eq!(mesh.polygons.corners()[6..9], [4, 6, 5]);
    assert_eq!(attribute(&mesh, "uv").of(7), [1.0, 1.0]);
    for corner in 0..12 {
        assert_eq!(attribute(&mesh, "normal").of(corner), [0.0, 0.0, 1.0]);
    }
    assert_eq!(mesh.attributes.labels("object").unwrap().rows, [0, 0, 1, 1]);
}

#[test]
fn copies_of_a_vertex_are_one_in_an_object_and_two_in_two() {
    let (mut document, bytes) = square();
    // The same triangles once more, of another material and without texture coordinates.
    let second = json!({ "attributes": { "POSITION": 0 }, "indices": 4, "mode": 4 });
    document["meshes"][0]["primitives"].as_array_mut().unwrap().push(second);
    let mesh = read(document.clone(), &bytes);
    assert_eq!((mesh.positions.len(), mesh.polygons.len()), (4, 4));
    let labels = mesh.attributes.labels("material").unwrap();
    assert_eq!((&labels.rows[..], &labels.names[1][..]), (&[0, 0, 1, 1][..], ""));
    // Colours that are missing are white; texture coordinates that are missing are a reason to keep none.
    assert_eq!(attribute(&mesh, "color").of(6), [1.0, 1.0, 1.0]);
    assert!(mesh.notes.contains(&Note::TextureCoordinatesIncomplete { without: 6, corners: 12 }));
    document["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0 }]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    assert_eq!(read(document, &bytes).positions.len(), 8);
}

#[test]
fn strips_and_fans_are_triangles() {
    assert_eq!(triangles(&[0, 1, 2, 3, 3, 4], STRIP), [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(triangles(&[0, 1, 2, 3], FAN), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(triangles(&[], FAN), [[0; 3]; 0]);
    assert_eq!(triangles(&[5, 6, 7, 8], TRIANGLES), [[5, 6, 7]]);
}

#[test]
fn buffers_may_be_files_beside() {
    let (mut document, bytes) = square();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("the data.bin"), &bytes).unwrap();
    document["buffers"][0]["uri"] = "the%20data.bin".into();
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, document.to_string()).unwrap();
    assert_eq!(read_mesh(&path).unwrap().polygons.len(), 2);
    let fault = |document: &Value| {
        std::fs::write(&path, document.to_string()).unwrap();
        let error = read_mesh(&path).unwrap_err().to_string();
        error.rsplit_once("a.gltf: ").unwrap().1.to_owned()
    };
    for outside in ["../the%20data.bin", "/etc/hosts", "http://x/y.bin", "%2e%2e/x"] {
        document["buffers"][0]["uri"] = outside.into();
        let expected =
            format!("the buffer `{outside}` is not in the folder of the file or below it");
        assert_eq!(fault(&document), expected);
    }
    document["buffers"][0]["uri"] = "gone.bin".into();
    assert!(fault(&document).starts_with("cannot be read: buffer `gone.bin`: "));
    let error = parse_mesh(document.to_string().as_bytes(), None, "a").unwrap_err();
    let expected =
        "a: the buffer `gone.bin` is in a file of its own; read the mesh from a file too";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn faults_are_told() {
    let index = |what: &str, count: &str| {
        format!("a: {what} index 9 is out of range: the file has {count}, counted from 0")
    };
    let mesh =
        |d: &mut Value, key: &str, value: Value| d["meshes"][0]["primitives"][0][key] = value;
    assert_eq!(fault(|d| d["scene"] = 9.into()), index("scene", "1 scene"));
    assert_eq!(fault(|d| d["scenes"][0]["nodes"][0] = 9.into()), index("node", "1 node"));
    assert_eq!(fault(|d| d["nodes"][0]["mesh"] = 9.into()), index("mesh", "1 mesh"));
    assert_eq!(fault(|d| mesh(d, "indices", 9.into())), index("accessor", "5 accessors"));
    assert_eq!(fault(|d| mesh(d, "material", 9.into())), index("material", "1 material"));
    let first = |d: &mut Value, key: &str, value: Value| d["accessors"][0][key] = value;
    assert_eq!(fault(|d| first(d, "bufferView", 9.into())), index("buffer view", "5 buffer views"));
    let short = "a: the file ends too early: expected";
    assert_eq!(fault(|d| first(d, "count", 5.into())), format!("{short} 5 rows in accessor 0"));
    assert_eq!(
        fault(|d| first(d, "byteOffset", u64::MAX.into())),
        format!("{short} 4 rows in accessor 0")
    );
    assert_eq!(
        fault(|d| d["buffers"][0]["byteLength"] = 999.into()),
        format!("{short} 999 bytes in buffer 0, found 156")
    );
    assert_eq!(
        fault(|d| first(d, "type", "MAT4".into())),
        "a: expected numbers or vectors, found `MAT4`"
    );
    assert_eq!(
        fault(|d| first(d, "componentType", 7.into())),
        "a: expected a type of numbers such as 5126, found 7"
    );
    assert_eq!(
        fault(|d| d["bufferViews"][0]["byteStride"] = 4.into()),
        "a: expected rows at least 12 bytes apart, found 4"
    );
    assert_eq!(
        fault(|d| d["accessors"][1]["count"] = 3.into()),
        "a: expected as many rows of `TEXCOORD_0` as positions, 4, found 3 rows"
    );
    assert_eq!(
        fault(|d| d["nodes"] = json!([{ "mesh": 0, "children": [0] }])),
        "a: expected nodes that form trees, found node 0 below two others, or below itself"
    );
    assert_eq!(
        fault(|d| d["asset"]["version"] = "1.0".into()),
        "a: expected version 2 of glTF, found `1.0`"
    );
    assert_eq!(
        fault(|d| d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"])),
        "a: the triangles are compressed (KHR_draco_mesh_compression); decompress the file first"
    );
    assert_eq!(
        fault(|d| d["accessors"][0]["sparse"] = json!({})),
        "a: accessor 0 is sparse or has no data of its own"
    );
    assert_eq!(fault(|d| mesh(d, "mode", 1.into())), "a: the file has no vertices");
    let out = fault(|d| d["accessors"][3]["componentType"] = 5126.into());
    assert_eq!(out, "a: expected rows at least 12 bytes apart, found 4");
    let error = parse_mesh(b"{\"asset\": {\n\"version\": 2}}", None, "a").unwrap_err();
    assert_eq!(error.line(), Some(2));
}

#[test]
fn copies_beyond_reason_are_refused() {
    let (mut document, bytes) = square();
    document["nodes"] = (0..3).map(|_| json!({ "mesh": 0 })).collect();
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let count = 5000;
    // A triangle without area, over and over again.
    document["accessors"][4] =
        json!({ "bufferView": 4, "componentType": 5121, "count": count, "type": "SCALAR" });
    let indices = vec![0u8; count];
    let (before, length) = (bytes.len(), count);
    document["bufferViews"][4] = json!({ "buffer": 0, "byteOffset": before, "byteLength": length });
    document["buffers"][0]["byteLength"] = (before + length).into();
    let many: Vec<Value> = (0..400).map(|_| json!({ "mesh": 0 })).collect();
    assert_eq!(
        read(document.clone(), &[bytes.clone(), indices.clone()].concat()).positions.len(),
        12
    );
    document["scenes"][0]["nodes"] = (0..many.len()).collect();
    document["nodes"] = many.into();
    let text = text(document, &[bytes, indices].concat());
    let error = parse_mesh(text.as_bytes(), None, "a").map(drop).unwrap_err().to_string();
    assert_eq!(error, "a: the objects of the scene are too many copies of large meshes");
}

#[test]
fn every_cut_of_a_binary_file_is_found() {
    let (document, bytes) = square();
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend(((28 + text.len() + bytes.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &bytes)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    assert_eq!(parse_mesh(&file, None, "a").unwrap().polygons.len(), 2);
    for end in 4..file.len() {
        let error = parse_mesh(&file[..end], Some(Format::Gltf), "a").unwrap_err();
        assert!(matches!(error.kind, ReadErrorKind::Truncated { .. }), "{end}: {error}");
        // And so if the head tells of the shorter length.
        if end > 12 {
            let mut honest = file[..end].to_vec();
            honest[8..12].copy_from_slice(&(end as u32).to_le_bytes());
            assert!(parse_mesh(&honest, None, "a").is_err(), "{end}");
        }
    }
}
