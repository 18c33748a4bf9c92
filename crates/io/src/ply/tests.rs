#![allow(clippy::panic, reason = "a test")]

use super::*;

const HEADER: &str = "comment c\nobj_info i\nelement vertex 3\nproperty double x\nproperty uchar red\n\
        property list short ushort seen\nproperty float y\nproperty float z\nelement face 2\n\
        property int8 tag\nproperty list uchar int vertex_indices\nelement edge 1\nproperty uint a\nend_header\n";

fn check(bytes: &[u8]) {
    let mesh = parse(bytes).map_err(|fault| fault.named("a.ply").to_string()).unwrap();
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.5, 0.0]]);
    assert_eq!(mesh.polygons.iter().collect::<Vec<_>>(), [&[0, 1, 2][..], &[2, 1, 0, 0]]);
    let vertex = Note::PropertiesIgnored { element: "vertex".into(), names: vec!["seen".into()] };
    let edge = Note::ElementsIgnored { kind: "`edge` element".into(), count: 1 };
    assert_eq!(mesh.notes, [vertex, edge]);
    let [red, tag] = &mesh.attributes.all[..] else { panic!("{:?}", mesh.attributes) };
    assert_eq!((red.name.as_str(), red.domain), ("red", AttributeDomain::Vertex));
    assert_eq!((tag.name.as_str(), tag.domain), ("tag", AttributeDomain::Face));
    assert!(red.kind == AttributeKind::Label && tag.kind == AttributeKind::Label);
    assert_eq!([red.of(0), red.of(1), red.of(2)], [[255.0], [0.0], [7.0]]);
    assert_eq!([tag.of(0), tag.of(1)], [[-1.0], [5.0]]);
}

fn ascii() -> String {
    let data = "0 255 0 0 0\n1 0 2 7 8 0 0\n\n0 7 1 9 0.5 0\n-1 3 0 1 2\n5 4 2 1 0 0\n77\n";
    format!("ply\nformat ascii 1.0\n{HEADER}{data}")
}

fn binary(big: bool) -> Vec<u8> {
    let format = if big { "big" } else { "little" };
    let mut bytes = format!("ply\nformat binary_{format}_endian 1.0\n{HEADER}").into_bytes();
    let mut put = |little: &[u8]| {
        let start = bytes.len();
        bytes.extend_from_slice(little);
        if big {
            bytes[start..].reverse();
        }
    };
    let rows = [(0.0f64, 255, &[][..], 0.0f32), (1.0, 0, &[7u16, 8], 0.0), (0.0, 7, &[9], 0.5)];
    for (x, red, seen, y) in rows {
        put(&x.to_le_bytes());
        put(&[red]);
        put(&(seen.len() as i16).to_le_bytes());
        for value in seen {
            put(&value.to_le_bytes());
        }
        put(&y.to_le_bytes());
        put(&0f32.to_le_bytes());
    }
    for (tag, face) in [(-1i8, &[0i32, 1, 2][..]), (5, &[2, 1, 0, 0])] {
        put(&tag.to_le_bytes());
        put(&[face.len() as u8]);
        for index in face {
            put(&index.to_le_bytes());
        }
    }
    put(&77u32.to_le_bytes());
    bytes
}

#[test]
fn all_encodings_agree() {
    check(ascii().as_bytes());
    check(ascii().replace('\n', "\r\n").as_bytes());
    check(ascii().replace('\n', "\r").as_bytes());
    check(&binary(false));
    check(&binary(true));
}

#[test]
fn a_line_feed_after_a_carriage_return_can_be_data() {
    let header = "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\rproperty uchar y\r\
            property uchar z\relement face 1\rproperty list uchar uchar vertex_index\rend_header\r";
    let mesh = parse(&[header.as_bytes(), b"\n\x01\x02\x03\0\0\0"].concat()).unwrap();
    assert_eq!(mesh.positions, [[10.0, 1.0, 2.0]]);
}

#[test]
fn every_cut_of_a_binary_file_is_found() {
    let whole = binary(false);
    for end in 0..whole.len() {
        let fault = parse(&whole[..end]).unwrap_err();
        let cut = matches!(
            fault.kind,
            ReadErrorKind::Truncated { .. }
                | ReadErrorKind::Syntax { .. }
                | ReadErrorKind::Empty(_)
        );
        assert!(cut, "{end}: {fault:?}");
    }
    let fault = parse(&whole[..whole.len() - 5]).unwrap_err().named("a").to_string();
    let expected = "the file ends too early: expected 2 `face` elements, found 1";
    assert_eq!(fault, format!("a, byte {}: {expected}", whole.len() - 5));
}

fn fault(header: &str, data: &str) -> String {
    let text = format!("ply\nformat ascii 1.0\n{header}end_header\n{data}");
    parse(text.as_bytes()).unwrap_err().named("a").to_string()
}

#[test]
fn faults_in_the_data_name_their_line() {
    let header = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uchar int vertex_indices\n";
    let cases = [
        ("0 0 0\n", "line 10: the file ends too early: expected 2 `vertex` elements, found 1"),
        (
            "0 0\n0 0 0",
            "line 10: expected one more value for this `vertex`, found the end of the line",
        ),
        ("0 0 0 9\n", "line 10: expected the end of the line after a `vertex`, found `9`"),
        ("0 0 0\n0 nan 0", "line 11: expected a finite number, found `nan`"),
        ("0 0 0\n0 z 0", "line 11: expected a number, found `z`"),
        ("0 0 0\n0 0 0\n2 0 1", "line 12: a face needs at least 3 corners, found 2"),
        ("0 0 0\n0 0 0\n-3 0 1", "line 12: expected the length of a list, found `-3`"),
        (
            "0 0 0\n0 0 0\n3 0 1 2",
            "line 12: vertex index 2 is out of range: the file has 2 vertices, counted from 0",
        ),
        (
            "0 0 0\n0 0 0\n3 0 1 -1",
            "line 12: vertex index -1 is out of range: the file has 2 vertices, counted from 0",
        ),
        ("0 0 0\n0 0 0\n3 0 1 .5", "line 12: expected a vertex index, found `.5`"),
        (
            "0 0 0\n0 0 0\n3 0 1 1\n7",
            "line 13: the header announces fewer elements, but the file goes on with `7`",
        ),
    ];
    for (data, expected) in cases {
        assert_eq!(fault(header, data), format!("a, {expected}"));
    }
}

#[test]
fn faults_in_the_header_name_their_line() {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let cases = [
        (
            "element vertex -1\n".to_owned(),
            "a, line 3: expected the number of `vertex` elements, found `-1`",
        ),
        (
            "element vertex 1\nproperty real x\n".to_owned(),
            "a, line 4: expected a number type such as `float`, found `real`",
        ),
        ("property float x\n".to_owned(), "a, line 3: expected `element`, found `property`"),
        ("elephant 1\n".to_owned(), "a, line 3: expected a PLY header statement, found `elephant`"),
        (
            "element vertex 1\nelement vertex 1\n".to_owned(),
            "a, line 4: expected each element once, found a second element `vertex`",
        ),
        (
            "element vertex 1\nproperty list float int x\n".to_owned(),
            "a, line 4: expected an integer type for the length of a list, found `float`",
        ),
        (
            "element vertex 1\nproperty float x\nelement face 1\n".to_owned(),
            "a, line 3: expected a vertex property `y`, found none",
        ),
        (
            format!("element vertex 1\n{xyz}element face 1\nproperty int a\n"),
            "a, line 7: expected a face property list `vertex_indices`, found none",
        ),
        (
            format!(
                "element vertex 1\n{xyz}element face 1\nproperty list int float vertex_index\n"
            ),
            "a, line 7: expected vertex indices of an integer type, found a floating-point type",
        ),
        (
            format!("element vertex 5\n{xyz}"),
            "a: the file has points but no surface (no `face` element)",
        ),
        (
            format!("element vertex 5\n{xyz}element face 0\n"),
            "a: the file has 5 vertices but no faces",
        ),
        ("element face 1\n".to_owned(), "a: the file has no vertices"),
    ];
    for (header, expected) in cases {
        assert_eq!(fault(&header, "0 0 0\n"), expected);
    }
    let parse = |text: &str| parse(text.as_bytes()).unwrap_err().named("a").to_string();
    assert_eq!(parse("OFF"), "a, line 1: expected `ply`, found `OFF`");
    assert_eq!(
        parse("ply\nend_header\n"),
        "a, line 2: expected a `format` statement in the header, found none"
    );
    assert_eq!(parse("ply\nformat ascii 2.0"), "a, line 2: expected version `1.0`, found `2.0`");
    assert_eq!(
        parse("ply\nformat ascii 1.0\n"),
        "a, line 2: the file ends too early: expected `end_header`"
    );
}

#[test]
fn counts_cost_nothing() {
    let header = "ply\nformat binary_little_endian 1.0\nelement nothing 9000000000000000000\n\
            element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uint uint vertex_indices\nend_header\n";
    let fault = parse(&[header.as_bytes(), &[0; 24]].concat()).unwrap_err().named("a").to_string();
    let expected = "the file ends too early: expected 4000000000 `vertex` elements, found 2";
    assert_eq!(fault, format!("a, byte {}: {expected}", header.len() + 24));
}

#[test]
fn triangle_strips_are_read() {
    let header = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
                  element tristrips 2\nproperty list int int vertex_indices\nend_header\n";
    let vertices = "0 0 0\n".repeat(6);
    // The first list has two strips, the second of which goes on by a step of no area.
    let text = format!("{header}{vertices}11 0 1 2 3 -1 3 4 5 5 1 2\n3 5 4 3\n");
    let mesh = parse(text.as_bytes()).unwrap();
    let expected = [[0, 1, 2], [2, 1, 3], [3, 4, 5], [1, 5, 2], [5, 4, 3]];
    let found: Vec<&[u32]> = mesh.polygons.iter().collect();
    assert_eq!(found, expected);
    assert_eq!(mesh.notes, []);
    let bad = format!("{header}{vertices}3 0 1 6\n0\n");
    let error = parse(bad.as_bytes()).unwrap_err().named("a").to_string();
    assert!(error.contains("vertex index 6 is out of range"), "{error}");
}
