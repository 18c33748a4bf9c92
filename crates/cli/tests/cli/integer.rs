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
    let quads = report["grid"]["quads"].as_f64().unwrap();
    assert!((quads - quads.round()).abs() < 1e-6 && quads > 1000.0, "{quads}");
    assert_eq!(report["integer_certificate"]["area"], report["grid"]["quads"]);
    assert!(folder.names().contains(&"p/layout.png".to_owned()));
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
