//! The direct method against the classical pipeline.

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::{Section, progress};
use crate::process::Clock;
use seamstress_parametrize::quality::Distortion;
use seamstress_parametrize::{
    FieldMapOptions, MapError, MapOptions, Start, make_field_map, make_map, make_map_from,
};
use std::error::Error;
use std::time::Duration;

/// Methods: the direct method against the classical pipeline
///
/// Three rows per mesh: `direct`; `field`, the Poisson layout of a smooth cross field, which may have
/// flips (tau is infinite then, and the energy that of the other triangles); `field+exact`, the same field
/// laid out by the exact layout with its safeguards and polish.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Seconds for each map
    #[arg(long, default_value_t = 120.0)]
    time_limit: f64,
}

/// Metrics of a map.
struct Metrics {
    distortion: Distortion,
    cones: usize,
    seconds: f64,
}

const METHODS: [&str; 3] = ["direct", "field", "field+exact"];

/// Maps every mesh by every method; passes whatever they give.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let titles =
        ["mesh", "triangles", "method", "flips", "tau", "symmetric Dirichlet", "cones", "CPU s"];
    let mut table = Table::new(titles);
    args.selection.survey(|subject| {
        for method in METHODS {
            let triangles = subject.mesh.connectivity.n_faces().to_string();
            let mut cells = vec![subject.name.clone(), triangles, method.to_owned()];
            cells.extend(match run(method, &subject.mesh, args.time_limit) {
                Ok(metrics) => metrics.cells(),
                Err(MapError::Cancelled(_)) => row_of("time limit"),
                Err(error) => {
                    progress(&format!("{}, {method}: {error}", subject.name));
                    row_of("no map")
                }
            });
            table.report(cells);
        }
        Ok(())
    })?;
    Ok(Section::new(table, &[]))
}

fn run(method: &str, mesh: &Mesh, time_limit: f64) -> Result<Metrics, MapError> {
    let limit = Duration::try_from_secs_f64(time_limit).unwrap_or(Duration::MAX);
    let clock = Clock::start();
    let mut observe = clock.limit(Some(limit));
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
    Ok(Metrics { distortion, cones, seconds: clock.seconds() })
}

impl Metrics {
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
