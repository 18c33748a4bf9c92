//! The direct method against the classical pipeline, on every mesh of a folder.

use clap::Parser;
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{Mesh, list, load, name};
use seamstress_bench::process::cpu_seconds;
use seamstress_parametrize::quality::Distortion;
use seamstress_parametrize::{
    FieldMapOptions, MapError, MapOptions, Start, make_field_map, make_map, make_map_from,
};
use std::error::Error;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Compares the direct method with a smooth cross field and its layouts
///
/// Three rows per mesh: `direct`; `field`, the Poisson layout of a smooth cross field, which may have
/// flips (tau is infinite then, and the energy that of the other triangles); `field+exact`, the same field
/// laid out by the exact layout with its safeguards and polish.
#[derive(Debug, Parser)]
struct Args {
    /// Folder with meshes
    folder: PathBuf,

    /// Only meshes whose name contains this
    #[arg(long)]
    only: Option<String>,

    /// Only meshes of at most this many triangles
    #[arg(long, default_value_t = usize::MAX)]
    largest: usize,

    /// Seconds for each map
    #[arg(long, default_value_t = 120.0)]
    time_limit: f64,
}

/// A map in figures.
struct Figures {
    distortion: Distortion,
    cones: usize,
    seconds: f64,
}

const METHODS: [&str; 3] = ["direct", "field", "field+exact"];

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let titles =
        ["mesh", "triangles", "method", "flips", "tau", "symmetric Dirichlet", "cones", "CPU s"];
    let mut table = Table::new(titles);
    for path in list(&args.folder, args.only.as_deref())? {
        let mesh = match load(&path) {
            Ok(mesh) if mesh.connectivity.n_faces() > args.largest => continue,
            Ok(mesh) => mesh,
            Err(error) => {
                writeln!(std::io::stderr(), "left out: {error}")?;
                continue;
            }
        };
        for method in METHODS {
            let mut cells =
                vec![name(&path), mesh.connectivity.n_faces().to_string(), method.to_owned()];
            cells.extend(match run(method, &mesh, args.time_limit) {
                Ok(figures) => figures.cells(),
                Err(MapError::Cancelled(_)) => row_of("time limit"),
                Err(error) => {
                    writeln!(std::io::stderr(), "{}, {method}: {error}", name(&path))?;
                    row_of("no map")
                }
            });
            writeln!(std::io::stderr(), "| {} |", cells.join(" | "))?;
            table.push(cells);
        }
    }
    write!(std::io::stdout(), "{table}")?;
    Ok(())
}

fn run(method: &str, mesh: &Mesh, time_limit: f64) -> Result<Figures, MapError> {
    let limit = Duration::try_from_secs_f64(time_limit).unwrap_or(Duration::MAX);
    let begun = Instant::now();
    let mut observe = |_| match begun.elapsed() > limit {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let before = cpu_seconds();
    let (connectivity, positions) = (&mesh.connectivity, &mesh.positions);
    let options = MapOptions::default();
    let (distortion, cones) = match method {
        "field" => {
            let options = FieldMapOptions::default();
            let made = make_field_map(connectivity, positions, &options, &mut observe)?;
            (made.distortion, made.field_cones.len())
        }
        "direct" => {
            let made = make_map(connectivity, positions, &options, &mut observe)?;
            (made.distortion, made.map.cones().len())
        }
        _ => {
            let start = Start::SmoothField;
            let made = make_map_from(connectivity, positions, &start, &options, &mut observe)?;
            (made.distortion, made.map.cones().len())
        }
    };
    let seconds = match (before, cpu_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => begun.elapsed().as_secs_f64(),
    };
    Ok(Figures { distortion, cones, seconds })
}

impl Figures {
    fn cells(&self) -> Vec<String> {
        vec![
            self.distortion.flipped.to_string(),
            format!("{:.3}", self.distortion.tau),
            format!("{:.4}", self.distortion.symmetric_dirichlet),
            self.cones.to_string(),
            format!("{:.2}", self.seconds),
        ]
    }
}

/// Cells of a method without a map.
fn row_of(text: &str) -> Vec<String> {
    [text, "-", "-", "-", "-"].map(String::from).to_vec()
}
