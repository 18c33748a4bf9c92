//! What the integration tests share: shapes made meshes, maps, and a checker of their own.
#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::panic,
    reason = "every test binary uses a part of it"
)]

pub(crate) mod checker;
pub(crate) mod collection;

use checker::Found;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::Sectors;
use seamstress_parametrize::cut::MatchedCut;
use seamstress_parametrize::progress::Watch;
use seamstress_parametrize::{MapOptions, MapSolution, make_map};
use std::ops::ControlFlow;

/// The connectivity of a soup that is a mesh.
#[track_caller]
pub(crate) fn mesh_of(soup: &TriangleSoup) -> TriMesh {
    TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap()
}

/// Mesh and metric of a soup that is a mesh.
#[track_caller]
pub(crate) fn surface(soup: &TriangleSoup) -> (TriMesh, Metric) {
    let mesh = mesh_of(soup);
    let metric = Metric::from_positions(&mesh, &soup.positions);
    (mesh, metric)
}

/// The map with default options, checked by [`assert_seamless`].
#[track_caller]
pub(crate) fn mapped(soup: &TriangleSoup) -> MapSolution {
    mapped_with(soup, &MapOptions::default())
}

/// The map with other options, checked by [`assert_seamless`].
#[track_caller]
pub(crate) fn mapped_with(soup: &TriangleSoup, options: &MapOptions) -> MapSolution {
    let mut go_on = |_| ControlFlow::Continue(());
    match make_map(&mesh_of(soup), &soup.positions, options, &mut go_on) {
        Ok(solution) => {
            assert_seamless(soup, &solution);
            solution
        }
        Err(error) => panic!("no map: {error}"),
    }
}

/// Holds the map against the independent checker, and the library's figures against what that found.
#[track_caller]
pub(crate) fn assert_seamless(soup: &TriangleSoup, solution: &MapSolution) -> Found {
    let map = &solution.map;
    let found = match checker::check(&soup.faces, map.corner_uvs()) {
        Ok(found) => found,
        Err(faults) => panic!("not a seamless map: {faults:#?}"),
    };
    let cones: Vec<_> = map.cones().iter().map(|c| (c.vertex, c.index)).collect();
    assert_eq!(cones, found.cones);
    assert_eq!(map.certificate().cones, cones.len());
    assert_eq!(map.certificate().faces, soup.faces.len());
    assert_eq!(map.certificate().euler_characteristic, found.euler_characteristic);
    let expected = 4.0 * found.euler_characteristic as f64;
    assert!((map.certificate().index_sum - expected).abs() < 1e-3);
    if found.is_closed {
        assert_eq!(cone_sum(solution), 4 * found.euler_characteristic);
    }
    let d = &solution.distortion;
    assert_eq!(d.flipped, 0);
    assert!(d.tau >= 1.0 - 1e-9 && d.tau.is_finite(), "tau {}", d.tau);
    assert!(d.symmetric_dirichlet >= 4.0 - 1e-9 && d.symmetric_dirichlet.is_finite());
    found
}

/// Sum of the indices of the interior cones.
pub(crate) fn cone_sum(solution: &MapSolution) -> i64 {
    let indices = solution.map.cones().iter().map(|c| i64::from(c.index));
    indices.sum()
}

/// Runs a stage that reports progress to nobody.
pub(crate) fn unwatched<R>(stage: impl FnOnce(&mut Watch<'_, '_>) -> R) -> R {
    let mut go_on = |_| ControlFlow::Continue(());
    stage(&mut Watch::new(&mut go_on, 0, 1))
}

/// Index of every vertex at the integer matchings, as real numbers.
pub(crate) fn real_indices(mesh: &TriMesh, metric: &Metric, matched: &MatchedCut) -> Vec<f64> {
    matched.unfolding.indices(&Sectors::unaligned(mesh), metric, &matched.rotations()).0
}
