//! The time of a map, in units of one sparse Cholesky factorisation of the same mesh.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

use clap::{Parser, value_parser};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{self, Mesh};
use seamstress_bench::process::{cpu_seconds, exit_code, forget_peak_memory, peak_memory};
use seamstress_mesh::{Component, Metric, TriMesh, components};
use seamstress_parametrize::cut::Cut;
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::layout::space::LinearSpace;
use seamstress_parametrize::layout::triangle::triangles;
use seamstress_parametrize::{MapOptions, Stage, make_map};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Measures the time of maps against that of one factorisation
///
/// For every mesh, in one process: the median time of a numeric Cholesky factorisation of its cotangent
/// system (two unknowns per vertex, by the same library), and the time of a whole map with default
/// settings. For several meshes, the order of growth of both with the number of triangles.
#[derive(Debug, Parser)]
struct Args {
    /// Meshes of one component each: OBJ, OFF, PLY or STL
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Measure this many times and take the median
    #[arg(long, value_name = "R", default_value_t = 1, value_parser = value_parser!(u16).range(1..))]
    repeat: u16,
}

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

/// Whether all meshes could be measured.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    if let Some(threads) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
        pool.build_global()?;
    }
    // Small ones first: what the allocator keeps of a large mesh would count as memory of a small one.
    let mut paths = args.meshes.clone();
    paths.sort_by_cached_key(|path| meshes::load(path).map_or(0, |m| m.connectivity.n_faces()));
    let mut measured = Vec::new();
    for path in &paths {
        match measure(path, args.repeat) {
            Ok(measurement) => {
                eprintln!("{}: {:.2} s", measurement.name, measurement.map.wall);
                measured.push(measurement);
            }
            Err(error) => eprintln!("error: {error}"),
        }
    }
    print!("{}", table(&measured));
    println!("\n{} threads, median of {}", rayon::current_num_threads(), args.repeat);
    if measured.len() > 1 {
        println!("Order of growth with the number of triangles: {}", growth(&measured));
    }
    Ok(measured.len() == args.meshes.len())
}

/// Seconds; `cpu` is not a number where the system does not tell.
#[derive(Debug, Clone, Copy)]
struct Cost {
    wall: f64,
    cpu: f64,
}

/// One mesh.
struct Measurement {
    name: String,
    triangles: usize,
    factorisation: Cost,
    map: Cost,
    /// Seconds of the stages of that map.
    stages: BTreeMap<Stage, f64>,
    /// Bytes.
    peak: Option<f64>,
}

fn measure(path: &Path, repeat: u16) -> Result<Measurement, Box<dyn Error>> {
    let mesh = meshes::load(path)?;
    measure_mesh(path, &mesh, repeat).map_err(|e| format!("{}: {e}", path.display()).into())
}

fn measure_mesh(path: &Path, whole: &Mesh, repeat: u16) -> Result<Measurement, Box<dyn Error>> {
    // As a component it has no vertex without a face.
    let mut pieces = components::components(&whole.connectivity)?;
    let (Some(Component { mesh, vertices, .. }), true) = (pieces.pop(), pieces.is_empty()) else {
        return Err("not a mesh of one component".into());
    };
    let positions: Vec<_> = vertices.iter().map(|v| whole.positions[v.at()]).collect();
    forget_peak_memory();
    let (mut factorisations, mut maps) = (Vec::new(), Vec::new());
    for _ in 0..repeat.max(1) {
        factorisations.push(time_factorisation(&mesh, &positions)?);
        maps.push(time_map(&mesh, &positions)?);
    }
    let factorisation = median(factorisations, |cost| cost.wall);
    let (map, stages) = median(maps, |(cost, _)| cost.wall);
    Ok(Measurement {
        name: meshes::name(path),
        triangles: mesh.n_faces(),
        factorisation,
        map,
        stages,
        peak: peak_memory(),
    })
}

/// Times the numeric factorisation of the Dirichlet form of the uncut mesh, median of many.
fn time_factorisation(mesh: &TriMesh, positions: &[[f64; 3]]) -> Result<Cost, Box<dyn Error>> {
    const LEAST_COUNT: usize = 9;
    // One factorisation is too short for the clock of CPU time.
    const LEAST_SECONDS: f64 = 0.5;
    const SHIFT: f64 = 1e-8;
    let metric = Metric::from_positions(mesh, positions);
    let uncut = Cut::new(mesh, |_| true);
    let space = LinearSpace::free(uncut.n_wedges);
    let mut problem = LayoutProblem::new(space, triangles(mesh, &metric, &uncut), None)?;
    problem.assemble_dirichlet();
    problem.factorize(SHIFT)?;
    let clock = Clock::start();
    let mut walls = Vec::new();
    while walls.len() < LEAST_COUNT || clock.wall.elapsed().as_secs_f64() < LEAST_SECONDS {
        let start = Instant::now();
        problem.factorize(SHIFT)?;
        walls.push(start.elapsed().as_secs_f64());
    }
    let cpu = clock.cost().cpu / walls.len() as f64;
    let wall = median(walls, |&wall| wall);
    Ok(Cost { wall, cpu })
}

fn time_map(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
) -> Result<(Cost, BTreeMap<Stage, f64>), Box<dyn Error>> {
    let clock = Clock::start();
    let mut go_on = |_| ControlFlow::Continue(());
    let solution = make_map(mesh, positions, &MapOptions::default(), &mut go_on)?;
    let cost = clock.cost();
    let mut stages = BTreeMap::new();
    for lap in solution.components.iter().flat_map(|c| &c.stages) {
        *stages.entry(lap.stage).or_default() += lap.seconds;
    }
    Ok((cost, stages))
}

struct Clock {
    wall: Instant,
    cpu: f64,
}

impl Clock {
    fn start() -> Self {
        let cpu = cpu_seconds().unwrap_or(f64::NAN);
        let wall = Instant::now();
        Self { wall, cpu }
    }

    fn cost(&self) -> Cost {
        Cost {
            wall: self.wall.elapsed().as_secs_f64(),
            cpu: cpu_seconds().unwrap_or(f64::NAN) - self.cpu,
        }
    }
}

/// The item in the middle, the upper of two; there must be one.
fn median<T>(mut items: Vec<T>, key: impl Fn(&T) -> f64) -> T {
    items.sort_by(|a, b| key(a).total_cmp(&key(b)));
    items.swap_remove(items.len() / 2)
}

fn table(measured: &[Measurement]) -> Table {
    let stages: BTreeSet<Stage> = measured.iter().flat_map(|m| m.stages.keys().copied()).collect();
    let mut titles: Vec<String> = [
        "mesh",
        "triangles",
        "factorisation s",
        "map wall s",
        "map CPU s",
        "wall ratio",
        "CPU ratio",
    ]
    .map(String::from)
    .into();
    titles.extend(stages.iter().map(|stage| format!("{} %", stage.name())));
    titles.extend(["rest %".into(), "MB".into()]);
    let mut table = Table::new(titles);
    for m in measured {
        let percent = |seconds: f64| figure(100.0 * seconds / m.map.wall, 0);
        let mut cells = vec![
            m.name.clone(),
            m.triangles.to_string(),
            figure(m.factorisation.wall, 4),
            figure(m.map.wall, 2),
            figure(m.map.cpu, 2),
            figure(m.map.wall / m.factorisation.wall, 1),
            figure(m.map.cpu / m.factorisation.cpu, 1),
        ];
        let seconds = |stage| m.stages.get(stage).copied().unwrap_or(0.0);
        cells.extend(stages.iter().map(|stage| percent(seconds(stage))));
        cells.push(percent(m.map.wall - m.stages.values().sum::<f64>()));
        cells.push(figure(m.peak.unwrap_or(f64::NAN) / 1e6, 0));
        table.push(cells);
    }
    table
}

fn figure(x: f64, decimals: usize) -> String {
    if x.is_finite() { format!("{x:.decimals$}") } else { "-".into() }
}

fn growth(measured: &[Measurement]) -> String {
    let order = |time: fn(&Measurement) -> f64| {
        let points = measured.iter().map(|m| ((m.triangles as f64).ln(), time(m).ln()));
        figure(slope(&points.collect::<Vec<_>>()), 2)
    };
    format!(
        "factorisation {}, map {} (wall) and {} (CPU)",
        order(|m| m.factorisation.wall),
        order(|m| m.map.wall),
        order(|m| m.map.cpu)
    )
}

/// Slope of the least-squares line through points.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean_x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let covariance = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y));
    let variance = points.iter().map(|p| (p.0 - mean_x).powi(2));
    covariance.sum::<f64>() / variance.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_power_is_its_exponent() {
        let points: Vec<_> = [1.0, 2.0, 5.0].map(|x: f64| (x.ln(), x.powf(1.3).ln())).into();
        assert!((slope(&points) - 1.3).abs() < 1e-12);
        assert_eq!(figure(slope(&points[..1]), 2), "-");
    }

    #[test]
    fn medians() {
        assert_eq!(median(vec![3.0, 1.0, 2.0], |&x| x), 2.0);
        assert_eq!(median(vec![4.0, 1.0], |&x| x), 4.0);
    }
}
