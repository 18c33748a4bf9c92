//! Times of the work on triangles, and of single iterations, on a torus: `cargo bench -p seamstress-parametrize`.
#![allow(clippy::unwrap_used, reason = "a bench has nobody to tell")]

use divan::{Bencher, black_box};
use num_complex::Complex64;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::energy::SymmetricDirichlet;
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::layout::newton::NewtonOptions;
use seamstress_parametrize::layout::polish::{PolishOptions, polish};
use seamstress_parametrize::map::SeamlessMap;
use seamstress_parametrize::progress::Watch;
use seamstress_parametrize::{MapOptions, make_map};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

fn main() {
    divan::main();
}

/// Corners around the tube: 20,000 and 80,000 triangles.
const SIDES: [u32; 2] = [80, 160];

fn torus(side: u32) -> TriangleSoup {
    kit::bumpy(&kit::torus(side * 3 / 2, side, 2.0, 0.8), 0.02, 1)
}

/// A layout of minimum energy and what it is one of.
struct Relaxed {
    mesh: TriMesh,
    map: SeamlessMap,
    layout: ExactLayout,
    y: Vec<f64>,
}

impl Relaxed {
    fn new(side: u32) -> Self {
        let soup = torus(side);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let options = MapOptions { polish: None, ..MapOptions::default() };
        let mut go_on = |_| ControlFlow::Continue(());
        let map = make_map(&mesh, &soup.positions, &options, &mut go_on).unwrap().map;
        let (layout, y) = ExactLayout::from_map(&mesh, &metric, &map).unwrap();
        Self { mesh, map, layout, y }
    }

    fn z(&self) -> Vec<Complex64> {
        self.layout.expand(&self.y)
    }
}

#[divan::bench(args = SIDES)]
fn linearize(bencher: Bencher<'_, '_>, side: u32) {
    let mut relaxed = Relaxed::new(side);
    let z = relaxed.z();
    let problem = relaxed.layout.problem_mut();
    bencher.bench_local(|| problem.linearize(&SymmetricDirichlet, black_box(&z)));
}

#[divan::bench(args = SIDES)]
fn factorize(bencher: Bencher<'_, '_>, side: u32) {
    let mut relaxed = Relaxed::new(side);
    let z = relaxed.z();
    let problem = relaxed.layout.problem_mut();
    problem.linearize(&SymmetricDirichlet, &z);
    bencher.bench_local(|| problem.factorize(1e-10).unwrap());
}

#[divan::bench(args = SIDES)]
fn newton_iteration(bencher: Bencher<'_, '_>, side: u32) {
    let Relaxed { mut layout, y, .. } = Relaxed::new(side);
    let once = NewtonOptions { max_iterations: 1, tolerance: 0.0 };
    bencher.with_inputs(|| y.clone()).bench_local_values(|y| {
        let mut go_on = |_| ControlFlow::Continue(());
        layout.minimize(y, &SymmetricDirichlet, &once, &mut Watch::new(&mut go_on, 0, 1)).unwrap().y
    });
}

#[divan::bench(args = SIDES, sample_count = 10)]
fn polish_of_tau(bencher: Bencher<'_, '_>, side: u32) {
    let Relaxed { mut layout, y, .. } = Relaxed::new(side);
    bencher.bench_local(|| {
        let mut go_on = |_| ControlFlow::Continue(());
        let options = PolishOptions::default();
        polish(&mut layout, black_box(&y), &options, &mut Watch::new(&mut go_on, 0, 1)).unwrap().y
    });
}

#[divan::bench(args = SIDES)]
fn certify(bencher: Bencher<'_, '_>, side: u32) {
    let Relaxed { mesh, map, .. } = Relaxed::new(side);
    let tolerance = MapOptions::default().tolerance;
    bencher.with_inputs(|| map.corner_uvs().to_vec()).bench_local_values(|uvs| {
        SeamlessMap::certify(&mesh, black_box(uvs), &tolerance).unwrap().cones().len()
    });
}
