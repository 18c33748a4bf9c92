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
    assert_eq!(run.stdout.matches("is a copy of").count(), 20);
    assert!(run.stdout.contains("fault        and 10 more"), "{}", run.stdout);
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
