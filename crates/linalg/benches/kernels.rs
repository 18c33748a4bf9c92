//! Times of sparse kernels on the Laplacian of a grid, two unknowns per node: `cargo bench -p seamstress-linalg`.
#![allow(clippy::unwrap_used, reason = "a bench has nobody to tell")]

use divan::{Bencher, black_box};
use seamstress_linalg::ordering::{Graph, expand, fill_reducing_order};
use seamstress_linalg::{Assembly, Cholesky, Pattern};

fn main() {
    divan::main();
}

/// Nodes along a side: as many unknowns as a mesh of 20,000 and of 80,000 triangles has.
const SIDES: [u32; 2] = [100, 200];

/// The triangles of a grid of squares, each cut in two.
fn triangles(side: u32) -> Vec<[u32; 3]> {
    let square = |k: u32| {
        let a = k / (side - 1) * side + k % (side - 1);
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    };
    (0..(side - 1) * (side - 1)).flat_map(square).collect()
}

fn graph(side: u32) -> Graph {
    let edges = triangles(side).into_iter().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
    Graph::from_edges((side * side) as usize, edges)
}

/// Elements of six unknowns, what is summed of them, and an order.
struct System {
    pattern: Pattern,
    assembly: Assembly,
    order: Vec<u32>,
    blocks: Vec<f64>,
    values: Vec<f64>,
}

impl System {
    fn new(side: u32) -> Self {
        let elements: Vec<[u32; 6]> = triangles(side)
            .into_iter()
            .map(|face| std::array::from_fn(|k| 2 * face[k / 2] + k as u32 % 2))
            .collect();
        let cliques = || elements.iter().map(<[u32; 6]>::as_slice);
        let pattern = Pattern::of_cliques(2 * (side * side) as usize, cliques());
        let assembly = Assembly::new(pattern.clone(), cliques());
        // Springs between corners, and a weak one to the ground.
        let block = (0..6).flat_map(|i| {
            (0..=i).map(move |j| match (i - j, i % 2 == j % 2) {
                (0, _) => 2.01,
                (_, true) => -1.0,
                (_, false) => 0.0,
            })
        });
        let block: Vec<f64> = block.collect();
        let blocks = block.repeat(elements.len());
        let mut values = vec![0.0; pattern.len()];
        assembly.sum_matrix(&blocks, &mut values);
        let order = expand(&fill_reducing_order(&graph(side)), 2);
        Self { pattern, assembly, order, blocks, values }
    }

    fn factored(&self) -> Cholesky<f64> {
        let mut cholesky = Cholesky::analyze(&self.pattern, &self.order).unwrap();
        cholesky.factorize(&self.values).unwrap();
        cholesky
    }
}

#[divan::bench(args = SIDES)]
fn order(bencher: Bencher<'_, '_>, side: u32) {
    let graph = graph(side);
    bencher.bench(|| fill_reducing_order(black_box(&graph)));
}

#[divan::bench(args = SIDES)]
fn analyze(bencher: Bencher<'_, '_>, side: u32) {
    let System { pattern, order, .. } = System::new(side);
    bencher.bench(|| Cholesky::<f64>::analyze(black_box(&pattern), &order).unwrap().factor_len());
}

#[divan::bench(args = SIDES)]
fn assemble(bencher: Bencher<'_, '_>, side: u32) {
    let System { assembly, blocks, mut values, .. } = System::new(side);
    bencher.bench_local(|| assembly.sum_matrix(black_box(&blocks), &mut values));
}

#[divan::bench(args = SIDES)]
fn factorize(bencher: Bencher<'_, '_>, side: u32) {
    let system = System::new(side);
    let mut cholesky = system.factored();
    bencher.bench_local(|| cholesky.factorize(black_box(&system.values)).unwrap());
}

#[divan::bench(args = SIDES)]
fn solve(bencher: Bencher<'_, '_>, side: u32) {
    let system = System::new(side);
    let mut cholesky = system.factored();
    let mut x = vec![1.0; system.pattern.order()];
    bencher.bench_local(|| {
        x.fill(1.0);
        cholesky.solve(black_box(&mut x));
    });
}

#[divan::bench(args = SIDES)]
fn solve_three_columns(bencher: Bencher<'_, '_>, side: u32) {
    let system = System::new(side);
    let cholesky = system.factored();
    let mut x = vec![1.0; 3 * system.pattern.order()];
    bencher.bench_local(|| {
        x.fill(1.0);
        cholesky.solve_columns(black_box(&mut x), 3);
    });
}
