//! Maps that succeed.

use crate::harness::{Folder, bare_faces, lines_of, obj, off};
use seamstress_testkit as testkit;
use serde_json::Value;

#[test]
fn vertices_and_faces_stay_and_the_map_is_certified() {
    let shapes = [
        ("sphere", testkit::bumpy(&testkit::icosphere(2), 0.1, 1)),
        ("torus", testkit::torus(16, 8, 1.0, 0.4)),
        ("saddle", testkit::saddle(6)),
        ("two", {
            let pair = [testkit::cube(), testkit::icosphere(1)];
            testkit::disjoint_union(&pair)
        }),
    ];
    let folder = Folder::new();
    for (name, soup) in shapes {
        folder.write(&format!("{name}.off"), off(&soup));
        let (input, output) = (format!("{name}.off"), format!("{name}.map.obj"));
        let run = folder.expect(0, &["map", &input, "-o", &output]);
        assert_eq!(run.stderr, "", "{name}");
        assert!(run.stdout.lines().count() <= 15, "{}", run.stdout);
        assert!(run.stdout.contains("certificate  passed"), "{}", run.stdout);
        let (source, map) = (obj(&soup), folder.read(&output));
        assert_eq!(positions(&map), soup.positions, "{name}");
        assert_eq!(lines_of(&source, "f"), bare_faces(&map), "{name}");
        assert!(map.starts_with("# Seamless map by Seamstress "));
        assert!(map.contains(&format!("# Source: {name}.off\n")), "{name}");
        let check = folder.expect(0, &["check", &input, &output]);
        assert!(check.stdout.contains("certificate  passed"), "{name}");
    }
}

fn positions(obj: &str) -> Vec<[f64; 3]> {
    let point = |line: &str| {
        let point: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        point.try_into().unwrap()
    };
    lines_of(obj, "v").into_iter().map(point).collect()
}

#[test]
fn every_output_is_written_and_agrees() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::icosphere(2));
    let arguments = [
        "map",
        "in.obj",
        "-o",
        "map.obj",
        "--report",
        "new/deep/r.json",
        "--pictures",
        "new/deep",
        "--sing",
        "cones.sing",
        "--json",
        "--threads",
        "2",
        "--cone-bias",
        "0.25",
    ];
    let run = folder.expect(0, &arguments);
    let expected = [
        "cones.sing",
        "in.obj",
        "map.obj",
        "new",
        "new/deep",
        "new/deep/back.png",
        "new/deep/front.png",
        "new/deep/layout.png",
        "new/deep/r.json",
    ];
    assert_eq!(folder.names(), expected);
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(run.stdout, folder.read("new/deep/r.json"));
    assert_eq!(report["options"]["cone_bias"], 0.25);
    assert_eq!(report["cost"]["threads"], 2);
    assert_eq!(report["input"]["faces"], 320);
    assert_eq!(report["input"]["genus"], 0);
    assert_eq!(report["certificate"]["index_sum"], 8.0);
    assert!(report["distortion"]["tau"].as_f64().unwrap() >= 1.0);
    assert!(report["components"][0]["stages"][0]["seconds"].is_number());
    let files = report["files"].as_array().unwrap();
    assert_eq!(files.len(), 6);
    for file in files {
        assert!(folder.path(file["path"].as_str().unwrap()).is_file());
    }
    let cones = report["cones"]["list"].as_array().unwrap();
    let mut expected = format!("4 {}\n", cones.len());
    for cone in cones {
        expected += &format!("{} {}\n", cone["vertex"], cone["index"]);
    }
    assert_eq!(folder.read("cones.sing"), expected);
    let png = std::fs::read(folder.path("new/deep/front.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
}

#[test]
fn the_bytes_depend_on_nothing_but_the_input() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::bumpy(&testkit::icosphere(3), 0.1, 3));
    let runs = [("a", "1"), ("b", "2"), ("c", "2")];
    for (name, threads) in runs {
        let output = format!("{name}.obj");
        let arguments = ["map", "in.obj", "-o", &output, "--pictures", name, "--threads", threads];
        folder.expect(0, &arguments);
    }
    let read =
        |name: &str, file: &str| std::fs::read(folder.path(&format!("{name}{file}"))).unwrap();
    for file in [".obj", "/front.png", "/back.png", "/layout.png"] {
        assert_eq!(read("a", file), read("b", file), "{file}");
        assert_eq!(read("b", file), read("c", file), "{file}");
    }
}

#[test]
fn the_finish_lowers_tau_and_can_be_left_out() {
    let folder = Folder::new();
    folder.write("in.off", off(&testkit::bumpy(&testkit::icosphere(3), 0.1, 5)));
    let distortion = |options: &[&str]| {
        let mut arguments = vec!["map", "in.off", "-o", "map.obj", "--json"];
        arguments.extend(options);
        let report: Value = serde_json::from_str(&folder.expect(0, &arguments).stdout).unwrap();
        let figure = |name: &str| report["distortion"][name].as_f64().unwrap();
        (figure("tau"), figure("symmetric_dirichlet"))
    };
    let (plain, polished) = (distortion(&["--no-tau-polish"]), distortion(&[]));
    assert!(polished.0 < plain.0, "{polished:?} {plain:?}");
    // The least energy is at most that of the plain map.
    assert!(polished.1 <= 1.003 * plain.1);
    let generous = distortion(&["--max-energy-rise", "0.05"]);
    assert!(generous.0 <= polished.0);
    // No time at all is the plain map.
    assert_eq!(distortion(&["--polish-time", "1e-9"]), plain);
    let both = ["map", "in.off", "-o", "map.obj", "--no-tau-polish", "--polish-time", "1"];
    folder.expect(2, &both);
}

#[test]
fn a_fast_map_stops_short_of_the_minimum() {
    let folder = Folder::new();
    folder.write("in.off", off(&testkit::bumpy(&testkit::icosphere(5), 0.1, 5)));
    let map = |options: &[&str]| {
        let mut arguments = vec!["map", "in.off", "-o", "map.obj", "--json"];
        arguments.extend(options);
        let report: Value = serde_json::from_str(&folder.expect(0, &arguments).stdout).unwrap();
        let stages = report["components"][0]["stages"].as_array().unwrap().clone();
        let iterations = |name: &str| {
            let of_stage = stages.iter().filter(|stage| stage["stage"] == name);
            of_stage.map(|stage| stage["iterations"].as_u64().unwrap()).sum::<u64>()
        };
        let energy = report["distortion"]["symmetric_dirichlet"].as_f64().unwrap();
        (iterations("layout"), iterations("polish"), energy)
    };
    let (full, fast) = (map(&["--no-tau-polish"]), map(&["--fast"]));
    assert!(fast.0 < full.0 && fast.1 == 0, "{fast:?} {full:?}");
    // Seen: 4.029 and 4.033.
    assert!(fast.2 < 4.0 + 1.5 * (full.2 - 4.0), "{fast:?} {full:?}");
    folder.expect(2, &["map", "in.off", "-o", "map.obj", "--fast", "--max-energy-rise", "0.1"]);
}

#[test]
fn quiet_is_quiet() {
    let folder = Folder::new();
    folder.write("in.obj", format!("vn 0 0 1\n{}", obj(&testkit::cube())));
    let run = folder.expect(0, &["map", "in.obj", "-o", "a.obj"]);
    assert_eq!(run.stderr, "note: 1 vertex normal ignored\n");
    let run = folder.expect(0, &["map", "in.obj", "-o", "a.obj", "--quiet"]);
    assert_eq!((run.stdout, run.stderr), (String::new(), String::new()));
}

#[test]
fn polygons_are_split_and_that_is_said() {
    let folder = Folder::new();
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    folder.write("quads.obj", cube);
    let run = folder.expect(0, &["map", "quads.obj", "-o", "map.obj"]);
    assert_eq!(run.stderr, "note: 6 quads split into triangles\n");
    let map = folder.read("map.obj");
    assert_eq!(bare_faces(&map).len(), 12);
    assert_eq!(bare_faces(&map)[..2], ["4 3 2", "4 2 1"]);
    folder.expect(0, &["check", "quads.obj", "map.obj"]);
}

#[test]
fn repairs_are_listed_and_the_map_is_of_the_repaired_mesh() {
    let folder = Folder::new();
    let mut soup = testkit::octahedron();
    soup.faces[3].swap(0, 1);
    soup.faces.push(soup.faces[0]);
    soup.positions.push([9.0; 3]);
    folder.write_obj("in.obj", &soup);
    let refused = folder.expect(1, &["map", "in.obj", "-o", "map.obj"]);
    assert!(refused.stderr.contains("face 8 is a copy of face 0"), "{refused:?}");
    assert!(refused.stderr.contains("add `--repair`"), "{refused:?}");
    let run =
        folder.expect(0, &["map", "in.obj", "-o", "map.obj", "--repair", "--report", "r.json"]);
    for line in [
        "repair: dropped face 8, a copy of face 0",
        "repair: turned over face 3",
        "repair: dropped vertex 6 in no face",
        "note: the result is of the repaired mesh",
    ] {
        assert!(run.stderr.contains(line), "{line} in {}", run.stderr);
    }
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    assert_eq!(report["input"]["repairs"].as_array().unwrap().len(), 3);
    let map = folder.read("map.obj");
    assert_eq!((lines_of(&map, "v").len(), bare_faces(&map).len()), (6, 8));
    folder.expect(1, &["check", "in.obj", "map.obj"]);
    folder.expect(0, &["check", "in.obj", "map.obj", "--repair"]);
}

#[test]
fn mixed_integer_rounding_reports_incumbents_and_bounds() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::bumpy(&testkit::icosphere(1), 0.1, 7));
    let map = ["map", "in.obj", "-o", "map.obj", "--rounding", "mixed-integer"];
    let run = folder.expect(0, &[&map[..], &["--batch", "20", "--nodes", "15", "--json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["lab"]["rounding"], "mixed-integer");
    assert_eq!(report["lab"]["batch"], 20);
    let batches = report["components"][0]["mixed_integer"]["batches"].as_array().unwrap();
    assert!(batches.len() >= 2);
    for batch in batches {
        let figure = |name: &str| batch[name].as_f64();
        assert!(batch["integers"].as_u64().unwrap() <= 20);
        assert!(batch["nodes"].as_u64().unwrap() <= 15);
        assert!(figure("tau").is_none_or(|tau| figure("bound").unwrap() <= tau), "{batch}");
    }
    folder.expect(0, &["check", "in.obj", "map.obj"]);
    let run = folder.expect(0, &[&map[..], &["--rounding-time", "0.000001"]].concat());
    assert!(run.stdout.contains("certificate  passed"), "{}", run.stdout);
    let features = [&map[..], &["--features", "angle:40"]].concat();
    assert!(folder.expect(2, &features).stderr.contains("mixed-integer"));
}

#[test]
fn what_a_mesh_carries_stays_in_its_map_and_comes_over_to_its_quads() {
    let folder = Folder::new();
    let soup = testkit::cube();
    let faces = soup.faces.iter().enumerate().map(|(f, face)| {
        let material = if f < 2 { "usemtl red\n" } else { "usemtl blue\n" };
        let [a, b, c] = face.map(|v| v + 1);
        format!("{material}f {a}/1 {b}/2 {c}/3\n")
    });
    let faces: String = faces.collect();
    let vertices: String =
        soup.positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let text = format!("mtllib paint.mtl\n{vertices}vt 0 0\nvt 1 0\nvt 0 1\n{faces}");
    folder.write("in.obj", text);
    folder.expect(0, &["map", "in.obj", "-o", "map.obj"]);
    let map = folder.read("map.obj");
    assert_eq!(lines_of(&map, "usemtl"), ["red", "blue"]);
    assert_eq!(lines_of(&map, "mtllib"), ["paint.mtl"]);
    folder.expect(0, &["check", "in.obj", "map.obj"]);
    folder.expect(0, &["map", "in.obj", "-o", "map.glb", "--uv-set", "second"]);
    folder.expect(0, &["quad", "map.glb", "--quads", "54", "-o", "q.obj"]);
    let quads = folder.read("q.obj");
    let n_red = quads
        .split("usemtl ")
        .filter(|part| part.starts_with("red"))
        .map(|part| part.matches("\nf ").count());
    let n_faces = lines_of(&quads, "f").len();
    assert_eq!((6 * n_red.sum::<usize>(), n_faces % 6), (n_faces, 0));
    assert!(!lines_of(&quads, "vt").is_empty());
}

#[test]
fn packed_charts_are_in_the_unit_square_and_the_map_is_still_seamless() {
    let folder = Folder::new();
    let pair = [testkit::cube(), testkit::bumpy(&testkit::icosphere(2), 0.1, 1)];
    folder.write("in.obj", obj(&testkit::disjoint_union(&pair)));
    let arguments = ["map", "in.obj", "-o", "map.obj", "--pack=256", "--report", "map.json"];
    let run = folder.expect(0, &arguments);
    assert!(run.stdout.contains("texture      256 by 256 texels, 4 between charts"), "{run:?}");
    let report: Value = serde_json::from_str(&folder.read("map.json")).unwrap();
    let packing = &report["packing"];
    let covered = packing["covered"].as_f64().unwrap();
    assert!((0.2..1.0).contains(&covered), "{packing}");
    assert!(packing["charts"].as_u64() >= packing["islands"].as_u64(), "{packing}");
    let map = folder.read("map.obj");
    let margin = 4.0 / 256.0 - 1e-12;
    for uv in lines_of(&map, "vt") {
        let inside = |x: &str| (margin..=1.0 - margin).contains(&x.parse::<f64>().unwrap());
        assert!(uv.split(' ').all(inside), "{uv}");
    }
    folder.expect(0, &["check", "in.obj", "map.obj"]);
    // The same distortion as without.
    let plain = folder.expect(0, &["map", "in.obj", "-o", "plain.obj", "--json"]);
    let plain: Value = serde_json::from_str(&plain.stdout).unwrap();
    assert_eq!(plain["distortion"], report["distortion"]);
    let full = folder.expect(2, &["map", "in.obj", "-o", "full.obj", "--pack=8"]);
    assert!(full.stderr.contains("texels do not fit into 8 by 8 texels"), "{full:?}");
    let quads = folder.expect(2, &["quad", "in.obj", "--quads", "50", "-o", "q.obj", "--pack"]);
    assert!(quads.stderr.contains("only charts of seamless maps are packed"), "{quads:?}");
}
