//! The files of `tests/data` are those that the generator makes, byte for byte.
//!
//! `SEAMSTRESS_WRITE_DATA=1 cargo test --release -p seamstress-testkit --test data` writes them anew.
#![allow(clippy::unwrap_used)]

use seamstress_mesh::soup::{TriangleSoup, check};
use seamstress_testkit::data_meshes;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

#[test]
fn files_are_those_of_the_generator() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data");
    let write = std::env::var_os("SEAMSTRESS_WRITE_DATA").is_some_and(|value| value == "1");
    let mut names = BTreeSet::from(["README.md".to_owned()]);
    for mesh in data_meshes() {
        let (path, text) = (folder.join(mesh.file), mesh.text());
        if write {
            fs::write(&path, &text).unwrap();
        }
        let found = fs::read_to_string(&path).unwrap();
        assert!(found == text, "{} is not what the generator makes", path.display());
        names.insert(mesh.file.to_owned());
    }
    let files: BTreeSet<String> = fs::read_dir(&folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(files, names, "every file of the folder has a generator");
}

#[test]
fn the_read_me_lists_every_file() {
    let read_me = include_str!("../../../tests/data/README.md");
    for mesh in data_meshes() {
        let topology = [mesh.components, mesh.genus, mesh.boundary_loops];
        let [components, genus, loops] = topology.map(|n| n.to_string());
        let triangles = mesh.soup.triangles().faces.len();
        let row = format!(
            "| `{}` | {} | {triangles} | {components} | {genus} | {loops} |",
            mesh.file, mesh.kind
        );
        assert!(read_me.contains(&row), "missing in tests/data/README.md: {row}");
    }
}

/// The volume enclosed, positive if the faces look outwards.
fn volume(soup: &TriangleSoup) -> f64 {
    let determinant = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| soup.positions[v as usize]);
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    soup.faces.iter().map(determinant).sum::<f64>() / 6.0
}

#[test]
fn meshes_are_faultless_and_what_they_are_said_to_be() {
    for mesh in data_meshes() {
        let soup = mesh.soup.triangles();
        let report = check(&soup);
        assert_eq!(report.faults, [], "{}", mesh.file);
        let facts = report.facts;
        let genus: usize = facts.components.iter().map(|c| c.genus.unwrap()).sum();
        let found = [facts.components.len(), genus, facts.boundary_loops()];
        assert_eq!(found, [mesh.components, mesh.genus, mesh.boundary_loops], "{}", mesh.file);
        assert_eq!(facts.euler_characteristic(), mesh.euler_characteristic(), "{}", mesh.file);
        assert!((100..3000).contains(&facts.n_faces), "{}: {} faces", mesh.file, facts.n_faces);
        assert!(mesh.boundary_loops > 0 || volume(&soup) > 0.0, "{}", mesh.file);
    }
}
