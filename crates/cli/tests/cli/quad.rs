//! `seamstress quad`.

use crate::harness::{Folder, lines_of};
use seamstress_testkit as kit;
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_cube_becomes_quads_with_its_corners_irregular() {
    let folder = Folder::new();
    folder.write_obj("cube.obj", &kit::subdivide(&kit::subdivide(&kit::cube())));
    let arguments = ["quad", "cube.obj", "--quads", "150", "-o", "q.obj", "--json"];
    let report = json(&folder.expect(0, &arguments).stdout);
    assert_eq!(report["quads"]["is_manifold"], true);
    assert_eq!(report["quads"]["euler_characteristic"], 2);
    assert_eq!(report["quads"]["irregular"]["by_valence"]["3"], 8);
    let quads = lines_of(&folder.read("q.obj"), "f").len() as u64;
    assert_eq!(report["quads"]["count"].as_u64(), Some(quads));
    assert!((100..200).contains(&quads), "{quads}");
    let quality = json(&folder.expect(0, &["quality", "q.obj", "--json"]).stdout);
    assert_eq!(quality["topology"]["polygons"]["4"].as_u64(), Some(quads));
    assert_eq!(quality["topology"]["bad_edges"], 0);
}

#[test]
fn pictures_reports_and_ply_are_written_together() {
    let folder = Folder::new();
    folder.write_obj("torus.obj", &kit::torus(16, 10, 2.0, 0.8));
    let arguments = ["quad", "torus.obj", "--quads", "200", "-o", "q.ply", "--smooth", "2"];
    let outputs = ["--picture", "q.png", "--report", "q.json"];
    let run = folder.expect(0, &[&arguments[..], &outputs].concat());
    assert!(run.stdout.contains("Euler characteristic 0"), "{}", run.stdout);
    assert_eq!(folder.names(), ["q.json", "q.ply", "q.png", "torus.obj"]);
    assert_eq!(json(&folder.read("q.json"))["command"], "quad");
}

#[test]
fn exactly_one_size_is_needed_and_bad_meshes_are_refused() {
    let folder = Folder::new();
    folder.write_obj("cube.obj", &kit::cube());
    folder.expect(2, &["quad", "cube.obj", "-o", "q.obj"]);
    folder.expect(2, &["quad", "cube.obj", "-o", "q.obj", "--quads", "9", "--scale", "1"]);
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
    folder.expect(1, &["quad", "open.obj", "-o", "q.obj", "--quads", "9"]);
    assert_eq!(folder.names(), ["cube.obj", "open.obj"]);
}

#[test]
fn badly_shaped_quads_are_mended_unless_the_map_is_wanted_as_it_is() {
    let folder = Folder::new();
    folder.write_obj("bracket.obj", &kit::subdivide(&kit::l_bracket()));
    let quality = |name: &str, more: &[&str]| {
        let arguments = ["quad", "bracket.obj", "--quads", "400", "-o", name, "--json"];
        let report = json(&folder.expect(0, &[&arguments[..], more].concat()).stdout);
        let arguments = ["quality", name, "--source", "bracket.obj", "--json"];
        (report, json(&folder.expect(0, &arguments).stdout))
    };
    let (raw_report, raw) = quality("raw.obj", &["--raw"]);
    let (report, mended) = quality("q.obj", &[]);
    assert_eq!(raw_report["mended"]["moved"], 0);
    assert_eq!(raw["topology"]["irregular"], mended["topology"]["irregular"]);
    assert_eq!(mended["orientation"]["inverted"], 0);
    let range = |of: &Value| {
        of["angles"]["max"].as_f64().unwrap() - of["angles"]["min"].as_f64().unwrap()
    };
    match report["mended"]["moved"].as_u64() {
        Some(0) => assert_eq!(folder.read("raw.obj"), folder.read("q.obj")),
        _ => assert!(range(&mended) < range(&raw), "{mended} {raw}"),
    }
}
