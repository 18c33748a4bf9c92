//! The multifrontal factorisation against faer, on random and on regular patterns.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::prelude::*;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use proptest::prelude::*;
use seamstress_linalg::ordering::{Graph, expand, fill_reducing_order};
use seamstress_linalg::{
    Cholesky, Complex64, NotPositiveDefinite, Pattern, PatternBuilder, Scalar,
};
use seamstress_parallel::with_threads;

/// A matrix, by the lower triangle, and an order of its unknowns.
#[derive(Debug, Clone)]
struct System<T> {
    pattern: Pattern,
    values: Vec<T>,
    order: Vec<u32>,
}

/// Numbers the tests can make up.
trait Number: Scalar + faer::traits::ComplexField {
    fn from_parts(re: f64, im: f64) -> Self;
    fn magnitude(self) -> f64;
    fn bits(self) -> [u64; 2];
}

impl Number for f64 {
    fn from_parts(re: f64, _: f64) -> Self {
        re
    }
    fn magnitude(self) -> f64 {
        self.abs()
    }
    fn bits(self) -> [u64; 2] {
        [self.to_bits(), 0]
    }
}

impl Number for Complex64 {
    fn from_parts(re: f64, im: f64) -> Self {
        Complex64::new(re, im)
    }
    fn magnitude(self) -> f64 {
        self.norm()
    }
    fn bits(self) -> [u64; 2] {
        [self.re.to_bits(), self.im.to_bits()]
    }
}

/// Numbers between -1 and 1 that look random (splitmix64).
fn noise(seed: u64) -> f64 {
    let mut z = seed.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

impl<T: Number> System<T> {
    /// Random entries, with a diagonal that outweighs its row.
    fn dominant(pattern: Pattern, order: Vec<u32>) -> Self {
        let mut values = vec![T::default(); pattern.len()];
        let mut sums = vec![1.0; pattern.order()];
        for column in 0..pattern.order() {
            let (begin, end) = (pattern.column_offsets[column], pattern.column_offsets[column + 1]);
            for slot in begin + 1..end {
                let seed = 2 * u64::from(slot);
                let value = T::from_parts(noise(seed), noise(seed + 1));
                values[slot as usize] = value;
                sums[column] += value.magnitude();
                sums[pattern.rows[slot as usize] as usize] += value.magnitude();
            }
        }
        for (&slot, sum) in pattern.diagonal().iter().zip(sums) {
            values[slot as usize] = T::from(sum);
        }
        Self { pattern, values, order }
    }

    fn rhs(&self, seed: u64) -> Vec<T> {
        let number = |k: usize| {
            let seed = 1_000_003 * (seed + 1) + 2 * k as u64;
            T::from_parts(noise(seed), noise(seed + 1))
        };
        (0..self.pattern.order()).map(number).collect()
    }

    /// Largest difference between `A x` and `b`.
    fn residual(&self, x: &[T], b: &[T]) -> f64 {
        let mut sum: Vec<T> = b.to_vec();
        for column in 0..self.pattern.order() {
            let range = self.pattern.column_offsets[column] as usize
                ..self.pattern.column_offsets[column + 1] as usize;
            for (&row, &value) in self.pattern.rows[range.clone()].iter().zip(&self.values[range]) {
                let row = row as usize;
                sum[row] -= value * x[column];
                if row != column {
                    sum[column] -= value.conjugate() * x[row];
                }
            }
        }
        sum.iter().map(|x| x.magnitude()).fold(0.0, f64::max)
    }

    /// The solution by faer, which chooses its own order.
    fn reference(&self, b: &[T]) -> Vec<T> {
        let n = self.pattern.order();
        let symbolic = SymbolicSparseColMat::<usize>::new_checked(
            n,
            n,
            self.pattern.column_offsets.iter().map(|&x| x as usize).collect(),
            None,
            self.pattern.rows.iter().map(|&x| x as usize).collect(),
        );
        let matrix = SparseColMat::new(symbolic, self.values.clone());
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), faer::Side::Lower).unwrap();
        let llt = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), faer::Side::Lower).unwrap();
        let mut x = Col::from_fn(n, |i| b[i]);
        llt.solve_in_place(x.as_mut());
        (0..n).map(|i| x[i]).collect()
    }
}

fn pattern_of(n: usize, edges: &[(u32, u32)]) -> Pattern {
    let mut builder = PatternBuilder::new(n);
    edges.iter().filter(|(a, b)| a != b).for_each(|&(a, b)| builder.add_clique(&[a, b]));
    builder.build()
}

/// A grid with diagonals, as a mesh has, of `side * side` points with some unknowns each.
fn grid<T: Number>(side: u32, unknowns: u32) -> System<T> {
    let at = |i: u32, j: u32| i * side + j;
    let mut triangles = Vec::new();
    for (i, j) in (1..side).flat_map(|i| (1..side).map(move |j| (i, j))) {
        triangles.push([at(i - 1, j - 1), at(i, j - 1), at(i, j)]);
        triangles.push([at(i - 1, j - 1), at(i, j), at(i - 1, j)]);
    }
    let mut builder = PatternBuilder::new((side * side * unknowns) as usize);
    for t in &triangles {
        let clique: Vec<u32> =
            t.iter().flat_map(|v| (0..unknowns).map(move |k| v * unknowns + k)).collect();
        builder.add_clique(&clique);
    }
    let edges = triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let order = fill_reducing_order(&Graph::from_edges((side * side) as usize, edges));
    System::dominant(builder.build(), expand(&order, unknowns))
}

fn bits<T: Number>(x: &[T]) -> Vec<[u64; 2]> {
    x.iter().map(|x| x.bits()).collect()
}

/// Solves like faer and to working precision; several right-hand sides at once give the bits of each alone; so does
/// a factorisation that follows others.
fn check<T: Number>(system: &System<T>) {
    let mut cholesky = Cholesky::<T>::analyze(&system.pattern, &system.order).unwrap();
    cholesky.factorize(&system.values).unwrap();
    let columns = 7;
    let rhs: Vec<Vec<T>> = (0..columns).map(|k| system.rhs(k)).collect();
    let mut solutions = rhs.clone();
    solutions.iter_mut().for_each(|x| cholesky.solve(x));
    for (x, b) in solutions.iter().zip(&rhs) {
        assert!(system.residual(x, b) < 1e-13 * (1.0 + system.pattern.order() as f64).sqrt());
        let reference = system.reference(b);
        assert!(x.iter().zip(reference).all(|(&x, y)| (x - y).magnitude() < 1e-12));
    }
    for count in 0..=columns as usize {
        let mut together = rhs[..count].concat();
        cholesky.solve_columns(&mut together, count);
        assert_eq!(bits(&together), bits(&solutions[..count].concat()));
    }
    let doubled: Vec<T> = system.values.iter().map(|x| x.scale(2.0)).collect();
    cholesky.factorize(&doubled).unwrap();
    let mut half = rhs[0].clone();
    cholesky.solve(&mut half);
    half.iter_mut().for_each(|x| *x = x.scale(2.0));
    assert!(half.iter().zip(&solutions[0]).all(|(&x, &y)| (x - y).magnitude() < 1e-12));
    cholesky.factorize(&system.values).unwrap();
    let mut again = rhs[0].clone();
    cholesky.solve(&mut again);
    assert_eq!(bits(&again), bits(&solutions[0]));
}

/// Up to 40 unknowns in any order, joined in any way: in pieces, as trees, or all with all.
fn random_pattern() -> impl Strategy<Value = (Pattern, Vec<u32>)> {
    (1..40usize).prop_flat_map(|n| {
        let edges = prop::collection::vec((0..n as u32, 0..n as u32), 0..4 * n);
        let order = Just((0..n as u32).collect::<Vec<_>>()).prop_shuffle();
        (edges, order).prop_map(move |(edges, order)| (pattern_of(n, &edges), order))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn random_real_systems((pattern, order) in random_pattern()) {
        check(&System::<f64>::dominant(pattern, order));
    }

    #[test]
    fn random_hermitian_systems((pattern, order) in random_pattern()) {
        check(&System::<Complex64>::dominant(pattern, order));
    }

    /// A matrix shifted by a little less than its least eigenvalue is positive definite, by a little more it is not.
    #[test]
    fn indefinite_matrices_are_refused((pattern, order) in random_pattern()) {
        let system = System::<f64>::dominant(pattern, order);
        let least = least_eigenvalue(&system);
        let mut cholesky = Cholesky::<f64>::analyze(&system.pattern, &system.order).unwrap();
        for (part, expected) in [(0.999, Ok(())), (1.001, Err(NotPositiveDefinite))] {
            let mut values = system.values.clone();
            for &slot in system.pattern.diagonal() {
                values[slot as usize] -= part * least;
            }
            prop_assert_eq!(cholesky.factorize(&values), expected);
        }
    }

    /// Any value that is not finite makes a matrix that is refused.
    #[test]
    fn values_must_be_finite(
        (pattern, order) in random_pattern(),
        at in any::<prop::sample::Index>(),
        bad in prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
    ) {
        let mut system = System::<f64>::dominant(pattern, order);
        let at = at.index(system.values.len());
        system.values[at] = bad;
        let mut cholesky = Cholesky::<f64>::analyze(&system.pattern, &system.order).unwrap();
        let refused = cholesky.factorize(&system.values);
        prop_assert_eq!(refused, Err(NotPositiveDefinite));
    }

    /// The selected inverse against the inverse of the dense matrix.
    #[test]
    fn selected_inverses((pattern, order) in random_pattern()) {
        let system = System::<f64>::dominant(pattern, order);
        let mut cholesky = Cholesky::<f64>::analyze(&system.pattern, &system.order).unwrap();
        cholesky.factorize(&system.values).unwrap();
        let selected = cholesky.selected_inverse(&system.pattern);
        let inverse = dense(&system).partial_piv_lu().inverse();
        for column in 0..system.pattern.order() {
            let range = system.pattern.column_offsets[column] as usize
                ..system.pattern.column_offsets[column + 1] as usize;
            for slot in range {
                let row = system.pattern.rows[slot] as usize;
                prop_assert!((selected[slot] - inverse[(row, column)]).abs() < 1e-13);
            }
        }
    }
}

fn dense(system: &System<f64>) -> Mat<f64> {
    let n = system.pattern.order();
    Mat::from_fn(n, n, |i, j| {
        let slot = system.pattern.slot(i as u32, j as u32);
        slot.map_or(0.0, |slot| system.values[slot as usize])
    })
}

fn least_eigenvalue(system: &System<f64>) -> f64 {
    let eigenvalues = dense(system).self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
    eigenvalues.into_iter().fold(f64::INFINITY, f64::min)
}

#[test]
fn grids_with_one_two_and_three_unknowns_per_point() {
    for unknowns in 1..=3 {
        check(&grid::<f64>(20, unknowns));
        check(&grid::<Complex64>(20, unknowns));
    }
    // Large enough for several pieces.
    check(&grid::<f64>(60, 2));
}

#[test]
fn points_with_one_unknown_among_points_with_two() {
    // Every third point of a grid keeps its first unknown only.
    let full = grid::<f64>(16, 2);
    let kept = |i: u32| i % 6 != 1;
    let mut number = vec![u32::MAX; full.pattern.order()];
    let kept_unknowns = (0..full.pattern.order() as u32).filter(|&i| kept(i));
    kept_unknowns.enumerate().for_each(|(k, i)| number[i as usize] = k as u32);
    let mut edges = Vec::new();
    for column in (0..full.pattern.order()).filter(|&j| kept(j as u32)) {
        let range = full.pattern.column_offsets[column] as usize
            ..full.pattern.column_offsets[column + 1] as usize;
        let rows = full.pattern.rows[range].iter().filter(|&&row| kept(row));
        edges.extend(rows.map(|&row| (number[row as usize], number[column])));
    }
    let order: Vec<u32> =
        full.order.iter().filter(|&&i| kept(i)).map(|&i| number[i as usize]).collect();
    check(&System::<f64>::dominant(pattern_of(order.len(), &edges), order));
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    fn check_threads<T: Number>(system: &System<T>) {
        let solve = |threads: usize| {
            let mut cholesky = Cholesky::<T>::analyze(&system.pattern, &system.order).unwrap();
            let mut x = system.rhs(0);
            with_threads(threads, || {
                cholesky.factorize(&system.values).unwrap();
                cholesky.solve(&mut x);
            })
            .unwrap();
            bits(&x)
        };
        let alone = solve(1);
        for threads in [2, 3, 8] {
            assert_eq!(alone, solve(threads), "{threads} threads");
        }
    }
    // Large enough for subtrees and for fronts that are cut into strips.
    check_threads(&grid::<f64>(100, 2));
    check_threads(&grid::<Complex64>(70, 1));
}

#[test]
fn a_dense_matrix_is_one_front() {
    let n = 150;
    let mut builder = PatternBuilder::new(n);
    builder.add_clique(&(0..n as u32).collect::<Vec<_>>());
    let order = (0..n as u32).rev().collect();
    check(&System::<f64>::dominant(builder.build(), order));
}

#[test]
fn a_star_and_a_path() {
    let star: Vec<(u32, u32)> = (1..3000).map(|leaf| (0, leaf)).collect();
    let inwards = (0..3000).rev().collect();
    check(&System::<f64>::dominant(pattern_of(3000, &star), inwards));
    let path: Vec<(u32, u32)> = (1..3000).map(|k| (k - 1, k)).collect();
    check(&System::<f64>::dominant(pattern_of(3000, &path), (0..3000).collect()));
}

#[test]
fn many_pieces() {
    // Points, pairs and a path, one after the other.
    let mut edges: Vec<(u32, u32)> = (1000..2000).map(|k| (2 * k - 1000, 2 * k - 999)).collect();
    edges.extend((3001..4000).map(|k| (k - 1, k)));
    check(&System::<f64>::dominant(pattern_of(4000, &edges), (0..4000).collect()));
    check(&System::<Complex64>::dominant(pattern_of(4000, &edges), (0..4000).rev().collect()));
}
