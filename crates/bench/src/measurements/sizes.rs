//! Quads of one size against quads whose sizes follow the curvature.

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::Section;
use crate::process::sibling;
use crate::program::{Outcome, Program, Report};
use seamstress_io::read_mesh;
use seamstress_quads::quality::{split_polygons, surface_distance};
use std::error::Error;
use std::path::Path;

/// Sizes of quads: alike, and smaller where the surface bends
///
/// Two rows per mesh, without and with `--adaptive`. Columns: quads; irregular vertices; the shortest and the longest edge
/// asked for, by the mean; edge lengths made by those asked for, the median, and how far 95 of 100 quads are off; tau and
/// mean energy on the surface, and in the metric of the sizes; distances to the source and from it, in per cent of the
/// diagonal of its bounding box. Passes if counts are met to 10 %, the median to 5 % and 95 of 100 quads to 30 %.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Quads asked for
    #[arg(long, value_name = "N", default_value_t = 2500.0)]
    quads: f64,

    /// How much sizes follow the curvature
    #[arg(long, value_name = "X", default_value_t = 1.0)]
    adaptive: f64,

    /// Points sampled on each surface for the distances, about
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    samples: usize,
}

const TITLES: [&str; 12] = [
    "mesh",
    "sizes",
    "quads",
    "irregular",
    "asked",
    "median",
    "95 % off",
    "tau, energy",
    "in sizes",
    "Hausdorff %",
    "mean %",
    "CPU s",
];

/// Makes the quads of every mesh both ways.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let program = Program { path: sibling("seamstress")?, time_limit: None, threads: Some(1) };
    let folder = tempfile::tempdir()?;
    let output = folder.path().join("quads.obj");
    let mut table = Table::new(TITLES);
    let mut missed = Vec::new();
    let failures = args.selection.survey(|subject| {
        for adaptive in [0.0, args.adaptive] {
            let (quads, adaptive_text) = (args.quads.to_string(), adaptive.to_string());
            let options = ["--quads", &quads, "--adaptive", &adaptive_text];
            let report = match program.run("quad", &subject.path, &output, &options) {
                Outcome::Done(report) => report,
                Outcome::Refused(reason) | Outcome::Failed(reason) => {
                    return Err(reason.to_string().into());
                }
            };
            let how = if adaptive > 0.0 { "adaptive" } else { "alike" };
            missed.extend(
                faults(&report, args.quads)
                    .iter()
                    .map(|fault| format!("{}, {how}: {fault}", subject.name)),
            );
            let mut cells = vec![subject.name.clone(), how.to_owned()];
            cells.extend(numbers(&report));
            let [hausdorff, mean] = distances(&subject.mesh, &output, args.samples)?;
            cells.extend([format!("{hausdorff:.3}"), format!("{mean:.4}")]);
            cells.push(format!("{:.1}", report.cpu_seconds().unwrap_or(f64::NAN)));
            table.report(cells);
        }
        Ok(())
    })?;
    Ok(Section::new(table, &[failures, missed].concat()))
}

/// What is not as it should be.
fn faults(report: &Report, asked: f64) -> Vec<String> {
    let is_met = |(name, pointer, ideal, most): (&str, &str, f64, f64)| {
        let off = (report.number(pointer)? / ideal - 1.0).abs();
        (off > most).then(|| format!("{name} off by {:.0} %", 100.0 * off))
    };
    let far = report.number("/sizes/off_95").filter(|&off| off > 0.3);
    [("the count", "/quads/count", asked, 0.1), ("the median", "/sizes/median_ratio", 1.0, 0.05)]
        .into_iter()
        .filter_map(is_met)
        .chain(far.map(|off| format!("95 % of the quads off by {:.0} %", 100.0 * off)))
        .collect()
}

/// The columns from a report.
fn numbers(report: &Report) -> Vec<String> {
    let number = |pointer: &str| report.number(pointer).unwrap_or(f64::NAN);
    let count = |pointer| format!("{:.0}", number(pointer));
    let pair = |of: &str| {
        let [tau, energy] =
            ["tau", "symmetric_dirichlet"].map(|name| number(&format!("{of}/{name}")));
        format!("{tau:.2}, {energy:.3}")
    };
    let mut cells = vec![count("/quads/count"), count("/quads/irregular/count")];
    cells.extend(match report.number("/sizes/least") {
        Some(least) => {
            let edge = number("/grid/edge_length");
            let largest = number("/sizes/largest");
            vec![
                format!("{:.2} to {:.2}", least / edge, largest / edge),
                format!("{:.3}", number("/sizes/median_ratio")),
                format!("{:.1} %", 100.0 * number("/sizes/off_95")),
                pair("/distortion"),
                pair("/sizes/distortion"),
            ]
        }
        None => ["1", "-", "-"]
            .map(String::from)
            .into_iter()
            .chain([pair("/distortion"), "-".into()])
            .collect(),
    });
    cells
}

/// The Hausdorff distance and the mean of quads in a file to a mesh, per cent.
fn distances(mesh: &Mesh, quads: &Path, samples: usize) -> Result<[f64; 2], Box<dyn Error>> {
    let read = read_mesh(quads)?;
    let triangles = split_polygons(&read.positions, read.polygons.iter())
        .map_err(|_| "the quads cannot be split into triangles")?;
    let faces = mesh.faces();
    let halves = (read.positions.as_slice(), triangles.as_slice());
    let distance = surface_distance(halves, (&mesh.positions, faces.as_slice()), samples)?;
    Ok([distance.hausdorff, distance.mean].map(|length| 100.0 * length / distance.diagonal))
}
