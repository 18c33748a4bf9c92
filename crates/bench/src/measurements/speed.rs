//! The time of a map, in units of one sparse Cholesky factorisation of the same mesh.

use crate::markdown::Table;
use crate::meshes::{Selection, Subject};
use crate::output::{Section, progress};
use crate::process::{Clock, Cost, forget_peak_memory, peak_memory};
use crate::statistics::{median, order};
use crate::yardstick::{Kernel, Yardstick};
use clap::value_parser;
use seamstress_linalg::ordering::{Graph, expand, fill_reducing_order};
use seamstress_mesh::{Component, Metric, TriMesh, components};
use seamstress_parametrize::cut::Cut;
use seamstress_parametrize::energy::triangles;
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::layout::space::LinearSpace;
use seamstress_parametrize::{MapOptions, Stage, make_map};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::ops::ControlFlow;

/// Speed: the time of a map in units of one factorisation
///
/// For every mesh of one component, in one process: the median time of a numeric Cholesky factorisation of its
/// cotangent system (two unknowns per vertex, by faer on one thread, in the order of METIS: a yardstick that stays
/// the same whatever solver the method uses), and the time of a whole map with
/// default settings, in all and by stages, with its quality. For several meshes, the order of growth of both with the number of triangles. On a busy machine only
/// the CPU ratio means anything.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Measure this many times and take the median
    #[arg(long, value_name = "R", default_value_t = 1, value_parser = value_parser!(u16).range(1..))]
    repeat: u16,
}

/// Times maps and factorisations, small meshes first: memory that the allocator keeps of a large mesh would count for
/// a small one. Passes if all meshes could be measured.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads.unwrap_or(0).into());
    let pool = pool.build()?;
    let mut measured = Vec::new();
    let failures = pool.install(|| {
        let survey = args.selection.survey(|subject| {
            let Some(measurement) = measure_mesh(subject, args.repeat)? else {
                progress(&format!("left out: {}: several components", subject.name));
                return Ok(());
            };
            progress(&format!("{}: {:.2} s", measurement.name, measurement.map.wall));
            measured.push(measurement);
            Ok(())
        });
        survey.map_err(|error| error.to_string())
    })?;
    let threads = pool.current_num_threads();
    let mut text = format!("{}\n{threads} threads, median of {}\n", table(&measured), args.repeat);
    if measured.len() > 1 {
        text += &format!("\nOrder of growth with the number of triangles: {}\n", growth(&measured));
    }
    Ok(Section::new(text, &failures))
}

/// One mesh.
struct Measurement {
    name: String,
    triangles: usize,
    factorisation: Cost,
    map: Cost,
    /// What came of it, the same in every repetition.
    outcome: Outcome,
    /// Bytes.
    peak: Option<f64>,
}

/// How a map was made, and how good it is.
struct Outcome {
    /// Seconds of the stages.
    stages: BTreeMap<Stage, f64>,
    tau: f64,
    /// Mean symmetric Dirichlet energy beyond the least possible.
    excess: f64,
    cones: usize,
}

/// None for a mesh of several components.
fn measure_mesh(subject: &Subject, repeat: u16) -> Result<Option<Measurement>, Box<dyn Error>> {
    let whole = &subject.mesh;
    // As a component it has no vertex without a face.
    let mut pieces = components::components(&whole.connectivity)?;
    let (Some(Component { mesh, vertices, .. }), true) = (pieces.pop(), pieces.is_empty()) else {
        return Ok(None);
    };
    let positions: Vec<_> = vertices.iter().map(|v| whole.positions[v.at()]).collect();
    forget_peak_memory();
    let (mut factorisations, mut maps) = (Vec::new(), Vec::new());
    for _ in 0..repeat.max(1) {
        factorisations.push(time_factorisation(&mesh, &positions)?);
        maps.push(time_map(&mesh, &positions)?);
    }
    let medians = median(factorisations, |cost| cost.wall).zip(median(maps, |(cost, _)| cost.wall));
    Ok(medians.map(|(factorisation, (map, outcome))| Measurement {
        name: subject.name.clone(),
        triangles: mesh.n_faces(),
        factorisation,
        map,
        outcome,
        peak: peak_memory(),
    }))
}

/// Times the numeric factorisation of the Dirichlet form of the uncut mesh by faer, median of many.
fn time_factorisation(mesh: &TriMesh, positions: &[[f64; 3]]) -> Result<Cost, Box<dyn Error>> {
    const MIN_COUNT: usize = 9;
    // One factorisation is too short for the clock of CPU time.
    const MIN_SECONDS: f64 = 0.5;
    const SHIFT: f64 = 1e-8;
    let metric = Metric::from_positions(mesh, positions);
    let uncut = Cut::new(mesh, |_| true);
    let space = LinearSpace::free(uncut.n_wedges);
    let mut problem = LayoutProblem::new(space, triangles(mesh, &metric, &uncut), None)?;
    problem.assemble_dirichlet();
    let (pattern, values) = problem.matrix();
    let mut values = values.to_vec();
    let diagonal = pattern.diagonal().iter().map(|&slot| slot as usize);
    let mean = diagonal.clone().map(|slot| values[slot]).sum::<f64>() / diagonal.len() as f64;
    diagonal.for_each(|slot| values[slot] += SHIFT * mean);
    let pairs = (0..pattern.order()).step_by(2).flat_map(|column| {
        let slots = pattern.column_offsets[column]..pattern.column_offsets[column + 1];
        slots.map(move |slot| (pattern.rows[slot as usize] / 2, column as u32 / 2))
    });
    let order = fill_reducing_order(&Graph::from_edges(uncut.n_wedges, pairs));
    let mut faer = Yardstick::new(Kernel::Supernodal, pattern, &expand(&order, 2), 1)?;
    faer.factorize(pattern, &values)?;
    let clock = Clock::start();
    let mut walls = Vec::new();
    while walls.len() < MIN_COUNT || clock.cost().wall < MIN_SECONDS {
        let start = Clock::start();
        faer.factorize(pattern, &values)?;
        walls.push(start.cost().wall);
    }
    let cpu = clock.cost().cpu / walls.len() as f64;
    let wall = median(walls, |&wall| wall).unwrap_or(f64::NAN);
    Ok(Cost { wall, cpu })
}

fn time_map(mesh: &TriMesh, positions: &[[f64; 3]]) -> Result<(Cost, Outcome), Box<dyn Error>> {
    let clock = Clock::start();
    let mut go_on = |_| ControlFlow::Continue(());
    let solution = make_map(mesh, positions, &MapOptions::default(), &mut go_on)?;
    let cost = clock.cost();
    let mut stages = BTreeMap::new();
    for lap in solution.components.iter().flat_map(|c| &c.stages) {
        *stages.entry(lap.stage).or_default() += lap.seconds;
    }
    let outcome = Outcome {
        stages,
        tau: solution.distortion.tau,
        excess: solution.distortion.symmetric_dirichlet - 4.0,
        cones: solution.map.cones().len(),
    };
    Ok((cost, outcome))
}

fn table(measured: &[Measurement]) -> Table {
    let stages = measured.iter().flat_map(|m| m.outcome.stages.keys().copied());
    let stages: BTreeSet<Stage> = stages.collect();
    let mut titles: Vec<String> =
        ["mesh", "triangles", "unit s", "wall s", "CPU s", "wall units", "CPU units"]
            .map(String::from)
            .into();
    titles.extend(stages.iter().map(|stage| stage.name().to_owned()));
    titles.extend(["rest", "MB", "tau", "SD - 4", "cones"].map(String::from));
    let mut table = Table::new(titles);
    for m in measured {
        let units = |seconds: f64| number(seconds / m.factorisation.wall, 1);
        let outcome = &m.outcome;
        let mut cells = vec![
            m.name.clone(),
            m.triangles.to_string(),
            number(m.factorisation.wall, 4),
            number(m.map.wall, 2),
            number(m.map.cpu, 2),
            units(m.map.wall),
            number(m.map.cpu / m.factorisation.cpu, 1),
        ];
        let seconds = |stage| outcome.stages.get(stage).copied().unwrap_or(0.0);
        cells.extend(stages.iter().map(|stage| units(seconds(stage))));
        cells.push(units(m.map.wall - outcome.stages.values().sum::<f64>()));
        cells.push(number(m.peak.unwrap_or(f64::NAN) / 1e6, 0));
        cells.push(number(outcome.tau, 3));
        cells.push(number(outcome.excess, 4));
        cells.push(outcome.cones.to_string());
        table.push(cells);
    }
    table
}

fn number(x: f64, decimals: usize) -> String {
    if x.is_finite() { format!("{x:.decimals$}") } else { "-".into() }
}

fn growth(measured: &[Measurement]) -> String {
    let exponent = |time: fn(&Measurement) -> f64| {
        let points: Vec<_> = measured.iter().map(|m| (m.triangles as f64, time(m))).collect();
        number(order(&points).unwrap_or(f64::NAN), 2)
    };
    format!(
        "factorisation {}, map {} (wall) and {} (CPU)",
        exponent(|m| m.factorisation.wall),
        exponent(|m| m.map.wall),
        exponent(|m| m.map.cpu)
    )
}
