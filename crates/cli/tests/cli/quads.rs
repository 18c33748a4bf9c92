//! `seamstress layout-quads` and `seamstress quality`.

use crate::harness::{Folder, lines_of};
use seamstress_testkit as testkit;
use serde_json::Value;
use std::path::PathBuf;

/// The squares of a box of 2 x 1 x 1.
const BOX: &str = "\
v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0
v 0 0 1\nv 1 0 1\nv 2 0 1\nv 0 1 1\nv 1 1 1\nv 2 1 1
f 1 4 5 2\nf 2 5 6 3\nf 7 8 11 10\nf 8 9 12 11
f 1 2 8 7\nf 2 3 9 8\nf 4 10 11 5\nf 5 11 12 6
f 1 7 10 4\nf 3 6 12 9\n";

fn with_box() -> Folder {
    let folder = Folder::new();
    folder.write("box.obj", BOX);
    folder
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_box_is_laid_out_in_squares_and_the_map_passes_check() {
    let folder = with_box();
    let run = folder.expect(0, &["layout-quads", "box.obj", "-o", "map.obj", "--json"]);
    let report = json(&run.stdout);
    assert_eq!(report["cones"]["by_index"]["1"], 8);
    assert_eq!(report["integer_error"], 0.0);
    let tau = report["distortion"]["tau"].as_f64().unwrap();
    assert!((tau - 1.0).abs() < 1e-12);
    let map = folder.read("map.obj");
    assert_eq!(lines_of(&map, "f").len(), 20);
    for uv in lines_of(&map, "vt") {
        assert!(uv.split(' ').all(|x| x.parse::<f64>().unwrap().fract() == 0.0), "{uv}");
    }
    folder.expect(0, &["check", "map.obj", "map.obj"]);
}

#[test]
fn the_conformal_layout_says_how_far_from_integers_it_is() {
    let folder = with_box();
    let arguments = ["layout-quads", "box.obj", "-o", "map.obj", "--method", "conformal", "--json"];
    let error = json(&folder.expect(0, &arguments).stdout)["integer_error"].as_f64().unwrap();
    assert!(error < 1e-9);
}

#[test]
fn pictures_of_a_turned_texture_differ_and_the_map_does_not() {
    let folder = with_box();
    let draw = |name: &str, angle: &str| {
        let map = format!("{name}.obj");
        let arguments = ["layout-quads", "box.obj", "-o", &map, "--pictures", name];
        folder.expect(0, &[&arguments[..], &["--texture-angle", angle]].concat());
        let picture = std::fs::read(folder.path(&format!("{name}/front.png"))).unwrap();
        (folder.read(&map), picture)
    };
    let (straight, turned) = (draw("straight", "0"), draw("turned", "22"));
    assert_eq!(straight.0, turned.0);
    assert_ne!(straight.1, turned.1);
    let run = folder.expect(2, &["layout-quads", "box.obj", "-o", "m.obj", "--texture-angle", "5"]);
    assert!(run.stderr.contains("--pictures"));
}

#[test]
fn what_is_no_quad_mesh_is_refused_by_name() {
    let folder = Folder::new();
    folder.write("mixed.obj", format!("{BOX}f 1 2 3\n"));
    let run = folder.expect(1, &["layout-quads", "mixed.obj", "-o", "map.obj"]);
    assert!(run.stderr.contains("face 10 with 3 corners"), "{}", run.stderr);
    folder.write("turned.obj", BOX.replace("f 1 4 5 2", "f 2 5 4 1"));
    let run = folder.expect(1, &["layout-quads", "turned.obj", "-o", "map.obj"]);
    assert!(run.stderr.contains("manifold"), "{}", run.stderr);
    assert_eq!(folder.names(), ["mixed.obj", "turned.obj"]);
}

#[test]
fn quality_of_a_box_against_itself_and_a_longer_one() {
    let folder = with_box();
    let run = folder.expect(0, &["quality", "box.obj", "--source", "box.obj", "--json"]);
    let report = json(&run.stdout);
    assert_eq!(report["topology"]["irregular"]["3"], 8);
    assert_eq!(report["topology"]["euler_characteristic"], 2);
    assert!((report["angles"]["min"].as_f64().unwrap() - 90.0).abs() < 1e-9);
    assert!(report["distance"]["hausdorff"].as_f64().unwrap() < 1e-12);
    // One unit longer: its far side is one unit away.
    folder.write("longer.obj", BOX.replace("v 2", "v 3"));
    let run = folder.expect(0, &["quality", "longer.obj", "--source", "box.obj", "--json"]);
    let hausdorff = json(&run.stdout)["distance"]["hausdorff"].as_f64().unwrap();
    assert!((hausdorff - 1.0).abs() < 1e-9);
    let run = folder.expect(0, &["quality", "box.obj"]);
    assert!(run.stdout.contains("8 (8 of valence 3)"), "{}", run.stdout);
}

#[test]
fn quality_of_other_polygons_leaves_the_layout_undefined() {
    let folder = Folder::new();
    folder.write("house.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 2 0\nf 1 2 3 4\nf 4 3 5\n");
    let run = folder.expect(0, &["quality", "house.obj"]);
    assert!(run.stdout.contains("polygon 1 has 3 corners"), "{}", run.stdout);
    folder.write("points.obj", "v 0 0 0\n");
    folder.expect(1, &["quality", "points.obj"]);
}

#[test]
fn pictures_show_angles_of_any_polygons_and_distortion_of_quads() {
    let folder = with_box();
    let picture = |arguments: &[&str]| {
        folder.expect(0, arguments);
        let png = std::fs::read(folder.path("p.png")).unwrap();
        assert_eq!(&png[1..4], b"PNG");
        png
    };
    let angles = picture(&["quality", "box.obj", "--picture", "p.png"]);
    let tau = picture(&["quality", "box.obj", "--picture", "p.png", "--of", "tau"]);
    assert_ne!(angles, tau);
    // A triangle on top: angles are defined, the layout is not.
    folder.write("mixed.obj", BOX.replace("f 7 8 11 10\n", "f 7 8 11\nf 7 11 10\n"));
    picture(&["quality", "mixed.obj", "--picture", "p.png"]);
    let run = folder.expect(1, &["quality", "mixed.obj", "--picture", "q.png", "--of", "tau"]);
    assert!(run.stderr.contains("tau cannot be painted: polygon 2 has 3 corners"), "{run:?}");
    assert!(!folder.names().contains(&"q.png".to_owned()));
}

#[test]
fn quads_that_face_the_wrong_way_are_told() {
    let folder = with_box();
    let report = |file: &str| {
        let arguments = ["quality", file, "--source", "box.obj", "--json", "--samples", "100"];
        json(&folder.expect(0, &arguments).stdout)
    };
    assert_eq!(report("box.obj")["orientation"]["inverted"], 0);
    assert_eq!(report("box.obj")["measures"].as_array().unwrap().len(), 8);
    folder.write("turned.obj", BOX.replace("f 7 8 11 10\n", "f 10 11 8 7\n"));
    assert_eq!(report("turned.obj")["orientation"]["inverted"], 1);
}

/// Quad meshes of other programs.
#[test]
fn quad_meshes_of_the_collection_are_measured_and_laid_out_exactly() {
    let Some(collection) = collection() else { return };
    let folder = Folder::new();
    for (name, irregular) in [
        ("fertility_quad.off", 48),
        ("gargoyle_quadriflow.obj", 180),
        ("inspired_mesh_quads_smooth.off", 0),
    ] {
        let quads = collection.join(name).to_string_lossy().into_owned();
        let quality = json(&folder.expect(0, &["quality", &quads, "--json"]).stdout);
        let by_valence = quality["topology"]["irregular"].as_object().unwrap();
        let count: u64 = by_valence.values().filter_map(Value::as_u64).sum();
        assert_eq!(count, irregular, "{name}");
        let arguments = ["layout-quads", &quads, "-o", "map.obj", "--json"];
        let layout = json(&folder.expect(0, &arguments).stdout);
        assert_eq!(layout["integer_error"], 0.0, "{name}");
        assert_eq!(layout["distortion"]["tau"], quality["distortion"]["tau"], "{name}");
        let conformal = [&arguments[..], &["--method", "conformal"]].concat();
        let error = json(&folder.expect(0, &conformal).stdout)["integer_error"].as_f64().unwrap();
        assert!(error > 0.0 && error < 1e-6, "{name}: {error}");
    }
    for (name, others) in [("suzanne.obj", "3"), ("spot_control_mesh.obj", "5")] {
        let path = collection.join(name).to_string_lossy().into_owned();
        let quality = json(&folder.expect(0, &["quality", &path, "--json"]).stdout);
        assert!(quality["topology"]["polygons"][others].as_u64().unwrap() > 0);
        assert!(quality["distortion"].is_null() && quality["angles"]["min"].is_number());
    }
}

/// Spikes and close features, of which some leave no room to the cells.
#[test]
fn a_coarse_robot_cat_has_quads_of_few_irregular_vertices() {
    let Some(mesh) = testkit::in_collection("robocat_deci.off") else { return };
    let (folder, mesh) = (Folder::new(), mesh.to_string_lossy().into_owned());
    for count in ["300", "400"] {
        let run = folder.expect(0, &["quad", &mesh, "-o", "q.obj", "--quads", count, "--json"]);
        let report = json(&run.stdout);
        let off = report["grid"]["quads"].as_f64().unwrap() / count.parse::<f64>().unwrap();
        assert!((0.9..1.1).contains(&off), "{count}: {off}");
        let irregular = report["quads"]["irregular"]["count"].as_u64().unwrap();
        assert!(irregular < 150, "{count}: {irregular} irregular vertices");
        assert_eq!(report["orientation"]["inverted"], 0);
    }
}

fn collection() -> Option<PathBuf> {
    testkit::in_collection("")
}
