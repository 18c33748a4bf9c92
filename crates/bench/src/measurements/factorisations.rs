//! The factorisations of the method against those of faer.

use crate::markdown::Table;
use crate::meshes::{Selection, Subject};
use crate::output::{Section, progress};
use crate::yardstick::{Kernel, Yardstick};
use clap::value_parser;
use faer::traits::ComplexField;
use num_complex::Complex64;
use seamstress_linalg::ordering::{Graph, expand, fill_reducing_order};
use seamstress_linalg::{Cholesky, Pattern, PatternBuilder, Scalar};
use seamstress_mesh::{HalfedgeData, Metric, TriMesh};
use seamstress_parallel::with_threads;
use std::error::Error;
use std::time::Instant;

/// Factorisations: times of the linear solver against those of faer
///
/// For every mesh three systems with the same elimination order for both: the cotangent Laplacian of two coordinates
/// per vertex with couplings between them (real), the same of one complex number per vertex, and of one real number
/// per vertex, where faer goes column by column. Milliseconds, the least of many; left of each bar our own,
/// right of it faer, which runs on one thread.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Threads of our own factorisation
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u16).range(1..=1024))]
    threads: u16,

    /// Measure this many times and take the least
    #[arg(long, value_name = "R", default_value_t = 15, value_parser = value_parser!(u16).range(1..))]
    repeat: u16,
}

/// Passes if all meshes could be measured.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let titles = [
        "mesh",
        "system",
        "unknowns",
        "analysis",
        "factorisation",
        "solve",
        "solve of 4",
        "entries, millions",
    ];
    let mut table = Table::new(titles);
    let survey = with_threads(args.threads.into(), || {
        let survey = args.selection.survey(|subject| {
            progress(&subject.name);
            measure_mesh(subject, args.repeat, &mut table)
        });
        survey.map_err(|error| error.to_string())
    })?;
    let text = format!("{table}\n{} threads, least of {}\n", args.threads, args.repeat);
    Ok(Section::new(text, &survey?))
}

fn measure_mesh(subject: &Subject, repeat: u16, table: &mut Table) -> Result<(), Box<dyn Error>> {
    let mesh = &subject.mesh.connectivity;
    let metric = Metric::from_positions(mesh, &subject.mesh.positions);
    let cotangent = metric.cotangent();
    let edges = mesh.edges().map(|h| (mesh.origin(h).0, mesh.tip(h).0));
    let order = fill_reducing_order(&Graph::from_edges(mesh.n_vertices(), edges));
    let mut row = |name: &str, cells: Cells| {
        let mut row = vec![subject.name.clone(), name.to_owned()];
        row.extend(cells.0);
        table.push(row);
    };
    let kernel = Kernel::Supernodal;
    let (pair, pairs) = (pattern(mesh, 2), expand(&order, 2));
    let weights = laplacian::<f64>(mesh, &cotangent, &pair, 2);
    row("two real", time(kernel, &pair, &weights, &pairs, repeat)?);
    let pattern = pattern(mesh, 1);
    let weights = laplacian::<Complex64>(mesh, &cotangent, &pattern, 1);
    row("complex", time(kernel, &pattern, &weights, &order, repeat)?);
    let weights = laplacian::<f64>(mesh, &cotangent, &pattern, 1);
    row("one real", time(Kernel::Simplicial, &pattern, &weights, &order, repeat)?);
    Ok(())
}

fn pattern(mesh: &TriMesh, unknowns: u32) -> Pattern {
    let mut builder = PatternBuilder::new(mesh.n_vertices() * unknowns as usize);
    for face in mesh.faces() {
        let corners = mesh.face_vertices(face).into_iter();
        let clique: Vec<u32> =
            corners.flat_map(|v| (0..unknowns).map(move |k| v.0 * unknowns + k)).collect();
        builder.add_clique(&clique);
    }
    builder.build()
}

/// A Laplacian of positive weights, which do not depend on the coordinate.
fn laplacian<T: Scalar>(
    mesh: &TriMesh,
    cotangent: &HalfedgeData<f64>,
    pattern: &Pattern,
    unknowns: u32,
) -> Vec<T> {
    const LEAST: f64 = 0.01;
    let mut values = vec![T::default(); pattern.len()];
    let mut add = |i: u32, j: u32, weight: f64| {
        if let Some(slot) = pattern.slot(i, j) {
            let value = &mut values[slot as usize];
            *value = *value + T::from(weight);
        }
    };
    for h in mesh.halfedges() {
        let weight = cotangent[h].max(LEAST);
        let (a, b) = (mesh.origin(h).0, mesh.tip(h).0);
        for k in 0..unknowns {
            let (a, b) = (a * unknowns + k, b * unknowns + k);
            add(a, b, -weight);
            add(a, a, weight * (1.0 + 1e-8));
            add(b, b, weight * (1.0 + 1e-8));
        }
    }
    values
}

/// The columns of a row after the second.
struct Cells(Vec<String>);

fn time<T: Scalar + ComplexField<Real = f64>>(
    kernel: Kernel,
    pattern: &Pattern,
    values: &[T],
    order: &[u32],
    repeat: u16,
) -> Result<Cells, Box<dyn Error>> {
    const COLUMNS: usize = 4;
    let n = pattern.order();
    // Analysis, factorisation, solve, solve of several: our own and faer's.
    let mut least = [[f64::INFINITY; 2]; 4];
    let mut note = |which: usize, whose: usize, start: Instant| {
        let time = &mut least[which][whose];
        *time = time.min(1e3 * start.elapsed().as_secs_f64());
    };
    let rhs: Vec<T> = (0..n * COLUMNS).map(|k| T::from((k as f64).sin())).collect();
    let mut worst = 0.0f64;
    let mut entries = [0; 2];
    for _ in 0..repeat.div_ceil(5) {
        let start = Instant::now();
        let mut own = Cholesky::<T>::analyze(pattern, order)?;
        note(0, 0, start);
        let start = Instant::now();
        let mut faer = Yardstick::<T>::new(kernel, pattern, order, COLUMNS)?;
        note(0, 1, start);
        entries = [own.factor_len(), faer.factor_len()];
        for _ in 0..5 {
            let start = Instant::now();
            own.factorize(values)?;
            note(1, 0, start);
            let start = Instant::now();
            faer.factorize(pattern, values)?;
            note(1, 1, start);
        }
        for _ in 0..5 {
            let (mut x, mut y) = (rhs.clone(), rhs.clone());
            let start = Instant::now();
            own.solve(&mut x[..n]);
            note(2, 0, start);
            let start = Instant::now();
            faer.solve(&mut y[..n], 1);
            note(2, 1, start);
            let pairs = x[..n].iter().zip(&y[..n]);
            let size = y[..n].iter().map(|y| magnitude(*y)).fold(0.0, f64::max);
            let error = pairs.map(|(&x, &y)| magnitude(x - y)).fold(0.0, f64::max) / size;
            worst = worst.max(error);
            let (mut x, mut y) = (rhs.clone(), rhs.clone());
            let start = Instant::now();
            own.solve_columns(&mut x, COLUMNS);
            note(3, 0, start);
            let start = Instant::now();
            faer.solve(&mut y, COLUMNS);
            note(3, 1, start);
        }
    }
    // The condition of the Laplacians is below 1e10.
    if worst > 1e-4 {
        return Err(format!("solutions differ by {worst:.1e}").into());
    }
    let mut cells = vec![n.to_string()];
    cells.extend(least.iter().map(|[own, faer]| format!("{own:.1} / {faer:.1}")));
    let [own, faer] = entries.map(|count| count as f64 / 1e6);
    cells.push(format!("{own:.2} / {faer:.2}"));
    Ok(Cells(cells))
}

fn magnitude<T: ComplexField<Real = f64>>(x: T) -> f64 {
    faer::traits::math_utils::abs(&x)
}
