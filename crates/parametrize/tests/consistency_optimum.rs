//! Proven optima of problem (14) on meshes of 20 vertices, against other ways to find them.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of a test")]

mod common;

use clarabel::algebra::{CscMatrix, MatrixMathMut};
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};
use common::{surface, unwatched};
use microlp::{ComparisonOp, OptimizationDirection, Problem as Mip, Variable};
use proptest::prelude::*;
use seamstress_mesh::{HalfedgeData, TriMesh, VertexData};
use seamstress_parametrize::consistency::{
    AngleNorm, ConsistencyInput, ConsistencyOptions, Consistent, MatchingSet, SeamMatching,
    make_consistent,
};
use seamstress_testkit::{self as kit, Rng};
use std::f64::consts::{FRAC_PI_2, PI};

/// Every edge an integer seam with matching 0: only indices and angles matter.
struct Problem {
    mesh: TriMesh,
    angles: HalfedgeData<f64>,
    indices: VertexData<f64>,
}

impl Problem {
    /// A sphere of 20 vertices with random valences, positions and order; its angles with noise.
    fn random(seed: u64, noise: f64) -> Self {
        let mut rng = Rng::new(seed);
        let soup = kit::small_sphere(seed);
        let (mesh, metric) = surface(&soup);
        let mut angles = metric.angle;
        angles.iter_mut().for_each(|a| *a += noise * (2.0 * rng.unit() - 1.0));
        let mut indices = VertexData(vec![0.0; 20]);
        // Any integers that sum to 8 will do: index moves at will.
        (0..8).for_each(|_| indices.0[rng.below(20)] += 1.0);
        Self { mesh, angles, indices }
    }

    fn solve(&self, options: &ConsistencyOptions) -> Consistent {
        let seam = |left| SeamMatching { left, matching: 0.0, set: MatchingSet::Integer };
        let seams: Vec<SeamMatching> = self.mesh.interior_edges().map(seam).collect();
        let (angles, indices) = (&self.angles, &self.indices);
        let input = ConsistencyInput { angles, indices, seams: &seams };
        unwatched(|watch| make_consistent(&self.mesh, &input, options, watch)).unwrap()
    }

    fn vertex(&self, corner: usize) -> usize {
        self.mesh.origin(seamstress_mesh::Halfedge(corner as u32)).at()
    }

    fn n_corners(&self) -> usize {
        self.angles.len()
    }

    /// Sum of the angles given at each vertex.
    fn given_sums(&self) -> Vec<f64> {
        let mut sums = vec![0.0; 20];
        (0..self.n_corners()).for_each(|c| sums[self.vertex(c)] += self.angles.0[c]);
        sums
    }

    fn valences(&self) -> Vec<i32> {
        let mut valences = vec![0; 20];
        (0..self.n_corners()).for_each(|c| valences[self.vertex(c)] += 1);
        valences
    }

    /// What the angles of each triangle lack of pi.
    fn lacks(&self) -> Vec<f64> {
        self.angles.0.chunks_exact(3).map(|a| PI - a.iter().sum::<f64>()).collect()
    }

    /// The l1 norm by a mixed-integer program: (14) with one integer for each vertex.
    fn optimum_absolute(&self) -> f64 {
        let mut mip = Mip::new(OptimizationDirection::Minimize);
        let change: Vec<[Variable; 2]> = self
            .angles
            .iter()
            .map(|&a| {
                let up = mip.add_var(1.0, (0.0, (PI - a).max(0.0)));
                let down = mip.add_var(1.0, (0.0, a.max(0.0)));
                [up, down]
            })
            .collect();
        for (c, &a) in self.angles.0.iter().enumerate().filter(|(_, a)| **a < 0.0) {
            mip.add_constraint([(change[c][0], 1.0)], ComparisonOp::Ge, -a);
        }
        for (f, lack) in self.lacks().into_iter().enumerate() {
            let terms: Vec<_> = (3 * f..3 * f + 3)
                .flat_map(|c| [(change[c][0], 1.0), (change[c][1], -1.0)])
                .collect();
            mip.add_constraint(&terms, ComparisonOp::Eq, lack);
        }
        let (sums, valences) = (self.given_sums(), self.valences());
        for v in 0..20 {
            let index = mip.add_integer_var(0.0, (5 - 2 * valences[v], 3));
            let mut terms: Vec<_> = (0..self.n_corners())
                .filter(|&c| self.vertex(c) == v)
                .flat_map(|c| [(change[c][0], 1.0), (change[c][1], -1.0)])
                .collect();
            terms.push((index, FRAC_PI_2));
            mip.add_constraint(&terms, ComparisonOp::Eq, 2.0 * PI - sums[v]);
        }
        mip.solve().unwrap().into_solution().unwrap().objective()
    }

    /// The l2 norm by enumeration: without positive angles the value is a quadratic form of the indices,
    /// whose Cholesky factor bounds all that begin alike; with them it is a quadratic program.
    fn optimum_squares(&self) -> f64 {
        let lacks = self.lacks();
        let mut angles = self.angles.0.clone();
        angles.iter_mut().enumerate().for_each(|(c, a)| *a += lacks[c / 3] / 3.0);
        let mut sums = vec![0.0; 20];
        (0..angles.len()).for_each(|c| sums[self.vertex(c)] += angles[c]);
        let mut laplacian = vec![[0.0; 20]; 20];
        for c in 0..self.n_corners() {
            for other in 3 * (c / 3)..3 * (c / 3) + 3 {
                laplacian[self.vertex(c)][self.vertex(other)] +=
                    f64::from(u8::from(c == other)) - 1.0 / 3.0;
            }
        }
        // The last vertex follows from the sum.
        let mut factor = vec![[0.0; 19]; 19];
        for i in 0..19 {
            for j in 0..=i {
                let dot: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
                let rest: f64 = laplacian[i][j] - dot;
                factor[i][j] = if i == j { rest.sqrt() } else { rest / factor[j][j] };
            }
        }
        let value = lacks.iter().map(|t| t * t / 3.0).sum();
        let mut enumeration = Enumeration {
            problem: self,
            factor,
            sums,
            valences: self.valences(),
            best: f64::INFINITY,
            z: Vec::new(),
            index: Vec::new(),
        };
        enumeration.extend(value);
        enumeration.best
    }

    /// The least squares at fixed indices, by Clarabel; none if no angles are positive.
    fn program(&self, index: &[i32]) -> Option<f64> {
        let n = self.n_corners();
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for f in 0..n / 3 {
            rows.push((3 * f..3 * f + 3).map(|c| (c, 1.0)).collect::<Vec<_>>());
            right.push(PI);
        }
        for (v, &k) in index.iter().enumerate() {
            rows.push((0..n).filter(|&c| self.vertex(c) == v).map(|c| (c, 1.0)).collect());
            right.push(f64::from(4 - k) * FRAC_PI_2);
        }
        let equations = rows.len();
        for c in 0..n {
            rows.push(vec![(c, -1.0)]);
            right.push(0.0);
        }
        let entries: Vec<(usize, usize, f64)> = rows
            .iter()
            .enumerate()
            .flat_map(|(r, row)| row.iter().map(move |&(c, x)| (r, c, x)))
            .collect();
        let column = |k: fn(&(usize, usize, f64)) -> usize| entries.iter().map(k).collect();
        let values = entries.iter().map(|e| e.2).collect();
        let matrix =
            CscMatrix::new_from_triplets(rows.len(), n, column(|e| e.0), column(|e| e.1), values);
        let mut square = CscMatrix::<f64>::identity(n);
        square.scale(2.0);
        let cost: Vec<f64> = self.angles.iter().map(|a| -2.0 * a).collect();
        let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
        let cones = [ZeroConeT(equations), NonnegativeConeT(n)];
        let mut solver =
            DefaultSolver::new(&square, &cost, &matrix, &right, &cones, settings).unwrap();
        solver.solve();
        let distance = |x: &[f64]| -> f64 {
            x.iter().zip(self.angles.iter()).map(|(a, b)| (a - b) * (a - b)).sum()
        };
        matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved)
            .then(|| distance(&solver.solution.x))
    }
}

/// Depth-first enumeration of indices after Fincke and Pohst.
struct Enumeration<'a> {
    problem: &'a Problem,
    factor: Vec<[f64; 19]>,
    sums: Vec<f64>,
    valences: Vec<i32>,
    best: f64,
    z: Vec<f64>,
    index: Vec<i32>,
}

impl Enumeration<'_> {
    /// Goes through all indices of the next vertex; `value` bounds what those chosen cost.
    fn extend(&mut self, value: f64) {
        let v = self.z.len();
        if v == 19 {
            let last = 8 - self.index.iter().sum::<i32>();
            if (5 - 2 * self.valences[19]..4).contains(&last) {
                self.index.push(last);
                let found = self.problem.program(&self.index);
                self.best = self.best.min(found.unwrap_or(f64::INFINITY));
                self.index.pop();
            }
            return;
        }
        let before: f64 = (0..v).map(|k| self.factor[v][k] * self.z[k]).sum();
        let wanted = self.sums[v] + before;
        let at = |k: i32| f64::from(4 - k) * FRAC_PI_2 - wanted;
        let mut indices: Vec<i32> = (5 - 2 * self.valences[v]..4).collect();
        indices.sort_by(|&a, &b| at(a).abs().total_cmp(&at(b).abs()));
        for k in indices {
            let z = at(k) / self.factor[v][v];
            if value + z * z >= self.best {
                break;
            }
            self.z.push(z);
            self.index.push(k);
            self.extend(value + z * z);
            self.z.pop();
            self.index.pop();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn squares_are_proven_minimal(seed in 0u64..100_000, noise in 0.0..0.6f64) {
        let problem = Problem::random(seed, noise);
        let solved = problem.solve(&ConsistencyOptions::default());
        prop_assert!(solved.optimal && solved.gap() < 1e-6);
        let optimum = problem.optimum_squares();
        prop_assert!((solved.objective - optimum).abs() < 1e-5, "{} {optimum}", solved.objective);
    }

    #[test]
    fn absolute_values_are_proven_minimal(seed in 0u64..100_000, noise in 0.0..0.6f64) {
        let problem = Problem::random(seed, noise);
        let norm = AngleNorm::L1;
        let solved = problem.solve(&ConsistencyOptions { norm, ..Default::default() });
        prop_assert!(solved.optimal && solved.gap() < 1e-6);
        let optimum = problem.optimum_absolute();
        prop_assert!((solved.objective - optimum).abs() < 1e-5, "{} {optimum}", solved.objective);
    }
}

#[test]
fn local_moves_alone_are_above_the_optimum_and_say_so() {
    let mut excess = 0.0f64;
    for seed in 0..24 {
        let problem = Problem::random(seed, 0.3);
        let options = ConsistencyOptions { norm: AngleNorm::L1, ..Default::default() };
        let local = problem.solve(&ConsistencyOptions { work: 0, ..options });
        let best = problem.solve(&options);
        assert!(best.optimal);
        assert!(
            local.lower_bound <= best.objective + 1e-6 && best.objective <= local.objective + 1e-9
        );
        assert!(local.lower_bound > 0.7 * best.objective, "{}", local.lower_bound);
        excess = excess.max(local.objective / best.objective - 1.0);
        assert!(!local.optimal || local.objective < best.objective + 1e-5);
    }
    assert!(excess > 0.02, "{excess}");
}
