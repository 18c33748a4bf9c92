//! Whatever the bytes, the readers return: random data, and valid files with random damage.

#![allow(clippy::unwrap_used, reason = "a test, with helpers")]

use proptest::prelude::*;
use seamstress_io::attributes::{Attribute, AttributeDomain, AttributeKind, Attributes};
use seamstress_io::{Format, PolygonMesh, Polymesh, parse_mesh};

const FORMATS: [Option<Format>; 6] = [
    None,
    Some(Format::Obj),
    Some(Format::Off),
    Some(Format::Ply),
    Some(Format::Stl),
    Some(Format::Gltf),
];

const OBJ: &str = "# c\nv 0 0 0 1\nv 1 0 0\nv 0 1 0 .1 .2 .3\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 -1/1/1\nl 1 2 \\\n 3\n";
const OFF: &str =
    "COFF # c\n3 2 0\n0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0\n3 0 1 2 0.5 0.5 0.5\n3 0\n2\n1\n";
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
    endfacet\nendsolid a\n";
const GLTF: &str = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0,"scale":[2,1,1]},{"children":[0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5121,"count":3,
"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":9}],"buffers":[{"byteLength":9,
"uri":"data:application/octet-stream;base64,AAAAAQAAAAEA"}]}"#;
const PLY: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty list char int q\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// A valid file of every kind.
fn samples() -> Vec<Vec<u8>> {
    let ply_text = format!("ply\nformat ascii 1.0\n{PLY}0 0 0 0\n1 0 0 1 7\n0 1 0 0\n3 0 1 2\n");
    let mut ply = format!("ply\nformat binary_little_endian 1.0\n{PLY}").into_bytes();
    for x in [0f32, 1.0, 0.0] {
        ply.extend([x, 0.0, 0.0].map(f32::to_le_bytes).as_flattened());
        ply.push(0);
    }
    ply.push(3);
    ply.extend([0i32, 1, 2].map(i32::to_le_bytes).as_flattened());
    let mut stl = vec![b' '; 80];
    stl.extend(1u32.to_le_bytes());
    stl.extend(
        [0f32, 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0.].map(f32::to_le_bytes).as_flattened(),
    );
    stl.extend([0; 2]);
    vec![OBJ.into(), OFF.into(), STL.into(), ply_text.into(), ply, stl, glb(), GLTF.into()]
}

/// A triangle with texture coordinates and a material.
fn glb() -> Vec<u8> {
    let uv = vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let names = vec!["red".to_owned()];
    let attributes = Attributes::from(vec![
        Attribute::new("uv", AttributeDomain::Corner, AttributeKind::Uv, 2, uv),
        Attribute::labels("material", AttributeDomain::Face, names, vec![0]),
    ]);
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let polygons = [[0, 1, 2]];
    let mesh = Polymesh {
        positions: &positions,
        polygons: &polygons,
        attributes: &attributes,
        comments: &[],
    };
    let mut bytes = Vec::new();
    mesh.write(&mut bytes, Format::Gltf).unwrap();
    bytes
}

/// Parses in every way and checks what a mesh promises.
fn parse_all(bytes: &[u8]) -> usize {
    let meshes = FORMATS.iter().filter_map(|&format| match parse_mesh(bytes, format, "a") {
        Ok(mesh) => Some(mesh),
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("a: ") || message.starts_with("a, "), "{message}");
            assert!(message.len() < 500 && !message.contains(char::is_control), "{message:?}");
            None
        }
    });
    meshes.map(|mesh| check(&mesh)).count()
}

fn check(mesh: &PolygonMesh) {
    let vertices = mesh.positions.len();
    assert!(mesh.positions.as_flattened().iter().all(|x| x.is_finite()));
    assert!(!mesh.polygons.is_empty());
    assert!(mesh.polygons.iter().all(|polygon| polygon.len() >= 3));
    let lines = mesh.lines.as_flattened();
    assert!(
        mesh.polygons.corners().iter().chain(lines).all(|&vertex| (vertex as usize) < vertices)
    );
    for attribute in &mesh.attributes.all {
        let n_elements = match attribute.domain {
            AttributeDomain::Vertex => vertices,
            AttributeDomain::Corner => mesh.polygons.corners().len(),
            AttributeDomain::Face => mesh.polygons.len(),
        };
        assert_eq!(attribute.check(n_elements), Ok(()));
    }
    for note in &mesh.notes {
        assert!(!note.to_string().is_empty());
    }
}

#[test]
fn samples_are_read() {
    for sample in samples() {
        assert_eq!(parse_all(&sample), FORMATS.len(), "{}", String::from_utf8_lossy(&sample));
    }
}

#[test]
fn every_cut_returns() {
    for sample in samples() {
        for end in 0..sample.len() {
            parse_all(&sample[..end]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_return(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        parse_all(&bytes);
    }

    #[test]
    fn random_words_return(words in proptest::collection::vec("[vfl]|vt|OFF|ply|solid|facet|-?[0-9]{1,3}(/-?[0-9]){0,3}|1e999|nan|#|\\\\|\n", 0..60)) {
        parse_all(words.join(" ").as_bytes());
    }

    #[test]
    fn damaged_files_return(
        sample in 0usize..8,
        damage in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>(), 0..3), 1..6),
    ) {
        let mut bytes = samples().swap_remove(sample);
        for (place, value, how) in damage {
            let at = place.index(bytes.len());
            match how {
                0 => bytes[at] = value,
                1 => bytes.insert(at, value),
                _ => { bytes.remove(at); }
            }
        }
        parse_all(&bytes);
    }
}

#[test]
fn long_hostile_shapes_end() {
    /// Work that grew with the square of this would not end within a test run.
    const SIZE: usize = 400_000;
    let header = |line: &str| {
        let lines: String = (0..SIZE).map(|i| line.replace('@', &i.to_string())).collect();
        format!("ply\nformat ascii 1.0\n{lines}")
    };
    let files = [
        header("element e@ 0\n"),
        header("element vertex 1\nproperty int p@\n"),
        format!("{}element vertex 1\nend_header\n", header("comment @\n")),
        format!("v 0 0 0{}", "\\ ".repeat(SIZE)),
        format!("v 0 0 0\nf{}", " 9".repeat(SIZE)),
        format!("f 1 1 1{}", "\nf 1 1 1".repeat(SIZE)),
        format!("v 0 0 0\nf 1 1 1{}", "\nunknown".repeat(SIZE)),
        format!("OFF 1 1 0\n0 0 0\n9999999999{}", "\n0".repeat(SIZE)),
        format!("solid\n{}", "facet\n".repeat(SIZE)),
        "#\r".repeat(SIZE),
    ];
    for file in &files {
        parse_all(file.as_bytes());
    }
}
