//! Finer meshes of the same surface.
#![allow(clippy::unwrap_used)]

use seamstress_mesh::features::{EdgeSet, sharp_edges};
use seamstress_mesh::refine::{Refinement, refine};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh, Vertex};
use seamstress_testkit::{extruded, icosphere, parts, pyramid, subdivide, torus};
use std::collections::BTreeSet;

/// A mesh and its edges of 40 degrees and more, with the boundary.
fn read(soup: &TriangleSoup) -> (TriMesh, EdgeSet) {
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let sharp = sharp_edges(&mesh, &soup.positions, 40f64.to_radians());
    let edges = sharp.union(&mesh, &EdgeSet::boundary(&mesh));
    (mesh, edges)
}

fn length(positions: &[[f64; 3]], [a, b]: [u32; 2]) -> f64 {
    let (a, b) = (positions[a as usize], positions[b as usize]);
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

fn area(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> f64 {
    let mesh = TriMesh::from_faces(positions.len(), faces).unwrap();
    Metric::from_positions(&mesh, positions).side().powi(2)
}

/// What must hold of every finer mesh.
fn check(name: &str, soup: &TriangleSoup, size: f64) -> Option<Refinement> {
    let (mesh, edges) = read(soup);
    let finer = refine(&mesh, &soup.positions, &edges, size)?;
    assert_eq!(finer.positions[..soup.positions.len()], soup.positions[..], "{name}");
    assert_eq!(finer.faces.len(), finer.face_origin.len());
    let fine = TriMesh::from_faces(finer.positions.len(), &finer.faces).unwrap();
    assert_eq!(fine.euler_characteristic(), mesh.euler_characteristic(), "{name}");
    assert_eq!(fine.n_boundary_loops(), mesh.n_boundary_loops(), "{name}");
    let [before, after] = [(&soup.positions, &soup.faces), (&finer.positions, &finer.faces)]
        .map(|(positions, faces)| area(positions, faces));
    assert!((after / before - 1.0).abs() < 1e-6, "{name}: area {before} became {after}");
    // The pieces of features are edges, and as long as what they are pieces of.
    let total =
        |pairs: &[[u32; 2]]| pairs.iter().map(|&e| length(&finer.positions, e)).sum::<f64>();
    let pieces: Vec<[u32; 2]> = finer.features.iter().map(|piece| piece.vertices).collect();
    for &[a, b] in &pieces {
        assert!(fine.edge_between(Vertex(a), Vertex(b)).is_some(), "{name}");
    }
    let wanted = total(&edges.vertex_pairs(&mesh));
    assert!((total(&pieces) - wanted).abs() < 1e-9 * (1.0 + wanted), "{name}");
    Some(finer)
}

#[test]
fn all_parts_have_finer_meshes_of_the_same_surface() {
    for (name, part) in parts() {
        check(&name, &part, 0.2);
    }
}

#[test]
fn every_side_of_a_house_gets_vertices_inside() {
    // A gable has five corners and no vertex inside for the sixth quarter turn.
    let front = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.8], [0.5, 1.3], [0.0, 0.8]];
    let finer = check("house", &extruded(&front, 1.4), 10.0).unwrap();
    let fine = TriMesh::from_faces(finer.positions.len(), &finer.faces).unwrap();
    let ends: BTreeSet<u32> = finer.features.iter().flat_map(|piece| piece.vertices).collect();
    let normal = |face: [u32; 3]| {
        let [a, b, c] = face.map(|v| finer.positions[v as usize]);
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let cross = [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            u[i] * v[j] - u[j] * v[i]
        });
        let size = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
        cross.map(|x| (1e3 * x / size).round() as i64)
    };
    let has_inner = |face: &&[u32; 3]| face.iter().any(|v| !ends.contains(v));
    let sides: BTreeSet<[i64; 3]> =
        finer.faces.iter().filter(has_inner).map(|&face| normal(face)).collect();
    assert_eq!(sides.len(), 7);
    assert!(fine.n_faces() < 500);
}

#[test]
fn a_smooth_mesh_stays_as_it_is() {
    for soup in [icosphere(3), subdivide(&icosphere(2))] {
        assert_eq!(check("sphere", &soup, 0.1), None);
    }
}

#[test]
fn coincident_vertices_become_one() {
    // The apex of a pyramid twice, with two triangles without area between.
    let mut soup = pyramid(6, 1.0);
    let twin = soup.positions.len() as u32;
    soup.positions.push(soup.positions[6]);
    // The sides 0 to 2 meet at the apex, 3 to 5 at its twin.
    for side in 3..6 {
        soup.faces[side] = soup.faces[side].map(|v| if v == 6 { twin } else { v });
    }
    soup.faces.extend([[6, 3, twin], [6, twin, 0]]);
    let (mesh, _) = read(&soup);
    let none = EdgeSet::new(&mesh, []);
    let finer = refine(&mesh, &soup.positions, &none, 1.0).unwrap();
    assert!(!finer.faces.as_flattened().contains(&twin));
    let clean = pyramid(6, 1.0);
    assert!(
        (area(&finer.positions, &finer.faces) / area(&clean.positions, &clean.faces) - 1.0).abs()
            < 1e-9
    );
}

#[test]
fn a_sheet_of_two_sides_has_a_finer_mesh() {
    // A tetrahedron without height: the triangles of both sides have the same border.
    let mut sheet = seamstress_testkit::tetrahedron();
    sheet.positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, 0.0]];
    assert!(check("sheet", &sheet, 0.1).is_some());
}

#[test]
fn what_is_narrow_everywhere_gets_no_more_points_than_others() {
    // A torus as long as a million of its widths, all of whose edges are features.
    let mut torus = torus(12, 8, 2.0, 0.7);
    torus.positions.iter_mut().for_each(|p| p[0] *= 1e6);
    let (mesh, _) = read(&torus);
    let all = EdgeSet::new(&mesh, mesh.edges());
    for size in [1e-3, 1.0, 1e3] {
        let finer = refine(&mesh, &torus.positions, &all, size).unwrap();
        assert!(finer.positions.len() < 50_000, "{size}: {} vertices", finer.positions.len());
    }
    // A triangle without area beside one with some.
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let soup = TriangleSoup { positions, faces: vec![[0, 2, 3], [0, 1, 2]] };
    let (mesh, edges) = read(&soup);
    let finer = refine(&mesh, &soup.positions, &edges, 0.5).unwrap();
    assert!(finer.positions.len() < 200, "{} vertices", finer.positions.len());
}
