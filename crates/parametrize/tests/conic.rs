//! Conic programs on layouts: optima known by hand, two solvers, invariance, failures.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{surface, unwatched};
use num_complex::Complex64;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parallel::with_threads;
use seamstress_parametrize::energy::Triangle;
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::layout::conic::{
    ConicError, ConicMinimum, ConicOptions, MaximalMeasure, Outcome, Phase, Program, Renewal,
    Solver, SolverOptions, interior_point, minimize, solve,
};
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::layout::space::LinearSpace;
use seamstress_parametrize::{MapOptions, make_map};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

const MEASURES: [MaximalMeasure; 4] =
    [MaximalMeasure::Tau, MaximalMeasure::Arap, MaximalMeasure::Asap, MaximalMeasure::Dilatation];

/// Algorithm 1 as printed.
fn printed(measure: MaximalMeasure) -> Vec<Phase> {
    vec![Phase::Alternating(measure)]
}

/// A fused run first.
fn fast(measure: MaximalMeasure) -> Vec<Phase> {
    vec![Phase::Fused(measure), Phase::Alternating(measure)]
}

/// (11), then (12).
fn fast_dilatation() -> Vec<Phase> {
    [fast(MaximalMeasure::Asap), fast(MaximalMeasure::Dilatation)].concat()
}

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

fn program(layout: &ExactLayout, measure: MaximalMeasure, y: &[f64]) -> Program {
    measure.program(layout.problem(), &layout.expand(y))
}

fn minimum(layout: &mut ExactLayout, y: &[f64], phases: &[Phase]) -> ConicMinimum {
    let options = ConicOptions::default();
    let problem = layout.problem_mut();
    unwatched(|watch| minimize(problem, y.to_vec(), phases, &options, watch)).unwrap()
}

/// Two triangles of a unit square, every corner free but the first.
fn square() -> LayoutProblem {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let soup = TriangleSoup { positions, faces: vec![[0, 1, 2], [0, 2, 3]] };
    let (mesh, metric) = surface(&soup);
    let cut = seamstress_parametrize::cut::Cut::new(&mesh, |_| true);
    let triangles = seamstress_parametrize::energy::triangles(&mesh, &metric, &cut);
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
    let methods = MEASURES.into_iter().flat_map(|measure| [printed(measure), fast(measure)]);
    for phases in methods.chain([fast_dilatation()]) {
        for solver in solvers() {
            let mut problem = square();
            let sheared = vec![0.0, 0.0, 1.3, 0.2, 1.9, 1.4, 0.5, 1.0];
            let options = ConicOptions { solver, ..ConicOptions::default() };
            let found =
                unwatched(|watch| minimize(&mut problem, sheared, &phases, &options, watch))
                    .unwrap();
            let ideal = if found.injective_by_bound.is_some() { 0.0 } else { 1.0 };
            assert!((found.value - ideal).abs() < 1e-4, "{phases:?} {solver:?} {found:?}");
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
    let mut program = MaximalMeasure::Arap.program(&problem, &z);
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
    let tau = minimum(&mut layout, &y, &fast(MaximalMeasure::Tau)).value;
    assert!((tau - stretch.sqrt()).abs() < 1e-5, "{tau}");
    let dilatation = minimum(&mut layout, &y, &fast_dilatation()).value;
    assert!((dilatation - stretch).abs() < 1e-4, "{dilatation}");
    if Solver::Clarabel.is_available() {
        let bisected = minimum(&mut layout, &y, &[Phase::Bisection]).value;
        assert!((bisected - stretch).abs() < 2e-3, "{bisected}");
    }
    let similar = minimum(&mut layout, &y, &fast(MaximalMeasure::Asap)).value;
    let expected = (stretch - 1.0).powi(2) / (stretch * stretch + 1.0);
    assert!((similar - expected).abs() < 1e-5, "{similar}");
    // (8) at the best scale of the triangle: s1 - 1 = 1 - s2 times the ratio's weights
    let rigid = minimum(&mut layout, &y, &fast(MaximalMeasure::Arap)).value;
    assert!((rigid - expected).abs() < 1e-5, "{rigid}");
}

#[test]
fn a_single_triangle_has_no_distortion() {
    let triangle = Triangle {
        wedges: [0, 1, 2],
        gradients: [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]],
        weight: 1.0,
        wanted: Complex64::ZERO,
    };
    for measure in MEASURES {
        let mut problem = problem(3, vec![triangle]);
        let y = vec![0.0, 0.0, 2.0, 0.3, -0.4, 0.7];
        let (phases, options) = (fast(measure), ConicOptions::default());
        let found = unwatched(|watch| minimize(&mut problem, y, &phases, &options, watch)).unwrap();
        let ideal = if found.injective_by_bound.is_some() { 0.0 } else { 1.0 };
        assert!((found.value - ideal).abs() < 1e-5, "{measure:?} {}", found.value);
    }
}

#[test]
fn developable_strips_have_no_distortion() {
    // An open cylinder rolls off: the seam closes by a translation.
    let (mut layout, y) = mapped(&kit::cylinder(12, 3));
    for phases in [fast(MaximalMeasure::Tau), printed(MaximalMeasure::Tau)] {
        assert!((minimum(&mut layout, &y, &phases).value - 1.0).abs() < 1e-5);
    }
    assert!(minimum(&mut layout, &y, &fast(MaximalMeasure::Arap)).value < 1e-5);
}

/// Own solver and Clarabel on every program of a map's own frames and scales.
#[cfg(feature = "clarabel")]
fn assert_agreement(soup: &TriangleSoup) {
    let (mut layout, y) = mapped(soup);
    for measure in MEASURES {
        let program = program(&layout, measure, &y);
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
        assert!(difference < allowed, "{measure:?}: {} {}", own.objective, other.objective);
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
            (fast(MaximalMeasure::Tau), printed(MaximalMeasure::Tau)),
            (fast_dilatation(), printed(MaximalMeasure::Dilatation)),
            (fast_dilatation(), vec![Phase::Bisection]),
        ] {
            if printed == [Phase::Bisection] && !Solver::Clarabel.is_available() {
                continue;
            }
            let (a, b) = (minimum(&mut layout, &y, &fast), minimum(&mut layout, &y, &printed));
            assert!(a.value <= b.value * (1.0 + 2e-2), "{fast:?} {} {}", a.value, b.value);
            assert!(a.value <= a.value_before && b.value <= b.value_before);
        }
    }
}

/// Goes on from a layout for many rounds, whatever they gain.
fn longer(layout: &mut ExactLayout, y: &[f64], measure: MaximalMeasure) -> ConicMinimum {
    let options = ConicOptions { max_rounds: 60, tolerance: 0.0, ..ConicOptions::default() };
    let (problem, phases) = (layout.problem_mut(), printed(measure));
    unwatched(|watch| minimize(problem, y.to_vec(), &phases, &options, watch)).unwrap()
}

#[test]
fn what_counts_as_settled_hardly_falls_any_more() {
    let tolerance = ConicOptions::default().tolerance;
    for soup in shapes() {
        let (mut layout, y) = mapped(&soup);
        for measure in MEASURES {
            for phases in [fast(measure), printed(measure)] {
                let found = minimum(&mut layout, &y, &phases);
                assert!(found.remaining.unwrap() <= tolerance, "{phases:?} {found:?}");
                let longer = longer(&mut layout, &found.y, measure).value;
                let left = found.value - longer;
                // What is left is an estimate.
                assert!(
                    left <= 1.5 * tolerance * longer + 1e-9,
                    "{phases:?}: {} {longer}",
                    found.value
                );
            }
        }
    }
}

#[test]
fn rounds_that_run_out_do_not_count_as_settled() {
    let (mut layout, y) = mapped(&kit::icosphere(2));
    let options = ConicOptions { max_rounds: 2, ..ConicOptions::default() };
    let phases = printed(MaximalMeasure::Asap);
    let problem = layout.problem_mut();
    let found = unwatched(|watch| minimize(problem, y, &phases, &options, watch)).unwrap();
    assert!(found.outcome == Outcome::Solved && found.remaining.unwrap() > options.tolerance);
}

#[test]
fn minima_are_free_of_flips_and_of_their_own_measure() {
    for soup in shapes() {
        let (mesh, _) = surface(&soup);
        let (mut layout, y) = mapped(&soup);
        for measure in MEASURES {
            let found = minimum(&mut layout, &y, &fast(measure));
            assert!(layout.defects(&Sectors::unaligned(&mesh), &found.y).none());
            let z = layout.expand(&found.y);
            let value = measure.of_layout(layout.problem(), &z);
            assert!((value - found.value).abs() < 1e-9 * found.value.max(1.0));
            let bounded = matches!(measure, MaximalMeasure::Arap | MaximalMeasure::Asap);
            assert_eq!(found.injective_by_bound, bounded.then_some(found.value < 1.0));
        }
    }
}

#[test]
fn size_and_pose_do_not_matter() {
    let (mut layout, y) = mapped(&kit::bumpy(&kit::icosphere(2), 0.1, 3));
    let doubled: Vec<f64> = y.iter().map(|y| 2.0 * y).collect();
    let (tau, asap) = (fast(MaximalMeasure::Tau), fast(MaximalMeasure::Asap));
    for phases in [tau, asap, fast_dilatation()] {
        let [a, b] = [&y, &doubled].map(|y| minimum(&mut layout, y, &phases));
        assert!((a.value / b.value - 1.0).abs() < 1e-6);
    }
    // A quarter turn of the whole layout of a disk, about the pinned wedge.
    let mut problem = square();
    let still = vec![0.0, 0.0, 1.3, 0.2, 1.9, 1.4, 0.5, 1.0];
    let turned: Vec<f64> = still.chunks(2).flat_map(|z| [-z[1], z[0]]).collect();
    let options = ConicOptions { max_rounds: 1, ..ConicOptions::default() };
    let mut value = |y: Vec<f64>| {
        let phases = printed(MaximalMeasure::Tau);
        unwatched(|watch| minimize(&mut problem, y, &phases, &options, watch)).unwrap().value
    };
    assert!((value(still) - value(turned)).abs() < 1e-9);
}

#[test]
fn failures_are_typed() {
    let (mut layout, y) = mapped(&kit::saddle(6));
    let tau = program(&layout, MaximalMeasure::Tau, &y);
    let limited = SolverOptions { max_iterations: 3, ..SolverOptions::default() };
    let problem = layout.problem_mut();
    let short = unwatched(|watch| {
        interior_point::solve(problem, &tau, &y, Renewal::Never, &limited, watch)
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
    let (phases, settings) = (fast(MaximalMeasure::Tau), ConicOptions::default());
    let refused =
        unwatched(|watch| minimize(layout.problem_mut(), flipped, &phases, &settings, watch));
    assert!(matches!(refused, Err(ConicError::FlippedStart { triangle: 0 })));
}

/// What asks for the reference solver is refused by name where it is not part of the build.
#[cfg(not(feature = "clarabel"))]
#[test]
fn a_missing_reference_solver_is_a_typed_outcome() {
    let y = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let by_clarabel = ConicOptions { solver: Solver::Clarabel, ..ConicOptions::default() };
    for (phases, options) in [
        (fast(MaximalMeasure::Tau), &by_clarabel),
        (vec![Phase::Bisection], &ConicOptions::default()),
    ] {
        let refused =
            unwatched(|watch| minimize(&mut square(), y.clone(), &phases, options, watch));
        assert!(matches!(refused, Err(ConicError::NoReferenceSolver)), "{phases:?}");
    }
    let mut problem = square();
    let program = MaximalMeasure::Tau.program(&problem, &problem.space().expand(&y));
    let options = SolverOptions::default();
    let found =
        unwatched(|watch| solve(&mut problem, &program, &y, Solver::Clarabel, &options, watch));
    assert_eq!(found.unwrap().outcome, Outcome::ReferenceUnavailable);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let (mut layout, y) = mapped(&kit::icosphere(3));
    let mut on = |threads: usize| {
        let phases = fast(MaximalMeasure::Tau);
        with_threads(threads, || minimum(&mut layout, &y, &phases).y).unwrap()
    };
    assert_eq!(on(1), on(3));
}
