//! Integer-grid maps of small shapes, judged by their certificate and by a check of their own.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]
use seamstress_mesh::components::FailedComponent;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Face, TriMesh};
use seamstress_parametrize::map::IntegerCertificate;
use seamstress_parametrize::{MapOptions, SeamlessMap, Tolerance, Violation, make_map};
use seamstress_quantize::{
    GridSize, IntegerGridMap, Quantization, QuantizationFailure, QuantizeError, QuantizeOptions,
    RoundingMethod, quantize,
};
use seamstress_testkit as testkit;
use std::collections::HashMap;
use std::ops::ControlFlow;

fn integer(soup: &TriangleSoup, size: GridSize) -> (TriMesh, Quantization) {
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let options = QuantizeOptions { size, ..Default::default() };
    let solution = run(&mesh, soup, &options).unwrap();
    (mesh, solution)
}

fn run(
    mesh: &TriMesh,
    soup: &TriangleSoup,
    options: &QuantizeOptions,
) -> Result<Quantization, QuantizeError> {
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(mesh, &soup.positions, &MapOptions::default(), &mut go_on).unwrap().map;
    quantize(mesh, &soup.positions, &map, &EdgeSet::new(mesh, []), options, &mut go_on)
}

/// The two images of every edge differ by a quarter turn and a whole translation, in whole numbers of a
/// fine unit; an integer check that shares nothing with the certificate.
fn check_exactly(soup: &TriangleSoup, uvs: &[[f64; 2]]) {
    // Scaling by a power of two is exact, and no bit of a coordinate at a seam is below 2^-60.
    let fixed = |x: f64| (x * 60f64.exp2()) as i128;
    let mut edges: HashMap<(u32, u32), [[f64; 2]; 2]> = HashMap::new();
    for (f, face) in soup.faces.iter().enumerate() {
        for k in 0..3 {
            let ends = [uvs[3 * f + k], uvs[3 * f + (k + 1) % 3]];
            edges.insert((face[k], face[(k + 1) % 3]), ends);
        }
    }
    for (&(a, b), &[p, q]) in &edges {
        let Some(&[s, r]) = edges.get(&(b, a)) else { continue };
        // p -> q on one side is r -> s on the other
        let fits = [[1, 0], [0, 1], [-1, 0], [0, -1]].into_iter().any(|[c, d]| {
            let turned = |z: [f64; 2]| {
                [c as f64 * z[0] - d as f64 * z[1], d as f64 * z[0] + c as f64 * z[1]]
            };
            let shift = |z: [f64; 2], image: [f64; 2]| {
                let z = turned(z);
                [0, 1].map(|k| fixed(image[k]) - fixed(z[k]))
            };
            let (first, second) = (shift(p, r), shift(q, s));
            first == second && first.iter().all(|t| t % (1i128 << 60) == 0)
        });
        assert!(fits, "edge {a}-{b}");
    }
}

#[test]
fn a_box_has_the_grid_that_its_sides_ask_for() {
    // 2 x 3 x 4, its corners the only cones: at scale 1 the grid is that of the box itself.
    let soup = testkit::stretch(&testkit::cube(), [2.0, 3.0, 4.0]);
    let size = testkit::cube().positions.iter().flatten().fold(0.0f64, |m, x| m.max(*x))
        - testkit::cube().positions.iter().flatten().fold(0.0f64, |m, x| m.min(*x));
    let (_, solution) = integer(&soup, GridSize::Scale(1.0 / size));
    assert_eq!(solution.map.seamless().cones().len(), 8);
    let quads = 2.0 * (2.0 * 3.0 + 3.0 * 4.0 + 2.0 * 4.0);
    assert_eq!(solution.quads(), quads);
    assert!((solution.distortion.tau - 1.0).abs() < 1e-9);
    for uv in solution.map.corner_uvs() {
        assert!(uv.iter().all(|x| x.fract() == 0.0));
    }
}

#[test]
fn shapes_of_every_kind_have_integer_maps() {
    let shapes = [
        ("sphere", testkit::bumpy(&testkit::icosphere(2), 0.1, 1)),
        ("torus", testkit::torus(16, 8, 1.0, 0.4)),
        ("double torus", testkit::double_torus()),
        ("annulus", testkit::annulus(12, 3)),
        ("cylinder", testkit::cylinder(12, 4)),
        ("disk", testkit::saddle(6)),
        ("cone", testkit::fan(5, 0.6, true)),
        ("tetrahedron", testkit::tetrahedron()),
        ("bracket", testkit::l_bracket()),
        ("two", testkit::disjoint_union(&[testkit::cube(), testkit::icosphere(1)])),
    ];
    for (name, soup) in shapes {
        for quads in [60.0, 700.0] {
            let (mesh, solution) = integer(&soup, GridSize::Quads(quads));
            check_exactly(&soup, solution.map.corner_uvs());
            let cones = solution.map.certificate().integral_cones;
            assert_eq!(cones, solution.map.seamless().cones().len(), "{name}");
            let whole = solution.quads();
            let is_closed = !mesh.has_boundary();
            assert!(
                !is_closed || (2.0 * whole - (2.0 * whole).round()).abs() < 1e-6,
                "{name}: {whole}"
            );
            if quads > 500.0 && solution.refinements() == 0 {
                assert!((whole / quads - 1.0).abs() < 0.15, "{name}: {whole}");
            }
        }
    }
}

#[test]
fn integers_behind_a_cut_are_rounded_again() {
    // Far fewer cells than its cones have room for.
    let soup = testkit::random_surface(11);
    let (_, solution) = integer(&soup, GridSize::Quads(80.0));
    check_exactly(&soup, solution.map.corner_uvs());
    assert!(solution.components[0].cuts > 0, "the path is free from the start");
    assert_eq!(solution.refinements(), 0);
}

#[test]
fn the_result_is_the_same_every_time() {
    let soup = testkit::bumpy(&testkit::torus(20, 10, 1.0, 0.4), 0.05, 3);
    let [a, b] = [(); 2].map(|()| integer(&soup, GridSize::Quads(300.0)).1);
    assert_eq!(a.map.corner_uvs(), b.map.corner_uvs());
}

#[test]
fn sizes_agree_with_each_other() {
    let soup = testkit::bumpy(&testkit::icosphere(2), 0.05, 5);
    let (_, by_length) = integer(&soup, GridSize::EdgeLength(0.1));
    let (_, by_scale) = integer(&soup, GridSize::Scale(10.0));
    assert_eq!(by_length.map.corner_uvs(), by_scale.map.corner_uvs());
    // a sphere of radius about 1 has about 4 pi / 0.01 cells
    assert!((by_length.quads() / 1256.0 - 1.0).abs() < 0.15, "{}", by_length.quads());
}

#[test]
fn units_do_not_matter() {
    // The area of neither is a number.
    let soup = testkit::bumpy(&testkit::icosphere(2), 0.05, 5);
    let (_, solution) = integer(&soup, GridSize::Quads(300.0));
    for scale in [(-650f64).exp2(), 650f64.exp2()] {
        let (_, scaled) = integer(&testkit::scale(&soup, scale), GridSize::Quads(300.0));
        assert_eq!(solution.map.corner_uvs(), scaled.map.corner_uvs());
    }
}

#[test]
fn a_triangle_without_area_is_no_obstacle() {
    // A triangle of area 2 with a fourth vertex on one of its sides.
    let soup = TriangleSoup {
        positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 0.0, 0.0]],
        faces: vec![[0, 1, 3], [3, 1, 2], [0, 3, 2]],
    };
    for size in [GridSize::Quads(800.0), GridSize::EdgeLength(0.05)] {
        let (_, solution) = integer(&soup, size);
        check_exactly(&soup, solution.map.corner_uvs());
        assert!((solution.quads() / 800.0 - 1.0).abs() < 0.02, "{}", solution.quads());
    }
}

#[test]
fn greedy_rounding_is_refused_where_it_flips() {
    let soup = testkit::bumpy(&testkit::icosphere(2), 0.25, 2);
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let rounding = RoundingMethod::Greedy;
    let options = QuantizeOptions { size: GridSize::Quads(2.0), rounding, ..Default::default() };
    match run(&mesh, &soup, &options) {
        Err(QuantizeError::Components(failed)) => {
            let [FailedComponent { cause: QuantizationFailure::Uncertified(violations), .. }] =
                &failed[..]
            else {
                panic!("{failed:?}")
            };
            let is_flip = |v: &Violation| {
                matches!(v, Violation::FlippedTriangle { .. } | Violation::CollapsedTriangle { .. })
            };
            assert!(violations.0.iter().any(is_flip), "{violations}");
        }
        other => panic!("{other:?}"),
    }
    // On a fine grid the greedy choice is harmless.
    let options = QuantizeOptions { size: GridSize::Quads(20_000.0), ..options };
    check_exactly(&soup, run(&mesh, &soup, &options).unwrap().map.corner_uvs());
}

#[test]
fn the_certificate_refuses_what_is_not_integral() {
    let soup = testkit::bumpy(&testkit::icosphere(1), 0.05, 1);
    let (mesh, solution) = integer(&soup, GridSize::Quads(200.0));
    let good = solution.map.corner_uvs().to_vec();
    let tolerance = Tolerance::of_seams(1e-2);
    let refused =
        |uvs: Vec<[f64; 2]>| IntegerGridMap::certify(&mesh, uvs, &tolerance).unwrap_err().0;
    assert!(IntegerGridMap::certify(&mesh, good.clone(), &tolerance).is_ok());

    // one corner moved by its last bit
    let mut nudged = good.clone();
    nudged[7][0] = f64::from_bits(nudged[7][0].to_bits() + 1);
    let violations = refused(nudged);
    assert!(
        violations
            .iter()
            .all(|v| matches!(v, Violation::InexactEdge { .. } | Violation::FractionalCone { .. }))
    );
    assert!(!violations.is_empty());

    // everything shifted by a half: the edges still fit, the cones do not
    let shifted = good.iter().map(|[u, v]| [u + 0.5, v + 0.5]).collect();
    let violations = refused(shifted);
    let cones = violations.iter().filter(|v| matches!(v, Violation::FractionalCone { .. }));
    assert_eq!(cones.count(), solution.map.seamless().cones().len());

    // twice as coarse: the translations get halves
    let halved = good.iter().map(|[u, v]| [u / 2.0, v / 2.0]).collect();
    let is_fractional = |v: &Violation| matches!(v, Violation::FractionalTranslation { .. });
    assert!(refused(halved).iter().any(is_fractional));

    // turned over
    let mirrored = good.iter().map(|[u, v]| [-u, *v]).collect();
    assert!(matches!(refused(mirrored)[0], Violation::FlippedTriangle { .. }));
}

/// The integer certificate of UVs that are a seamless map to within a thousandth of an edge.
fn checked(
    mesh: &TriMesh,
    uvs: Vec<[f64; 2]>,
    tolerance: &Tolerance,
) -> Result<IntegerCertificate, Vec<Violation>> {
    let map = SeamlessMap::certify(mesh, uvs, &Tolerance::of_seams(1e-3)).unwrap();
    map.integers(mesh, &[], tolerance).map_err(|violations| violations.0)
}

#[test]
fn maps_of_few_digits_are_checked_to_a_tolerance() {
    let soup = testkit::bumpy(&testkit::icosphere(1), 0.05, 1);
    let (mesh, solution) = integer(&soup, GridSize::Quads(200.0));
    let good = solution.map.corner_uvs();
    let exact = checked(&mesh, good.to_vec(), &Tolerance::default()).unwrap();
    assert_eq!(&exact, solution.map.certificate());
    assert_eq!((exact.exact_edges, exact.integral_error), (exact.edges, 0.0));

    let digits = |x: f64| (x * 1e5).round() / 1e5;
    let rounded: Vec<_> = good.iter().map(|[u, v]| [digits(u + 2e-5), digits(*v)]).collect();
    let with =
        |x| checked(&mesh, rounded.clone(), &Tolerance { integers: x, ..Tolerance::default() });
    // Across a half turn both ends count.
    let certificate = with(1e-4).unwrap();
    assert!(certificate.exact_edges < certificate.edges);
    assert!((certificate.integral_error - 4e-5).abs() < 1e-9, "{}", certificate.integral_error);
    assert_eq!(certificate.largest_translation, exact.largest_translation);
    assert!(with(1e-5).is_err());
    let is_inexact = |v: &Violation| matches!(v, Violation::InexactEdge { .. });
    assert!(with(0.0).unwrap_err().iter().any(is_inexact));
}

#[test]
fn a_shifted_seam_is_named_by_its_edges() {
    // A torus without cones: a chart that is moved by a quarter of a cell opens no seam.
    let soup = testkit::torus(8, 6, 1.0, 0.4);
    let (mesh, solution) = integer(&soup, GridSize::Quads(100.0));
    let mut uvs = solution.map.corner_uvs().to_vec();
    for corner in &mut uvs[0..3] {
        corner[0] += 0.25;
    }
    let tolerance = &Tolerance { integers: 0.01, ..Tolerance::default() };
    let corners = mesh.face_vertices(Face(0)).map(|v| v.0);
    for tolerance in [&Tolerance::default(), tolerance] {
        let found = checked(&mesh, uvs.clone(), tolerance).unwrap_err();
        let translations = found.iter().filter_map(|v| match v {
            Violation::FractionalTranslation { vertices, translation, .. } => {
                let off = translation.map(|x| (x - x.round()).abs());
                assert!((off[0].max(off[1]) - 0.25).abs() < 1e-9, "{translation:?}");
                Some(vertices)
            }
            _ => None,
        });
        let named: Vec<_> = translations.collect();
        assert_eq!(named.len(), 3, "{found:?}");
        assert!(named.iter().all(|ends| ends.iter().all(|v| corners.contains(v))));
    }
}

#[test]
fn bad_sizes_and_cancelling() {
    let soup = testkit::icosphere(1);
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = QuantizeOptions { size: GridSize::Quads(size), ..Default::default() };
        assert!(matches!(run(&mesh, &soup, &options), Err(QuantizeError::BadSize)));
    }
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(&mesh, &soup.positions, &MapOptions::default(), &mut go_on).unwrap().map;
    let mut stop = |_| ControlFlow::Break(());
    let options = QuantizeOptions::default();
    let stopped =
        quantize(&mesh, &soup.positions, &map, &EdgeSet::new(&mesh, []), &options, &mut stop);
    assert!(matches!(stopped, Err(QuantizeError::Cancelled(_))));
}

#[test]
fn a_map_keeps_its_directions_where_they_count() {
    let soup = testkit::bumpy(&testkit::torus(24, 16, 2.0, 0.8), 0.1, 1);
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(&mesh, &soup.positions, &MapOptions::default(), &mut go_on).unwrap().map;
    let turned = |alignment| {
        let options =
            QuantizeOptions { size: GridSize::Quads(300.0), alignment, ..Default::default() };
        let aligned = EdgeSet::new(&mesh, []);
        let made = quantize(&mesh, &soup.positions, &map, &aligned, &options, &mut go_on).unwrap();
        let faces = made.map.corner_uvs().chunks(3).zip(map.corner_uvs().chunks(3));
        let turns = faces.map(|(to, from)| {
            // The best rotation of the sides, up to quarters.
            let side = |uvs: &[[f64; 2]], k: usize| [0, 1].map(|i| uvs[(k + 1) % 3][i] - uvs[k][i]);
            let (mut along, mut across) = (0.0, 0.0);
            for k in 0..3 {
                let ([a, b], [c, d]) = (side(from, k), side(to, k));
                along += a * c + b * d;
                across += a * d - b * c;
            }
            let angle = f64::atan2(across, along).to_degrees().rem_euclid(90.0);
            angle.min(90.0 - angle)
        });
        turns.sum::<f64>() / mesh.n_faces() as f64
    };
    let [free, kept] = [0.0, 1.0].map(turned);
    assert!(kept < 0.9 * free, "{free} degrees, and {kept} where directions count");
}
