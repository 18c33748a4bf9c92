//! Every objective minimised on one map of each mesh.

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::{Section, progress};
use crate::process::Clock;
use crate::verify::{Verdict, Verifier};
use seamstress_mesh::Metric;
use seamstress_parametrize::quality::{
    Measure, SingularValues, Summary, distance_to_frames, summarize,
};
use seamstress_parametrize::{
    MapOptions, Objective, RelayoutOptions, SeamlessMap, make_map, relayout,
};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Objectives: every objective minimised on one map, every measure of every result
///
/// A table per mesh: a row for each objective, a column for each measure; the lowest value of a column is
/// marked with a star. It counts as a failure if an objective does not have the lowest value of its own measure
/// (within the tolerance), or a map has a flip.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Check every map with `python3 SCRIPT --strict SOURCE MAP`, which prints a JSON object
    #[arg(long, value_name = "SCRIPT")]
    verify: Option<PathBuf>,

    /// Values that differ by less than this fraction of their excess over the ideal count as equal
    #[arg(long, default_value_t = 0.01)]
    tolerance: f64,
}

/// Minimises every objective on every mesh; passes if each is best at its own measure, without flips.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let mut text = String::new();
    let mut worse = Vec::new();
    let mut failures = args.selection.survey(|subject| {
        let rows = measure_mesh(&subject.mesh, args)?;
        let triangles = subject.mesh.connectivity.n_faces();
        text += &format!("\n### {} ({triangles} triangles)\n\n{}", subject.name, table(&rows));
        for fault in faults(&rows, args.tolerance) {
            worse.push(format!("{}: {fault}", subject.name));
        }
        Ok(())
    })?;
    failures.extend(worse);
    Ok(Section::new(text, &failures))
}

/// The measures of the columns, after the one of the frames.
const COLUMNS: [Measure; 7] = [
    Measure::Tau,
    Measure::SymmetricDirichlet,
    Measure::Arap,
    Measure::ArapMax,
    Measure::Asap,
    Measure::AsapMax,
    Measure::Dilatation,
];

/// One layout.
struct Row {
    /// None: the map all others start from.
    objective: Option<Objective>,
    /// Mean squared distance to the frames of that map.
    to_frames: f64,
    values: [f64; COLUMNS.len()],
    flips: usize,
    cpu: f64,
    verdict: Option<Verdict>,
}

fn measure_mesh(mesh: &Mesh, args: &Args) -> Result<Vec<Row>, Box<dyn Error>> {
    let (connectivity, positions) = (&mesh.connectivity, &mesh.positions[..]);
    let metric = Metric::from_positions(connectivity, positions);
    let mut go_on = |_| ControlFlow::Continue(());
    let clock = Clock::start();
    let start = make_map(connectivity, positions, &MapOptions::default(), &mut go_on)?.map;
    let row = |objective, map: &SeamlessMap, clock: Clock| -> Result<Row, Box<dyn Error>> {
        let cpu = clock.seconds();
        let singular = SingularValues::new(connectivity, &metric, map.corner_uvs());
        let verdict = args.verify.as_deref();
        let verdict =
            verdict.map(|script| Verifier::new(script).check_uvs(mesh, map.corner_uvs(), &[]));
        Ok(Row {
            objective,
            to_frames: distance_to_frames(
                connectivity,
                &metric,
                map.corner_uvs(),
                start.corner_uvs(),
            ),
            values: COLUMNS.map(|measure| Summary::figure(&summarize(measure, &singular))),
            flips: singular.flipped(),
            cpu,
            verdict: verdict.transpose()?,
        })
    };
    let mut rows = vec![row(None, &start, clock)?];
    for objective in Objective::ALL {
        let clock = Clock::start();
        let options = RelayoutOptions::new(objective);
        let solution = relayout(connectivity, positions, &start, &options, &mut go_on)?;
        progress(&format!("{objective}: {}", endings(&solution.components)));
        rows.push(row(Some(objective), &solution.map, clock)?);
    }
    Ok(rows)
}

fn endings(components: &[seamstress_parametrize::RelayoutStats]) -> String {
    let texts: Vec<String> = components.iter().map(|c| c.ending.to_string()).collect();
    texts.join(", ")
}

fn table(rows: &[Row]) -> Table {
    let mut titles = vec!["objective".to_owned(), "to frames".to_owned()];
    titles.extend(COLUMNS.map(|measure| measure.name().to_owned()));
    titles.extend(["flips", "CPU s"].map(str::to_owned));
    let verified = rows.iter().any(|row| row.verdict.is_some());
    titles.extend(verified.then(|| "verified".to_owned()));
    let lowest = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).fold(f64::INFINITY, f64::min);
    let cell = |of: &dyn Fn(&Row) -> f64, row: &Row| {
        let star = if of(row) == lowest(of) { "*" } else { "" };
        format!("{:.5}{star}", of(row))
    };
    let mut table = Table::new(titles);
    for row in rows {
        let mut cells = vec![row.objective.map_or("(the map)", Objective::name).to_owned()];
        cells.push(cell(&|row| row.to_frames, row));
        cells.extend((0..COLUMNS.len()).map(|k| cell(&|row: &Row| row.values[k], row)));
        cells.extend([row.flips.to_string(), format!("{:.2}", row.cpu)]);
        cells.extend(row.verdict.as_ref().map(Verdict::cell));
        table.push(cells);
    }
    table
}

/// Values closer than this are equal.
const ROUNDING: f64 = 1e-9;

/// Objectives that are not best at their own measure, and maps with flips.
fn faults(rows: &[Row], tolerance: f64) -> Vec<String> {
    let mut faults = Vec::new();
    for row in rows {
        let name = row.objective.map_or("the map", Objective::name);
        if row.flips > 0 || row.verdict.as_ref().is_some_and(|verdict| verdict.fault.is_some()) {
            faults.push(format!("{name}: not certified"));
        }
        let Some(objective) = row.objective else { continue };
        let column = COLUMNS.iter().position(|&measure| Some(measure) == objective.measure());
        let of = |row: &Row| column.map_or(row.to_frames, |k| row.values[k]);
        let ideal = objective.measure().map_or(0.0, Measure::ideal);
        for other in rows.iter().filter(|other| other.objective != row.objective) {
            if of(other) - ideal + ROUNDING < (1.0 - tolerance) * (of(row) - ideal) {
                let better = other.objective.map_or("the map", Objective::name);
                faults.push(format!("{name}: {} is worse than {} of {better}", of(row), of(other)));
            }
        }
    }
    faults
}
