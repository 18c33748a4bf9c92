//! Consistent matchings against hand-worked cases, enumeration, and a checker of their own.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{mapped, mesh_of, surface, unwatched};
use proptest::prelude::*;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use seamstress_parametrize::consistency::{
    AngleNorm, ConsistencyError, ConsistencyInput, ConsistencyOptions, Consistent, MatchingSet,
    SeamMatching, consistent_cut, lifted_angles, make_consistent, matched_by_angles,
};
use seamstress_parametrize::cut::{DualTree, curvature_weight};
use seamstress_parametrize::features::Sectors;
use seamstress_testkit::{self as kit, CheckedSeam, Rng, consistency_faults};
use std::f64::consts::{FRAC_PI_2, PI};

/// A problem that owns its numbers.
#[derive(Clone)]
struct Problem {
    soup: TriangleSoup,
    mesh: TriMesh,
    angles: HalfedgeData<f64>,
    indices: VertexData<f64>,
    seams: Vec<SeamMatching>,
}

impl Problem {
    /// Angles of the surface, every edge an integer seam with matching 0, and the indices given.
    fn new(soup: TriangleSoup, indices: Vec<f64>) -> Self {
        let (mesh, metric) = surface(&soup);
        let seam = |left| SeamMatching { left, matching: 0.0, set: MatchingSet::Integer };
        let seams = mesh.interior_edges().map(seam).collect();
        Self { angles: metric.angle, indices: VertexData(indices), soup, mesh, seams }
    }

    /// The indices of naive rounding: nearest integers to the rotations of the surface's own angles.
    fn naive(soup: TriangleSoup) -> Self {
        let (mesh, metric) = surface(&soup);
        let tree = DualTree::lightest(&mesh, curvature_weight(&mesh, &metric));
        let matched =
            seamstress_parametrize::cut::MatchedCut::new(&Sectors::unaligned(&mesh), &metric, tree);
        let indices = matched.sector_indices(&Sectors::unaligned(&mesh), &metric);
        Self::new(soup, indices.iter().map(|&k| f64::from(k)).collect())
    }

    /// Changes the matching of a seam together with the indices it moves.
    fn turn(&mut self, seam: usize, by: f64) {
        let left = self.seams[seam].left;
        self.seams[seam].matching += by;
        self.indices[self.mesh.origin(left)] -= by;
        self.indices[self.mesh.tip(left)] += by;
    }

    fn solve_with(&self, options: &ConsistencyOptions) -> Result<Consistent, ConsistencyError> {
        let input =
            ConsistencyInput { angles: &self.angles, indices: &self.indices, seams: &self.seams };
        unwatched(|watch| make_consistent(&self.mesh, &input, options, watch))
    }

    fn solve(&self) -> Consistent {
        self.solve_with(&ConsistencyOptions::default()).unwrap()
    }

    fn faults(&self, solved: &Consistent) -> Vec<String> {
        let name = |set| match set {
            MatchingSet::Constant => 'c',
            MatchingSet::Integer => 'i',
            MatchingSet::Real => 'r',
        };
        let pairs = self.seams.iter().zip(&solved.matchings);
        let seams: Vec<_> = pairs
            .map(|(s, &after)| CheckedSeam {
                left: s.left.0,
                before: s.matching,
                after,
                set: name(s.set),
            })
            .collect();
        let (angles, indices) = (&solved.angles, &solved.indices);
        let mut faults =
            consistency_faults(&self.soup.faces, &self.indices, indices, angles, &seams);
        if solved.lower_bound > solved.objective + 1e-9 {
            faults.push(format!("bound {} above {}", solved.lower_bound, solved.objective));
        }
        faults
    }

    fn set(&mut self, set: MatchingSet) {
        self.seams.iter_mut().for_each(|seam| seam.set = set);
    }

    fn shake(&mut self, rng: &mut Rng, noise: f64) {
        self.angles.iter_mut().for_each(|a| *a += noise * (2.0 * rng.unit() - 1.0));
    }
}

#[test]
fn one_wrong_matching_on_a_tetrahedron_is_put_right() {
    let mut problem = Problem::new(kit::tetrahedron(), vec![2.0; 4]);
    problem.turn(0, 1.0);
    let solved = problem.solve();
    assert_eq!(problem.faults(&solved), [""; 0]);
    assert_eq!(solved.indices.0, [2.0; 4]);
    assert!(solved.objective < 1e-12);
    assert!(solved.matchings.iter().all(|&r| r == 0.0));
    assert_eq!((solved.stats.changed_matchings, solved.stats.changed_indices), (1, 2));
}

#[test]
fn angles_for_constant_indices_by_hand() {
    // Indices (1, 3, 2, 2): the Laplacian of a regular tetrahedron is 8/3 on what sums to zero, and the
    // angle sums are off by (1, -1, 0, 0) quarters, so the objective is 2 (pi/2)^2 / (8/3).
    let mut problem = Problem::new(kit::tetrahedron(), vec![2.0; 4]);
    problem.set(MatchingSet::Constant);
    problem.indices = VertexData(vec![1.0, 3.0, 2.0, 2.0]);
    let solved = problem.solve();
    assert_eq!(problem.faults(&solved), [""; 0]);
    assert!((solved.objective - 0.75 * FRAC_PI_2 * FRAC_PI_2).abs() < 1e-9);
    // Each of two vertices spreads a quarter over three corners at best.
    assert!(solved.lower_bound >= 2.0 / 3.0 * FRAC_PI_2 * FRAC_PI_2 - 1e-6);
    assert_eq!(solved.stats.programs, 0);
}

#[test]
fn a_cube_keeps_its_corners() {
    let mut problem = Problem::new(kit::cube(), vec![1.0; 8]);
    for (seam, by) in [(0, 1.0), (5, -1.0), (9, 2.0)] {
        problem.turn(seam, by);
    }
    let solved = problem.solve();
    assert_eq!(problem.faults(&solved), [""; 0]);
    assert_eq!(solved.indices.0, [1.0; 8]);
    assert!(solved.objective < 1e-12);
}

/// All indices with the right sum between two bounds.
fn enumerate(n: usize, sum: i32, low: i32, high: i32) -> Vec<Vec<i32>> {
    if n == 0 {
        return if sum == 0 { vec![Vec::new()] } else { Vec::new() };
    }
    let rest = |k| enumerate(n - 1, sum - k, low, high).into_iter().map(move |r| (k, r));
    (low..=high)
        .flat_map(rest)
        .map(|(k, mut r)| {
            r.push(k);
            r
        })
        .collect()
}

#[test]
fn the_best_of_all_indices() {
    for seed in 0..12 {
        let mut rng = Rng::new(seed);
        let soup = if seed % 2 == 0 { kit::tetrahedron() } else { kit::octahedron() };
        let n = soup.positions.len();
        let mut problem = Problem::naive(soup);
        problem.shake(&mut rng, 0.5);
        let solved = problem.solve();
        assert_eq!(problem.faults(&solved), [""; 0]);
        let mut fixed = problem.clone();
        fixed.set(MatchingSet::Constant);
        let mut best = f64::INFINITY;
        for indices in enumerate(n, 8, 0, 3) {
            fixed.indices = VertexData(indices.iter().map(|&k| f64::from(k)).collect());
            match fixed.solve_with(&ConsistencyOptions::default()) {
                Ok(solved) => best = best.min(solved.objective),
                Err(ConsistencyError::Infeasible { .. }) => {}
                Err(other) => panic!("{other}"),
            }
        }
        assert!(solved.optimal);
        assert!((solved.objective - best).abs() < 1e-6, "{} {best}", solved.objective);
        assert!(solved.lower_bound < best + 1e-7, "{} > {best}", solved.lower_bound);
    }
}

/// Shapes closed and open, of several genera and components.
fn shape(kind: usize, seed: u64) -> TriangleSoup {
    match kind {
        0 => kit::bumpy(&kit::icosphere(2), 0.1, seed),
        1 => kit::bumpy(&kit::torus(10, 7, 2.0, 0.8), 0.1, seed),
        2 => kit::disk_grid(6, 5),
        3 => kit::bumpy(&kit::annulus(9, 3), 0.05, seed),
        4 => kit::disjoint_union(&[kit::octahedron(), kit::disk_grid(3, 4), kit::cube()]),
        _ => kit::random_surface(seed),
    }
}

/// Enough to change indices on shapes of a thousand triangles.
const SOME_WORK: u64 = 4_000_000;

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn whatever_the_damage_all_conditions_hold(
        kind in 0usize..6,
        seed in 0u64..1000,
        noise in 0.0..0.3f64,
        wrong in 0usize..6,
        norm in prop_oneof![Just(AngleNorm::L2), Just(AngleNorm::L1)],
    ) {
        let mut problem = Problem::naive(shape(kind, seed));
        let mut rng = Rng::new(seed);
        for _ in 0..wrong {
            let seam = rng.below(problem.seams.len());
            problem.turn(seam, if rng.unit() < 0.5 { 1.0 } else { -1.0 });
        }
        problem.shake(&mut rng, noise);
        let options = ConsistencyOptions { norm, work: SOME_WORK, ..Default::default() };
        let solved = problem.solve_with(&options);
        let solved = solved.map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(problem.faults(&solved), [""; 0]);
    }

    #[test]
    fn the_three_sets_are_respected(kind in 0usize..6, seed in 0u64..1000) {
        let mut problem = Problem::naive(shape(kind, seed));
        let mut rng = Rng::new(seed);
        // Real matchings at first: unrounded, as in the middle of rounding.
        for seam in 0..problem.seams.len() {
            let kind = rng.below(4);
            problem.seams[seam].set = match kind {
                0 => MatchingSet::Constant,
                1 => MatchingSet::Real,
                _ => MatchingSet::Integer,
            };
            if kind == 1 {
                problem.turn(seam, 0.2 * (2.0 * rng.unit() - 1.0));
            }
        }
        let options = ConsistencyOptions { work: SOME_WORK, ..Default::default() };
        match problem.solve_with(&options) {
            Ok(solved) => prop_assert_eq!(problem.faults(&solved), [""; 0]),
            // Constant matchings may leave no solution.
            Err(ConsistencyError::Infeasible { .. }) => {}
            Err(error) => prop_assert!(false, "{}", error),
        }
    }
}

#[test]
fn free_matchings_leave_the_angles_alone() {
    let mut problem = Problem::naive(kit::bumpy(&kit::icosphere(2), 0.1, 4));
    problem.set(MatchingSet::Real);
    let solved = problem.solve();
    assert_eq!(problem.faults(&solved), [""; 0]);
    assert!(solved.objective < 1e-15);
    let changed = solved.angles.iter().zip(problem.angles.iter()).map(|(a, b)| (a - b).abs());
    assert!(changed.fold(0.0, f64::max) < 1e-9);
}

#[test]
fn absolute_values_concentrate_the_change() {
    let mut problem = Problem::new(kit::bumpy(&kit::torus(12, 9, 2.0, 0.8), 0.02, 1), vec![]);
    problem.indices = VertexData(vec![0.0; problem.mesh.n_vertices()]);
    problem.set(MatchingSet::Constant);
    // Flat angles, then one corner pulled out of place.
    problem.angles = problem.solve().angles;
    let pulled = Halfedge(40);
    problem.angles[pulled] += 0.6;
    problem.angles[pulled.next()] -= 0.6;
    let of = |norm| problem.solve_with(&ConsistencyOptions { norm, ..Default::default() }).unwrap();
    let (squares, absolute) = (of(AngleNorm::L2), of(AngleNorm::L1));
    let changes = |solved: &Consistent| -> Vec<f64> {
        solved.angles.iter().zip(problem.angles.iter()).map(|(a, b)| (a - b).abs()).collect()
    };
    let count = |solved: &Consistent| changes(solved).iter().filter(|&&d| d > 1e-2).count();
    assert!(4 * count(&absolute) < count(&squares), "{} {}", count(&absolute), count(&squares));
    assert!(absolute.objective < 0.9 * changes(&squares).iter().sum::<f64>());
    assert!((absolute.objective - 1.2).abs() < 0.02, "{}", absolute.objective);
    assert!((absolute.lower_bound - 1.2).abs() < 1e-6);
    assert_eq!(problem.faults(&absolute), [""; 0]);
}

#[test]
fn the_same_problem_has_the_same_solution() {
    let mut problem = Problem::naive(kit::bumpy(&kit::icosphere(3), 0.1, 9));
    problem.shake(&mut Rng::new(2), 0.2);
    let (first, second) = (problem.solve(), problem.solve());
    assert_eq!(first.matchings, second.matchings);
    assert_eq!(first.angles, second.angles);
}

#[test]
fn short_memory_changes_nothing() {
    let mut problem = Problem::naive(kit::bumpy(&kit::icosphere(2), 0.1, 9));
    problem.shake(&mut Rng::new(3), 0.3);
    let options = ConsistencyOptions { column_memory: 0, ..Default::default() };
    assert_eq!(problem.solve_with(&options).unwrap().matchings, problem.solve().matchings);
}

#[test]
fn faulty_input_is_named() {
    let good = Problem::new(kit::tetrahedron(), vec![2.0; 4]);
    let error = |change: &dyn Fn(&mut Problem)| {
        let mut problem = good.clone();
        change(&mut problem);
        problem.solve_with(&ConsistencyOptions::default()).unwrap_err()
    };
    assert_eq!(
        error(&|p| p.indices[seamstress_mesh::Vertex(1)] = 3.0),
        ConsistencyError::IndexSum { component: 0, sum: 9.0, expected: 8 }
    );
    assert_eq!(
        error(&|p| p.seams[2] = p.seams[1]),
        ConsistencyError::NoSeam { halfedge: good.seams[1].left.0 }
    );
    assert_eq!(
        error(&|p| p.angles[Halfedge(7)] = f64::NAN),
        ConsistencyError::NonFinite { what: "angle of corner", element: 7 }
    );
    assert_eq!(
        error(&|p| p.indices = VertexData(vec![2.0; 3])),
        ConsistencyError::Count { what: "indices", expected: 4, found: 3 }
    );
    // A vertex of index 4 has no angle left, and constant matchings cannot give it one.
    let stuck = error(&|p| {
        p.set(MatchingSet::Constant);
        p.indices = VertexData(vec![4.0, 2.0, 1.0, 1.0]);
    });
    assert_eq!(stuck, ConsistencyError::Infeasible { vertices: vec![0] });
}

#[test]
fn a_good_map_is_consistent_as_it_is() {
    let soup = kit::bumpy(&kit::torus(14, 9, 2.0, 0.8), 0.1, 1);
    let solution = mapped(&soup);
    let (mesh, metric) = surface(&soup);
    let angles = lifted_angles(&mesh, solution.map.corner_uvs());
    let tree = DualTree::lightest(&mesh, curvature_weight(&mesh, &metric));
    let matched = matched_by_angles(&mesh, &metric, tree, &angles);
    let cones: Vec<(u32, i32)> = solution.map.cones().iter().map(|c| (c.vertex, c.index)).collect();
    let found = matched.sector_indices(&Sectors::unaligned(&mesh), &metric);
    let found: Vec<_> =
        found.enumerate().filter(|(_, k)| **k != 0).map(|(v, &k)| (v.0, k)).collect();
    assert_eq!(found, cones);
    let options = ConsistencyOptions::default();
    let (same, consistent) =
        unwatched(|watch| consistent_cut(&mesh, &metric, &matched, &angles, &options, watch))
            .unwrap();
    assert_eq!(same.matching, matched.matching);
    assert!(consistent.objective < 1e-9);
}

#[test]
fn a_vertex_dragged_through_an_edge_keeps_its_index() {
    // A hexagon whose centre lies outside, beyond one side: one triangle is flipped.
    let soup = kit::fan(6, 0.0, true);
    let mesh = mesh_of(&soup);
    let metric = Metric::from_positions(&mesh, &soup.positions);
    let centre = mesh.vertices().find(|&v| !mesh.is_boundary(v)).unwrap();
    let mut uvs: Vec<[f64; 2]> = mesh
        .halfedges()
        .map(|h| soup.positions[mesh.origin(h).at()])
        .map(|p| [p[0], p[1]])
        .collect();
    let side = mesh.halfedges().find(|&h| mesh.twin(h).is_none()).unwrap();
    let (a, b) = (uvs[side.at()], uvs[side.next().at()]);
    let beyond = [0.51 * (a[0] + b[0]), 0.51 * (a[1] + b[1])];
    mesh.outgoing(centre).for_each(|h| uvs[h.at()] = beyond);
    let angles = lifted_angles(&mesh, &uvs);
    assert!(angles.iter().any(|&a| a < 0.0));
    let sum: f64 = mesh.outgoing(centre).map(|h| angles[h]).sum();
    assert!((sum - 2.0 * PI).abs() < 1e-9, "{sum}");
    for f in mesh.faces() {
        assert!((f.halfedges().map(|h| angles[h]).iter().sum::<f64>() - PI).abs() < 1e-9);
    }
    let tree = DualTree::lightest(&mesh, curvature_weight(&mesh, &metric));
    let matched = matched_by_angles(&mesh, &metric, tree, &angles);
    let options = ConsistencyOptions { norm: AngleNorm::L1, ..Default::default() };
    let (mended, _) =
        unwatched(|watch| consistent_cut(&mesh, &metric, &matched, &angles, &options, watch))
            .unwrap();
    assert_eq!(mended.sector_indices(&Sectors::unaligned(&mesh), &metric)[centre], 0);
}

/// The angles of a flat square whose vertices were dragged over edges: sums are right and angles negative.
fn folded_square() -> Problem {
    let soup = kit::disk_grid(6, 6);
    let mesh = mesh_of(&soup);
    let mut uv =
        |v: seamstress_mesh::Vertex| [soup.positions[v.at()][0], soup.positions[v.at()][1]];
    let mut flat: Vec<[f64; 2]> = mesh.vertices().map(&mut uv).collect();
    let inner: Vec<_> = mesh.vertices().filter(|&v| !mesh.is_boundary(v)).collect();
    let side = mesh.halfedges().next().map(|h| {
        let [a, b] = [mesh.origin(h), mesh.tip(h)].map(|v| flat[v.at()]);
        (a[0] - b[0]).hypot(a[1] - b[1])
    });
    for v in [inner[6], inner[18]] {
        flat[v.at()][0] += 1.3 * side.unwrap();
    }
    let uvs: Vec<[f64; 2]> = mesh.halfedges().map(|h| flat[mesh.origin(h).at()]).collect();
    let mut problem = Problem::new(soup, vec![0.0; mesh.n_vertices()]);
    problem.angles = lifted_angles(&mesh, &uvs);
    problem
}

#[test]
fn the_bound_of_a_folded_map_counts_its_negative_angles() {
    let problem = folded_square();
    let negative: f64 = problem.angles.iter().map(|a| (-a).max(0.0)).sum();
    assert!(negative > 0.5, "{negative}");
    for norm in [AngleNorm::L1, AngleNorm::L2] {
        let solved =
            problem.solve_with(&ConsistencyOptions { norm, work: 0, ..Default::default() });
        let solved = solved.unwrap();
        assert_eq!(problem.faults(&solved), [""; 0]);
        // What is added to a negative angle is taken from another one in its triangle.
        let least = if norm == AngleNorm::L1 { 2.0 * negative } else { 0.1 * negative };
        assert!(solved.lower_bound > 0.999 * least, "{} {least}", solved.lower_bound);
    }
}

#[test]
fn a_broken_map_leads_to_a_good_one() {
    let soup = kit::bumpy(&kit::torus(14, 9, 2.0, 0.8), 0.1, 1);
    let good = mapped(&soup);
    let mesh = mesh_of(&soup);
    let mut uvs = good.map.corner_uvs().to_vec();
    // Drag a few vertices that no seam touches far enough to fold their triangles over.
    let mut rng = Rng::new(5);
    let whole = |v: seamstress_mesh::Vertex| {
        let mut places = mesh.outgoing(v).map(|h| uvs[h.at()]);
        places.next().is_some_and(|first| places.all(|place| place == first))
    };
    let movable: Vec<_> = mesh.vertices().filter(|&v| whole(v)).collect();
    for _ in 0..4 {
        let v = movable[rng.below(movable.len())];
        let [x, y, _] = rng.in_ball().map(|x| 4.0 * x);
        mesh.outgoing(v).for_each(|h| uvs[h.at()] = [uvs[h.at()][0] + x, uvs[h.at()][1] + y]);
    }
    let tolerance = seamstress_parametrize::Tolerance::default();
    assert!(seamstress_parametrize::SeamlessMap::certify(&mesh, uvs.clone(), &tolerance).is_err());
    let start = seamstress_parametrize::Start::Map(uvs);
    let mut go_on = |_| std::ops::ControlFlow::Continue(());
    let options = seamstress_parametrize::MapOptions::default();
    let made =
        seamstress_parametrize::make_map_from(&mesh, &soup.positions, &start, &options, &mut go_on)
            .unwrap();
    common::assert_seamless(&soup, &made);

    let short = seamstress_parametrize::Start::Map(vec![[0.0; 2]; 3]);
    let refused =
        seamstress_parametrize::make_map_from(&mesh, &soup.positions, &short, &options, &mut go_on);
    assert!(matches!(refused, Err(seamstress_parametrize::MapError::Field(_))));
}
