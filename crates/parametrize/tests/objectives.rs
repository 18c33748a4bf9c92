//! What minimising an objective promises: its own measure falls, nothing flips, cones stay.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{checker, mesh_of, surface};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parametrize::layout::objective::Ending;
use seamstress_parametrize::quality::{Measure, SingularValues, distance_to_frames, summarize};
use seamstress_parametrize::{
    Anisotropy, MapError, MapOptions, Objective, Relayout, RelayoutOptions, SeamlessMap, Stretch,
    lay_out_disk, make_map, relayout,
};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

fn start(soup: &TriangleSoup) -> SeamlessMap {
    let mut go_on = |_| ControlFlow::Continue(());
    let options = MapOptions::default();
    make_map(&mesh_of(soup), &soup.positions, &options, &mut go_on).unwrap().map
}

fn laid_out(soup: &TriangleSoup, map: &SeamlessMap, objective: Objective) -> Relayout {
    let mut go_on = |_| ControlFlow::Continue(());
    let options = RelayoutOptions::new(objective);
    relayout(&mesh_of(soup), &soup.positions, map, &options, &mut go_on).unwrap()
}

fn figure(soup: &TriangleSoup, map: &SeamlessMap, measure: Measure) -> f64 {
    let (mesh, metric) = surface(soup);
    summarize(measure, &SingularValues::new(&mesh, &metric, map.corner_uvs())).figure()
}

fn shapes() -> Vec<TriangleSoup> {
    vec![
        kit::bumpy(&kit::icosphere(2), 0.15, 4),
        kit::bumpy(&kit::torus(14, 9, 2.0, 0.8), 0.1, 1),
        kit::with_boundaries(&kit::subdivide(&kit::double_torus()), 2, 1),
        kit::disjoint_union(&[kit::icosphere(1), kit::saddle(5)]),
    ]
}

#[test]
fn every_objective_lowers_its_measure_and_keeps_the_cones() {
    for soup in shapes() {
        let map = start(&soup);
        let (mesh, metric) = surface(&soup);
        let connected = mesh.connected_faces().1 == 1;
        for objective in Objective::ALL.into_iter().filter(|objective| objective.is_available()) {
            let result = laid_out(&soup, &map, objective);
            let found = checker::check(&soup.faces, result.map.corner_uvs()).unwrap();
            let cones: Vec<_> = map.cones().iter().map(|c| (c.vertex, c.index)).collect();
            assert_eq!(found.cones, cones, "{objective}");
            for stats in &result.components {
                assert!(stats.after <= stats.before, "{objective}: {stats:?}");
            }
            if !connected {
                continue;
            }
            // The figures of the layout are those of the UVs that are given out.
            let of = |map: &SeamlessMap| match objective.measure() {
                Some(measure) => figure(&soup, map, measure),
                None => distance_to_frames(&mesh, &metric, map.corner_uvs(), start_uvs(&soup)),
            };
            let stats = result.components[0];
            assert!(
                (of(&result.map) - stats.after).abs() < 1e-6 * (1.0 + stats.after),
                "{objective}"
            );
            let before = of(&map);
            let is_scaled = objective.measure().is_some();
            assert!(!is_scaled || (before - stats.before).abs() < 1e-6 * (1.0 + before));
        }
    }
}

/// UVs of the map that [`start`] gives; they do not depend on the run.
fn start_uvs(soup: &TriangleSoup) -> &'static [[f64; 2]] {
    Vec::leak(start(soup).corner_uvs().to_vec())
}

#[test]
fn two_methods_find_the_same_rigid_layout() {
    for soup in shapes() {
        let map = start(&soup);
        let figure_of = |objective| {
            let result = laid_out(&soup, &map, objective);
            result.components.iter().map(|c| c.after).collect::<Vec<_>>()
        };
        let (alternating, newton) = (figure_of(Objective::Arap), figure_of(Objective::ArapNewton));
        for (a, b) in alternating.iter().zip(&newton) {
            assert!((a - b).abs() < 1e-3 * a.max(1e-3), "{a} {b}");
        }
    }
}

#[test]
fn a_developable_disk_is_unrolled_by_every_objective() {
    // A sheet bent around a cylinder.
    let mut soup = kit::disk_grid(8, 4);
    for p in &mut soup.positions {
        let angle = p[0];
        *p = [angle.sin(), p[1], angle.cos()];
    }
    let mesh = mesh_of(&soup);
    let mut go_on = |_| ControlFlow::Continue(());
    for objective in Objective::ALL.into_iter().filter(|objective| objective.is_available()) {
        let options = RelayoutOptions::new(objective);
        let result = lay_out_disk(&mesh, &soup.positions, &options, &mut go_on).unwrap();
        assert!(result.map.seams().is_empty() && result.map.cones().is_empty());
        let tau = result.distortion.tau;
        assert!((tau - 1.0).abs() < 2e-3, "{objective}: {tau}");
    }
}

#[test]
fn only_disks_need_no_map() {
    let soup = kit::annulus(12, 3);
    let mut go_on = |_| ControlFlow::Continue(());
    let options = RelayoutOptions::new(Objective::Arap);
    let refused = lay_out_disk(&mesh_of(&soup), &soup.positions, &options, &mut go_on);
    assert!(refused.as_ref().is_err_and(MapError::is_not_a_disk), "{refused:?}");
}

#[test]
fn wanted_stretches_count_as_no_distortion() {
    let soup = kit::disk_grid(4, 4);
    let mesh = mesh_of(&soup);
    // Twice as long along the diagonal, whatever is said of the direction across the plane.
    let stretch = Stretch { direction: [3.0, 3.0, 5.0], along: 2.0, across: 1.0 };
    let stretches = vec![stretch; mesh.n_faces()];
    let mut options = RelayoutOptions::new(Objective::Arap);
    options.anisotropy = Some(Anisotropy::new(&mesh, &soup.positions, &stretches).unwrap());
    let mut go_on = |_| ControlFlow::Continue(());
    for objective in [Objective::Arap, Objective::ArapNewton, Objective::Tau] {
        options.objective = objective;
        let result = lay_out_disk(&mesh, &soup.positions, &options, &mut go_on).unwrap();
        let (_, metric) = surface(&soup);
        let singular = SingularValues::new(&mesh, &metric, result.map.corner_uvs());
        for [s1, s2] in singular.values.iter().flatten() {
            assert!((s1 / s2 - 2.0).abs() < 1e-2, "{objective}: {s1} {s2}");
        }
        if objective != Objective::Tau {
            let [s1, s2] = singular.values.0[0].unwrap();
            assert!((s1 - 2.0).abs() < 1e-2 && (s2 - 1.0).abs() < 1e-2, "{s1} {s2}");
        }
    }
}

#[test]
fn senseless_stretches_are_refused_by_face() {
    let soup = kit::disk_grid(2, 1);
    let mesh = mesh_of(&soup);
    let good = Stretch { direction: [1.0, 0.0, 0.0], along: 1.0, across: 2.0 };
    let refuse = |stretches: &[Stretch]| {
        Anisotropy::new(&mesh, &soup.positions, stretches).unwrap_err().to_string()
    };
    let second = |bad| [good, bad, good, good];
    assert_eq!(refuse(&[good]), "1 stretches for 4 faces");
    let negative = Stretch { along: -1.0, ..good };
    assert_eq!(refuse(&second(negative)), "the stretch of face 1 is not positive and finite");
    let upright = Stretch { direction: [0.0, 0.0, 1.0], ..good };
    assert_eq!(refuse(&second(upright)), "the direction of face 1 has no part in its plane");
    // Without a preferred direction none is needed.
    let even = Stretch { along: 3.0, across: 3.0, ..upright };
    assert!(Anisotropy::new(&mesh, &soup.positions, &second(even)).is_ok());
}

#[test]
fn minimisers_that_flip_are_held_back() {
    // A sphere with a hole: as rigid as possible, it folds over.
    let soup = kit::with_boundaries(&kit::icosphere(2), 1, 3);
    let mut go_on = |_| ControlFlow::Continue(());
    let options = RelayoutOptions::new(Objective::Arap);
    let mesh = mesh_of(&soup);
    let result = lay_out_disk(&mesh, &soup.positions, &options, &mut go_on).unwrap();
    let stats = result.components[0];
    assert!(matches!(stats.ending, Ending::Guarded { flips: 1.. }), "{stats:?}");
    assert!(stats.after < stats.before && result.distortion.flipped == 0);
}

/// Laid out with the dilatation bounded.
fn bounded(soup: &TriangleSoup, map: &SeamlessMap, bound: f64) -> Result<Relayout, MapError> {
    let mut go_on = |_| ControlFlow::Continue(());
    let mut options = RelayoutOptions::new(Objective::Dilatation);
    options.settings.dilatation_bound = Some(bound);
    relayout(&mesh_of(soup), &soup.positions, map, &options, &mut go_on)
}

#[test]
fn a_bound_on_the_dilatation_is_kept_at_the_least_energy() {
    for soup in shapes() {
        let map = start(&soup);
        let smallest =
            figure(&soup, &laid_out(&soup, &map, Objective::Dilatation).map, Measure::Dilatation);
        let energy_of = |map: &SeamlessMap| figure(&soup, map, Measure::SymmetricDirichlet);
        let unbounded = energy_of(&laid_out(&soup, &map, Objective::SymmetricDirichlet).map);
        let mut last = f64::INFINITY;
        for factor in [1.0 + 1e-3, 1.05, 1.2, 10.0] {
            let bound = factor * smallest;
            let result = bounded(&soup, &map, bound).unwrap();
            let dilatation = figure(&soup, &result.map, Measure::Dilatation);
            assert!(dilatation <= bound * (1.0 + 2e-6), "{dilatation} {bound}");
            let cones: Vec<_> = map.cones().iter().map(|c| (c.vertex, c.index)).collect();
            let found = checker::check(&soup.faces, result.map.corner_uvs()).unwrap();
            assert_eq!(found.cones, cones);
            for stats in &result.components {
                assert!(stats.dilatation.is_some_and(|k| k <= bound * (1.0 + 2e-6)), "{stats:?}");
            }
            // The looser the bound, the less energy; without one that matters, the minimum.
            let energy = energy_of(&result.map);
            assert!(energy <= last * (1.0 + 1e-4), "{factor}: {energy} {last}");
            last = energy;
        }
        assert!((last / unbounded - 1.0).abs() < 1e-4, "{last} {unbounded}");
    }
}

#[test]
fn a_bound_that_no_layout_keeps_is_reported_with_the_smallest_found() {
    let soup = kit::bumpy(&kit::icosphere(2), 0.15, 4);
    let error = bounded(&soup, &start(&soup), 1.001).unwrap_err();
    assert!(error.is_infeasible());
    let text = error.to_string();
    assert!(text.contains("at most 1.001 was found; the smallest one found has 1."), "{text}");
    // What is no bound, or not of the objective, is refused.
    let mut go_on = |_| ControlFlow::Continue(());
    let (mesh, map) = (mesh_of(&soup), start(&soup));
    for (objective, bound, reason) in [
        (Objective::Dilatation, 0.5, "cannot be bounded by 0.5"),
        (Objective::Dilatation, f64::NAN, "cannot be bounded by NaN"),
        (Objective::Tau, 2.0, "not with tau"),
    ] {
        let mut options = RelayoutOptions::new(objective);
        options.settings.dilatation_bound = Some(bound);
        let error = relayout(&mesh, &soup.positions, &map, &options, &mut go_on).unwrap_err();
        assert!(!error.is_infeasible() && error.to_string().contains(reason), "{error}");
    }
}

#[test]
fn a_developable_patch_has_a_layout_without_dilatation() {
    let mut soup = kit::disk_grid(8, 4);
    for p in &mut soup.positions {
        let angle = p[0];
        *p = [angle.sin(), p[1], angle.cos()];
    }
    let mesh = mesh_of(&soup);
    let mut go_on = |_| ControlFlow::Continue(());
    for objective in
        [Objective::Dilatation, Objective::DilatationAlternating, Objective::DilatationBisection]
    {
        let mut options = RelayoutOptions::new(objective);
        options.settings.dilatation_bound = Some(1.0);
        let result = lay_out_disk(&mesh, &soup.positions, &options, &mut go_on).unwrap();
        let dilatation = result.components[0].dilatation.unwrap();
        assert!((1.0..1.0 + 2e-5).contains(&dilatation), "{objective}: {dilatation}");
    }
}

#[test]
fn conic_objectives_converge_or_say_that_they_stopped() {
    let soup = kit::bumpy(&kit::icosphere(2), 0.15, 4);
    let (mesh, map) = (mesh_of(&soup), start(&soup));
    let mut go_on = |_| ControlFlow::Continue(());
    for objective in
        [Objective::TauAlternating, Objective::AsapMax, Objective::DilatationAlternating]
    {
        let mut options = RelayoutOptions::new(objective);
        for (max_rounds, ending) in [(60, Ending::Converged), (1, Ending::Stopped)] {
            options.settings.conic.max_rounds = max_rounds;
            let result = relayout(&mesh, &soup.positions, &map, &options, &mut go_on).unwrap();
            let stats = result.components[0];
            assert_eq!(stats.ending, ending, "{objective}");
            let remaining = stats.conic.unwrap().remaining.unwrap();
            let is_settled = remaining <= options.settings.conic.tolerance;
            assert_eq!(is_settled, ending == Ending::Converged, "{objective}: {remaining}");
        }
    }
}
