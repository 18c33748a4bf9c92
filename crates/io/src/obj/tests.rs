use super::*;
use seamstress_mesh::attributes::Attributes;

fn read(text: &str) -> PolygonMesh {
    parse(text.as_bytes()).map_err(|fault| fault.named("a.obj").to_string()).unwrap()
}

fn fault(text: &str) -> String {
    parse(text.as_bytes()).unwrap_err().named("a").to_string()
}

const POINTS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn all_forms_of_corners() {
    let faces = "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 -2/-1/-1 -1\nf 1// 2/ 3//";
    let mesh = read(&format!("{POINTS}vt 0 0\nvn 0 0 1\n{faces}"));
    assert_eq!(mesh.polygons.len(), 5);
    assert!(mesh.polygons.iter().all(|polygon| polygon == [0, 1, 2]));
    assert_eq!(mesh.attributes, Attributes::default());
    let incomplete = Note::TextureCoordinatesIncomplete { without: 10, corners: 15 };
    assert_eq!(mesh.notes, [incomplete, Note::NormalsIgnored { count: 1 }]);
}

#[test]
fn every_line_end_tab_comment_and_continuation() {
    for end in ["\n", "\r", "\r\n"] {
        let text = [
            "\u{feff}# c",
            "v\t0 0 0 # c",
            "",
            "g a",
            "v 1 \\",
            "  0 0",
            "v 0 1 0#",
            "f 1 2\\",
            "3",
        ];
        let mesh = read(&text.join(end));
        assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_eq!(mesh.polygons.get(0), [0, 1, 2]);
        assert_eq!(mesh.notes, []);
        let broken = format!("{}{end}f 1 2{end}", text.join(end));
        assert_eq!(fault(&broken), "a, line 10: a face needs at least 3 corners, found 2");
    }
}

#[test]
fn names_may_end_in_a_backslash() {
    let mesh = read(&format!("mtllib C:\\m\\\n{POINTS}f 1 2 3"));
    assert_eq!(mesh.positions.len(), 3);
    assert_eq!(mesh.attributes.material_files, ["C:\\m\\"]);
}

#[test]
fn faces_may_precede_vertices() {
    let mesh = read(&format!("f 1 2 3\n{POINTS}f -3 -2 -1\nv 5 5 5"));
    assert_eq!(mesh.polygons.corners(), [0, 1, 2, 0, 1, 2]);
    let late = fault(&format!("f 1 2 3\nf 1 2 4\n{POINTS}"));
    assert_eq!(late, "a, line 2: vertex index 4 is out of range: the file has 3 vertices");
}

#[test]
fn lines_are_split_and_points_noted() {
    let mesh =
        read(&format!("{POINTS}f 1 2 3\nl 1/1 2/2 -1\nl 2\np 1 2\ncurv 0 1 \\\n1 2\nshape x"));
    assert_eq!(mesh.lines, [[0, 1], [1, 2]]);
    let points = Note::ElementsIgnored { kind: "point".into(), count: 3 };
    let curves = Note::ElementsIgnored { kind: "free-form curve or surface".into(), count: 1 };
    let unknown = Note::UnknownKeywords { count: 1, first_line: 10, keyword: "`shape`".into() };
    assert_eq!(mesh.notes, [points, curves, unknown]);
}

#[test]
fn texture_coordinates_are_kept_if_complete() {
    let uv = "vt 0.5\nvt 1 0 0\n";
    let mesh = read(&format!("{POINTS}{uv}f 1/1 2/2 3/1"));
    let uvs = mesh.corner_uvs().unwrap();
    assert_eq!(uvs.values, [0.5, 0.0, 1.0, 0.0]);
    assert_eq!(uvs.rows, [0, 1, 0]);
    let mesh = read(&format!("{POINTS}{uv}f 1 2 3"));
    assert_eq!(mesh.notes, [Note::TextureCoordinatesUnused { count: 2 }]);
    let mesh = read(&format!("{POINTS}vt nan 0\nf 1/1 2/1 3/1"));
    assert_eq!(mesh.notes, [Note::TextureCoordinatesNotFinite { line: 4 }]);
    for face in ["f 1/1 2/2 3/3", "f 1/-1 2/-1 3/-1"] {
        let mesh = read(&format!("{POINTS}{face}"));
        assert_eq!(mesh.notes, [Note::TextureCoordinatesIncomplete { without: 3, corners: 3 }]);
    }
    let range = fault(&format!("{POINTS}{uv}f 1/1 2/2 3/3"));
    assert_eq!(
        range,
        "a, line 6: texture coordinate index 3 is out of range: the file has 2 texture coordinates"
    );
}

#[test]
fn what_a_mesh_carries_is_read() {
    let vertices = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 .5\n";
    let faces = "mtllib a b.mtl\nmtllib c.mtl\nf 1//1 2//2 3//-1\nusemtl red paint\no box\ns 1\n\
        f 3//1 2//2 1//1\ng lid\ns off\nf 1//2 2//2 3//2\n";
    let mesh = read(&format!("{vertices}vn 0 0 1\nvn 0 0 2\n{faces}"));
    assert_eq!(mesh.notes, []);
    assert_eq!(mesh.attributes.material_files, ["a b.mtl", "c.mtl"]);
    let color = mesh.attributes.of_kind(AttributeKind::Color).next().unwrap();
    assert_eq!((color.width, color.of(2)), (3, &[0.0, 0.0, 0.5][..]));
    let normal = mesh.attributes.of_kind(AttributeKind::Normal).next().unwrap();
    assert_eq!(normal.rows, [0, 1, 1, 0, 1, 0, 1, 1, 1]);
    assert_eq!(normal.values, [0.0, 0.0, 1.0, 0.0, 0.0, 2.0]);
    let names = |name: &str| -> Vec<&str> {
        let labels = mesh.attributes.labels(name).unwrap();
        labels.rows.iter().map(|&row| labels.names[row as usize].as_str()).collect()
    };
    assert_eq!(names("material"), ["", "red paint", "red paint"]);
    assert_eq!(names("object"), ["", "box", "box"]);
    assert_eq!(names("group"), ["", "", "lid"]);
    assert_eq!(names("smoothing"), ["", "1", "0"]);
}

#[test]
fn normals_that_are_not_there_are_noted() {
    for (normals, face) in
        [("vn 0 0 1", "f 1//1 2//1 3//2"), ("vn 0 0", "f 1//1 2//1 3//1"), ("vn 0 0 x", "f 1 2 3")]
    {
        let mesh = read(&format!("{POINTS}{normals}\n{face}"));
        assert_eq!(mesh.notes, [Note::NormalsIgnored { count: 1 }]);
        assert!(mesh.attributes.all.is_empty());
    }
}

#[test]
fn weights_are_noted() {
    let mesh = read("v 0 0 0 1\nv 1 0 0 .1 .2 .3\nv 0 1 0\nf 1 2 3");
    assert_eq!(mesh.notes, [Note::VertexColumnsIgnored { count: 2 }]);
}

#[test]
fn a_repeated_vertex_is_left_to_later_checks() {
    assert_eq!(read(&format!("{POINTS}f 1 1 2")).polygons.get(0), [0, 0, 1]);
}

#[test]
fn faults_name_their_line() {
    let cases = [
        ("v 1 2\n", "line 1: expected three coordinates after `v`, found the end of the line"),
        ("v 1 abc 2", "line 1: expected three coordinates after `v`, found `abc`"),
        (
            "v 1,5 0 0",
            "line 1: expected three coordinates after `v`, found `1,5` (write decimals with a point)",
        ),
        ("\nv 1 1e999 0", "line 2: expected a finite number, found `1e999`"),
        ("v -nan(ind) 0 0", "line 1: expected a finite number, found `-nan(ind)`"),
        ("v 0 0 0\nf 1 0 1", "line 2: vertex index 0 is out of range: OBJ counts from 1"),
        ("v 0 0 0\nf 1 1 -2", "line 2: vertex index -2 is out of range: 1 vertex precedes it"),
        (
            "v 0 0 0\nf 1 1 99999999999999999999",
            "line 2: vertex index 99999999999999999999 is out of range: the file has 1 vertex",
        ),
        (
            "v 0 0 0\nf 1 1 1.5",
            "line 2: expected a face corner such as `3`, `3/1` or `3/1/2`, found `1.5`",
        ),
        (
            "v 0 0 0\nf 1 1 1/2/3/4",
            "line 2: expected a face corner such as `3`, `3/1` or `3/1/2`, found `1/2/3/4`",
        ),
        ("v 0 0 0\nf\n", "line 2: a face needs at least 3 corners, found 0"),
        (
            "lorem\nipsum",
            "line 1: expected an OBJ statement such as `v` or `f` (the file has none), found `lorem`",
        ),
        ("v 0 0 0\n\x07x", "line 2: expected an OBJ statement, found `\\u{7}x`"),
        ("v 0 0 0\nv 0 \0", "byte 12: expected text, found a NUL byte in line 2"),
    ];
    for (text, expected) in cases {
        assert_eq!(fault(text), format!("a, {expected}"));
    }
    assert_eq!(fault("# nothing\n"), "a: the file has no vertices");
    assert_eq!(fault(POINTS), "a: the file has 3 vertices but no faces");
}

#[test]
fn polylines_need_no_polygons() {
    let text = b"v 0 0 0\nv 1 0 0\nv 1 2 0\nl 1 2 3\nl -1 -3\n";
    let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0]];
    assert_eq!(crate::parse_segments(text, "s.obj").unwrap(), [[a, b], [b, c], [c, a]]);
    let error = |text: &[u8]| crate::parse_segments(text, "s.obj").unwrap_err().to_string();
    assert_eq!(error(b"v 0 0 0\nv 1 0 0\n"), "s.obj: the file has no `l` elements");
    let range = error(b"v 0 0 0\nl 1 2\n");
    assert!(range.starts_with("s.obj, line 2: vertex index 2 is out of range"), "{range}");
}
