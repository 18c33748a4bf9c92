use super::*;

fn ascii(facets: &[&str]) -> String {
    let mut text = String::from("solid \"a facet\"\n");
    for facet in facets {
        text += "facet normal nan 0 1\n outer loop\n";
        for vertex in facet.split(", ") {
            text += &format!("  VERTEX {vertex}\n");
        }
        text += " endloop\nEndFacet\n";
    }
    text + "endsolid a\n"
}

fn binary(count: u32, facets: &[[f32; 9]]) -> Vec<u8> {
    let mut bytes = b"solid made by hand".to_vec();
    bytes.resize(HEADER - 4, b' ');
    bytes.extend_from_slice(&count.to_le_bytes());
    for facet in facets {
        bytes.extend_from_slice(&[0xff; 12]);
        bytes.extend(facet.iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend_from_slice(&[0; 2]);
    }
    bytes
}

fn fault(bytes: &[u8]) -> String {
    parse(bytes).unwrap_err().named("a").to_string()
}

const TWO: [[f32; 9]; 2] =
    [[0., 0., 0., 1., 0., 0., 0., 1., 0.], [1., 0., 0., 1., 1., 0., -0., 1., 0.]];

#[test]
fn ascii_and_binary_weld_in_order_of_appearance() {
    let text = ascii(&["0 0 0, 1 0 0, 0 1 0", "1 0 -0, 1 1 0, -0 1 0"]);
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    for bytes in
        [text.clone().into_bytes(), text.replace('\n', "\r\n").into_bytes(), binary(2, &TWO)]
    {
        let mesh = parse(&bytes).unwrap();
        assert_eq!(mesh.positions, expected);
        assert_eq!(mesh.polygons.corners(), [0, 1, 2, 1, 3, 2]);
        assert_eq!(mesh.notes, [Note::VerticesWelded { before: 6, after: 4 }]);
    }
}

#[test]
fn several_solids_and_degenerate_facets() {
    let mesh =
        parse((ascii(&["0 0 0, 1 0 0, 0 1 0"]) + &ascii(&["0 0 0, 0 0 0, 0 1 0"])).as_bytes())
            .unwrap();
    assert_eq!(mesh.polygons.corners(), [0, 1, 2, 0, 0, 2]);
    assert_eq!(mesh.notes[1], Note::DegenerateFacets { count: 1 });
}

#[test]
fn text_faults_name_their_line() {
    let good = ascii(&["0 0 0, 1 0 0, 0 1 0"]);
    let cases = [
        (good.replace("endloop", "vertex 0 0 0"), "line 7: expected `endloop`, found `vertex`"),
        (
            good.replace("1 0 0", "1 0"),
            "line 5: expected three coordinates after `vertex`, found the end of the line",
        ),
        (good.replace("1 0 0", "1 inf 0"), "line 5: expected a finite number, found `inf`"),
        (
            good.replace("1 0 0", "1,0 0 0"),
            "line 5: expected three coordinates after `vertex`, found `1,0` (write decimals with a point)",
        ),
        (
            good.replace("endsolid", "colour"),
            "line 9: expected `facet` or `endsolid`, found `colour`",
        ),
        (
            good.replace("endsolid a\n", ""),
            "line 8: the file ends too early: expected `facet` or `endsolid`",
        ),
        (
            good[..60].to_owned(),
            "line 4: the file ends too early: expected three coordinates after `vertex`",
        ),
        (good + "more", "line 10: expected `solid`, found `more`"),
        ("hello".to_owned(), "line 1: expected `solid`, found `hello`"),
    ];
    for (text, expected) in cases {
        assert_eq!(fault(text.as_bytes()), format!("a, {expected}"), "{text}");
    }
    assert_eq!(fault(ascii(&[]).as_bytes()), "a: the file has no vertices");
}

#[test]
fn binary_faults_name_their_byte() {
    assert_eq!(
        fault(&binary(4_000_000_000, &TWO)),
        "a, byte 184: the file ends too early: expected 4000000000 facets, found 2"
    );
    assert_eq!(
        fault(&binary(2, &TWO)[..183]),
        "a, byte 183: the file ends too early: expected 2 facets, found 1"
    );
    assert_eq!(
        fault(&[0; 20]),
        "a, byte 20: the file ends too early: expected a header of 84 bytes"
    );
    let mut broken = TWO;
    broken[1][4] = f32::NAN;
    assert_eq!(fault(&binary(2, &broken)), "a, byte 162: expected a finite number, found NaN");
    assert_eq!(
        fault(&binary(1, &TWO)),
        "a, byte 134: the header announces 1 facets, but the file goes on with 1 more"
    );
    let mut longer = binary(2, &TWO);
    longer.extend_from_slice(b"mark");
    assert_eq!(parse(&longer).unwrap().notes[1], Note::TrailingBytes { count: 4 });
}
