//! Measuring maps and laying them out anew.

use crate::harness::{Folder, lines_of};
use seamstress_testkit as testkit;
use serde_json::Value;

/// A folder with `in.obj` and its map `map.obj`.
fn mapped() -> Folder {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::bumpy(&testkit::icosphere(2), 0.2, 7));
    folder.expect(0, &["map", "in.obj", "-o", "map.obj", "--quiet"]);
    folder
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_map_is_measured_in_every_way() {
    let folder = mapped();
    let run = folder.expect(0, &["measure", "in.obj", "map.obj"]);
    for name in [
        "tau-tilde",
        "symmetric-dirichlet",
        "arap-max",
        "asap",
        "dilatation",
        "certified: no flips",
    ] {
        assert!(run.stdout.contains(name), "{name} in {}", run.stdout);
    }
    let value = json(&folder.expect(0, &["measure", "in.obj", "map.obj", "--json"]).stdout);
    let checked = json(&folder.expect(0, &["check", "in.obj", "map.obj", "--json"]).stdout);
    let tau = &value["measures"][1];
    assert_eq!(tau["measure"], "tau");
    let (a, b) =
        (tau["max"].as_f64().unwrap(), checked["map"]["distortion"]["tau"].as_f64().unwrap());
    assert!((a - b).abs() < 1e-9 * a);
    assert_eq!(value["map"]["certified"], true);
}

#[test]
fn flips_are_told_and_painted() {
    let folder = mapped();
    let map = folder.read("map.obj");
    let line = lines_of(&map, "f")[7];
    let corners: Vec<(&str, &str)> = line.split(' ').map(|c| c.split_once('/').unwrap()).collect();
    let [a, b, c] = corners[..] else { panic!("{line}") };
    let flipped = format!("f {}/{} {}/{} {}/{}\n", a.0, b.1, b.0, a.1, c.0, c.1);
    folder.write("flipped.obj", map.replacen(&format!("f {line}\n"), &flipped, 1));
    let run = folder.expect(0, &["measure", "in.obj", "flipped.obj", "--picture", "heat.png"]);
    assert!(run.stdout.contains("1 triangle flipped or collapsed"), "{}", run.stdout);
    assert!(run.stdout.contains("not a seamless map: face 7 is flipped"), "{}", run.stdout);
    let picture = std::fs::read(folder.path("heat.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    let value = json(&folder.expect(0, &["measure", "in.obj", "flipped.obj", "--json"]).stdout);
    assert_eq!((&value["map"]["flipped"], &value["map"]["certified"]), (&1.into(), &false.into()));
    let measures = value["measures"].as_array().unwrap();
    let max = |name: &str| &measures.iter().find(|m| m["measure"] == name).unwrap()["max"];
    assert_eq!(max("dilatation"), "inf");
    assert!(max("arap").is_number());
    let worst = &measures.iter().find(|m| m["measure"] == "tau").unwrap()["worst"];
    assert_eq!(worst, 7);
    // A layout needs a map without.
    let run = folder
        .expect(1, &["layout", "in.obj", "flipped.obj", "--objective", "arap", "-o", "x.obj"]);
    assert!(run.stderr.contains("not a seamless map: "), "{}", run.stderr);
}

#[test]
fn a_map_of_another_mesh_is_refused() {
    let folder = mapped();
    folder.write_obj("other.obj", &testkit::icosphere(1));
    let run = folder.expect(1, &["measure", "other.obj", "map.obj"]);
    assert!(run.stderr.contains("not a map of the mesh"), "{}", run.stderr);
}

#[test]
fn a_map_is_laid_out_anew() {
    let folder = mapped();
    for objective in ["arap", "asap", "tau"] {
        let arguments = [
            "layout",
            "in.obj",
            "map.obj",
            "--objective",
            objective,
            "-o",
            "new.obj",
            "--report",
            "r.json",
        ];
        let run = folder.expect(0, &arguments);
        assert!(run.stdout.contains(&format!("objective    {objective}")), "{}", run.stdout);
        let report = json(&folder.read("r.json"));
        let stats = &report["components"][0];
        assert!(stats["after"].as_f64() <= stats["before"].as_f64(), "{stats}");
        folder.expect(0, &["check", "in.obj", "new.obj"]);
    }
    folder.expect(0, &["map", "in.obj", "-o", "rigid.obj", "--objective", "arap-newton", "-q"]);
    let arap = |name: &str| {
        let value = json(&folder.expect(0, &["measure", "in.obj", name, "--json"]).stdout);
        value["measures"][3]["mean"].as_f64().unwrap()
    };
    assert!(arap("rigid.obj") < arap("map.obj"));
}

fn lay_out<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    let layout = ["layout", "in.obj", "map.obj", "-o", "new.obj", "--objective"];
    [&layout[..], arguments].concat()
}

#[test]
fn the_dilatation_is_minimised_by_several_methods_and_bounded() {
    let folder = mapped();
    let value = json(&folder.expect(0, &lay_out(&["dilatation-alternating", "--json"])).stdout);
    let smallest = value["components"][0]["after"].as_f64().unwrap();
    assert!(smallest > 1.0);
    let bound = format!("{}", 1.2 * smallest);
    let bounded = lay_out(&["dilatation-alternating", "--bound", &bound]);
    let run = folder.expect(0, &bounded);
    assert!(run.stdout.contains("objective    symmetric-dirichlet"), "{}", run.stdout);
    assert!(run.stdout.contains("bound        dilatation"), "{}", run.stdout);
    let value = json(&folder.expect(0, &[&bounded[..], &["--json"]].concat()).stdout);
    let stats = &value["components"][0];
    assert!(stats["dilatation"].as_f64().unwrap() <= 1.2 * smallest * (1.0 + 1e-6));
    assert_eq!(value["options"]["bound"].as_f64().unwrap(), 1.2 * smallest);
    folder.expect(0, &["check", "in.obj", "new.obj"]);
    let measured = json(&folder.expect(0, &["measure", "in.obj", "new.obj", "--json"]).stdout);
    let measures = measured["measures"].as_array().unwrap();
    let dilatation = measures.iter().find(|m| m["measure"] == "dilatation").unwrap();
    assert!(dilatation["max"].as_f64().unwrap() <= 1.2 * smallest * (1.0 + 1e-6));

    let run = folder.expect(3, &lay_out(&["dilatation", "--bound", "1.0001"]));
    assert!(run.stderr.contains("dilatation of at most 1.0001 was found"), "{}", run.stderr);
    let run = folder.expect(2, &lay_out(&["dilatation", "--bound", "0.9"]));
    assert!(run.stderr.contains("no map has a dilatation below 1"), "{}", run.stderr);
    let run = folder.expect(2, &lay_out(&["tau", "--bound", "2"]));
    assert!(run.stderr.contains("one on the dilatation, not on tau"), "{}", run.stderr);
}

#[test]
fn disks_need_no_map_and_stretches_come_from_a_file() {
    let folder = Folder::new();
    folder.write_obj("disk.obj", &testkit::disk_grid(3, 3));
    folder.write("stretch.txt", format!("# long in x\n{}", "1 0 0 2 1\n".repeat(18)));
    let arguments = [
        "layout",
        "disk.obj",
        "--objective",
        "arap",
        "-o",
        "long.obj",
        "--anisotropy",
        "stretch.txt",
        "--json",
    ];
    let report = json(&folder.expect(0, &arguments).stdout);
    let sigma = report["distortion"]["sigma_1_max"].as_f64().unwrap();
    assert!((sigma - 2.0).abs() < 1e-2, "{sigma}");
    folder.write("stretch.txt", "1 0 0 2\n");
    let run = folder.expect(1, &arguments);
    assert!(run.stderr.contains("line 1: expected five numbers"), "{}", run.stderr);
    folder.write("stretch.txt", "1 0 0 2 1\n");
    let run = folder.expect(1, &arguments);
    assert!(run.stderr.contains("1 stretches for 18 faces"), "{}", run.stderr);
    folder.write_obj("ball.obj", &testkit::icosphere(1));
    let run = folder.expect(2, &["layout", "ball.obj", "--objective", "arap", "-o", "x.obj"]);
    assert!(run.stderr.contains("give a seamless map to start from"), "{}", run.stderr);
}
