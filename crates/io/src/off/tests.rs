use super::*;

fn read(text: &str) -> PolygonMesh {
    parse(text.as_bytes()).map_err(|fault| fault.named("a.off").to_string()).unwrap()
}

fn fault(text: &str) -> String {
    parse(text.as_bytes()).unwrap_err().named("a").to_string()
}

const BODY: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn all_headers() {
    let headers = [
        "OFF\n3 1 0",
        "OFF 3 1 0",
        "OFF3 1 3 # c",
        "# c\n\n3 1 0",
        "3 1",
        "COFF\n#\n3 1 0",
        "STCNOFF\n3\n1 0",
    ];
    for header in headers {
        for end in ["\n", "\r\n", "\r"] {
            let mesh = read(&format!("{header}\n{BODY}").replace('\n', end));
            assert_eq!(mesh.positions[1], [1.0, 0.0, 0.0]);
            assert_eq!(mesh.polygons.get(0), [0, 1, 2]);
        }
    }
}

#[test]
fn colours_are_noted() {
    let mesh =
        read("COFF\n3 2 0\n0 0 0 9 9 9 1\n1 0 0 9 9 9 1\n0 1 0\n3 0 1 2 0.1 0.2 0.3\n3 0 2 1 7");
    assert_eq!(mesh.polygons.corners(), [0, 1, 2, 0, 2, 1]);
    assert_eq!(
        mesh.notes,
        [Note::VertexColumnsIgnored { count: 2 }, Note::FaceColorsIgnored { count: 2 }]
    );
}

#[test]
fn elements_may_be_spread_over_lines() {
    let mesh = read("OFF\n3 2 0\n0\n0 0\n1 0 0\n0 1 0\n3 0 \n1 \n2 \n\n3 2\n\n1 # c\n 0");
    assert_eq!(mesh.polygons.corners(), [0, 1, 2, 2, 1, 0]);
    assert_eq!(mesh.notes, []);
}

#[test]
fn faults_name_their_line() {
    let cases = [
        ("ply", "line 1: expected `OFF`, found `ply`"),
        ("OFF BINARY\n\0", "line 1: binary OFF is not read; save it as text"),
        (
            "4OFF\n1 1 1",
            "line 1: `4OFF` has points that are not three-dimensional, which is not read",
        ),
        ("OFF\n3 -1 0", "line 2: expected the number of faces, found `-1`"),
        ("OFF\n3 1 0 7", "line 2: expected the end of the line after the counts, found `7`"),
        ("OFF\n3", "line 2: the file ends too early: expected the number of faces"),
        (
            "OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2",
            "line 3: expected three coordinates, found fewer values in the line",
        ),
        ("OFF\n3 1 0\n0 0 inf", "line 3: expected a finite number, found `inf`"),
        ("OFF\n3 1 0\n0 0 0\n\n1 x", "line 5: expected a vertex coordinate, found `x`"),
        (
            "OFF\n9000000000 1 0\n0 0 0\n",
            "line 3: the file ends too early: expected 9000000000 vertices, found 1",
        ),
        (
            "OFF\n1 2 0\n0 0 0\n3 0 0 0\n",
            "line 4: the file ends too early: expected 2 faces, found 1",
        ),
        ("OFF\n1 2 0\n0 0 0\n3 0", "line 4: the file ends too early: expected 2 faces, found 0"),
        (
            "OFF\n4 2 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n4 0 0 0\n3 0 0 0",
            "line 7: expected 4 corners, found fewer values in the line",
        ),
        ("OFF\n1 1 0\n0 0 0\n2 0 0", "line 4: a face needs at least 3 corners, found 2"),
        ("OFF\n1 1 0\n0 0 0\n3 0 0 1.5", "line 4: expected a vertex index, found `1.5`"),
        (
            "OFF\n1 1 0\n0 0 0\n3 0 0 1",
            "line 4: vertex index 1 is out of range: the file has 1 vertex, counted from 0",
        ),
        (
            "OFF\n1 1 0\n0 0 0\n3 0 0 -1",
            "line 4: vertex index -1 is out of range: the file has 1 vertex, counted from 0",
        ),
        (
            "OFF\n1 1 0\n0 0 0\n3 0 0 0\n3 0 0 0",
            "line 5: the header announces 1 vertex and 1 face, but the file goes on with `3`",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(fault(text), format!("a, {expected}"));
    }
    assert_eq!(fault(" \n"), "a: the file is empty");
    assert_eq!(fault("OFF 0 0 0"), "a: the file has no vertices");
    assert_eq!(fault("OFF 2 0 0\n0 0 0"), "a: the file has 2 vertices but no faces");
}
