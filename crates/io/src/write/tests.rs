use super::*;
use crate::{PolygonMesh, parse_mesh};

const POSITIONS: [[f64; 3]; 6] = [
    [0.0, 0.1, -1.0 / 3.0],
    [1.0, 0.0, 5e-324],
    [1.0, 1.0, f64::MAX],
    [0.0, 1e17, 0.0],
    [2.0, 0.0, -0.0],
    [2.0, 1.0, 1e-7],
];
const QUADS: [[u32; 4]; 2] = [[0, 1, 2, 3], [1, 4, 5, 2]];

fn mesh<'a>(positions: &'a [[f64; 3]], comments: &'a [String]) -> Polymesh<'a, 4> {
    Polymesh { positions, polygons: &QUADS, attributes: Attributes::NONE, comments }
}

#[test]
fn quads_read_back_exactly() {
    let comments = ["by hand\nf 1 1 1".to_owned()];
    for format in [Format::Obj, Format::Off, Format::Ply] {
        let mut bytes = Vec::new();
        mesh(&POSITIONS, &comments).write(&mut bytes, format).unwrap();
        let read = parse_mesh(&bytes, Some(format), "quads").unwrap();
        let bits =
            |points: &[[f64; 3]]| points.iter().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(&read.positions), bits(&POSITIONS));
        assert_eq!(read.polygons.len(), 2);
        assert_eq!(read.polygons.corners(), QUADS.as_flattened());
        assert!(read.notes.is_empty(), "{:?}", read.notes);
    }
}

#[test]
fn what_cannot_be_read_back_is_not_written() {
    let error = |positions: &[[f64; 3]], format| {
        let mut bytes = Vec::new();
        let error = mesh(positions, &[]).write(&mut bytes, format).unwrap_err();
        assert!(bytes.is_empty());
        error.to_string()
    };
    assert_eq!(error(&POSITIONS[..5], Format::Obj), "polygon 1 names a vertex that does not exist");
    let mut far = POSITIONS;
    far[3][0] = f64::NAN;
    assert_eq!(error(&far, Format::Ply), "the position of vertex 3 is not finite");
    assert_eq!(error(&POSITIONS, Format::Stl), "the position of vertex 2 is too large for STL");
}

#[test]
fn stl_has_the_triangles_of_the_quads() {
    let positions = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [4.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let polygons = [[0, 1, 2, 3], [3, 2, 1, 0]];
    let comments = ["by hand".to_owned()];
    let mut bytes = Vec::new();
    let mesh = Polymesh {
        positions: &positions,
        polygons: &polygons,
        attributes: Attributes::NONE,
        comments: &comments,
    };
    mesh.write(&mut bytes, Format::Stl).unwrap();
    assert_eq!(bytes.len(), 84 + 4 * 50);
    let read = parse_mesh(&bytes, Some(Format::Stl), "quads").unwrap();
    // The diagonal from 1 to 3 is the shorter one.
    let expected = [1, 2, 3, 1, 3, 0, 3, 2, 1, 3, 1, 0].map(|v| positions[v]);
    let corners = read.polygons.corners().iter().map(|&v| read.positions[v as usize]);
    assert_eq!(corners.collect::<Vec<_>>(), expected);
}

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
const FACES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// A map: triangles with UVs.
fn map_text(positions: &[[f64; 3]], uvs: &[[f64; 2]], rows: &[u32], comments: &[String]) -> String {
    let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Uv);
    let uv = Attribute::new("uv", domain, kind, 2, uvs.as_flattened().to_vec());
    let attributes = vec![uv.with_rows(rows.to_vec())].into();
    let map = Polymesh { positions, polygons: &FACES, attributes: &attributes, comments };
    let mut bytes = Vec::new();
    map.write(&mut bytes, Format::Obj).unwrap();
    String::from_utf8(bytes).unwrap()
}

#[test]
fn maps_are_triangles_with_uvs() {
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 1.5], [0.0, 0.0]];
    let comments = &["made by hand\nf 1 1 1".to_owned()];
    let expected = "# made by hand\n# f 1 1 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvt 1 1.5\nvt 0 0\nf 1/1 2/2 3/3\nf 1/1 3/4 4/5\n";
    assert_eq!(map_text(&SQUARE, &uvs, &[0, 1, 2, 0, 3, 4], comments), expected);
}

#[test]
fn maps_read_back_exactly() {
    let numbers =
        [0.1, -1.0 / 3.0, f64::MAX, f64::MIN_POSITIVE, 5e-324, 1e17, 123_456_789.123_456_78, -0.0];
    let positions: Vec<[f64; 3]> = numbers.iter().map(|&x| [x, -x, x / 7.0]).collect();
    let uvs: Vec<[f64; 2]> = (0..6).map(|i| [numbers[i], numbers[i + 2]]).collect();
    let text = map_text(&positions, &uvs, &[0, 1, 2, 3, 4, 5], &[]);
    let mesh = parse_mesh(text.as_bytes(), Some(Format::Obj), "map").unwrap();
    let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(mesh.positions.as_flattened()), bits(positions.as_flattened()));
    assert_eq!(mesh.polygons.corners(), FACES.as_flattened());
    assert_eq!(bits(&mesh.corner_uvs().unwrap().values), bits(uvs.as_flattened()));
}

/// Two squares with all that a mesh may carry.
fn carried() -> Attributes {
    use AttributeDomain::{Corner, Face, Vertex};
    let uv = [0.0, 0.0, 0.5, 0.0, 0.5, 1.0, 0.0, 1.0, 0.75, 0.25];
    let normals = vec![0.0, 0.0, 1.0, 0.0, 1.0, 0.0];
    let colors = (0..18).map(|k| f64::from(k) / 255.0).collect();
    let names = |names: &[&str]| names.iter().map(ToString::to_string).collect();
    let mut attributes = Attributes::from(vec![
        Attribute::new("uv", Corner, AttributeKind::Uv, 2, uv.to_vec())
            .with_rows(vec![0, 1, 2, 3, 4, 1, 2, 2]),
        Attribute::new("normal", Corner, AttributeKind::Normal, 3, normals)
            .with_rows(vec![0, 0, 0, 0, 1, 1, 1, 1]),
        Attribute::new("color", Vertex, AttributeKind::Color, 3, colors),
        Attribute::new(
            "heat",
            Vertex,
            AttributeKind::Number,
            1,
            vec![0.5, 1.5, 2.5, 3.5, 4.5, -1.0],
        ),
        Attribute::labels("material", Face, names(&["red paint", "blue"]), vec![1, 0]),
        Attribute::labels("object", Face, names(&["box"]), vec![0, 0]),
        Attribute::new("patch", Face, AttributeKind::Label, 1, vec![7.0, -2.0]),
    ]);
    attributes.material_files = vec!["paint.mtl".into()];
    attributes
}

const PLANE: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [2.0, 0.0, 0.0],
    [2.0, 1.0, 0.0],
];

fn written(format: Format) -> PolygonMesh {
    let (attributes, comments) = (carried(), []);
    let quads = Polymesh {
        positions: &PLANE,
        polygons: &QUADS,
        attributes: &attributes,
        comments: &comments,
    };
    let mut bytes = Vec::new();
    quads.write(&mut bytes, format).unwrap();
    let read = parse_mesh(&bytes, Some(format), "quads").unwrap();
    assert_eq!(read.notes, []);
    read
}

/// The values of an attribute at all of its elements.
fn values(mesh: &PolygonMesh, name: &str) -> Vec<f64> {
    let attribute = mesh.attributes.all.iter().find(|a| a.name == name).unwrap();
    attribute.rows.iter().flat_map(|&row| attribute.row(row)).copied().collect()
}

fn expected(name: &str) -> Vec<f64> {
    let mut mesh = PolygonMesh::new(Format::Obj);
    mesh.attributes = carried();
    values(&mesh, name)
}

fn names(mesh: &PolygonMesh, name: &str) -> Vec<String> {
    let labels = mesh.attributes.labels(name).unwrap();
    labels.rows.iter().map(|&row| labels.names[row as usize].clone()).collect()
}

#[test]
fn obj_holds_what_meshes_carry() {
    let read = written(Format::Obj);
    for name in ["uv", "normal", "color"] {
        assert_eq!(values(&read, name), expected(name), "{name}");
    }
    assert_eq!(names(&read, "material"), ["blue", "red paint"]);
    assert_eq!(names(&read, "object"), ["box", "box"]);
    assert_eq!(read.attributes.material_files, ["paint.mtl"]);
    assert_eq!(read.attributes.all.len(), 5);
}

#[test]
fn no_name_after_a_name_is_said_too() {
    let names = ["", "lid", "1", "0"].map(String::from).to_vec();
    let label = |name, rows| Attribute::labels(name, AttributeDomain::Face, names.clone(), rows);
    let attributes = vec![
        label("material", vec![1, 0]),
        label("group", vec![0, 1]),
        label("smoothing", vec![2, 3]),
    ];
    let attributes = attributes.into();
    let quads =
        Polymesh { positions: &PLANE, polygons: &QUADS, attributes: &attributes, comments: &[] };
    let mut bytes = Vec::new();
    quads.write(&mut bytes, Format::Obj).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let (_, faces) = text.split_once("usemtl").unwrap();
    assert_eq!(faces, " lid\ns 1\nf 1 2 3 4\ng lid\nusemtl (null)\ns off\nf 2 5 6 3\n");
}

#[test]
fn ply_holds_what_meshes_carry() {
    let read = written(Format::Ply);
    for name in ["uv", "color", "heat", "patch"] {
        assert_eq!(values(&read, name), expected(name), "{name}");
    }
    // The normals of two vertices are means of those of their corners.
    let mean = values(&read, "normal");
    assert_eq!(mean[..6], [0.0, 0.0, 1.0, 0.0, 0.5, 0.5]);
    // Names are told by their numbers.
    assert_eq!(values(&read, "material"), [1.0, 0.0]);
}

#[test]
fn glb_holds_what_meshes_carry() {
    let read = written(Format::Gltf);
    // Vertices are those of triangles: the corners of both.
    assert_eq!(read.polygons.len(), 4);
    // A primitive for each material, so that the second polygon, which has the first, comes first.
    let corners = [4, 5, 6, 4, 6, 7, 0, 1, 2, 0, 2, 3];
    let at = |values: &[f64], width: usize| -> Vec<f64> {
        corners.iter().flat_map(|&c| values[c * width..][..width].to_vec()).collect()
    };
    let positions: Vec<f64> =
        read.polygons.corners().iter().flat_map(|&v| read.positions[v as usize]).collect();
    let of_quads: Vec<f64> = QUADS.as_flattened().iter().flat_map(|&v| PLANE[v as usize]).collect();
    assert_eq!(positions, at(&of_quads, 3));
    assert_eq!(read.positions.len(), 6);
    assert_eq!(values(&read, "uv"), at(&expected("uv"), 2));
    assert_eq!(values(&read, "normal"), at(&expected("normal"), 3));
    let colors = expected("color");
    let of_corners: Vec<f64> =
        QUADS.as_flattened().iter().flat_map(|&v| colors[3 * v as usize..][..3].to_vec()).collect();
    let gap = values(&read, "color")
        .iter()
        .zip(at(&of_corners, 3))
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(gap < 1e-7, "{gap}");
    let heat = expected("heat");
    let heat: Vec<f64> = QUADS.as_flattened().iter().map(|&v| heat[v as usize]).collect();
    assert_eq!(values(&read, "_HEAT"), at(&heat, 1));
    assert_eq!(names(&read, "material"), ["red paint", "red paint", "blue", "blue"]);
    assert_eq!(names(&read, "object"), ["box"; 4]);
}

#[test]
fn attributes_that_do_not_fit_are_not_written() {
    let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Uv);
    let refused = |values: Vec<f64>| {
        let attributes = vec![Attribute::new("uv", domain, kind, 2, values)].into();
        let map = Polymesh {
            positions: &SQUARE,
            polygons: &FACES,
            attributes: &attributes,
            comments: &[],
        };
        map.write(&mut Vec::new(), Format::Obj).unwrap_err().to_string()
    };
    assert_eq!(refused(vec![0.0; 10]), "uv: values for 5 corners; the mesh has 6");
    let mut broken = vec![0.0; 12];
    broken[9] = f64::NAN;
    assert_eq!(refused(broken), "uv: value 9 is not finite");
}
