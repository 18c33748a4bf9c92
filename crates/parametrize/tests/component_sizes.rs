//! Components of different sizes: each is judged by itself, and small ones keep their digits.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{mapped, mesh_of};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use seamstress_mesh::{Face, TriMesh};
use seamstress_parametrize::{SeamlessMap, Tolerance, Violation, Violations};
use seamstress_testkit as kit;
use std::collections::BTreeSet;

type Uvs = Vec<[f64; 2]>;

/// The twelve triangles of a cube, its six squares of side 1 apart from each other, each turned by one
/// quarter more than the last, and all of it by `angle`.
fn cube_laid(angle: f64) -> Uvs {
    let (sin, cos) = angle.sin_cos();
    let mut uvs = Uvs::new();
    for square in 0..6 {
        let turn = |[x, y]: [f64; 2]| [[x, y], [-y, x], [-x, -y], [y, -x]][square % 4];
        let at = |x, y| {
            let [x, y] = turn([x, y]).map(|c| c + 3.0 * square as f64);
            [cos * x - sin * y, sin * x + cos * y]
        };
        let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        uvs.extend([a, b, c, a, c, d]);
    }
    uvs
}

/// Two cubes: the first as it is, the second at a size and a place.
fn with_second(first: &Uvs, second: &Uvs, size: f64, left: f64) -> Result<SeamlessMap, Violations> {
    let cube = kit::cube();
    let mesh = mesh_of(&kit::disjoint_union(&[cube.clone(), cube]));
    let placed = second.iter().map(|[u, v]| [size * u + left, size * v]);
    let uvs = first.iter().copied().chain(placed).collect();
    SeamlessMap::certify(&mesh, uvs, &Tolerance::default())
}

/// Every face scaled about its first corner, by factors from 0.5 to 2.
fn faces_scaled(uvs: &Uvs) -> Uvs {
    let face = |(f, corners): (usize, &[[f64; 2]])| {
        let factor = 0.5 * 4f64.powf(f as f64 / 11.0);
        let [[u, v], ..] = [corners[0]];
        corners.iter().map(|p| [u + factor * (p[0] - u), v + factor * (p[1] - v)]).collect::<Uvs>()
    };
    uvs.chunks_exact(3).enumerate().flat_map(face).collect()
}

#[test]
fn small_components_with_scaled_faces_are_refused_edge_by_edge() {
    let good = cube_laid(0.3);
    let broken = faces_scaled(&good);
    let mesh = mesh_of(&kit::disjoint_union(&[kit::cube(), kit::cube()]));
    let second = mesh.interior_edges().filter(|h| h.face() >= Face(12));
    let all: BTreeSet<[u32; 2]> =
        second.map(|h| [mesh.origin(h).0, mesh.tip(h).0].map(|v| v)).collect();
    assert_eq!(all.len(), 18);
    for exponent in [-300, -100, -15, -12, -10, -6, -3, 0, 6, 12, 100, 280] {
        let size = 10f64.powi(exponent);
        assert!(with_second(&good, &good, size, 0.0).is_ok(), "10^{exponent}");
        let Violations(found) = with_second(&good, &broken, size, 0.0).unwrap_err();
        let open = found.iter().filter_map(|v| match v {
            Violation::OpenSeam { vertices, residual, .. } if *residual > 0.05 => Some(*vertices),
            _ => None,
        });
        assert_eq!(open.collect::<BTreeSet<_>>(), all, "10^{exponent}");
    }
    // Beside the large one, where its digits are few: no rounding excuses an edge that is half as long.
    for exponent in [-14, -12, -10, -6] {
        let found = with_second(&good, &broken, 10f64.powi(exponent), 30.0).unwrap_err().0;
        let is_open = |v: &&Violation| matches!(v, Violation::OpenSeam { .. });
        assert!(found.iter().filter(is_open).count() >= 16, "10^{exponent}: {found:?}");
    }
}

#[test]
fn the_verdict_does_not_depend_on_the_size_of_a_component() {
    let config = Config { cases: 200, failure_persistence: None, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let inputs = (-12.0..12.0, -7.0..-0.3, 0.0..6.3, 0usize..36, any::<bool>());
    let outcome = TestRunner::new_with_rng(config, rng).run(&inputs, |input| {
        let (size, shift, angle, corner, is_broken) = input;
        let good = cube_laid(angle);
        let mut second = good.clone();
        if is_broken {
            second[corner][0] += 10f64.powf(shift);
        }
        let alone =
            SeamlessMap::certify(&mesh_of(&kit::cube()), second.clone(), &Tolerance::default());
        prop_assert_eq!(alone.is_ok(), !is_broken);
        for size in [10f64.powf(size), 1.0] {
            match (with_second(&good, &second, size, 0.0), &alone) {
                (Ok(map), Ok(alone)) => {
                    prop_assert_eq!(map.cones().len(), 8 + alone.cones().len());
                    prop_assert!(map.certificate().seam_residual < 1e-13);
                }
                (Err(Violations(found)), Err(Violations(alone))) => {
                    let is_open = |v: &&Violation| matches!(v, Violation::OpenSeam { .. });
                    prop_assert_eq!(
                        found.iter().filter(is_open).count(),
                        alone.iter().filter(is_open).count()
                    );
                }
                (found, _) => prop_assert!(false, "at {}: {:?}", size, found.map(|_| ())),
            }
        }
        Ok(())
    });
    assert!(outcome.is_ok(), "{outcome:?}");
}

#[test]
fn digits_lost_far_from_the_origin_are_told_and_then_refused() {
    let good = cube_laid(0.3);
    let mesh = mesh_of(&kit::cube());
    let at = |distance: f64| {
        let uvs = good.iter().map(|[u, v]| [u + distance, v - distance]).collect();
        SeamlessMap::certify(&mesh, uvs, &Tolerance::default())
    };
    for exponent in 1..=11 {
        let distance = 10f64.powi(exponent);
        let residual = at(distance).unwrap().certificate().seam_residual;
        let rounding = f64::EPSILON * distance;
        assert!(
            residual < 4.0 * rounding && residual > 0.01 * rounding,
            "{residual} at {distance}"
        );
    }
    for exponent in 14..=16 {
        let Violations(found) = at(10f64.powi(exponent)).unwrap_err();
        assert!(found.iter().any(|v| matches!(v, Violation::OpenSeam { .. })), "10^{exponent}");
    }
    let Violations(found) = at(1e18).unwrap_err();
    let collapsed = found.iter().filter(|v| matches!(v, Violation::CollapsedTriangle { .. }));
    assert_eq!(collapsed.count(), 12);
    // Whole numbers have all their digits up to 2^53.
    let whole: Uvs = cube_laid(0.0).iter().map(|p| p.map(|x| x + 1e15)).collect();
    let map = SeamlessMap::certify(&mesh, whole, &Tolerance::default()).unwrap();
    assert_eq!(map.certificate().seam_residual, 0.0);
}

/// Largest mismatch of an edge in its own lengths, without the certificate.
fn open_by(mesh: &TriMesh, uvs: &[[f64; 2]]) -> f64 {
    let vector = |h: seamstress_mesh::Halfedge| {
        let (p, q) = (uvs[h.at()], uvs[h.next().at()]);
        [q[0] - p[0], q[1] - p[1]]
    };
    let open = mesh.interior_edges().map(|h| {
        let ([x, y], [c, d]) = (vector(h), vector(mesh.twin(h).unwrap()).map(|x| -x));
        let off = |[a, b]: [f64; 2]| (a - c).hypot(b - d) / x.hypot(y);
        [[x, y], [-y, x], [-x, -y], [y, -x]].map(off).into_iter().fold(f64::INFINITY, f64::min)
    });
    open.fold(0.0, f64::max)
}

#[test]
fn maps_of_two_tori_are_tight_at_any_ratio_of_sizes() {
    let torus = kit::torus(12, 8, 2.0, 0.8);
    for exponent in [-3, -6, -10, -12, -15, -40] {
        let small = kit::scale(&torus, 10f64.powi(exponent));
        for pair in [[torus.clone(), small.clone()], [small.clone(), torus.clone()]] {
            let soup = kit::disjoint_union(&pair);
            let solution = mapped(&soup);
            let open = open_by(&mesh_of(&soup), solution.map.corner_uvs());
            assert!(open < 1e-11, "open by {open} at 10^{exponent}");
            let residual = solution.map.certificate().seam_residual;
            assert!((residual / open - 1.0).abs() < 1e-9, "{residual}, but open by {open}");
        }
    }
}

#[test]
fn components_of_similar_sizes_stand_in_the_order_of_their_faces() {
    let torus = kit::torus(12, 8, 2.0, 0.8);
    let sizes = [1.0, 0.01, 0.3];
    let soup = kit::disjoint_union(&sizes.map(|size| kit::scale(&torus, size)));
    let uvs = mapped(&soup).map.corner_uvs().to_vec();
    let n = 3 * torus.faces.len();
    let [a, b, c] = [0, 1, 2].map(|k| {
        let u = uvs[k * n..][..n].iter().map(|uv| uv[0]);
        (u.clone().fold(f64::INFINITY, f64::min), u.fold(0.0, f64::max))
    });
    assert!(a.0 == 0.0 && a.1 < b.0 && b.1 < c.0);
}
