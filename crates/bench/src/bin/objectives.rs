//! Lays one map of each mesh out for every objective and measures every result in every way.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the tables are what this program is for"
)]

use clap::Parser;
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{self, Mesh, name};
use seamstress_bench::process::{cpu_seconds, exit_code};
use seamstress_io::{MapObj, write_map_obj};
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::quality::{
    Measure, SingularValues, Summary, distance_to_frames, summarize,
};
use seamstress_parametrize::{
    MapOptions, Objective, RelayoutOptions, SeamlessMap, make_map, relayout,
};
use serde_json::Value;
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Minimises every objective on one seamless map of each mesh
///
/// Prints a table per mesh: a row for each objective, a column for each measure. The least figure of a
/// column is marked with a star. The exit code is 1 if an objective does not have the least figure of its own
/// measure (within the tolerance), or a map has a flip.
#[derive(Debug, Parser)]
struct Args {
    /// The meshes
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Check every map with `python3 SCRIPT --strict SOURCE MAP`, which prints a JSON object; the source is
    /// written as an OBJ file of triangles
    #[arg(long, value_name = "SCRIPT")]
    verify: Option<PathBuf>,

    /// Figures that differ by less than this fraction of their excess over the ideal count as equal
    #[arg(long, default_value_t = 0.01)]
    tolerance: f64,
}

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

/// Whether every objective is best at its own measure, without flips.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let mut all_well = true;
    for path in &args.meshes {
        let mesh = meshes::load(path)?;
        let rows = measure_mesh(&mesh, args, folder.path())?;
        println!("## {} ({} triangles)\n", name(path), mesh.connectivity.n_faces());
        println!("{}", table(&rows));
        for fault in faults(&rows, args.tolerance) {
            println!("* {fault}");
            all_well = false;
        }
        println!();
        std::io::stdout().flush()?;
    }
    Ok(all_well)
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
    figures: [f64; COLUMNS.len()],
    flips: usize,
    cpu: f64,
    verdict: Option<String>,
}

fn measure_mesh(mesh: &Mesh, args: &Args, folder: &Path) -> Result<Vec<Row>, Box<dyn Error>> {
    let (connectivity, positions) = (&mesh.connectivity, &mesh.positions[..]);
    let metric = Metric::from_positions(connectivity, positions);
    let mut go_on = |_| ControlFlow::Continue(());
    let begin = cpu_seconds();
    let start = make_map(connectivity, positions, &MapOptions::default(), &mut go_on)?.map;
    let row = |objective, map: &SeamlessMap, begin: Option<f64>| -> Result<Row, Box<dyn Error>> {
        let cpu = cpu_seconds().zip(begin).map_or(f64::NAN, |(now, begin)| now - begin);
        let singular = SingularValues::new(connectivity, &metric, map.corner_uvs());
        let verdict = args.verify.as_deref().map(|script| verify(script, mesh, map, folder));
        Ok(Row {
            objective,
            to_frames: distance_to_frames(
                connectivity,
                &metric,
                map.corner_uvs(),
                start.corner_uvs(),
            ),
            figures: COLUMNS.map(|measure| Summary::figure(&summarize(measure, &singular))),
            flips: singular.flipped(),
            cpu,
            verdict: verdict.transpose()?,
        })
    };
    let mut rows = vec![row(None, &start, begin)?];
    for objective in Objective::ALL {
        let begin = cpu_seconds();
        let options = RelayoutOptions::new(objective);
        let solution = relayout(connectivity, positions, &start, &options, &mut go_on)?;
        eprintln!("{objective}: {}", endings(&solution.components));
        rows.push(row(Some(objective), &solution.map, begin)?);
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
    let least = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).fold(f64::INFINITY, f64::min);
    let cell = |of: &dyn Fn(&Row) -> f64, row: &Row| {
        let star = if of(row) == least(of) { "*" } else { "" };
        format!("{:.5}{star}", of(row))
    };
    let mut table = Table::new(titles);
    for row in rows {
        let mut cells = vec![row.objective.map_or("(the map)", Objective::name).to_owned()];
        cells.push(cell(&|row| row.to_frames, row));
        cells.extend((0..COLUMNS.len()).map(|k| cell(&|row: &Row| row.figures[k], row)));
        cells.extend([row.flips.to_string(), format!("{:.2}", row.cpu)]);
        cells.extend(row.verdict.clone());
        table.push(cells);
    }
    table
}

/// Figures closer than this are equal.
const ROUNDING: f64 = 1e-9;

/// Objectives that are not best at their own measure, and maps with flips.
fn faults(rows: &[Row], tolerance: f64) -> Vec<String> {
    let mut faults = Vec::new();
    for row in rows {
        let name = row.objective.map_or("the map", Objective::name);
        if row.flips > 0 || row.verdict.as_ref().is_some_and(|verdict| verdict != "ok") {
            faults.push(format!("{name}: not certified"));
        }
        let Some(objective) = row.objective else { continue };
        let column = COLUMNS.iter().position(|&measure| Some(measure) == objective.measure());
        let of = |row: &Row| column.map_or(row.to_frames, |k| row.figures[k]);
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

/// Runs the script on a map: "ok", or what it says.
fn verify(
    script: &Path,
    mesh: &Mesh,
    map: &SeamlessMap,
    folder: &Path,
) -> Result<String, Box<dyn Error>> {
    let [source, target] = ["source.obj", "map.obj"].map(|name| folder.join(name));
    let faces: Vec<[u32; 3]> = faces(&mesh.connectivity);
    let mut out = BufWriter::new(File::create(&source)?);
    for [x, y, z] in &mesh.positions {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [a, b, c] in &faces {
        writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    out.flush()?;
    let content = MapObj {
        positions: &mesh.positions,
        faces: &faces,
        corner_uvs: map.corner_uvs(),
        comments: &[],
    };
    let mut out = BufWriter::new(File::create(&target)?);
    write_map_obj(&mut out, &content)?;
    out.flush()?;
    let output =
        Command::new("python3").arg(script).arg("--strict").arg(source).arg(target).output()?;
    let json: Value = serde_json::from_slice(&output.stdout)?;
    Ok(if json["ok"] == true { "ok".into() } else { json.to_string() })
}

fn faces(mesh: &TriMesh) -> Vec<[u32; 3]> {
    mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.0)).collect()
}
