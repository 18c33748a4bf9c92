//! Checking meshes and maps; every kind of fault is found and named.

use crate::harness::{Folder, lines_of, obj};
use seamstress_testkit as testkit;
use serde_json::Value;
use std::collections::BTreeMap;

/// A folder with `in.obj` and its map `map.obj`.
fn mapped() -> Folder {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::icosphere(1));
    folder.expect(0, &["map", "in.obj", "-o", "map.obj", "--quiet"]);
    folder
}

/// Changes the `n`-th line with this keyword in the map, and expects `check` to say `message`.
#[track_caller]
fn spoil(folder: &Folder, keyword: &str, n: usize, change: impl Fn(&str) -> String, message: &str) {
    let map = folder.read("map.obj");
    let old = format!("{keyword} {}", lines_of(&map, keyword)[n]);
    let new = format!("{keyword} {}", change(lines_of(&map, keyword)[n]));
    assert_ne!(old, new);
    folder.write("spoilt.obj", map.replacen(&format!("{old}\n"), &format!("{new}\n"), 1));
    let run = folder.expect(1, &["check", "in.obj", "spoilt.obj"]);
    assert!(run.stdout.contains(message), "{message} in {}", run.stdout);
    assert!(run.stdout.contains("certificate  failed"), "{}", run.stdout);
    let json = folder.expect(1, &["check", "in.obj", "spoilt.obj", "--json"]);
    let value: Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(value["map"]["certified"], false);
    assert!(value["map"]["violations"].to_string().contains(message));
}

fn corners(line: &str) -> [&str; 3] {
    let corners: Vec<&str> = line.split(' ').collect();
    corners.try_into().unwrap()
}

fn uv(corner: &str) -> &str {
    corner.split_once('/').unwrap().1
}

fn vertex(corner: &str) -> &str {
    corner.split_once('/').unwrap().0
}

#[test]
fn a_flipped_triangle_is_named() {
    let swap = |line: &str| {
        let [a, b, c] = corners(line);
        format!("{}/{} {}/{} {c}", vertex(a), uv(b), vertex(b), uv(a))
    };
    spoil(&mapped(), "f", 7, swap, "face 7 is flipped");
}

#[test]
fn a_collapsed_triangle_is_named() {
    let collapse = |line: &str| {
        let [a, b, c] = corners(line);
        format!("{a} {}/{} {}/{}", vertex(b), uv(a), vertex(c), uv(a))
    };
    spoil(&mapped(), "f", 11, collapse, "face 11 is collapsed");
}

#[test]
fn a_moved_vertex_is_named() {
    let nudge = |line: &str| format!("{line}1");
    spoil(&mapped(), "v", 1, nudge, "vertex 1 was moved by");
}

#[test]
fn a_changed_face_is_named() {
    let rotate = |line: &str| {
        let [a, b, c] = corners(line);
        format!("{b} {c} {a}")
    };
    spoil(&mapped(), "f", 3, rotate, "face 3 is not the source's face");
}

#[test]
fn an_open_seam_is_named_unless_tolerated() {
    let folder = mapped();
    let map = folder.read("map.obj");
    // A vertex with several UVs is on a seam.
    let mut uvs: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for corner in lines_of(&map, "f").into_iter().flat_map(corners) {
        let known = uvs.entry(vertex(corner)).or_default();
        if !known.contains(&uv(corner)) {
            known.push(uv(corner));
        }
    }
    let (v, at) = uvs.iter().find(|(_, uvs)| uvs.len() > 1).unwrap();
    let name: usize = v.parse::<usize>().unwrap() - 1;
    let shift = |line: &str| {
        let (u, v) = line.split_once(' ').unwrap();
        format!("{} {v}", u.parse::<f64>().unwrap() + 1e-6)
    };
    let at = at[0].parse::<usize>().unwrap() - 1;
    spoil(&folder, "vt", at, shift, "does not close: off by");
    let run = folder.run(&["check", "in.obj", "spoilt.obj"]);
    let is_named = run.stdout.lines().any(|line| {
        let edge = line.split("edge ").nth(1).and_then(|rest| rest.split(' ').next());
        edge.is_some_and(|edge| edge.split('-').any(|end| end == name.to_string()))
    });
    assert!(run.stdout.contains("seams        open by up to"), "{}", run.stdout);
    assert!(is_named, "vertex {name} in {}", run.stdout);
    folder.expect(0, &["check", "in.obj", "spoilt.obj", "--tolerance", "1e-4"]);
}

#[test]
fn other_counts_are_told() {
    let folder = mapped();
    folder.write_obj("other.obj", &testkit::icosahedron());
    let run = folder.expect(1, &["check", "other.obj", "map.obj"]);
    assert!(run.stdout.contains("the map has 42 vertices, the source 12"));
    assert!(run.stdout.contains("the map has 80 faces, the source 20"));
}

#[test]
fn a_map_needs_texture_coordinates_and_triangles() {
    let folder = mapped();
    let run = folder.expect(1, &["check", "in.obj", "in.obj"]);
    assert!(run.stderr.starts_with("error: in.obj: not a map"), "{run:?}");
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    folder.write("quad.obj", format!("{quad}f 1/1 2/2 3/3 4/4\n"));
    let run = folder.expect(1, &["check", "in.obj", "quad.obj"]);
    assert!(run.stderr.contains("face 0 is not a triangle"), "{run:?}");
}

#[test]
fn meshes_without_faults_pass() {
    let folder = Folder::new();
    folder.write_obj("torus.obj", &testkit::torus(12, 6, 1.0, 0.4));
    let run = folder.expect(0, &["check", "torus.obj"]);
    assert!(run.stdout.contains("1 component, genus 1, closed, Euler characteristic 0"));
    let run = folder.expect(0, &["check", "torus.obj", "--json"]);
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["is_mesh"], true);
    assert_eq!(value["faults"], Value::Array(Vec::new()));
}

#[test]
fn warnings_are_no_fault() {
    let folder = Folder::new();
    let mut soup = testkit::cube();
    soup.positions.push([2.0; 3]);
    folder.write_obj("in.obj", &soup);
    let run = folder.expect(0, &["check", "in.obj"]);
    assert!(run.stdout.contains("warning      vertex 8 belongs to no face"), "{run:?}");
    let run = folder.expect(0, &["map", "in.obj", "-o", "map.obj"]);
    assert_eq!(run.stderr, "warning: vertex 8 belongs to no face\n");
    folder.expect(0, &["check", "in.obj", "map.obj"]);
}

#[test]
fn many_faults_are_cut_short_for_people_only() {
    let folder = Folder::new();
    let mut soup = testkit::icosphere(1);
    soup.faces.extend_from_within(..30);
    folder.write_obj("in.obj", &soup);
    let run = folder.expect(1, &["check", "in.obj"]);
    assert_eq!(run.stdout.matches("is a copy of").count(), 10);
    assert!(run.stdout.contains("fault        and 20 more"), "{}", run.stdout);
    assert!(run.stdout.contains("`--repair` can mend its 30 faults"), "{}", run.stdout);
    let run = folder.expect(1, &["check", "in.obj", "--json"]);
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["faults"].as_array().unwrap().len(), 30);
    assert_eq!(value["faults"][0]["kind"], "duplicate-face");
    assert_eq!(value["is_repairable"], true);
}

#[test]
fn faults_name_the_polygons_of_the_file() {
    let folder = Folder::new();
    // Two quads and a triangle on one edge.
    let quads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 0 0 1\nv 0 -1 0\n";
    folder.write("fin.obj", format!("{quads}f 1 2 3 4\nf 2 1 6 5\nf 2 1 7\n"));
    let run = folder.expect(1, &["check", "fin.obj"]);
    assert!(run.stdout.contains("edge 0-1 has 3 faces: 0, 1, 2"), "{}", run.stdout);
}

#[test]
fn a_reader_that_leaves_is_no_fault() {
    let folder = Folder::new();
    folder.write("in.obj", obj(&testkit::cube()));
    let mut child = folder.start(&["check", "in.obj"]);
    drop(child.stdout.take());
    assert_eq!(crate::harness::wait(child).code, Some(0));
}

/// The map in `name` with every texture coordinate changed, as `changed.obj`.
fn change_uvs(folder: &Folder, name: &str, change: impl Fn(f64, f64) -> [f64; 2]) {
    let line = |line: &str| match line.strip_prefix("vt ") {
        Some(uv) => {
            let (u, v) = uv.split_once(' ').unwrap();
            let [u, v] = change(u.parse().unwrap(), v.parse().unwrap());
            format!("vt {u} {v}\n")
        }
        None => format!("{line}\n"),
    };
    folder.write("changed.obj", folder.read(name).lines().map(line).collect::<String>());
}

#[test]
fn integer_grid_maps_are_certified_and_others_refused() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::bumpy(&testkit::icosphere(2), 0.1, 1));
    folder.expect(0, &["integer", "in.obj", "--quads", "300", "-o", "grid.obj", "--quiet"]);
    let run = folder.expect(0, &["check", "in.obj", "grid.obj", "--integer"]);
    assert!(run.stdout.contains("integers     exact across 480 edges"), "{}", run.stdout);
    let json = folder.expect(0, &["check", "in.obj", "grid.obj", "--integer", "--json"]);
    let value: Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(value["map"]["integral"], true);
    assert_eq!(value["map"]["integer_certificate"]["exact_edges"], 480);
    assert_eq!(value["map"]["integer_certificate"]["integral_error"], 0.0);

    // A seamless map that is none.
    folder.expect(0, &["map", "in.obj", "-o", "map.obj", "--quiet"]);
    let run = folder.expect(1, &["check", "in.obj", "map.obj", "--integer"]);
    assert!(run.stdout.contains("certificate  passed"), "{}", run.stdout);
    assert!(run.stdout.contains("violation    the cone at vertex"), "{}", run.stdout);
    assert!(run.stdout.contains("integers     failed: "), "{}", run.stdout);
    let json = folder.expect(1, &["check", "in.obj", "map.obj", "--integer", "--json"]);
    let value: Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(
        (&value["map"]["certified"], &value["map"]["integral"]),
        (&true.into(), &false.into())
    );
    let violations = value["map"]["integer_certificate"]["violations"].as_array().unwrap();
    assert!(violations.iter().any(|v| v["kind"] == "fractional-cone"));
    folder.expect(0, &["check", "in.obj", "map.obj"]);

    // Cones in the middle of cells.
    change_uvs(&folder, "grid.obj", |u, v| [u + 0.5, v + 0.5]);
    let run = folder.expect(1, &["check", "in.obj", "changed.obj", "--integer"]);
    assert!(run.stdout.contains(", which is not a grid point"), "{}", run.stdout);
    // And a map that is not even seamless.
    change_uvs(&folder, "grid.obj", |u, v| [2.0 * u, v]);
    let run = folder.expect(1, &["check", "in.obj", "changed.obj", "--integer"]);
    assert!(run.stdout.contains("integers     not checked"), "{}", run.stdout);
    folder.expect(2, &["check", "in.obj", "--integer"]);
}

#[test]
fn integer_grid_maps_of_few_digits_need_a_tolerance() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::bumpy(&testkit::icosphere(2), 0.1, 1));
    folder.expect(0, &["integer", "in.obj", "--quads", "300", "-o", "grid.obj", "--quiet"]);
    let digits = |x: f64| (x * 1e5).round() / 1e5;
    change_uvs(&folder, "grid.obj", |u, v| [digits(u + 0.000_02), digits(v)]);
    let check = ["check", "in.obj", "changed.obj", "--integer", "--tolerance", "1e-3"];
    let run = folder.expect(1, &check);
    assert!(run.stdout.contains("need `--integer-tolerance`"), "{}", run.stdout);
    let with = |tolerance| [&check[..], &["--integer-tolerance", tolerance]].concat();
    let run = folder.expect(0, &with("1e-4"));
    assert!(run.stdout.contains("integers     to within 4.0e-5 grid units"), "{}", run.stdout);
    folder.expect(1, &with("1e-5"));
    folder.expect(2, &with("0.3"));
}

#[test]
fn features_of_integer_grid_maps_lie_on_lines_of_the_grid() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::subdivide(&testkit::l_bracket()));
    let features = ["--features", "angle:40", "--align-boundary"];
    let integer = ["integer", "in.obj", "--quads", "400", "-o", "grid.obj", "--quiet"];
    folder.expect(0, &[&integer[..], &features].concat());
    let check = |name| [&["check", "in.obj", name, "--integer"][..], &features].concat();
    let run = folder.expect(0, &check("grid.obj"));
    assert!(run.stdout.contains("aligned edges"), "{}", run.stdout);
    // Everything moved by a quarter of a cell: still on the axes, but off the lines.
    change_uvs(&folder, "grid.obj", |u, v| [u + 0.25, v]);
    let run = folder.expect(1, &check("changed.obj"));
    assert!(run.stdout.contains("alignment    passed"), "{}", run.stdout);
    assert!(run.stdout.contains("is not at an integer in face"), "{}", run.stdout);
}

#[test]
fn tolerances_that_would_pass_anything_are_wrong_usage() {
    let folder = mapped();
    let check = ["check", "in.obj", "map.obj"];
    for tolerance in
        [["--tolerance", "10"], ["--tolerance", "0.02"], ["--alignment-tolerance", "2"]]
    {
        let run = folder.expect(2, &[&check[..], &tolerance].concat());
        assert!(run.stderr.contains("it must be from 0 to"), "{}", run.stderr);
    }
    folder.expect(2, &["measure", "in.obj", "map.obj", "--tolerance", "10"]);
    folder.expect(2, &["field", "in.obj", "map.obj", "-o", "f.rawfield", "--tolerance", "10"]);
    let layout = ["layout", "in.obj", "map.obj", "--objective", "arap", "-o", "o.obj"];
    folder.expect(2, &[&layout[..], &["--tolerance", "10"]].concat());
    let integer = ["integer", "in.obj", "map.obj", "--quads", "100", "-o", "o.obj"];
    folder.expect(2, &[&integer[..], &["--tolerance", "10"]].concat());
    folder.expect(0, &[&check[..], &["--tolerance", "0.01"]].concat());
}

#[test]
fn boundary_vertices_that_turn_too_far_are_counted() {
    let folder = Folder::new();
    // Five right angles around a vertex of the boundary.
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 1 0 1\nv 0 1 1\n";
    let faces = [[2, 3, 1, 2], [3, 4, 2, 3], [4, 5, 3, 4], [5, 6, 4, 1], [6, 7, 1, 2]];
    let write = |corner: fn(i32, i32) -> String| {
        let face = |[a, b, c, d]: [i32; 4]| {
            format!("f {} {} {}\n", corner(1, 5), corner(a, c), corner(b, d))
        };
        faces.map(face).concat()
    };
    folder.write("in.obj", format!("{mesh}{}", write(|v, _| v.to_string())));
    let uvs = "vt 1 0\nvt 0 1\nvt -1 0\nvt 0 -1\nvt 0 0\n";
    folder.write("map.obj", format!("{mesh}{uvs}{}", write(|v, uv| format!("{v}/{uv}"))));
    let run = folder.expect(0, &["check", "in.obj", "map.obj"]);
    let line = "1 boundary vertex where the map turns by more than a full turn";
    assert!(run.stdout.contains(line), "{}", run.stdout);
    let run = folder.expect(0, &["check", "in.obj", "map.obj", "--json"]);
    let value: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(value["map"]["certificate"]["overwound_boundary_vertices"], 1);
    let mapped = mapped().expect(0, &["check", "in.obj", "map.obj"]);
    assert!(!mapped.stdout.contains("full turn"), "{}", mapped.stdout);
}
