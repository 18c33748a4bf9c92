//! `seamstress quad`.

use crate::harness::{Folder, lines_of, obj, off};
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
    let layout =
        json(&folder.expect(0, &["layout-quads", "q.obj", "-o", "m.obj", "--json"]).stdout);
    assert_eq!(
        (&layout["integer_error"], &layout["cones"]["by_index"]["1"]),
        (&json("0.0"), &json("8"))
    );
}

#[test]
fn every_format_has_the_same_quads() {
    let folder = Folder::new();
    folder.write_obj("torus.obj", &kit::torus(16, 10, 2.0, 0.8));
    let count = |name: &str| {
        folder.expect(0, &["quad", "torus.obj", "--quads", "200", "-o", name]);
        let inspected = json(&folder.expect(0, &["check", name, "--json"]).stdout);
        inspected["input"]["polygons_read"].as_u64().unwrap()
    };
    let quads = count("q.obj");
    for name in ["q.off", "q.ply", "q.obj.gz", "q.PLY.gz"] {
        assert_eq!(count(name), quads, "{name}");
    }
    assert_eq!(count("q.stl"), 2 * quads);
    let run = folder.expect(2, &["quad", "torus.obj", "--quads", "200", "-o", "q.fbx.gz"]);
    assert!(run.stderr.contains("OBJ, OFF, PLY, STL or GLB, not FBX"), "{run:?}");
}

#[test]
fn standard_input_and_output_stand_for_files() {
    let folder = Folder::new();
    let torus = kit::torus(16, 10, 2.0, 0.8);
    folder.write_obj("torus.obj", &torus);
    folder.write("torus.off", off(&torus));
    let arguments = ["quad", "-", "--quads", "200", "-o", "-"];
    for name in ["torus.obj", "torus.off"] {
        let run = folder.fed(name, &arguments);
        assert_eq!(run.code, Some(0), "{run:?}");
        // Nothing but the quads, and those of the file.
        assert!(run.stdout.lines().all(|line| ["#", "v", "f"].contains(&&line[..1])), "{run:?}");
        folder.expect(0, &["quad", name, "--quads", "200", "-o", "q.obj"]);
        let quads = |obj: &str| lines_of(obj, "f").join("\n");
        assert_eq!(quads(&run.stdout), quads(&folder.read("q.obj")));
    }
    let run = folder.fed("torus.obj", &[&arguments[..], &["--json"]].concat());
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{run:?}");
    folder.write("nothing", "");
    let run = folder.fed("nothing", &["check", "-"]);
    assert_eq!((run.code, run.stderr.trim_end()), (Some(1), "error: -: the file is empty"));
}

#[test]
fn a_format_that_the_content_does_not_tell_can_be_named() {
    let folder = Folder::new();
    // The first word is none of OBJ.
    let torus = obj(&kit::torus(16, 10, 2.0, 0.8));
    folder.write("torus", format!("maker 7\n{torus}"));
    let run = folder.fed("torus", &["check", "-"]);
    assert!(run.code == Some(1) && run.stderr.contains("`--format`"), "{run:?}");
    let run = folder.fed("torus", &["check", "-", "--format", "obj"]);
    assert!(run.code == Some(0) && run.stdout.contains("320 triangles"), "{run:?}");
    folder.expect(0, &["check", "torus", "--format", "obj"]);
    // What the content says plainly counts.
    folder.write("torus.txt", torus);
    let run = folder.expect(0, &["check", "torus.txt", "--format", "ply"]);
    assert!(run.stdout.contains("taken for PLY, but the content is OBJ"), "{run:?}");
}

#[test]
fn absurd_sizes_are_refused_at_once() {
    let folder = Folder::new();
    folder.write_obj("torus.obj", &kit::torus(16, 10, 2.0, 0.8));
    for size in [["--quads", "1e9"], ["--edge-length", "1e-6"], ["--scale", "1e6"]] {
        let run = folder.expect(2, &[&["quad", "torus.obj", "-o", "q.obj"][..], &size].concat());
        assert!(run.stderr.contains("more than fit into memory"), "{run:?}");
    }
    assert_eq!(folder.names(), ["torus.obj"]);
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
fn source_points_are_written_where_the_format_holds_them() {
    let folder = Folder::new();
    folder.write_obj("cube.obj", &kit::subdivide(&kit::cube()));
    let quad = ["quad", "cube.obj", "--quads", "100", "--source-points", "-o"];
    let to = |name: &'static str| [&quad[..], &[name]].concat();
    // A name without an ending has the one format that holds them.
    for name in ["q.ply", "q"] {
        folder.expect(0, &to(name));
        let ply = std::fs::read(folder.path(name)).unwrap();
        let header = String::from_utf8_lossy(&ply[..1000]).into_owned();
        for property in ["int source_face", "int source_vertex_2", "double source_weight_0"] {
            assert!(header.contains(&format!("property {property}\n")), "{header}");
        }
    }
    let refused = folder.expect(2, &to("q.obj"));
    assert!(refused.stderr.contains("source points are written as PLY, not OBJ"), "{refused:?}");
    assert_eq!(folder.names(), ["cube.obj", "q", "q.ply"]);
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

/// Lengths of the edges of quads that lie on segments, all together; each edge once.
fn covered(obj: &str, segments: &[[[f64; 3]; 2]]) -> f64 {
    let numbers = |line: &&str| -> [f64; 3] {
        let mut numbers = line.split_whitespace().map(|x| x.parse().unwrap());
        [(); 3].map(|()| numbers.next().unwrap())
    };
    let at: Vec<[f64; 3]> = lines_of(obj, "v").iter().map(numbers).collect();
    let mut edges = std::collections::BTreeSet::new();
    for line in lines_of(obj, "f") {
        let ring: Vec<usize> =
            line.split_whitespace().map(|x| x.parse::<usize>().unwrap() - 1).collect();
        assert_eq!(ring.len(), 4);
        for k in 0..4 {
            let (a, b) = (ring[k], ring[(k + 1) % 4]);
            edges.insert((a.min(b), a.max(b)));
        }
    }
    let distance = |a: [f64; 3], b: [f64; 3]| {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    };
    let is_on = |p: [f64; 3], [a, b]: [[f64; 3]; 2]| {
        (distance(a, p) + distance(p, b) - distance(a, b)).abs() < 1e-9
    };
    let on_one = |&&(a, b): &&(usize, usize)| {
        segments.iter().any(|&segment| is_on(at[a], segment) && is_on(at[b], segment))
    };
    edges.iter().filter(on_one).map(|&(a, b)| distance(at[a], at[b])).sum()
}

#[test]
fn quads_follow_the_edges_of_a_box() {
    let folder = Folder::new();
    let cuboid = kit::stretch(&kit::cube(), [1.0, 1.4, 2.3]);
    folder.write_obj("box.obj", &kit::subdivide(&kit::subdivide(&cuboid)));
    let sizes: Vec<(f64, f64)> = (0..3)
        .map(|k| {
            let along = || cuboid.positions.iter().map(|p| p[k]);
            (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max))
        })
        .collect();
    let corner =
        |c: usize| [0, 1, 2].map(|k| if c >> k & 1 == 0 { sizes[k].0 } else { sizes[k].1 });
    let segments: Vec<[[f64; 3]; 2]> = (0..8usize)
        .flat_map(|c| (0..3).filter(move |k| c >> k & 1 == 0).map(move |k| [c, c | 1 << k]))
        .map(|ends| ends.map(corner))
        .collect();
    let total: f64 = 4.0 * sizes.iter().map(|(low, high)| high - low).sum::<f64>();
    for quads in ["60", "700"] {
        let arguments = ["quad", "box.obj", "--quads", quads, "-o", "q.obj", "--json"];
        let report =
            json(&folder.expect(0, &[&arguments[..], &["--features", "angle:40"]].concat()).stdout);
        assert_eq!(report["quads"]["irregular"]["by_valence"]["3"], 8);
        assert_eq!(report["features"]["kept"], 48);
        let found = covered(&folder.read("q.obj"), &segments);
        assert!((found - total).abs() < 1e-6, "{found} of {total} at {quads}");
    }
}

#[test]
fn quads_reach_an_aligned_boundary() {
    let folder = Folder::new();
    folder.write_obj("square.obj", &kit::disk_grid(5, 5));
    let arguments = ["quad", "square.obj", "--quads", "90", "-o", "q.obj", "--json"];
    let report = json(&folder.expect(0, &[&arguments[..], &["--align-boundary"]].concat()).stdout);
    assert_eq!(report["quads"]["trimmed"], 0, "{}", report["quads"]);
    let rim = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x, y, 0.0]);
    let segments: Vec<[[f64; 3]; 2]> = (0..4).map(|k| [rim[k], rim[(k + 1) % 4]]).collect();
    let found = covered(&folder.read("q.obj"), &segments);
    assert!((found - 8.0).abs() < 1e-9, "{found}");
    // The same through an aligned map in a file.
    folder.expect(0, &["map", "square.obj", "--align-boundary", "-o", "m.obj"]);
    let arguments = ["integer", "square.obj", "m.obj", "--quads", "90", "-o", "i.obj", "--json"];
    let report = json(&folder.expect(0, &[&arguments[..], &["--align-boundary"]].concat()).stdout);
    assert_eq!(report["integer_certificate"]["isoline_edges"], 20);
    assert_eq!(report["integer_certificate"]["integral_corners"], 4);
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
    assert_eq!(report["orientation"], mended["orientation"]);
    assert_eq!(raw_report["orientation"], raw["orientation"]);
    let range =
        |of: &Value| of["angles"]["max"].as_f64().unwrap() - of["angles"]["min"].as_f64().unwrap();
    match report["mended"]["moved"].as_u64() {
        Some(0) => assert_eq!(folder.read("raw.obj"), folder.read("q.obj")),
        _ => assert!(range(&mended) < range(&raw), "{mended} {raw}"),
    }
}

#[test]
fn what_is_merged_and_what_gets_no_quads_is_said_by_every_command() {
    let folder = Folder::new();
    // A cube whose faces share no vertices, and a triangle smaller than a cell, and too thin for one of its own size.
    let mut soup = kit::subdivide(&kit::subdivide(&kit::cube()));
    let corners = soup.faces.concat();
    soup.positions = corners.iter().map(|&v| soup.positions[v as usize]).collect();
    soup.positions.extend([[9.0, 0.0, 0.0], [9.01, 0.0, 0.0], [9.0, 0.0005, 0.0]]);
    soup.faces =
        (0..soup.positions.len() as u32 / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    folder.write_obj("parts.obj", &soup);
    let said = |arguments: &[&str], words: &str| {
        let output = ["--features", "none", "-o", "out.obj"];
        let run = folder.expect(0, &[arguments, &output].concat());
        let line = run.stderr.lines().find(|line| line.contains(words)).map(str::to_owned);
        line.unwrap_or_else(|| panic!("{words} is not in {}", run.stderr))
    };
    let quad = ["quad", "parts.obj", "--quads", "100"];
    let integer = ["integer", "parts.obj", "--quads", "100"];
    let merged = said(&quad, "vertices in the place of another");
    assert_eq!(said(&integer, "merged"), merged);
    assert_eq!(said(&["map", "parts.obj"], "merged"), merged);
    let lost = said(&quad, "have no quads");
    assert!(lost.starts_with("warning: 1 of 2 components"), "{lost}");
    assert_eq!(said(&integer, "have no quads"), lost);
}

#[test]
fn views_need_a_picture_and_turn_it() {
    let folder = Folder::new();
    folder.write_obj("torus.obj", &kit::torus(16, 10, 2.0, 0.8));
    folder.expect(2, &["features", "torus.obj", "--view", "top"]);
    let picture = |view: &[&str]| {
        let arguments = ["features", "torus.obj", "--picture", "torus.png"];
        folder.expect(0, &[&arguments[..], view].concat());
        std::fs::read(folder.path("torus.png")).unwrap()
    };
    let pictures =
        [picture(&[]), picture(&["--view", "top"]), picture(&["--view", "top", "--up", "z"])];
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
}

#[test]
fn small_parts_are_counted() {
    let folder = Folder::new();
    let speck = kit::scale(&kit::cube(), 0.01);
    folder.write_obj("both.obj", &kit::disjoint_union(&[kit::cube(), speck]));
    let arguments = ["quad", "both.obj", "--quads", "600", "-o", "q.obj"];
    let run = folder.expect(0, &arguments);
    let row = "small parts  1 smaller than a cell, of 12 faces: ";
    assert!(run.stdout.contains(&format!("{row}each with a few cells of its own size")), "{run:?}");
    let run = folder.expect(0, &[&arguments[..], &["--small-parts", "drop"]].concat());
    assert!(run.stdout.contains(&format!("{row}left out")), "{run:#?}");
    assert_eq!(lines_of(&folder.read("q.obj"), "f").len(), 600);
}

#[test]
fn a_part_that_fails_is_named_and_the_others_are_quads_on_request() {
    let folder = Folder::new();
    // Twelve creases meet at the tip, where there is not even one quarter turn.
    let spike = kit::pyramid(12, 8.0);
    folder.write_obj("both.obj", &kit::disjoint_union(&[kit::cube(), spike]));
    let command = [
        "quad",
        "both.obj",
        "--quads",
        "200",
        "--features",
        "angle:20",
        "--features-strict",
        "-o",
        "q.obj",
    ];
    let run = folder.expect(3, &command);
    assert!(run.stderr.contains(" of 1 of 2 components:\n  component 1 ("), "{run:#?}");
    assert!(run.stderr.contains(" feature edges could not be aligned: "), "{run:#?}");
    assert!(run.stderr.ends_with("; `--partial` makes the other components\n"), "{run:#?}");
    assert_eq!(folder.names(), ["both.obj"]);

    let run = folder.expect(3, &[&command[..], &["--partial"]].concat());
    assert!(run.stdout.contains("\nfailed       component 1 ("), "{run:#?}");
    assert!(run.stdout.contains(" from face 12); left out\n"), "{run:#?}");
    let written = json(&folder.expect(0, &["check", "q.obj", "--json"]).stdout);
    assert_eq!(written["input"]["components"].as_array().map(Vec::len), Some(1));
}
