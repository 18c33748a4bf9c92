//! Large meshes, whose cones are looked for on coarser ones.

mod common;

use common::{cone_sum, mapped};
use seamstress_mesh::coarse::coarsen;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_testkit as kit;

fn subdivided(soup: TriangleSoup, times: usize) -> TriangleSoup {
    (0..times).fold(soup, |soup, _| kit::subdivide(&soup))
}

#[test]
fn a_cube_of_many_triangles_has_its_cones_at_its_corners() {
    let cube = subdivided(kit::cube(), 5);
    assert_eq!(cube.faces.len(), 12 * 1024);
    let solution = mapped(&cube);
    let cones: Vec<(u32, i32)> =
        solution.map.cones().iter().map(|cone| (cone.vertex, cone.index)).collect();
    // Subdivision keeps the first vertices.
    assert_eq!(cones, (0..8).map(|corner| (corner, 1)).collect::<Vec<_>>());
    assert!(solution.distortion.tau < 1.0 + 1e-6, "{}", solution.distortion.tau);
}

#[test]
fn cones_are_vertices_of_the_coarser_mesh() {
    let torus = kit::bumpy(&kit::torus(100, 60, 2.0, 0.8), 0.15, 3);
    assert_eq!(torus.faces.len(), 12_000);
    let solution = mapped(&torus);
    assert_eq!(cone_sum(&solution), 0);
    assert!(solution.distortion.symmetric_dirichlet < 4.2, "{:?}", solution.distortion);
    // No vertex of this one has the curvature of half a cone.
    let coarse = coarsen(&torus.positions, &torus.faces, 4000, &[]);
    let cones = solution.map.cones();
    assert!(!cones.is_empty() && cones.iter().all(|cone| coarse.vertices.contains(&cone.vertex)));
}

#[test]
fn handles_and_boundaries_keep_their_rotations() {
    let double = kit::bumpy(&subdivided(kit::double_torus(), 4), 0.05, 2);
    for soup in [double.clone(), kit::with_boundaries(&double, 5, 1)] {
        assert!(soup.faces.len() > 8000, "{}", soup.faces.len());
        let solution = mapped(&soup);
        assert!(solution.distortion.symmetric_dirichlet < 4.2, "{:?}", solution.distortion);
    }
}
