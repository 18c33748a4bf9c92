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
