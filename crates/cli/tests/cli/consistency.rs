//! `repair-matchings`, and `map --from` a broken map.

use crate::harness::Folder;
use seamstress_testkit as testkit;
use serde_json::Value;

/// A good map with some UVs moved so far that triangles fold over.
fn break_map(map: &str) -> String {
    let mut seen = 0;
    let lines = map.lines().map(|line| {
        let Some(rest) = line.strip_prefix("vt ") else { return line.to_owned() };
        seen += 1;
        match seen % 40 {
            20 => {
                let uv: Vec<f64> = rest.split_whitespace().map(|x| x.parse().unwrap()).collect();
                format!("vt {} {}", uv[0] + 0.4, uv[1] - 0.3)
            }
            _ => line.to_owned(),
        }
    });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn a_broken_map_is_recovered() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::bumpy(&testkit::icosphere(2), 0.1, 3));
    folder.expect(0, &["map", "in.obj", "-o", "good.obj"]);
    folder.write("broken.obj", break_map(&folder.read("good.obj")));
    folder.expect(1, &["check", "in.obj", "broken.obj"]);
    folder.expect(0, &["map", "in.obj", "--from", "broken.obj", "-o", "map.obj"]);
    folder.expect(0, &["check", "in.obj", "map.obj"]);

    // The same matchings by hand: consistent ones in a file, and a map from these.
    let run = folder.expect(
        0,
        &[
            "repair-matchings",
            "in.obj",
            "--from",
            "broken.obj",
            "-o",
            "m.matching",
            "--sing",
            "m.sing",
            "--json",
        ],
    );
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    let (objective, bound) =
        (report["objective"].as_f64().unwrap(), report["lower_bound"].as_f64().unwrap());
    assert!(0.0 <= bound && bound <= objective, "{bound} {objective}");
    let sum: i64 =
        report["cones"].as_array().unwrap().iter().map(|c| c["index"].as_i64().unwrap()).sum();
    assert_eq!(sum, 8);
    folder.expect(
        0,
        &["map", "in.obj", "--matching", "m.matching", "-o", "again.obj", "--sing", "again.sing"],
    );
    // A file of matchings modulo 4 keeps the indices modulo 4.
    let residues = |name: &str| -> Vec<(u32, i32)> {
        let text = folder.read(name);
        let rows = text.lines().skip(1).map(|line| line.split_once(' ').unwrap());
        let rows = rows.map(|(v, k)| (v.parse().unwrap(), k.parse::<i32>().unwrap().rem_euclid(4)));
        rows.filter(|&(_, k)| k != 0).collect()
    };
    assert_eq!(residues("again.sing"), residues("m.sing"));
}

#[test]
fn a_map_of_another_mesh_and_missing_input_are_refused() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::octahedron());
    folder.write_obj("other.obj", &testkit::cube());
    folder.expect(0, &["map", "other.obj", "-o", "map.obj"]);
    folder.expect(1, &["map", "in.obj", "--from", "map.obj", "-o", "out.obj"]);
    folder.expect(1, &["repair-matchings", "in.obj", "--from", "map.obj", "-o", "m.matching"]);
    folder.expect(2, &["repair-matchings", "in.obj", "-o", "m.matching"]);
    assert_eq!(folder.names(), ["in.obj", "map.obj", "other.obj"]);
}

/// A regular tetrahedron unfolded into a triangle twice its size: every vertex has index 2.
const UNFOLDED: &str = "\
v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1
vt 0 0\nvt 1 0\nvt 0.5 0.8660254037844386
vt 0.5 -0.8660254037844386\nvt -0.5 0.8660254037844386\nvt 1.5 0.8660254037844386
f 1/1 2/2 3/3\nf 1/1 4/4 2/2\nf 1/1 3/3 4/5\nf 2/2 4/6 3/3\n";

#[test]
fn matchings_are_constant_integers_or_real_numbers() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::tetrahedron());
    folder.write("map.obj", UNFOLDED);
    folder
        .expect(0, &["field", "in.obj", "map.obj", "-o", "f.rawfield", "--matching", "m.matching"]);
    // A quarter more across the edge between vertices 0 and 1: their indices become 1 and 3.
    let matching = folder.read("m.matching");
    assert!(matching.contains("0 1 0 1 0\n"), "{matching}");
    folder.write("m.matching", matching.replace("0 1 0 1 0\n", "0 1 0 1 1\n"));
    let start = ["repair-matchings", "in.obj", "--field", "f.rawfield", "--matching", "m.matching"];
    let repaired = |more: &[&str]| -> Value {
        let run = folder.expect(0, &[&start[..], &["-o", "out.matching", "--json"], more].concat());
        serde_json::from_str(&run.stdout).unwrap()
    };
    let all = repaired(&[]);
    assert_eq!(all["stats"]["changed_matchings"], 1);
    assert!(all["objective"].as_f64().unwrap() < 1e-12);
    assert_eq!(all["optimal"], true);

    // Nothing may change: two vertices are a quarter off, and the Laplacian of a regular tetrahedron is 8/3.
    let constant = repaired(&["--constant-edges", "edges:0-1,0-2,0-3,1-2,1-3,2-3"]);
    let quarter = std::f64::consts::FRAC_PI_2;
    let objective = constant["objective"].as_f64().unwrap();
    assert!((objective - 0.75 * quarter * quarter).abs() < 1e-9, "{objective}");
    assert_eq!(constant["stats"]["changed_matchings"], 0);
    assert_eq!(constant["optimal"], true);
    assert!(folder.read("out.matching").contains("0 1 0 1 1\n"));

    // The one real matching goes back by the quarter: to one full turn, by which the frames differ there.
    folder.write("rest.pairs", "0 2\n0 3\n1 2\n1 3\n2 3\n");
    let sets = ["--constant-edges", "pairs:rest.pairs", "--real-edges", "edges:0-1"];
    let real = repaired(&sets);
    assert!(real["objective"].as_f64().unwrap() < 1e-12);
    assert_eq!(real["stats"]["changed_matchings"], 0);
    let found = real["real_matchings"].as_array().unwrap();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0]["vertices"], serde_json::json!([0, 1]));
    assert!((found[0]["matching"].as_f64().unwrap() - 4.0).abs() < 1e-9);

    let both = ["-o", "o.matching", "--constant-edges", "edges:1-0", "--real-edges", "edges:0-1"];
    let run = folder.expect(2, &[&start[..], &both].concat());
    assert!(run.stderr.contains("cannot be both constant and real"), "{}", run.stderr);
}
