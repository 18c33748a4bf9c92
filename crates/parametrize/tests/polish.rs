//! What the polish of tau promises: energy within its bound, whatever it starts from.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{mesh_of, surface, unwatched};
use num_complex::Complex64;
use seamstress_mesh::features::{EdgeSet, sharp_edges};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Face, FaceData};
use seamstress_parametrize::energy::{DIRECTION_ENERGY, SymmetricDirichlet};
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::field::Guide;
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::layout::newton::NewtonOptions;
use seamstress_parametrize::layout::polish::{PolishOptions, Polished, polish};
use seamstress_parametrize::{MapOptions, make_aligned_map, make_map};
use seamstress_testkit as kit;
use std::ops::ControlFlow;
use std::time::Duration;

fn shapes() -> Vec<TriangleSoup> {
    vec![
        kit::icosphere(2),
        kit::bumpy(&kit::torus(14, 9, 2.0, 0.8), 0.1, 1),
        kit::saddle(6),
        kit::subdivide(&kit::double_torus()),
    ]
}

/// A layout of minimum energy.
fn relaxed(soup: &TriangleSoup) -> (ExactLayout, Vec<f64>) {
    let (mesh, metric) = surface(soup);
    let options = MapOptions { polish: None, ..MapOptions::default() };
    let mut go_on = |_| ControlFlow::Continue(());
    let made = make_map(&mesh, &soup.positions, &options, &mut go_on).unwrap();
    let (mut layout, y) = ExactLayout::from_map(&mesh, &metric, &made.map).unwrap();
    let settle = NewtonOptions { max_iterations: 60, tolerance: 1e-9 };
    let relaxed = unwatched(|watch| layout.minimize(y, &SymmetricDirichlet, &settle, watch));
    (layout, relaxed.unwrap().y)
}

fn polished(layout: &mut ExactLayout, relaxed: &[f64], options: &PolishOptions) -> Polished {
    unwatched(|watch| polish(layout, relaxed, options, watch)).unwrap()
}

const RISES: [f64; 5] = [0.0, 1e-5, 0.0005, 0.003, 0.02];

#[test]
fn tau_falls_and_the_energy_stays_within_its_bound() {
    for soup in shapes() {
        let (mesh, _) = surface(&soup);
        let (mut layout, relaxed) = relaxed(&soup);
        let before = layout.figures(&relaxed);
        for max_energy_rise in RISES {
            let options = PolishOptions { max_energy_rise, time_limit: None };
            let found = polished(&mut layout, &relaxed, &options).y;
            let after = layout.figures(&found);
            let most = (1.0 + max_energy_rise) * before.symmetric_dirichlet;
            assert!(after.symmetric_dirichlet <= most * (1.0 + 1e-14), "{max_energy_rise}");
            assert!(layout.defects(&Sectors::unaligned(&mesh), &found).none());
            assert!(after.tau <= before.tau * (1.0 + 1e-14));
        }
    }
}

#[test]
fn directions_that_count_stay_within_the_bound_as_well() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        let (mut layout, y) = relaxed(&soup);
        // Somewhat askew to the layout, here and there more than elsewhere.
        let off = |f: Face| Complex64::from_polar(1.0, 0.3 * f64::from(f.0).sin());
        let z = layout.expand(&y);
        let seen = layout.problem().triangles().iter().map(|t| t.jacobian(&z).similar);
        let rotation = seen.zip(mesh.faces()).map(|(s, f)| s / s.norm() * off(f)).collect();
        let weight = FaceData::filled(mesh.n_faces(), 1.0);
        let guide = Guide { rotation, weight, cell: metric.total_area().sqrt() / 20.0 };
        layout.problem_mut().follow(&guide, DIRECTION_ENERGY);
        let settle = NewtonOptions { max_iterations: 60, tolerance: 1e-9 };
        let relaxed = unwatched(|watch| layout.minimize(y, &SymmetricDirichlet, &settle, watch));
        let relaxed = relaxed.unwrap().y;
        let total = |layout: &ExactLayout, y: &[f64]| {
            let figures = layout.figures(y);
            (figures.pull, figures.symmetric_dirichlet + figures.pull)
        };
        let before = total(&layout, &relaxed);
        assert!(before.0 > 0.05, "{}", before.0);
        for max_energy_rise in RISES {
            let options = PolishOptions { max_energy_rise, time_limit: None };
            let found = polished(&mut layout, &relaxed, &options).y;
            let after = total(&layout, &found);
            assert!(after.1 <= (1.0 + max_energy_rise) * before.1 * (1.0 + 1e-14));
        }
    }
}

#[test]
fn without_a_rise_the_minimum_of_the_energy_stays() {
    let (mut layout, relaxed) = relaxed(&kit::icosphere(2));
    let options = PolishOptions { max_energy_rise: 0.0, time_limit: None };
    let found = polished(&mut layout, &relaxed, &options);
    let [before, after] = [&relaxed, &found.y].map(|y| layout.figures(y));
    assert!((before.symmetric_dirichlet - after.symmetric_dirichlet).abs() < 1e-12);
    assert!((before.tau - after.tau).abs() < 1e-12);
    assert_eq!(found.iterations, 0);
}

#[test]
fn a_larger_rise_lowers_tau() {
    for soup in shapes() {
        let (mut layout, relaxed) = relaxed(&soup);
        let mut last = f64::INFINITY;
        for max_energy_rise in RISES {
            let options = PolishOptions { max_energy_rise, time_limit: None };
            let found = polished(&mut layout, &relaxed, &options).y;
            let tau = layout.figures(&found).tau;
            assert!(tau <= last * (1.0 + 1e-3), "{max_energy_rise}: {tau} {last}");
            last = tau;
        }
    }
}

#[test]
fn without_time_the_relaxed_layout_stays() {
    for soup in shapes() {
        let (mut layout, relaxed) = relaxed(&soup);
        let before = layout.figures(&relaxed);
        let options = PolishOptions { max_energy_rise: 1.0, time_limit: Some(Duration::ZERO) };
        let found = polished(&mut layout, &relaxed, &options).y;
        let after = layout.figures(&found);
        assert!((before.tau - after.tau).abs() < 1e-12);
    }
}

/// Mean symmetric Dirichlet energy of a map with its energy allowed to rise by a part.
fn energy_of_map(soup: &TriangleSoup, features: &EdgeSet, max_energy_rise: f64) -> f64 {
    let polish = Some(PolishOptions { max_energy_rise, time_limit: None });
    let options = MapOptions { polish, ..MapOptions::default() };
    let mut go_on = |_| ControlFlow::Continue(());
    let mesh = mesh_of(soup);
    let made = make_aligned_map(&mesh, &soup.positions, features, &options, &mut go_on).unwrap();
    made.distortion.symmetric_dirichlet
}

#[test]
fn maps_keep_the_bound_with_and_without_features() {
    let bracket = kit::bumpy(&kit::subdivide(&kit::l_bracket()), 0.03, 3);
    let creases = sharp_edges(&mesh_of(&bracket), &bracket.positions, 40f64.to_radians());
    let mut cases = vec![(bracket, creases)];
    cases.extend(shapes().into_iter().map(|soup| {
        let none = EdgeSet::new(&mesh_of(&soup), []);
        (soup, none)
    }));
    for (soup, features) in cases {
        let minimum = energy_of_map(&soup, &features, 0.0);
        for rise in [1e-4, 0.003] {
            let energy = energy_of_map(&soup, &features, rise);
            // The result is scaled and moved once more.
            assert!(energy <= (1.0 + rise) * minimum * (1.0 + 1e-12), "{rise}: {energy} {minimum}");
        }
    }
}
