//! Integer-grid maps at several counts of quads.

use crate::map_files::seamless;
use crate::markdown::Table;
use crate::meshes::{Selection, Subject};
use crate::output::{Section, progress};
use crate::verify::{Verdict, Verifier};
use seamstress_mesh::features::EdgeSet;
use seamstress_quantize::{
    GridSize, Quantization, QuantizationStats, QuantizeOptions, RoundingMethod, quantize,
};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Integer-grid maps: quads achieved, distortion and time
///
/// For each mesh and count: the quads achieved, the energy and tau before and after, the number of integers, the
/// seconds of each part, how often the grid had to be refined, the seconds of the seamless map, and, with a
/// verifier, its verdict.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Quads asked for
    #[arg(long, value_delimiter = ',', default_values_t = [500.0, 2500.0, 10000.0])]
    quads: Vec<f64>,

    /// Round greedily instead
    #[arg(long)]
    greedy: bool,

    /// Keep the seamless maps in this folder, and take those that are there
    #[arg(long, value_name = "DIR")]
    maps: Option<PathBuf>,

    /// Check every map with `python3 SCRIPT --strict --integer SOURCE MAP`, which prints a JSON object
    #[arg(long, value_name = "SCRIPT")]
    verify: Option<PathBuf>,
}

const TITLES: [&str; 13] = [
    "mesh",
    "triangles",
    "cones",
    "asked",
    "quads",
    "off %",
    "SD",
    "tau",
    "integers",
    "refined",
    "reduce/round/move/polish s",
    "map s",
    "verifier",
];

/// Makes the maps; passes if every run gave an integer-grid map that the verifier accepts.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let mut table = Table::new(TITLES);
    let mut tally = Tally::default();
    let mut failures = Vec::new();
    args.selection.survey(|subject| {
        for &asked in &args.quads {
            tally.runs += 1;
            let place = format!("{} at {asked}", subject.name);
            match measure_mesh(subject, asked, args) {
                Ok(row) => {
                    tally.add(&row);
                    table.report(row.cells(subject));
                    let fault = row.verdict.and_then(|verdict| verdict.fault);
                    failures.extend(fault.map(|fault| format!("{place}: {fault}")));
                }
                Err(error) => {
                    progress(&format!("{place}: {error}"));
                    failures.push(format!("{place}: {error}"));
                }
            }
        }
        Ok(())
    })?;
    Ok(Section::new(format!("{table}\n{tally}"), &failures))
}

/// What came out of one run.
struct Row {
    asked: f64,
    cones: usize,
    /// Seconds for the seamless map.
    seconds: f64,
    solution: Quantization,
    verdict: Option<Verdict>,
}

fn measure_mesh(subject: &Subject, asked: f64, args: &Args) -> Result<Row, Box<dyn Error>> {
    let mesh = &subject.mesh;
    let (map, seconds) = seamless(&subject.name, mesh, asked, args.maps.as_deref())?;
    let rounding = if args.greedy { RoundingMethod::Greedy } else { RoundingMethod::Constrained };
    let options = QuantizeOptions { size: GridSize::Quads(asked), rounding, ..Default::default() };
    let mut go_on = |_| ControlFlow::Continue(());
    let (connectivity, nothing) = (&mesh.connectivity, EdgeSet::new(&mesh.connectivity, []));
    let solution = quantize(connectivity, &mesh.positions, &map, &nothing, &options, &mut go_on)?;
    let verdict = args.verify.as_deref().map(|script| {
        Verifier::new(script).check_uvs(mesh, solution.map.corner_uvs(), &["--integer".as_ref()])
    });
    let verdict = verdict.transpose()?;
    Ok(Row { asked, cones: map.cones().len(), seconds, solution, verdict })
}

impl Row {
    fn off(&self) -> f64 {
        self.solution.quads() / self.asked - 1.0
    }

    fn cells(&self, subject: &Subject) -> Vec<String> {
        let solution = &self.solution;
        let sum =
            |part: fn(&QuantizationStats) -> f64| solution.components.iter().map(part).sum::<f64>();
        let (before, after) = (&solution.before, &solution.distortion);
        let parts = [
            sum(|c| c.seconds_reduction),
            sum(|c| c.seconds_rounding),
            sum(|c| c.seconds_moving),
            sum(|c| c.seconds_polish),
        ];
        vec![
            subject.name.clone(),
            subject.mesh.connectivity.n_faces().to_string(),
            self.cones.to_string(),
            format!("{:.0}", self.asked),
            format!("{:.1}", solution.quads()),
            format!("{:+.1}", 100.0 * self.off()),
            format!("{:.3} to {:.3}", before.symmetric_dirichlet, after.symmetric_dirichlet),
            format!("{:.2} to {:.2}", before.tau, after.tau),
            format!("{:.0}", sum(|c| c.integers as f64)),
            solution.refinements().to_string(),
            parts.map(|x| format!("{x:.2}")).join("/"),
            format!("{:.1}", self.seconds),
            self.verdict.as_ref().map_or("-".into(), Verdict::cell),
        ]
    }
}

/// Counts over all runs.
#[derive(Default)]
struct Tally {
    runs: usize,
    done: usize,
    refined: usize,
    far: usize,
    refuted: usize,
    verified: usize,
}

impl Tally {
    fn add(&mut self, row: &Row) {
        self.done += 1;
        self.refined += usize::from(row.solution.refinements() > 0);
        self.far += usize::from(row.asked >= 2500.0 && row.off().abs() > 0.05);
        self.verified += usize::from(row.verdict.is_some());
        self.refuted += usize::from(row.verdict.as_ref().is_some_and(|v| v.fault.is_some()));
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(
            f,
            "{} of {} runs gave an integer-grid map, {} of them on a refined grid. {} of those at 2500 and more \
             are off by over 5 %. The verifier refused {} of {}.",
            self.done, self.runs, self.refined, self.far, self.refuted, self.verified
        )
    }
}
