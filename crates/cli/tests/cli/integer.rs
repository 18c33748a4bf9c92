//! Integer maps on the command line.

use crate::harness::{Folder, lines_of, off};
use seamstress_testkit as testkit;
use serde_json::Value;

#[test]
fn from_a_mesh_and_from_a_map() {
    let folder = Folder::new();
    folder.write("in.off", off(&testkit::bumpy(&testkit::icosphere(2), 0.1, 1)));
    let run = folder.expect(0, &["integer", "in.off", "--quads", "400", "-o", "a.obj"]);
    assert!(run.stdout.contains("asked for 400 quads"), "{}", run.stdout);
    assert!(run.stdout.contains("exact across"), "{}", run.stdout);
    folder.expect(0, &["map", "in.off", "-o", "map.obj"]);
    folder.expect(0, &["integer", "in.off", "map.obj", "--quads", "400", "-o", "b.obj"]);
    for name in ["a.obj", "b.obj"] {
        let check = folder.expect(0, &["check", "in.off", name, "--tolerance", "0"]);
        assert!(check.stdout.contains("certificate  passed"), "{}", check.stdout);
    }
    assert_eq!(lines_of(&folder.read("a.obj"), "f").len(), 320);
}

#[test]
fn the_report_tells_what_was_asked_and_achieved() {
    let folder = Folder::new();
    folder.write("in.off", off(&testkit::torus(24, 12, 1.0, 0.4)));
    let arguments =
        ["integer", "in.off", "--edge-length", "0.1", "-o", "o.obj", "--json", "--pictures", "p"];
    let run = folder.expect(0, &arguments);
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["grid"]["requested"]["edge-length"], 0.1);
    assert_eq!(report["grid"]["edge_length"], 0.1);
    // A whole number, without a trace of rounding.
    let quads = report["grid"]["quads"].as_u64().unwrap();
    assert!(quads > 1000, "{quads}");
    assert_eq!(report["integer_certificate"]["area"].as_f64(), Some(quads as f64));
    assert!(run_summary(&folder).contains(&format!("grid         {quads} quads, asked for")));
    assert!(folder.names().contains(&"p/layout.png".to_owned()));
}

fn run_summary(folder: &Folder) -> String {
    folder.expect(0, &["integer", "in.off", "--edge-length", "0.1", "-o", "o.obj"]).stdout
}

#[test]
fn features_that_the_map_does_not_follow_are_listed() {
    let folder = Folder::new();
    folder
        .write_obj("in.obj", &testkit::bumpy(&testkit::subdivide(&testkit::l_bracket()), 0.03, 3));
    let aligned = ["--features", "angle:40"];
    folder.expect(0, &["map", "in.obj", "-o", "free.obj", "-q"]);
    let integer = ["integer", "in.obj", "free.obj", "--quads", "600", "-o", "int.obj"];
    let run = folder.expect(0, &[&integer[..], &aligned].concat());
    assert!(run.stdout.contains("of 72 edges not aligned"), "{}", run.stdout);
    assert!(run.stdout.contains(": the map given does not follow it"), "{}", run.stdout);
    let run = folder.expect(0, &[&integer[..], &aligned, &["--json"]].concat());
    let features = serde_json::from_str::<Value>(&run.stdout).unwrap()["features"].take();
    let dropped = features["dropped"].as_array().unwrap();
    assert!(!dropped.is_empty() && dropped.iter().all(|edge| edge["reason"] == "not-in-map"));
    assert_eq!(features["edges"], 72);
    assert_eq!(features["kept"], 72 - dropped.len());
    // Neither do its quads.
    let extract = ["extract", "int.obj", "-o", "q.obj"];
    let run = folder.expect(0, &[&extract[..], &aligned].concat());
    assert!(run.stdout.contains("of 72 edges not aligned"), "{}", run.stdout);
}

#[test]
fn wrong_usage_and_failures() {
    let folder = Folder::new();
    folder.write("in.off", off(&testkit::bumpy(&testkit::icosphere(2), 0.25, 2)));
    folder.expect(2, &["integer", "in.off", "-o", "o.obj"]);
    folder.expect(2, &["integer", "in.off", "--quads", "5", "--scale", "1", "-o", "o.obj"]);
    folder.expect(2, &["integer", "in.off", "--quads", "0", "-o", "o.obj"]);
    let greedy = ["integer", "in.off", "--quads", "2", "--rounding", "greedy", "-o", "o.obj"];
    let run = folder.expect(3, &greedy);
    assert!(run.stderr.contains("face "), "{}", run.stderr);
    folder.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    folder.expect(1, &["integer", "in.off", "other.obj", "--quads", "50", "-o", "o.obj"]);
    assert_eq!(folder.names(), ["in.off", "other.obj"]);
}

#[test]
fn maps_of_few_digits_are_rounded_within_a_tolerance() {
    let folder = Folder::new();
    let part = testkit::subdivide(&testkit::subdivide(&testkit::l_bracket()));
    folder.write_obj("part.obj", &part);
    folder.expect(0, &["map", "part.obj", "-o", "map.obj", "--features", "angle:40"]);
    let few = |line: &str| match line.strip_prefix("vt ") {
        None => line.to_owned(),
        Some(uv) => {
            let numbers = uv.split(' ').map(|x| format!("{:.5}", x.parse::<f64>().unwrap()));
            format!("vt {}", numbers.collect::<Vec<_>>().join(" "))
        }
    };
    let lines: Vec<String> = folder.read("map.obj").lines().map(few).collect();
    folder.write("few.obj", lines.join("\n"));
    let command = ["integer", "part.obj", "few.obj", "--quads", "400", "-o", "int.obj"];
    let features = ["--features", "angle:40"];
    let refused = folder.run(&[&command[..], &features].concat());
    if refused.code != Some(0) {
        assert!(refused.stderr.contains("larger `--tolerance`"), "{refused:#?}");
    }
    let arguments = [&command[..], &features, &["--tolerance", "1e-3", "--json"]].concat();
    let run = folder.expect(0, &arguments);
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["features"]["dropped"].as_array().map(Vec::len), Some(0));
    let check = ["check", "part.obj", "int.obj", "--integer"];
    folder.expect(0, &[&check[..], &features].concat());
}

#[test]
fn a_part_that_fails_is_named_and_the_others_are_written_on_request() {
    let folder = Folder::new();
    // Greedy rounding takes what is smaller than a cell to a point.
    let speck = testkit::scale(&testkit::cube(), 0.01);
    folder.write_obj("both.obj", &testkit::disjoint_union(&[testkit::cube(), speck]));
    let command =
        ["integer", "both.obj", "--quads", "600", "--rounding", "greedy", "-o", "out.obj"];
    let run = folder.expect(3, &command);
    assert!(run.stderr.contains("\n  component 1 (12 faces from face 12): "), "{run:#?}");
    assert!(run.stderr.contains("\nNothing was written\nhint: "), "{run:#?}");
    assert!(run.stderr.ends_with("; `--partial` makes the other components\n"), "{run:#?}");
    assert_eq!(folder.names(), ["both.obj"]);

    let partial = [&command[..], &["--partial"]].concat();
    let run = folder.expect(3, &partial);
    let warning = "warning: component 1 (12 faces from face 12) is left out: ";
    assert!(run.stderr.starts_with(warning), "{run:#?}");
    let row = "failed       component 1 (12 faces from face 12); left out\n";
    assert!(run.stdout.contains(row), "{run:#?}");
    assert_eq!(lines_of(&folder.read("out.obj"), "f").len(), 12);
    // Being stopped is no failure of a part.
    folder.expect(4, &[&partial[..], &["--time-limit", "1e-9"]].concat());
}
