//! Conic programs on layouts: optima known by hand, two solvers, invariance, failures.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{surface, unwatched};
use num_complex::Complex64;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parallel::with_threads;
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::layout::conic::{
    ConicError, ConicMinimum, ConicObjective, ConicOptions, Outcome, Program, Solver,
    SolverOptions, minimize, solve,
};
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::layout::polish::{PolishOptions, polish};
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::layout::space::LinearSpace;
use seamstress_parametrize::layout::triangle::Triangle;
use seamstress_parametrize::{MapOptions, make_map};
use seamstress_testkit as kit;
use std::ops::ControlFlow;
use std::time::Duration;

const MEASURES: [ConicObjective; 4] = [
    ConicObjective::TauAlternating,
    ConicObjective::ArapMax,
    ConicObjective::AsapMax,
    ConicObjective::DilatationAlternating,
];

/// The exact layout of a map that was not polished, and its unknowns.
fn mapped(soup: &TriangleSoup) -> (ExactLayout, Vec<f64>) {
    let (mesh, metric) = surface(soup);
    let options = MapOptions { polish: None, ..MapOptions::default() };
    let mut go_on = |_| ControlFlow::Continue(());
    let made = make_map(&mesh, &soup.positions, &options, &mut go_on).unwrap();
    ExactLayout::from_map(&mesh, &metric, &made.map).unwrap()
}

fn shapes() -> Vec<TriangleSoup> {
    vec![
        kit::icosphere(2),
        kit::bumpy(&kit::torus(14, 9, 2.0, 0.8), 0.1, 1),
        kit::saddle(6),
        kit::subdivide(&kit::double_torus()),
    ]
}

fn program(layout: &ExactLayout, objective: ConicObjective, y: &[f64]) -> Program {
    objective.program(layout.problem(), None, &layout.expand(y))
}

fn minimum(layout: &mut ExactLayout, y: &[f64], objective: ConicObjective) -> ConicMinimum {
    let options = ConicOptions::default();
    let problem = layout.problem_mut();
    unwatched(|watch| minimize(problem, y.to_vec(), objective, &options, watch)).unwrap()
}

/// Two triangles of a unit square, every corner free but the first.
fn square() -> LayoutProblem {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let soup = TriangleSoup { positions, faces: vec![[0, 1, 2], [0, 2, 3]] };
    let (mesh, metric) = surface(&soup);
    let cut = seamstress_parametrize::cut::Cut::new(&mesh, |_| true);
    let triangles = seamstress_parametrize::layout::triangle::triangles(&mesh, &metric, &cut);
    problem(4, triangles)
}

fn problem(n_wedges: usize, triangles: Vec<Triangle>) -> LayoutProblem {
    LayoutProblem::new(LinearSpace::free(n_wedges), triangles, None).unwrap()
}

fn solvers() -> impl Iterator<Item = Solver> {
    [Solver::Own, Solver::Clarabel].into_iter().filter(|solver| solver.is_available())
}

#[test]
fn a_sheared_square_is_straightened() {
    for objective in MEASURES.into_iter().chain([ConicObjective::Tau, ConicObjective::Dilatation]) {
        for solver in solvers() {
            let mut problem = square();
            let sheared = vec![0.0, 0.0, 1.3, 0.2, 1.9, 1.4, 0.5, 1.0];
            let options = ConicOptions { solver, ..ConicOptions::default() };
            let found =
                unwatched(|watch| minimize(&mut problem, sheared, objective, &options, watch))
                    .unwrap();
            let ideal = match objective {
                ConicObjective::ArapMax | ConicObjective::AsapMax => 0.0,
                _ => 1.0,
            };
            assert!((found.value - ideal).abs() < 1e-4, "{objective:?} {solver:?} {found:?}");
        }
    }
}

/// Turning the frames of the two triangles by an angle a, one each way, leaves both deviations at sin a at
/// least: along the common edge e the Jacobians agree, so `|(J1 - R1) e| + |(J2 - R2) e| >= |(R1 - R2) e|`, which is
/// `2 sin a`; and rank-one deviations along e attain it.
#[test]
fn two_frames_that_disagree_share_the_error() {
    let mut problem = square();
    let y = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let z = problem.space().expand(&y);
    let mut program = ConicObjective::ArapMax.program(&problem, None, &z);
    let a = 0.3_f64;
    program.frames[0] *= Complex64::from_polar(1.0, a);
    program.frames[1] *= Complex64::from_polar(1.0, -a);
    for solver in solvers() {
        let options = SolverOptions::default();
        let best =
            unwatched(|watch| solve(&mut problem, &program, &y, solver, &options, watch)).unwrap();
        assert_eq!((best.outcome, best.solver_used), (Outcome::Solved, solver));
        assert!((best.objective - a.sin().powi(2)).abs() < 1e-6, "{solver:?} {}", best.objective);
    }
}

/// Four equilateral triangles around a vertex, 240 degrees, are laid out around a cone of 270: by symmetry and
/// convexity the best layout opens each apex to 67.5 degrees and stretches along its axes alone.
#[test]
fn a_pyramid_opens_to_a_cone_of_three_quarters() {
    let positions =
        vec![[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
    let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    let (mut layout, y) = mapped(&TriangleSoup { positions, faces });
    assert_eq!(layout.index.iter().copied().max(), Some(1));
    let stretch = 33.75_f64.to_radians().tan() / 30_f64.to_radians().tan();
    let tau = minimum(&mut layout, &y, ConicObjective::Tau).value;
    assert!((tau - stretch.sqrt()).abs() < 1e-5, "{tau}");
    let dilatation = minimum(&mut layout, &y, ConicObjective::Dilatation).value;
    assert!((dilatation - stretch).abs() < 1e-4, "{dilatation}");
    if Solver::Clarabel.is_available() {
        let bisected = minimum(&mut layout, &y, ConicObjective::DilatationBisection).value;
        assert!((bisected - stretch).abs() < 2e-3, "{bisected}");
    }
    let similar = minimum(&mut layout, &y, ConicObjective::AsapMax).value;
    let expected = (stretch - 1.0).powi(2) / (stretch * stretch + 1.0);
    assert!((similar - expected).abs() < 1e-5, "{similar}");
    // (8) at the best scale of the triangle: s1 - 1 = 1 - s2 times the ratio's weights
    let rigid = minimum(&mut layout, &y, ConicObjective::ArapMax).value;
    assert!((rigid - expected).abs() < 1e-5, "{rigid}");
}

#[test]
fn a_single_triangle_has_no_distortion() {
    let triangle = Triangle {
        wedges: [0, 1, 2],
        gradients: [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]],
        weight: 1.0,
    };
    for objective in MEASURES {
        let mut problem = problem(3, vec![triangle]);
        let y = vec![0.0, 0.0, 2.0, 0.3, -0.4, 0.7];
        let options = ConicOptions::default();
        let found =
            unwatched(|watch| minimize(&mut problem, y, objective, &options, watch)).unwrap();
        let ideal = if found.injective_by_bound.is_some() { 0.0 } else { 1.0 };
        assert!((found.value - ideal).abs() < 1e-5, "{objective:?} {}", found.value);
    }
}

#[test]
fn developable_strips_have_no_distortion() {
    // An open cylinder rolls off: the seam closes by a translation.
    let (mut layout, y) = mapped(&kit::cylinder(12, 3));
    for objective in [ConicObjective::Tau, ConicObjective::TauAlternating] {
        assert!((minimum(&mut layout, &y, objective).value - 1.0).abs() < 1e-5);
    }
    assert!(minimum(&mut layout, &y, ConicObjective::ArapMax).value < 1e-5);
}

/// Own solver and Clarabel on every program of a map's own frames and scales.
#[cfg(feature = "clarabel")]
fn assert_agreement(soup: &TriangleSoup) {
    let (mut layout, y) = mapped(soup);
    for objective in MEASURES {
        let program = program(&layout, objective, &y);
        let mut by = |solver, tolerance| {
            let problem = layout.problem_mut();
            let options = SolverOptions { tolerance, ..SolverOptions::default() };
            unwatched(|watch| solve(problem, &program, &y, solver, &options, watch)).unwrap()
        };
        let (own, other) = (by(Solver::Own, 1e-6), by(Solver::Clarabel, 1e-8));
        assert_eq!((own.solver_used, own.fallback_from), (Solver::Own, None));
        assert_eq!((own.outcome, other.solver_used), (Outcome::Solved, Solver::Clarabel));
        // A layout without distortion has the optimum 0.
        let difference = (own.objective - other.objective).abs();
        let allowed = 1e-4 * other.objective + 1e-8;
        assert!(difference < allowed, "{objective:?}: {} {}", own.objective, other.objective);
    }
}

#[cfg(feature = "clarabel")]
#[test]
fn solvers_agree() {
    shapes().iter().for_each(assert_agreement);
}

#[cfg(feature = "clarabel")]
#[test]
fn solvers_agree_on_real_meshes() {
    use common::collection;
    let Some(folder) = collection::folder() else { return };
    for file in ["decimated_knight.off", "chipped_torus.obj", "rocker_arm_2500.obj"] {
        if let Some(soup) = collection::read(&folder, file) {
            assert_agreement(&soup);
        }
    }
}

#[test]
fn accelerated_methods_are_no_worse_than_those_printed() {
    for soup in shapes() {
        let (mut layout, y) = mapped(&soup);
        for (fast, printed) in [
            (ConicObjective::Tau, ConicObjective::TauAlternating),
            (ConicObjective::Dilatation, ConicObjective::DilatationAlternating),
            (ConicObjective::Dilatation, ConicObjective::DilatationBisection),
        ] {
            if printed == ConicObjective::DilatationBisection && !Solver::Clarabel.is_available() {
                continue;
            }
            let (a, b) = (minimum(&mut layout, &y, fast), minimum(&mut layout, &y, printed));
            assert!(a.value <= b.value * (1.0 + 2e-2), "{fast:?} {} {}", a.value, b.value);
            assert!(a.value <= a.value_before && b.value <= b.value_before);
        }
    }
}

#[test]
fn minima_are_free_of_flips_and_of_their_own_measure() {
    for soup in shapes() {
        let (mesh, _) = surface(&soup);
        let (mut layout, y) = mapped(&soup);
        for objective in MEASURES {
            let found = minimum(&mut layout, &y, objective);
            assert!(layout.defects(&Sectors::unaligned(&mesh), &found.y).none());
            let z = layout.expand(&found.y);
            let value = objective.value(layout.problem(), None, &z);
            assert!((value - found.value).abs() < 1e-9 * found.value.max(1.0));
            let bounded = matches!(objective, ConicObjective::ArapMax | ConicObjective::AsapMax);
            assert_eq!(found.injective_by_bound, bounded.then_some(found.value < 1.0));
        }
    }
}

#[test]
fn size_and_pose_do_not_matter() {
    let (mut layout, y) = mapped(&kit::bumpy(&kit::icosphere(2), 0.1, 3));
    let doubled: Vec<f64> = y.iter().map(|y| 2.0 * y).collect();
    for objective in [ConicObjective::Tau, ConicObjective::AsapMax, ConicObjective::Dilatation] {
        let (a, b) =
            (minimum(&mut layout, &y, objective), minimum(&mut layout, &doubled, objective));
        assert!((a.value / b.value - 1.0).abs() < 1e-6);
    }
    // A quarter turn of the whole layout of a disk, about the pinned wedge.
    let mut problem = square();
    let still = vec![0.0, 0.0, 1.3, 0.2, 1.9, 1.4, 0.5, 1.0];
    let turned: Vec<f64> = still.chunks(2).flat_map(|z| [-z[1], z[0]]).collect();
    let options = ConicOptions { max_rounds: 1, ..ConicOptions::default() };
    let mut value = |y: Vec<f64>| {
        let objective = ConicObjective::TauAlternating;
        unwatched(|watch| minimize(&mut problem, y, objective, &options, watch)).unwrap().value
    };
    assert!((value(still) - value(turned)).abs() < 1e-9);
}

#[test]
fn anisotropic_frames_shape_the_layout() {
    let mut problem = square();
    let frame = [[2.0, 0.0], [0.0, 0.5]];
    let y = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let options = ConicOptions { anisotropy: Some(vec![frame; 2]), ..ConicOptions::default() };
    for objective in [ConicObjective::ArapMax, ConicObjective::Tau] {
        let found =
            unwatched(|watch| minimize(&mut problem, y.clone(), objective, &options, watch))
                .unwrap();
        let j = problem.triangles()[0].jacobian(&problem.space().expand(&found.y));
        let (s1, s2) = j.singular_values();
        // A R for a rotation R: the stretches of A.
        assert!((s1 / s2 - 4.0).abs() < 1e-3, "{s1} {s2}");
    }
}

#[test]
fn failures_are_typed() {
    let (mut layout, y) = mapped(&kit::saddle(6));
    let tau = program(&layout, ConicObjective::Tau, &y);
    let limited = SolverOptions { max_iterations: 3, ..SolverOptions::default() };
    let problem = layout.problem_mut();
    let short = unwatched(|watch| {
        seamstress_parametrize::layout::conic::interior_point::solve(
            problem,
            &tau,
            &y,
            seamstress_parametrize::layout::conic::interior_point::Renewal::Never,
            &limited,
            watch,
        )
    })
    .unwrap();
    assert_eq!(short.outcome, Outcome::IterationLimit);
    assert!(short.objective.is_finite() && short.gap > limited.tolerance);

    // Frames turned half around: the start satisfies nothing, and Clarabel, if it is there, says there is no
    // solution near it.
    let mut turned = tau.clone();
    turned.frames.iter_mut().for_each(|r| *r *= Complex64::from_polar(1.0, 2.0));
    let options = SolverOptions::default();
    let fallback =
        unwatched(|watch| solve(problem, &turned, &y, Solver::Own, &options, watch)).unwrap();
    if Solver::Clarabel.is_available() {
        assert_eq!(fallback.fallback_from, Some(Outcome::NoInteriorStart));
        assert_eq!(fallback.solver_used, Solver::Clarabel);
    } else {
        assert_eq!(fallback.outcome, Outcome::NoInteriorStart);
        assert_eq!((fallback.solver_used, fallback.fallback_from), (Solver::Own, None));
    }

    // Numbers that are not finite leave no factor.
    let mut broken = tau.clone();
    broken.scales = Some(vec![f64::MAX; broken.frames.len()]);
    let lost =
        unwatched(|watch| solve(problem, &broken, &y, Solver::Own, &options, watch)).unwrap();
    assert_ne!(lost.outcome, Outcome::Solved);

    let flipped: Vec<f64> =
        y.iter().enumerate().map(|(k, y)| if k % 2 == 0 { -y } else { *y }).collect();
    let settings = ConicOptions::default();
    let refused = unwatched(|watch| {
        minimize(layout.problem_mut(), flipped, ConicObjective::Tau, &settings, watch)
    });
    assert!(matches!(refused, Err(ConicError::FlippedStart { triangle: 0 })));
    let singular = ConicOptions {
        anisotropy: Some(vec![[[1.0, 1.0], [1.0, 1.0]]; 1]),
        ..ConicOptions::default()
    };
    let refused =
        unwatched(|watch| minimize(layout.problem_mut(), y, ConicObjective::Tau, &singular, watch));
    assert!(matches!(refused, Err(ConicError::BadFrame { triangle: 0 })));
}

/// What asks for the reference solver is refused by name where it is not part of the build.
#[cfg(not(feature = "clarabel"))]
#[test]
fn a_missing_reference_solver_is_a_typed_outcome() {
    let y = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let by_clarabel = ConicOptions { solver: Solver::Clarabel, ..ConicOptions::default() };
    for (objective, options) in [
        (ConicObjective::Tau, &by_clarabel),
        (ConicObjective::DilatationBisection, &ConicOptions::default()),
    ] {
        let refused =
            unwatched(|watch| minimize(&mut square(), y.clone(), objective, options, watch));
        assert!(matches!(refused, Err(ConicError::NoReferenceSolver)), "{objective:?}");
    }
    let mut problem = square();
    let program = ConicObjective::Tau.program(&problem, None, &problem.space().expand(&y));
    let options = SolverOptions::default();
    let found =
        unwatched(|watch| solve(&mut problem, &program, &y, Solver::Clarabel, &options, watch));
    assert_eq!(found.unwrap().outcome, Outcome::ReferenceUnavailable);
}

#[test]
fn the_polish_keeps_to_its_budget_and_to_its_time() {
    for soup in shapes() {
        let (mesh, _) = surface(&soup);
        let (mut layout, y) = mapped(&soup);
        let settle = seamstress_parametrize::layout::newton::NewtonOptions {
            max_iterations: 40,
            tolerance: 1e-6,
        };
        let energy = seamstress_parametrize::layout::energy::SymmetricDirichlet;
        let relaxed =
            unwatched(|watch| layout.minimize(y.clone(), &energy, &settle, watch)).unwrap().y;
        let (least, before) = (layout.distortion(&relaxed).0, layout.distortion(&y).1);
        for max_energy_rise in [0.0005, 0.003, 0.02] {
            let options = PolishOptions { max_energy_rise, time_limit: None };
            let found =
                unwatched(|watch| polish(&mut layout, &relaxed, &y, &options, watch)).unwrap();
            if let Some(found) = found {
                let (energy, tau) = layout.distortion(&found.y);
                assert!(energy <= least * (1.0 + max_energy_rise) && tau < before);
                assert!(layout.defects(&Sectors::unaligned(&mesh), &found.y).none());
            } else {
                assert!(max_energy_rise < 0.02, "a generous budget gains something");
            }
        }
        let hurried =
            PolishOptions { time_limit: Some(Duration::ZERO), ..PolishOptions::default() };
        let none = unwatched(|watch| polish(&mut layout, &relaxed, &y, &hurried, watch)).unwrap();
        assert!(none.is_none());
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let (mut layout, y) = mapped(&kit::icosphere(3));
    let mut on = |threads: usize| {
        with_threads(threads, || minimum(&mut layout, &y, ConicObjective::Tau).y).unwrap()
    };
    assert_eq!(on(1), on(3));
}
