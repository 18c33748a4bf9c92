//! From integer maps to quad meshes.

use crate::harness::{Folder, lines_of};
use seamstress_io::attributes::{Attribute, AttributeDomain, AttributeKind};
use seamstress_io::{Format, Polymesh};
use seamstress_testkit as testkit;
use seamstress_testkit::{IntegerMap, cube, disk_grid, slab_with_holes, squares, torus};
use serde_json::Value;
use std::collections::BTreeSet;

fn write_map(folder: &Folder, name: &str, map: &IntegerMap) {
    let mut bytes = Vec::new();
    let IntegerMap { soup, corner_uvs } = map;
    let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Uv);
    let uvs = Attribute::new("map", domain, kind, 2, corner_uvs.as_flattened().to_vec());
    let (positions, polygons, attributes) = (&soup.positions, &soup.faces, &vec![uvs].into());
    let obj = Polymesh { positions, polygons, attributes, comments: &[] };
    obj.write(&mut bytes, Format::Obj).unwrap();
    folder.write(name, bytes);
}

#[test]
fn a_map_becomes_quads_with_report_and_picture() {
    let folder = Folder::new();
    write_map(&folder, "map.obj", &squares(&slab_with_holes(1), 3).with_random_charts(9, 1));
    let run = folder.expect(
        0,
        &["extract", "map.obj", "-o", "q.obj", "--report", "q.json", "--picture", "q.png"],
    );
    let n = 9 * slab_with_holes(1).faces.len() / 2;
    assert_eq!(run.stderr, "");
    assert!(run.stdout.contains("Euler characteristic 0"), "{}", run.stdout);
    assert_eq!(lines_of(&folder.read("q.obj"), "f").len(), n);
    assert_eq!(folder.names(), ["map.obj", "q.json", "q.obj", "q.png"]);
    let report: Value = serde_json::from_str(&folder.read("q.json")).unwrap();
    assert_eq!(report["quads"]["count"], n);
    assert_eq!(report["quads"]["is_manifold"], true);
    assert_eq!(report["quads"]["irregular"]["by_valence"]["3"], 8);
    assert_eq!(report["map"]["uv_area"], n as f64);
    let again = folder.expect(0, &["quality", "q.obj", "--json"]);
    assert!(again.stdout.contains(&n.to_string()));
}

#[test]
fn quads_are_written_in_the_formats_that_are_read_and_in_no_other() {
    let folder = Folder::new();
    write_map(&folder, "map.obj", &squares(&cube(), 2));
    folder.expect(0, &["extract", "map.obj", "-o", "q.ply", "--quiet"]);
    folder.expect(0, &["layout-quads", "q.ply", "-o", "back.obj"]);
    folder.expect(0, &["extract", "back.obj", "-o", "again.obj", "--quiet"]);
    assert_eq!(lines_of(&folder.read("again.obj"), "f").len(), 24);
    let run = folder.expect(2, &["extract", "map.obj", "-o", "q.fbx"]);
    assert!(run.stderr.contains("in .obj, .off, .ply, .stl or .glb"), "{run:?}");
    for (arguments, refusal) in [
        (
            ["-o", "q.fbx"].as_slice(),
            "quad meshes are written as OBJ, OFF, PLY, STL or GLB, not FBX",
        ),
        (&["-o", "q.obj", "--picture", "q.jpg"], "pictures are written as PNG, not JPG"),
    ] {
        let run = folder.expect(2, &[&["extract", "map.obj"], arguments].concat());
        assert!(run.stderr.contains(refusal), "{run:?}");
    }
}

#[test]
fn features_keep_their_vertices() {
    let folder = Folder::new();
    // A slanted cube, on which smoothing has something to do.
    let mut map = squares(&cube(), 4);
    map.soup.positions.iter_mut().for_each(|p| p[0] += 0.5 * p[1]);
    write_map(&folder, "map.obj", &map);
    let on_creases = |arguments: &[&str]| {
        let smooth = ["extract", "map.obj", "-o", "q.obj", "--smooth", "5", "--json"];
        let run = folder.expect(0, &[&smooth[..], arguments].concat());
        let is_on = |coordinates: &&str| {
            let numbers = coordinates.split_whitespace().map(|x| x.parse::<f64>().unwrap());
            let [x, y, z] = numbers.collect::<Vec<_>>()[..] else { panic!("{coordinates}") };
            let is_side = |x: &f64| (x - x.round()).abs() < 1e-12;
            [x - 0.5 * y, y, z].iter().filter(|x| is_side(x)).count() > 1
        };
        let quads = folder.read("q.obj");
        let report: Value = serde_json::from_str(&run.stdout).unwrap();
        (
            lines_of(&quads, "v").into_iter().filter(is_on).count(),
            report["features"]["edges"].clone(),
        )
    };
    let (all, edges) = on_creases(&["--features", "angle:60"]);
    assert_eq!((all, edges), (8 + 12 * 3, 12.into()));
    let (left, edges) = on_creases(&[]);
    assert!(left < all && edges.is_null(), "{left}");
    let run = folder.expect(1, &["extract", "map.obj", "-o", "q.obj", "--features", "pairs:none"]);
    assert!(run.stderr.contains("none"), "{run:?}");
}

#[test]
fn maps_that_are_not_integral_are_refused() {
    let folder = Folder::new();
    let mut map = squares(&torus(4, 4, 2.0, 0.7), 1);
    map.corner_uvs[..6].iter_mut().for_each(|uv| uv[0] += 0.4);
    write_map(&folder, "map.obj", &map);
    let run = folder.expect(1, &["extract", "map.obj", "-o", "q.obj"]);
    assert!(run.stderr.contains("has the translation"), "{run:?}");
    assert!(run.stderr.contains("`seamstress integer`"), "{run:?}");
    folder.write_obj("plain.obj", &cube());
    let run = folder.expect(1, &["extract", "plain.obj", "-o", "q.obj"]);
    assert!(run.stderr.contains("not a map"), "{run:?}");
    assert_eq!(folder.names(), ["map.obj", "plain.obj"]);
}

#[test]
fn folds_are_refused_unless_asked_for() {
    let folder = Folder::new();
    let mut map = squares(&cube(), 4).with_random_points(1);
    let middle = map.corner_uvs[2];
    let images = map.corner_uvs[..9].iter_mut();
    images.filter(|uv| **uv == middle).for_each(|uv| *uv = [1.9, 2.4]);
    write_map(&folder, "map.obj", &map);
    let run = folder.expect(1, &["extract", "map.obj", "-o", "q.obj"]);
    assert!(run.stderr.contains("1 flipped face: 2"), "{run:?}");
    assert_eq!(folder.names(), ["map.obj"]);
    let run = folder.expect(0, &["extract", "map.obj", "-o", "q.obj", "--best-effort"]);
    assert!(run.stderr.contains("warning: the map folds: 1 flipped face"), "{run:?}");
    assert_eq!(lines_of(&folder.read("q.obj"), "f").len(), 96);
}

#[test]
fn trimmed_cells_are_told() {
    let folder = Folder::new();
    let mut map = squares(&disk_grid(1, 1), 1);
    map.corner_uvs.as_flattened_mut().iter_mut().for_each(|x| *x *= 2.5);
    write_map(&folder, "map.obj", &map);
    let run = folder.expect(0, &["extract", "map.obj", "-o", "q.obj"]);
    assert_eq!(run.stderr, "note: 5 cells cut by the boundary left out\n");
    assert_eq!(lines_of(&folder.read("q.obj"), "f").len(), 4);
}

#[test]
fn a_torus_of_one_quad_is_no_manifold() {
    let folder = Folder::new();
    let mut map = squares(&torus(3, 3, 2.0, 0.7), 1);
    // Nine squares become one: a third of each.
    let corner = |quad: usize| [(quad / 3) as f64 / 3.0, (quad % 3) as f64 / 3.0];
    for (at, uv) in map.corner_uvs.iter_mut().enumerate() {
        let [u, v] = corner(at / 6);
        *uv = [u + uv[0] / 3.0, v + uv[1] / 3.0];
    }
    write_map(&folder, "map.obj", &map);
    let run = folder.expect(3, &["extract", "map.obj", "-o", "q.obj"]);
    assert!(run.stderr.contains("the quads are no manifold: quad 0 has vertex"), "{run:?}");
    assert_eq!(folder.names(), ["map.obj"]);
}

#[test]
fn smoothing_keeps_the_quads() {
    let folder = Folder::new();
    write_map(&folder, "map.obj", &squares(&torus(8, 5, 2.0, 0.7), 2));
    folder.expect(0, &["extract", "map.obj", "-o", "raw.obj", "--quiet"]);
    folder.expect(0, &["extract", "map.obj", "-o", "smooth.obj", "--smooth", "5", "--quiet"]);
    let [raw, smooth] = ["raw.obj", "smooth.obj"].map(|name| folder.read(name));
    assert_eq!(lines_of(&raw, "f"), lines_of(&smooth, "f"));
    assert_ne!(lines_of(&raw, "v"), lines_of(&smooth, "v"));
}

/// The maps that libQEx is tested with.
#[test]
fn maps_with_folds_from_the_collection() {
    let Some(map) = testkit::in_collection("duck_miq_4_param.obj") else { return };
    let folder = Folder::new();
    let map = map.to_string_lossy();
    let run = folder.expect(1, &["extract", &map, "-o", "q.obj"]);
    assert!(run.stderr.contains("18 flipped faces: 4640, 4642, 5103, 6051, 8140 ..."), "{run:?}");
    let run = folder.expect(0, &["extract", &map, "-o", "q.obj", "--best-effort", "--json"]);
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["quads"]["vertices"], 1075);
    assert_eq!(report["quads"]["is_manifold"], true);
    assert_eq!(report["map"]["uv_area"], 1073.0);
}

/// Vertices and quads of an OBJ file.
fn quads_of(text: &str) -> (Vec<[f64; 3]>, Vec<[usize; 4]>) {
    let positions = lines_of(text, "v").into_iter().map(|line| {
        let mut numbers = line.split_whitespace().map(|x| x.parse().unwrap());
        [(); 3].map(|()| numbers.next().unwrap())
    });
    let quads = lines_of(text, "f").into_iter().map(|line| {
        let mut corners = line.split_whitespace().map(|c| c.split('/').next().unwrap());
        [(); 4].map(|()| corners.next().unwrap().parse::<usize>().unwrap() - 1)
    });
    (positions.collect(), quads.collect())
}

/// For each vertex of ours one of theirs at the same place, to the digits of the files.
fn same_places(ours: &[[f64; 3]], theirs: &[[f64; 3]]) -> Vec<Option<usize>> {
    let distance =
        |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
    let far = theirs.iter().map(|&q| distance(theirs[0], q)).fold(0.0, f64::max);
    let found = |&p: &[f64; 3]| theirs.iter().position(|&q| distance(p, q) < 1e-5 * far);
    ours.iter().map(found).collect()
}

/// What of the quad meshes that libQEx makes of its test maps is found again; chapter 9 says why not all.
#[test]
fn quads_of_folded_maps_compared_with_those_of_libqex() {
    let Some(collection) = testkit::in_collection("") else { return };
    // Coarseness; quads, vertices, boundary loops, by valence; vertices and quads that libQEx has too.
    let cases = [
        (4, [1071, 1075, 1], [(3, 21), (5, 12)].as_slice(), [1065, 1031]),
        (16, [47, 61, 3], &[(2, 1), (3, 7), (5, 2)], [39, 17]),
        (28, [10, 19, 1], &[(3, 2)], [11, 2]),
    ];
    let folder = Folder::new();
    for (coarseness, counts, by_valence, same) in cases {
        let map = collection.join(format!("duck_miq_{coarseness}_param.obj"));
        let map = map.to_string_lossy();
        let run = folder.expect(0, &["extract", &map, "-o", "q.obj", "--best-effort", "--json"]);
        let report: Value = serde_json::from_str(&run.stdout).unwrap();
        let found = ["count", "vertices", "boundary_loops"].map(|n| report["quads"][n].as_u64());
        assert_eq!(found, counts.map(Some), "{coarseness}");
        let irregular = report["quads"]["irregular"]["by_valence"].as_object().unwrap();
        let irregular: Vec<(usize, u64)> =
            irregular.iter().map(|(v, n)| (v.parse().unwrap(), n.as_u64().unwrap())).collect();
        assert_eq!(irregular, by_valence, "{coarseness}");

        let expected = collection.join(format!("duck_miq_{coarseness}_quad.obj"));
        let theirs = quads_of(&std::fs::read_to_string(expected).unwrap());
        let ours = quads_of(&folder.read("q.obj"));
        let place = same_places(&ours.0, &theirs.0);
        let sorted = |mut quad: [usize; 4]| {
            quad.sort_unstable();
            quad
        };
        let known: BTreeSet<[usize; 4]> = theirs.1.into_iter().map(sorted).collect();
        let at_known = ours.1.iter().filter_map(|quad| {
            let corners = quad.map(|v| place[v]);
            corners.iter().all(Option::is_some).then(|| corners.map(Option::unwrap))
        });
        let at_known: Vec<[usize; 4]> = at_known.map(sorted).collect();
        let common = at_known.iter().filter(|quad| known.contains(*quad)).count();
        assert_eq!([place.iter().flatten().count(), common], same, "{coarseness}");
        if coarseness == 4 {
            assert_eq!(
                common,
                at_known.len(),
                "a quad at known vertices that libQEx does not have"
            );
        }
    }
}
