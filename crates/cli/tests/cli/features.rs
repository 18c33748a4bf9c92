//! Features from every source, what is wrong with them, and the certificate of alignment.

use crate::harness::{Folder, obj};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_testkit as testkit;
use serde_json::Value;
use std::fmt::Write as _;

/// The features that `check` finds.
#[track_caller]
fn features(folder: &Folder, arguments: &[&str]) -> Value {
    let run = folder.expect(0, &[&["check"], arguments, &["--json"]].concat());
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    value["features"].clone()
}

/// Expects `check` to refuse features of `in.obj` with these words.
#[track_caller]
fn refuse(folder: &Folder, source: &str, message: &str) {
    let run = folder.expect(1, &["check", "in.obj", "--features", source]);
    assert!(run.stderr.starts_with("error: "), "{run:?}");
    assert!(run.stderr.contains(message), "{message} in {}", run.stderr);
    assert_eq!(run.stdout, "");
}

#[test]
fn the_creases_of_a_bracket_by_their_angle() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::l_bracket());
    let run = folder.expect(0, &["check", "in.obj", "--features", "angle:40"]);
    // Two L of twelve edges, and six creases of two between them.
    assert!(
        run.stdout.contains("features     36 edges: 18 curves, 0 loops, 12 junctions\n"),
        "{}",
        run.stdout
    );
    assert!(run.stdout.contains("from angle:40 36 edges\n"), "{}", run.stdout);
    let found = features(&folder, &["in.obj", "--features", "angle:40"]);
    assert_eq!((&found["edges"], &found["length"]), (&36.into(), &36.0.into()));
    assert_eq!(found["nodes"].as_array().unwrap().len(), 12);
    assert_eq!(found["nodes"][0]["kind"], "junction");
    assert_eq!(features(&folder, &["in.obj", "--features", "angle:100"])["edges"], 0);
}

#[test]
fn sources_add_up() {
    let folder = Folder::new();
    let mut text = obj(&testkit::disk_grid(4, 4));
    // A polyline of two edges, and one of them again.
    text += "l 11 12 13\nl 13 12\n";
    folder.write("in.obj", text);
    folder.write("pairs.txt", "# one known, one new\n11 12\n12 17\n");
    // Side 1 of face 2 runs from vertex 2 to vertex 7.
    folder.write("in.sharp", "1\n1,2,1\n");
    let lines = ["in.obj", "--features", "lines"];
    assert_eq!(features(&folder, &lines)["edges"], 2);
    let arguments = [
        &lines[..],
        &["--features", "pairs:pairs.txt", "--features", "sharp:in.sharp", "--align-boundary"],
    ];
    let found = features(&folder, &arguments.concat());
    let of = |source: &str| {
        let sources = found["sources"].as_array().unwrap();
        sources.iter().find(|s| s["source"] == source).unwrap()["edges"].clone()
    };
    assert_eq!([of("lines"), of("pairs:pairs.txt"), of("sharp:in.sharp")], [2, 2, 1]);
    assert_eq!((&found["edges"], &found["boundary_edges"]), (&20.into(), &16.into()));
    // The lines start on the boundary and turn in the middle; the third edge leaves the boundary.
    let expected = [("junctions", 2), ("turns", 5), ("open_ends", 2), ("boundary_ends", 0)];
    for (kind, count) in expected {
        assert_eq!(found[kind], count, "{kind}: {found:#}");
    }
    // Vertices that a curve passes: those of a chain in order.
    let curves = found["curves"].as_array().unwrap();
    assert!(curves.iter().any(|curve| curve["vertices"] == serde_json::json!([12, 17])));
}

#[test]
fn borders_of_what_the_file_says_of_its_faces() {
    let folder = Folder::new();
    // A strip of three squares; faces are split into triangles, whose diagonals are no borders.
    let points: String = (0..4).map(|x| format!("v {x} 0 0\nv {x} 1 0\n")).collect();
    let faces = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\ng a\ns 1\nf 1/1 3/2 4/3 2/4\nusemtl b\n\
                 f 3/2 5/1 6/4 4/3\ng b\ns 2\nf 5/2 7/1 8/4 6/3\n";
    folder.write("in.obj", points + faces);
    let ends = |source: &str| {
        let found = features(&folder, &["in.obj", "--features", source]);
        found["curves"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c["vertices"].clone())
            .collect::<Vec<_>>()
    };
    let [first, second] = [serde_json::json!([2, 3]), serde_json::json!([4, 5])];
    assert_eq!(ends("material"), [first]);
    for source in ["group", "smoothing", "uv-seams"] {
        assert_eq!(ends(source), std::slice::from_ref(&second), "{source}");
    }
    folder.write_obj("in.obj", &testkit::cube());
    refuse(&folder, "material", "need a mesh with materials");
    refuse(&folder, "uv-seams", "need a mesh with a texture coordinate at every corner");
}

#[test]
fn quads_follow_creases_and_rims_unless_told_otherwise() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::l_bracket());
    let aligned = |more: &[&str]| {
        let quad = ["quad", "in.obj", "--quads", "136", "-o", "q.obj", "--json"];
        let run = folder.expect(0, &[&quad, more].concat());
        let report: Value = serde_json::from_str(&run.stdout).unwrap();
        report["features"]["kept"].as_u64()
    };
    assert_eq!(aligned(&[]), Some(36));
    assert_eq!(aligned(&["--features", "none"]), None);
    assert_eq!(aligned(&["--features", "edges:0-1"]), Some(1));
    assert_eq!(aligned(&["--features", "edges:0-1", "--features", "auto"]), Some(36));
    folder.expect(0, &["map", "in.obj", "-o", "m.obj"]);
    let found = features(&folder, &["in.obj", "m.obj"]);
    assert_eq!(found, Value::Null);
}

#[test]
fn faces_of_a_sharp_file_are_those_of_the_file() {
    let folder = Folder::new();
    // A quad and a triangle: after the split the triangle is face 2.
    let points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 1 0\n";
    folder.write("in.obj", format!("{points}f 1 2 3 4\nf 2 5 3\nl 1 2\n"));
    folder.write("in.sharp", "2\n1,1,2\n0,0,3\n");
    let found = features(&folder, &["in.obj", "--features", "sharp:in.sharp"]);
    let ends: Vec<_> =
        found["curves"].as_array().unwrap().iter().map(|c| c["vertices"].clone()).collect();
    assert_eq!(ends, [serde_json::json!([0, 3]), serde_json::json!([1, 2])]);
    // A side of a polygon is an edge; a diagonal that is no edge after the split is not.
    assert_eq!(features(&folder, &["in.obj", "--features", "lines"])["edges"], 1);
    folder.write("in.obj", format!("{points}f 1 2 3 4\nf 2 5 3\nl 2 4\n"));
    refuse(&folder, "lines", "an `l` element: no edge joins the vertices 1 and 3");
    refuse(&folder, "sharp:missing.sharp", "missing.sharp: cannot be read");
    folder.write("in.sharp", "1\n1,0,4\n");
    refuse(
        &folder,
        "sharp:in.sharp",
        "in.sharp: not edges of in.obj:\n  line 2: face 0 has no side 4: it has 4",
    );
    folder.write("in.sharp", "2\n1,0,0\n0,2,0\n");
    refuse(&folder, "sharp:in.sharp", "line 3: face 2 does not exist: there are 2");
}

#[test]
fn what_is_no_edge_is_named_by_its_line() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::cube());
    refuse(&folder, "lines", "need an OBJ file with `l` elements");
    folder.write("p.txt", "0 1\n\n0 99\n4 4\n");
    refuse(&folder, "pairs:p.txt", "p.txt: not edges of in.obj:\n");
    refuse(
        &folder,
        "pairs:p.txt",
        "line 3: vertex 99 of the pair 0-99 does not exist: there are 8",
    );
    refuse(&folder, "pairs:p.txt", "line 4: no edge joins the vertices 4 and 4");
    folder.write("p.txt", "0 1 2\n");
    refuse(&folder, "pairs:p.txt", "p.txt, line 1: expected two vertices, counted from 0");
    folder.write("p.txt", "7 7\n".repeat(8));
    refuse(&folder, "pairs:p.txt", "and 3 more");
    folder.write("s.sharp", "3\n1,0,0\n");
    refuse(&folder, "sharp:s.sharp", "expected 3 sharp edges, found 1");
}

#[test]
fn features_keep_their_names_through_repairs() {
    let folder = Folder::new();
    let mut soup = testkit::disk_grid(2, 2);
    // An unused vertex comes first, and a copy of face 0.
    soup.positions.insert(0, [5.0; 3]);
    soup.faces.iter_mut().flatten().for_each(|v| *v += 1);
    soup.faces.insert(1, soup.faces[0]);
    folder.write_obj("in.obj", &soup);
    folder.write("p.txt", "1 2\n");
    folder.write("s.sharp", "1\n1,1,0\n");
    for source in ["pairs:p.txt", "sharp:s.sharp"] {
        let found = features(&folder, &["in.obj", "--repair", "--features", source]);
        assert_eq!(found["edges"], 1);
        assert_eq!(found["curves"][0]["vertices"], serde_json::json!([0, 1]));
    }
    folder.write("p.txt", "0 1\n");
    let run = folder.expect(1, &["check", "in.obj", "--repair", "--features", "pairs:p.txt"]);
    assert!(run.stderr.contains("line 1: no edge joins the vertices 0 and 1"), "{run:?}");
}

#[test]
fn wrong_options_are_2() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::cube());
    folder.write("p.txt", "0 1\n");
    let wrong: [&[&str]; 7] = [
        &["--features", "angle:0"],
        &["--features", "creases"],
        &["--features"],
        &["--alignment-tolerance", "1"],
        &["in.obj", "--picture", "a.png"],
        &["--picture", "in.obj"],
        &["--features", "pairs:p.txt", "--picture", "./p.txt"],
    ];
    for arguments in wrong {
        folder.expect(2, &[&["check", "in.obj"], arguments].concat());
    }
    assert_eq!(folder.names(), ["in.obj", "p.txt"]);
    assert_eq!(folder.read("p.txt"), "0 1\n");
}

#[test]
fn a_picture_shows_the_features() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::cube());
    folder.expect(0, &["check", "in.obj", "--picture", "plain.png"]);
    folder.expect(0, &["check", "in.obj", "--picture", "sharp.png", "--features", "angle:40"]);
    let [plain, sharp] =
        ["plain.png", "sharp.png"].map(|name| std::fs::read(folder.path(name)).unwrap());
    assert!(plain.starts_with(b"\x89PNG") && sharp.starts_with(b"\x89PNG"));
    assert_ne!(plain, sharp);
}

#[test]
fn a_faulty_mesh_has_no_features() {
    let folder = Folder::new();
    let mut soup = testkit::cube();
    soup.faces.push(soup.faces[0]);
    folder.write_obj("in.obj", &soup);
    let arguments = ["check", "in.obj", "--align-boundary", "--picture", "a.png"];
    let run = folder.expect(1, &arguments);
    assert!(run.stdout.contains("is a copy of") && !run.stdout.contains("features"), "{run:?}");
    assert_eq!(folder.names(), ["in.obj"]);
}

/// The planar map of a flat soup, turned by some degrees, with `digits` digits.
fn turned_map(soup: &TriangleSoup, degrees: f64, digits: usize) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let mut text = String::new();
    for [x, y, z] in &soup.positions {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for [x, y, _] in &soup.positions {
        let (u, v) = (cos * x - sin * y, sin * x + cos * y);
        writeln!(text, "vt {u:.digits$} {v:.digits$}").unwrap();
    }
    for face in &soup.faces {
        let [a, b, c] = face.map(|v| v + 1);
        writeln!(text, "f {a}/{a} {b}/{b} {c}/{c}").unwrap();
    }
    text
}

#[test]
fn alignment_is_certified() {
    let folder = Folder::new();
    let soup = testkit::disk_grid(4, 4);
    folder.write_obj("in.obj", &soup);
    folder.write("straight.obj", turned_map(&soup, 0.0, 17));
    folder.write("p.txt", "10 11\n11 12\n");
    let arguments =
        ["check", "in.obj", "straight.obj", "--features", "pairs:p.txt", "--align-boundary"];
    let run = folder.expect(0, &arguments);
    let passed =
        "alignment    passed: 18 edges within 0.0e0 degrees of an axis (20 of 20 sides exact)";
    assert!(run.stdout.contains(passed), "{}", run.stdout);
    let run = folder.expect(0, &[&arguments[..], &["--json"]].concat());
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["map"]["aligned"], true);
    assert_eq!(value["map"]["alignment"]["axis_error"], 0.0);
    // Four corners and two sectors where the path meets the boundary.
    assert_eq!(value["map"]["alignment"]["sectors_by_quarters"]["1"], 6);
    assert_eq!(value["features"]["edges"], 18);
}

#[test]
fn what_is_not_aligned_is_named() {
    let folder = Folder::new();
    let soup = testkit::disk_grid(4, 4);
    folder.write_obj("in.obj", &soup);
    folder.write("turned.obj", turned_map(&soup, 1e-4, 17));
    let arguments = ["check", "in.obj", "turned.obj"];
    folder.expect(0, &arguments);
    let aligned = [&arguments[..], &["--align-boundary"]].concat();
    let run = folder.expect(1, &aligned);
    assert!(run.stdout.contains("certificate  passed"), "{}", run.stdout);
    assert!(run.stdout.contains("violation    edge 0-1 is"), "{}", run.stdout);
    assert!(run.stdout.contains("degrees off the axes in face 0"), "{}", run.stdout);
    assert!(run.stdout.contains("need `--alignment-tolerance`"), "{}", run.stdout);
    assert!(run.stdout.contains("alignment    failed: 16 violations"), "{}", run.stdout);
    let run = folder.expect(1, &[&aligned[..], &["--json"]].concat());
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(
        (&value["map"]["certified"], &value["map"]["aligned"]),
        (&true.into(), &false.into())
    );
    let violations = value["map"]["alignment"]["violations"].as_array().unwrap();
    assert_eq!((violations.len(), &violations[0]["kind"]), (16, &"off-axis".into()));
    folder.expect(0, &[&aligned[..], &["--alignment-tolerance", "1e-3"]].concat());
    // The diagonals are edges as well, and no axis runs along one.
    folder.write("p.txt", "6 12\n");
    let run = folder.expect(1, &[&arguments[..], &["--features", "pairs:p.txt"]].concat());
    assert!(run.stdout.contains("edge 12-6 is 4.4"), "{}", run.stdout);
    assert!(!run.stdout.contains("--alignment-tolerance"), "{}", run.stdout);
}

#[test]
fn a_map_has_its_features_on_its_axes() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::l_bracket());
    let aligned = ["--features", "angle:40"];
    let arguments = ["map", "in.obj", "-o", "map.obj", "--report", "r.json", "--features-strict"];
    let run = folder.expect(0, &[&arguments[..], &aligned].concat());
    assert!(run.stdout.contains("features     36 edges: 18 curves"), "{}", run.stdout);
    assert!(run.stdout.contains("alignment    passed: 36 edges within"), "{}", run.stdout);
    assert!(!run.stdout.contains("dropped"), "{}", run.stdout);
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    assert_eq!(report["options"]["features"], serde_json::json!(["angle:40"]));
    let found = &report["features"];
    assert_eq!((&found["edges"], &found["kept"]), (&36.into(), &36.into()));
    assert_eq!(
        (&found["dropped"], &found["alignment"]["sides"]),
        (&serde_json::json!([]), &72.into())
    );
    folder.expect(0, &[&["check", "in.obj", "map.obj"][..], &aligned].concat());
    // Without features there is nothing about them.
    let run = folder.expect(0, &["map", "in.obj", "-o", "map.obj", "--json"]);
    assert!(!run.stdout.contains("\"alignment\""), "{}", run.stdout);
}

#[test]
fn released_features_are_listed_drawn_and_refused_when_strict() {
    let folder = Folder::new();
    // All three sides of a triangle cannot be aligned.
    folder.write_obj("in.obj", &testkit::disk_grid(4, 4));
    folder.write("p.txt", "6 7\n7 12\n12 6\n");
    let map = ["map", "in.obj", "-o", "map.obj", "--features", "pairs:p.txt"];
    let strict = folder.expect(3, &[&map[..], &["--features-strict"]].concat());
    assert!(strict.stderr.contains("third feature edge of a triangle"), "{strict:?}");
    assert_eq!(folder.names(), ["in.obj", "p.txt"]);
    let run = folder.expect(0, &[&map[..], &["--report", "r.json", "--pictures", "new"]].concat());
    assert!(run.stdout.contains("dropped      "), "{}", run.stdout);
    assert!(run.stdout.contains(": third feature edge of a triangle"), "{}", run.stdout);
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    let released = report["features"]["dropped"].as_array().unwrap();
    assert_eq!(released[0]["reason"], "three-in-triangle");
    assert_eq!(report["features"]["kept"], 3 - released.len());
    // What is kept is aligned, what is released is named.
    let ends = |edge: &Value| [&edge["vertices"][0], &edge["vertices"][1]].map(Value::to_string);
    let gone: Vec<_> = released.iter().map(ends).collect();
    let kept: Vec<_> = [["6", "7"], ["7", "12"], ["12", "6"]]
        .into_iter()
        .filter(|[a, b]| !gone.iter().any(|g| g == &[*a, *b] || g == &[*b, *a]))
        .map(|pair| pair.join(" "))
        .collect();
    assert_eq!(kept.len(), 3 - gone.len());
    folder.write("kept.txt", kept.join("\n"));
    folder.expect(0, &["check", "in.obj", "map.obj", "--features", "pairs:kept.txt"]);
    folder.expect(1, &["check", "in.obj", "map.obj", "--features", "pairs:p.txt"]);
}

#[test]
fn maps_refuse_what_checks_refuse() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::cube());
    folder.write("p.txt", "0 99\n");
    let run = folder.expect(1, &["map", "in.obj", "-o", "map.obj", "--features", "pairs:p.txt"]);
    assert!(run.stderr.contains("line 1: vertex 99 of the pair 0-99 does not exist"), "{run:?}");
    for arguments in [&["p.txt"][..], &["map.obj", "--report", "p.txt"]] {
        let map = ["map", "in.obj", "--features", "pairs:p.txt", "-o"];
        folder.expect(2, &[&map[..], arguments].concat());
    }
    assert_eq!(folder.names(), ["in.obj", "p.txt"]);
}

#[test]
fn meshes_of_the_collection_have_their_features_aligned() {
    // Most features dropped, and the largest tau: that of the scarf, of 68 triangles, lies between 2.4 and 5.1 when its
    // vertices are moved by a millionth.
    for (name, released, tau) in
        [("flap", 0, 1.40), ("chipped_torus", 0, 1.38), ("halved_scarf", 19, 5.2)]
    {
        let Some(mesh) = testkit::in_collection(&format!("{name}.obj")) else { continue };
        let mesh = mesh.to_str().unwrap();
        let folder = Folder::new();
        let aligned = ["--features", "angle:40", "--align-boundary"];
        let map = |file: &str, threads: &str| {
            let arguments = ["map", mesh, "-o", file, "--json", "--threads", threads];
            let run = folder.expect(0, &[&arguments[..], &aligned].concat());
            serde_json::from_str::<Value>(&run.stdout).unwrap()
        };
        let report = map("one.obj", "1");
        map("two.obj", "2");
        assert_eq!(folder.read("one.obj"), folder.read("two.obj"));
        let features = &report["features"];
        let gone = features["dropped"].as_array().unwrap().len();
        assert!(gone <= released, "{name}: {gone} released");
        assert_eq!(features["kept"].as_u64(), features["edges"].as_u64().map(|n| n - gone as u64));
        assert!(features["alignment"]["axis_error"].as_f64().unwrap() < 1e-9);
        let found = report["distortion"]["tau"].as_f64().unwrap();
        assert!(found < tau, "{name}: tau {found}");
    }
}

#[test]
fn the_sharp_file_of_the_collection() {
    let [Some(mesh), Some(sharp)] =
        ["bracket_inches_rem.obj", "bracket_inches_rem.sharp"].map(testkit::in_collection)
    else {
        return;
    };
    let [mesh, sharp] = [mesh, sharp].map(|path| path.to_str().unwrap().to_owned());
    let sharp = format!("sharp:{sharp}");
    let folder = Folder::new();
    let named = features(&folder, &[&mesh, "--features", &sharp]);
    assert_eq!((&named["edges"], &named["loops"]), (&1166.into(), &13.into()));
    // All but a few of them bend by 40 degrees and more: sides are counted as the file means it.
    let both = features(&folder, &[&mesh, "--features", &sharp, "--features", "angle:40"]);
    assert_eq!((&both["sources"][1]["edges"], &both["edges"]), (&1145.into(), &1175.into()));
}

#[test]
fn layouts_keep_features_on_the_axes() {
    let folder = Folder::new();
    folder
        .write_obj("in.obj", &testkit::bumpy(&testkit::subdivide(&testkit::l_bracket()), 0.03, 3));
    let aligned = ["--features", "angle:40"];
    folder.expect(0, &[&["map", "in.obj", "-o", "map.obj", "-q"][..], &aligned].concat());
    for objective in ["arap", "asap", "tau"] {
        let arguments = ["layout", "in.obj", "map.obj", "--objective", objective, "-o", "new.obj"];
        let strict = [&arguments[..], &aligned, &["--features-strict", "--json"]].concat();
        let value: Value = serde_json::from_str(&folder.expect(0, &strict).stdout).unwrap();
        assert_eq!(value["features"]["kept"], 72);
        let check = [&["check", "in.obj", "new.obj"][..], &aligned].concat();
        let run = folder.expect(0, &check);
        assert!(run.stdout.contains("alignment    passed: 72 edges"), "{}", run.stdout);
    }
    // Without being told of them, a layout leaves them.
    let arguments = ["layout", "in.obj", "map.obj", "--objective", "arap", "-o", "free.obj"];
    folder.expect(0, &arguments);
    folder.expect(1, &[&["check", "in.obj", "free.obj"][..], &aligned].concat());
    // What the map does not follow is named, or refused.
    let from_free = ["layout", "in.obj", "free.obj", "--objective", "arap", "-o", "new.obj"];
    let run = folder.expect(0, &[&from_free[..], &aligned].concat());
    assert!(run.stdout.contains("the map given does not follow it"), "{}", run.stdout);
    folder.expect(3, &[&from_free[..], &aligned, &["--features-strict"]].concat());
    let disk = ["layout", "in.obj", "--objective", "arap", "-o", "new.obj"];
    let run = folder.expect(2, &[&disk[..], &aligned].concat());
    assert!(run.stderr.contains("features need a map that follows them"), "{}", run.stderr);
}
