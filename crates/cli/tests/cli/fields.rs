//! Fields and cones, from maps to files and back to maps.

use crate::harness::{Folder, lines_of};
use seamstress_testkit as testkit;
use serde_json::Value;

/// A sphere of 320 faces and its map, with field, cones and matchings in files.
fn folder_with_field() -> Folder {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::bumpy(&testkit::icosphere(2), 0.1, 7));
    folder.expect(0, &["map", "in.obj", "-o", "map.obj", "--sing", "map.sing"]);
    let outputs = ["-o", "f.rawfield", "--sing", "f.sing", "--matching", "f.matching"];
    let run = folder.expect(0, &[&["field", "in.obj", "map.obj"], &outputs[..]].concat());
    assert!(run.stdout.contains("indices around handles: none"), "{}", run.stdout);
    folder
}

#[test]
fn a_field_leads_back_to_the_cones_it_came_from() {
    let folder = folder_with_field();
    let cones = folder.read("map.sing");
    assert_eq!(folder.read("f.sing"), cones);
    folder.expect(0, &["field", "in.obj", "map.obj", "-o", "f.rosy"]);
    for start in [
        &["--field", "f.rawfield"][..],
        &["--field", "f.rosy"],
        &["--field", "f.rawfield", "--matching", "f.matching"],
        &["--matching", "f.matching"],
        &["--cones", "f.sing"],
    ] {
        let arguments = [&["map", "in.obj", "-o", "again.obj", "--sing", "again.sing"], start];
        let run = folder.expect(0, &arguments.concat());
        assert!(run.stdout.contains("certificate  passed"), "{start:?}: {}", run.stdout);
        assert_eq!(folder.read("again.sing"), cones, "{start:?}");
        folder.expect(0, &["check", "in.obj", "again.obj"]);
    }
}

#[test]
fn some_cones_may_be_given_and_the_rest_left_free() {
    let folder = folder_with_field();
    folder.write("some.sing", "4 2\n0 1\n1 0\n");
    let report = ["--report", "r.json", "--sing", "out.sing"];
    let start = ["map", "in.obj", "-o", "a.obj", "--cones", "some.sing", "--free-cones"];
    folder.expect(0, &[&start[..], &report].concat());
    let out = folder.read("out.sing");
    assert!(out.lines().any(|line| line == "0 1"), "{out}");
    assert!(!out.lines().skip(1).any(|line| line.starts_with("1 ")), "{out}");
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    assert_eq!(report["lab"]["start"]["free_cones"], true);
    let refused = folder.expect(1, &start[..6]);
    assert!(
        refused.stderr.contains("have indices that sum to 1; they must sum to 8"),
        "{refused:?}"
    );
}

#[test]
fn what_does_not_fit_the_mesh_is_named() {
    let folder = folder_with_field();
    folder.write_obj("cube.obj", &testkit::cube());
    let refused = |start: &[&str]| {
        let run = folder.expect(1, &[&["map", "cube.obj", "-o", "no.obj"], start].concat());
        assert!(!folder.names().contains(&"no.obj".to_owned()));
        run.stderr
    };
    let field = refused(&["--field", "f.rawfield"]);
    assert!(
        field.contains("f.rawfield, line 1: the file is for 320 faces, and the mesh has 12"),
        "{field}"
    );
    assert!(refused(&["--matching", "f.matching"]).contains("line 1: the file is for 320 faces"));
    assert!(
        refused(&["--cones", "f.sing"]).contains("f.sing, line "),
        "{}",
        refused(&["--cones", "f.sing"])
    );
    folder.write("four.sing", "4 1\n3 4\n");
    assert!(
        refused(&["--cones", "four.sing"])
            .contains("index 4 at vertex 3 would have no positive angle")
    );
    folder.write("wide.sing", "4 1\n3 -30\n");
    assert!(refused(&["--cones", "wide.sing"]).contains("would need 34 quarter turns"));
    folder.write("angles", "1\n".repeat(8));
    assert!(refused(&["--cones", "angles"]).contains("is not a multiple of a quarter turn"));
    let zero = "4 12\n".to_owned() + &"1 0 0 0 1 0 -1 0 0 0 -1 0\n".repeat(11) + &"0 ".repeat(12);
    folder.write("zero.rawfield", zero);
    let field = refused(&["--field", "zero.rawfield"]);
    assert!(field.contains("no direction in the plane of face"), "{field}");
    let usage = ["map", "cube.obj", "-o", "no.obj", "--cones", "angles", "--free-cones"];
    assert!(folder.expect(2, &usage).stderr.contains("needs a .sing file"));
    folder.expect(2, &["map", "cube.obj", "-o", "no.obj", "--exact"]);
    folder.expect(2, &["map", "cube.obj", "-o", "no.obj", "--field", "f", "--cones", "c"]);
    let other = folder.expect(1, &["field", "cube.obj", "map.obj", "-o", "no.rawfield"]);
    assert!(other.stderr.contains("the map has 162 vertices, the source 8"), "{other:?}");
}

#[test]
fn the_classical_way_is_certified_or_needs_leave_to_flip() {
    let folder = Folder::new();
    folder.write_obj("cube.obj", &testkit::cube());
    let run = folder.expect(0, &["map", "cube.obj", "-o", "cube.map.obj", "--method", "field"]);
    assert!(run.stdout.contains("certificate  passed"));
    folder.write_obj("in.obj", &testkit::crown(40));
    let classical = ["map", "in.obj", "-o", "map.obj", "--method", "field"];
    let refused = folder.expect(3, &classical);
    assert!(refused.stderr.contains("flipped"), "{refused:?}");
    assert!(refused.stderr.contains("`--exact`"), "{refused:?}");
    assert!(!folder.names().contains(&"map.obj".to_owned()));
    let flags = ["--allow-flips", "--report", "r.json"];
    let run = folder.expect(0, &[&classical[..], &flags].concat());
    assert!(run.stdout.contains("certificate  none: "), "{}", run.stdout);
    assert!(folder.read("map.obj").starts_with("# Uncertified layout"));
    assert_eq!(lines_of(&folder.read("map.obj"), "f").len(), 80);
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    assert!(report["certificate"].is_null());
    assert!(!report["violations"].as_array().unwrap().is_empty());
    folder.expect(1, &["check", "in.obj", "map.obj"]);
    folder.expect(0, &[&classical[..], &["--exact"]].concat());
    folder.expect(0, &["check", "in.obj", "map.obj"]);
}

/// Fields and angles made by other programs, in the optional collection of meshes.
#[test]
fn foreign_fields_and_angles_are_followed() {
    let folder = Folder::new();
    for (mesh, flag, file, cones) in [
        ("aircraft.obj", "--cones", "aircraft_Th_hat", 41),
        ("lilium.obj", "--field", "lilium.rawfield", 15),
        ("bracket_inches_rem.obj", "--field", "bracket_inches_rem.rosy", 52),
    ] {
        let [Some(mesh), Some(file)] = [mesh, file].map(testkit::in_collection) else { continue };
        let [mesh, file] = [mesh, file].map(|path| path.to_str().unwrap().to_owned());
        let run = folder.expect(0, &["map", &mesh, "-o", "map.obj", flag, &file, "--json"]);
        let report: Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(report["cones"]["count"], cones, "{file}");
        if flag == "--cones" {
            let angles: Vec<f64> = std::fs::read_to_string(&file)
                .unwrap()
                .lines()
                .map(|line| line.trim().parse().unwrap())
                .collect();
            for cone in report["cones"]["list"].as_array().unwrap() {
                let vertex = cone["vertex"].as_u64().unwrap() as usize;
                let quarters = 4.0 - cone["index"].as_f64().unwrap();
                let asked = angles[vertex] / std::f64::consts::FRAC_PI_2;
                assert!(
                    (quarters - asked).abs() < 1e-6,
                    "vertex {vertex}: {quarters}, {asked} asked"
                );
            }
        }
        folder.expect(0, &["check", &mesh, "map.obj"]);
    }
}

/// The quads of a box of 2 x 1 x 1, bent in the middle.
const BOX: &str = "\
v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0
v 0 0 1\nv 1 0 1.3\nv 2 0 1\nv 0 1 1\nv 1 1 0.8\nv 2 1 1
f 1 4 5 2\nf 2 5 6 3\nf 7 8 11 10\nf 8 9 12 11
f 1 2 8 7\nf 2 3 9 8\nf 4 10 11 5\nf 5 11 12 6
f 1 7 10 4\nf 3 6 12 9\n";

#[test]
fn a_quad_mesh_has_a_field_whose_cones_are_its_irregular_vertices() {
    let folder = Folder::new();
    folder.write("box.obj", BOX);
    let outputs = ["-o", "f.rawfield", "--sing", "f.sing", "--matching", "f.matching"];
    folder.expect(0, &[&["field", "box.obj"], &outputs[..]].concat());
    // The eight corners have three quads; the four vertices in the middle are regular.
    let sing = folder.read("f.sing");
    assert_eq!(sing, "4 8\n0 1\n2 1\n3 1\n5 1\n6 1\n8 1\n9 1\n11 1\n");
    let field = folder.read("f.rawfield");
    assert!(field.starts_with("4 20\n"), "{field}");
    for start in [&["--field", "f.rawfield"][..], &["--matching", "f.matching"]] {
        let arguments = [&["map", "box.obj", "-o", "map.obj", "--sing", "again.sing"], start];
        folder.expect(0, &arguments.concat());
        assert_eq!(folder.read("again.sing"), sing, "{start:?}");
    }
}

#[test]
fn the_field_of_a_quad_mesh_is_that_of_its_layout() {
    let folder = Folder::new();
    folder.write("box.obj", BOX);
    folder.expect(0, &["layout-quads", "box.obj", "-o", "squares.obj"]);
    folder.expect(
        0,
        &["field", "squares.obj", "squares.obj", "-o", "a.rawfield", "--sing", "a.sing"],
    );
    folder.expect(0, &["field", "box.obj", "-o", "b.rawfield", "--sing", "b.sing"]);
    assert_eq!(folder.read("a.sing"), folder.read("b.sing"));
}

#[test]
fn a_mesh_of_triangles_without_a_map_has_no_field_to_read_off() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::cube());
    let run = folder.expect(1, &["field", "in.obj", "-o", "f.rawfield"]);
    assert!(run.stderr.contains("not a quad mesh"), "{}", run.stderr);
    assert!(!folder.names().contains(&"f.rawfield".to_owned()));
}

/// A torus of 4 by 3 quads, each with its corners counter-clockwise from the outside.
fn torus_of_quads() -> String {
    let (n, m) = (4, 3);
    let mut text = String::new();
    for i in 0..n {
        for j in 0..m {
            let [a, b] =
                [(i, n), (j, m)].map(|(i, n)| f64::from(i) / f64::from(n) * std::f64::consts::TAU);
            let r = 2.0 + b.cos();
            text += &format!("v {} {} {}\n", r * a.cos(), r * a.sin(), b.sin());
        }
    }
    let at = |i: i32, j: i32| (i % n) * m + j % m + 1;
    for i in 0..n {
        for j in 0..m {
            let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            text += &format!("f {} {} {} {}\n", corners[0], corners[1], corners[2], corners[3]);
        }
    }
    text
}

/// Every regular grid of quads on a torus is a parallel field: each loop closes without a turn.
#[test]
fn loops_of_a_parallel_field_are_listed_and_have_index_zero() {
    let folder = Folder::new();
    folder.write("torus.obj", torus_of_quads());
    let run = folder.expect(
        0,
        &["field", "torus.obj", "-o", "f.rawfield", "--matching", "f.matching", "--json"],
    );
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let loops = report["loops"].as_array().unwrap();
    assert_eq!(loops.len(), 2);
    let rows: Vec<Vec<i64>> = folder.read("f.matching").lines().skip(1).map(numbers_of).collect();
    for path in loops {
        assert_eq!(path["index"], 0);
        let ids = |key: &str| path[key].as_array().unwrap().clone();
        let (faces, edges) = (ids("faces"), ids("edges"));
        assert!(faces.len() >= 3 && faces.len() == edges.len());
        for (i, edge) in edges.iter().enumerate() {
            // The edge lies between its face and the next one.
            let pair = [&faces[i], &faces[(i + 1) % faces.len()]].map(|f| f.as_i64().unwrap());
            let ends = [&edge[0], &edge[1]].map(|v| v.as_i64().unwrap());
            let is_there = rows.iter().any(|row| {
                let forth = row[..2] == pair && row[2..4] == ends;
                forth || (row[..2] == [pair[1], pair[0]] && row[2..4] == [ends[1], ends[0]])
            });
            assert!(is_there, "{pair:?} {ends:?}");
        }
    }
}

fn numbers_of(line: &str) -> Vec<i64> {
    line.split_whitespace().map(|x| x.parse().unwrap()).collect()
}

/// The indices of the vertices by counting, as chapter 10 has it, from matchings modulo 4 and their full turns.
#[test]
fn full_turns_complete_the_matchings() {
    let folder = folder_with_field();
    let run = folder.expect(0, &["field", "in.obj", "map.obj", "-o", "f.rawfield", "--json"]);
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let mesh = testkit::icosphere(2);
    let mut index = vec![4i64; mesh.positions.len()];
    mesh.faces.iter().for_each(|face| index[face[0] as usize] += 4);
    let rows: Vec<Vec<i64>> = folder.read("f.matching").lines().skip(1).map(numbers_of).collect();
    assert_eq!(rows.len(), 480);
    for row in rows {
        let [left, right] = [row[2], row[3]].map(|v| v as usize);
        index[left] -= row[4];
        index[right] += row[4] - 4;
    }
    let turns = report["full_turns"].as_array().unwrap();
    assert!(!turns.is_empty());
    for edge in turns {
        let k = edge["turns"].as_i64().unwrap();
        index[edge["vertices"][0].as_u64().unwrap() as usize] -= 4 * k;
        index[edge["vertices"][1].as_u64().unwrap() as usize] += 4 * k;
    }
    let mut found = vec![0; index.len()];
    for cone in report["cones"].as_array().unwrap() {
        found[cone["vertex"].as_u64().unwrap() as usize] = cone["index"].as_i64().unwrap();
    }
    assert_eq!(index, found);
}
