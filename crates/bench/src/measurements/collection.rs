//! Maps and quads of a whole collection: how many there are, how good, what they cost, and why others are not.

use crate::jobs;
use crate::markdown::Table;
use crate::meshes::{Selection, name};
use crate::output::{Section, progress};
use crate::process::sibling;
use crate::program::{Outcome, Program, Report};
use clap::value_parser;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Collections: success, quality and cost of every mesh
///
/// Runs the `seamstress map` and `seamstress quad` that lie next to this program, with default options on one thread.
/// `map` says whether there is a certified map, or the code of the error; `quads` the same of quads, and how many; `SD` is
/// the mean symmetric Dirichlet energy (4 is an isometry). Passes if every mesh has a certified map or an error with a
/// code that is no fault of the program, if so many per cent of those that are surfaces have a map, and if no map takes more time or
/// memory than allowed.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Quads asked for; 0 for maps alone
    #[arg(long, value_name = "N", default_value_t = 1000)]
    quads: u32,

    /// Show one row for all meshes whose names begin alike, up to a `_`, and one for each that failed
    #[arg(long)]
    kinds: bool,

    /// The share of surfaces that must have a certified map, per cent
    #[arg(long, value_name = "PERCENT", default_value_t = 98.0)]
    certified: f64,

    /// CPU seconds that a map may take
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    most_seconds: f64,

    /// Memory that a map may take, MB
    #[arg(long, value_name = "MB", default_value_t = 2000.0)]
    most_memory: f64,

    /// Give up on a run after this many seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 600, value_parser = value_parser!(u32).range(1..))]
    time_limit: u32,

    /// Meshes at the same time
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u16).range(1..=256))]
    jobs: u16,
}

const TITLES: [&str; 15] = [
    "mesh",
    "triangles",
    "genus",
    "loops",
    "map",
    "tau",
    "SD",
    "cones",
    "CPU s",
    "MB",
    "quads",
    "irregular",
    "CPU s",
    "MB",
    "reason",
];

/// Makes maps and quads of all of them.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let paths = args.selection.paths()?;
    let folder = tempfile::tempdir()?;
    let program = Program {
        path: sibling("seamstress")?,
        time_limit: Some(args.time_limit),
        threads: Some(1),
    };
    let done = AtomicUsize::new(0);
    let runs = jobs::map(&paths, args.jobs.into(), |mesh| {
        let run = Run::new(mesh, &program, folder.path(), args.quads);
        let k = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress(&format!("[{k}/{}] | {} |", paths.len(), run.cells().join(" | ")));
        run
    });
    Ok(section(&runs, args))
}

/// One mesh.
struct Run {
    name: String,
    map: Outcome,
    /// None where they were not asked for.
    quads: Option<Outcome>,
}

impl Run {
    fn new(mesh: &Path, program: &Program, folder: &Path, quads: u32) -> Self {
        let output = |what: &str| folder.join(format!("{}.{what}.obj", name(mesh)));
        let map = program.run::<&str>("map", mesh, &output("map"), &[]);
        let count = quads.to_string();
        let quads =
            (quads > 0).then(|| program.run("quad", mesh, &output("quads"), &["--quads", &count]));
        Self { name: name(mesh), map, quads }
    }

    fn kind(&self) -> &str {
        self.name.split('_').next().unwrap_or_default()
    }

    fn is_complete(&self) -> bool {
        self.map.report().is_some()
            && self.quads.as_ref().is_none_or(|quads| quads.report().is_some())
    }

    fn cells(&self) -> Vec<String> {
        let number = |outcome: &Outcome, path: &str, digits| {
            number(outcome.report().and_then(|report| report.number(path)), digits)
        };
        let of_map = |path, digits| number(&self.map, path, digits);
        let mut cells = vec![
            self.name.clone(),
            of_map("/input/faces", 0),
            of_map("/input/genus", 0),
            of_map("/input/boundary_loops", 0),
            code(&self.map).unwrap_or("certified").to_owned(),
            of_map("/distortion/tau", 3),
            of_map("/distortion/symmetric_dirichlet", 4),
            of_map("/cones/count", 0),
        ];
        cells.extend(cost_cells(&self.map));
        match &self.quads {
            None => cells.extend(["-"; 4].map(String::from)),
            Some(quads) => {
                cells.push(match code(quads) {
                    Some(code) => code.into(),
                    None => number(quads, "/quads/count", 0),
                });
                cells.push(number(quads, "/quads/irregular/count", 0));
                cells.extend(cost_cells(quads));
            }
        }
        let reasons = [Some(&self.map), self.quads.as_ref()];
        let reason = reasons.into_iter().flatten().find_map(|outcome| match outcome {
            Outcome::Done(_) => None,
            Outcome::Refused(reason) | Outcome::Failed(reason) => Some(reason.message.clone()),
        });
        cells.push(reason.unwrap_or_default());
        cells
    }
}

/// The code of the error, `crash` if the program ended without one, and none where there is a result.
fn code(outcome: &Outcome) -> Option<&str> {
    match outcome {
        Outcome::Done(_) => None,
        Outcome::Refused(reason) | Outcome::Failed(reason) => {
            Some(reason.code.as_deref().unwrap_or("crash"))
        }
    }
}

/// CPU seconds and megabytes of a run, where it says them.
fn cost(outcome: &Outcome) -> [Option<f64>; 2] {
    let report = match outcome {
        Outcome::Done(report) => Some(report),
        Outcome::Refused(reason) | Outcome::Failed(reason) => reason.cost.as_ref(),
    };
    let seconds = report.and_then(Report::cpu_seconds);
    let bytes = report.and_then(|report| report.number("/cost/peak_memory_bytes"));
    [seconds, bytes.map(|bytes| bytes / 1e6)]
}

fn cost_cells(outcome: &Outcome) -> [String; 2] {
    let [seconds, megabytes] = cost(outcome);
    [number(seconds, 2), number(megabytes, 0)]
}

fn number(x: Option<f64>, decimals: usize) -> String {
    x.map_or("-".into(), |x| format!("{x:.decimals$}"))
}

/// The larger, nothing being the least.
fn largest<'a>(
    runs: impl IntoIterator<Item = &'a Run>,
    value: impl Fn(&Run) -> Option<f64>,
) -> Option<(f64, &'a str)> {
    let values = runs.into_iter().filter_map(|run| Some((value(run)?, run.name.as_str())));
    values.max_by(|a, b| a.0.total_cmp(&b.0))
}

fn section(runs: &[Run], args: &Args) -> Section {
    let mut table = Table::new(TITLES);
    let mut failures = Vec::new();
    for run in runs {
        if !args.kinds || !run.is_complete() {
            table.push(run.cells());
        }
        for outcome in [Some(&run.map), run.quads.as_ref()].into_iter().flatten() {
            if let Some(code @ ("crash" | "internal")) = code(outcome) {
                failures.push(format!("{}: {code}", run.name));
            }
        }
        let [seconds, megabytes] = cost(&run.map);
        for (value, most, unit) in
            [(seconds, args.most_seconds, "CPU s"), (megabytes, args.most_memory, "MB")]
        {
            if let Some(value) = value.filter(|&value| value > most) {
                failures.push(format!("{}: {value:.0} {unit}, more than {most:.0}", run.name));
            }
        }
    }
    let is_surface = |run: &&Run| !matches!(code(&run.map), Some("unreadable" | "not-a-surface"));
    let surfaces = runs.iter().filter(is_surface).count();
    let mapped = runs.iter().filter(|run| run.map.report().is_some()).count();
    let share = 100.0 * mapped as f64 / surfaces.max(1) as f64;
    if share < args.certified {
        failures.push(format!("{share:.1} % certified, less than {} %", args.certified));
    }
    let mut text = match args.kinds {
        true => format!("{}\n", kinds(runs)),
        false => String::new(),
    };
    if !args.kinds || runs.iter().any(|run| !run.is_complete()) {
        text += &table.to_string();
    }
    text += &format!(
        "\nMeshes: {}; {surfaces} surfaces, {mapped} certified ({share:.1} %)",
        runs.len()
    );
    if args.quads > 0 {
        let made = |run: &&Run| run.quads.as_ref().is_some_and(|quads| quads.report().is_some());
        text += &format!("; quads of {}", runs.iter().filter(made).count());
    }
    let seconds: f64 = runs.iter().filter_map(|run| cost(&run.map)[0]).sum();
    text += &format!("; {seconds:.0} CPU s of maps");
    for (k, unit, decimals) in [(0, "s", 2), (1, "MB", 0)] {
        if let Some((most, name)) = largest(runs, |run| cost(&run.map)[k]) {
            text += &format!("; at most {most:.decimals$} {unit} ({name})");
        }
    }
    text.push('\n');
    Section::new(text, &failures)
}

/// A row for all meshes of a kind.
fn kinds(runs: &[Run]) -> Table {
    let mut by_kind: BTreeMap<&str, Vec<&Run>> = BTreeMap::new();
    runs.iter().for_each(|run| by_kind.entry(run.kind()).or_default().push(run));
    let mut table = Table::new([
        "kind",
        "meshes",
        "triangles",
        "certified",
        "with quads",
        "median tau",
        "largest tau",
        "mean SD",
        "CPU s of maps",
        "largest",
        "largest MB",
    ]);
    for (kind, runs) in by_kind {
        let values = |path: &str| -> Vec<f64> {
            let value = |run: &&Run| run.map.report()?.number(path);
            let mut values: Vec<f64> = runs.iter().filter_map(value).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let (tau, energy) = (values("/distortion/tau"), values("/distortion/symmetric_dirichlet"));
        let faces = values("/input/faces");
        let with_quads = |run: &&&Run| run.quads.as_ref().is_some_and(|q| q.report().is_some());
        let seconds: f64 = runs.iter().filter_map(|run| cost(&run.map)[0]).sum();
        let most = |k: usize| largest(runs.iter().copied(), |run| cost(&run.map)[k]).map(|m| m.0);
        table.push(vec![
            kind.to_owned(),
            runs.len().to_string(),
            format!(
                "{} to {}",
                number(faces.first().copied(), 0),
                number(faces.last().copied(), 0)
            ),
            tau.len().to_string(),
            runs.iter().filter(with_quads).count().to_string(),
            number(tau.get(tau.len() / 2).copied(), 3),
            number(tau.last().copied(), 3),
            number(
                (!energy.is_empty()).then(|| energy.iter().sum::<f64>() / energy.len() as f64),
                4,
            ),
            format!("{seconds:.1}"),
            number(most(0), 2),
            number(most(1), 0),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Reason;

    fn args(kinds: bool) -> Args {
        let selection = Selection { meshes: vec![], only: vec![], smallest: None, largest: None };
        Args {
            selection,
            quads: 0,
            kinds,
            certified: 60.0,
            most_seconds: 60.0,
            most_memory: 2000.0,
            time_limit: 1,
            jobs: 1,
        }
    }

    fn done(name: &str, seconds: f64) -> Run {
        let json = format!(
            r#"{{"input": {{"faces": 12}}, "distortion": {{"tau": 1.5, "symmetric_dirichlet": 4.1}},
                "cost": {{"cpu_seconds": {seconds}, "peak_memory_bytes": 2e7}}}}"#
        );
        let map = Outcome::Done(Report::parse(json.as_bytes()).unwrap());
        Run { name: name.into(), map, quads: None }
    }

    fn failed(name: &str, code: Option<&str>) -> Run {
        let code = code.map(str::to_owned);
        let reason = Reason { code, message: "a reason".into(), cost: None };
        Run { name: name.into(), map: Outcome::Failed(reason), quads: None }
    }

    #[test]
    fn errors_with_a_code_pass_as_long_as_there_are_few() {
        let mut runs =
            vec![done("box_1", 2.0), done("box_2", 3.0), failed("ball_1", Some("no-map"))];
        let good = section(&runs, &args(false));
        assert!(good.passed, "{}", good.text);
        for part in [" no-map |", " a reason |", "2 certified (66.7 %)", "at most 3.00 s (box_2)"] {
            assert!(good.text.contains(part), "{part} in {}", good.text);
        }
        let by_kind = section(&runs, &args(true)).text;
        assert!(by_kind.contains("| box ") && !by_kind.contains("| box_1 "), "{by_kind}");
        assert!(by_kind.contains("| ball_1 "), "{by_kind}");
        runs.push(failed("ball_2", Some("no-map")));
        let bad = section(&runs, &args(false));
        assert!(!bad.passed && bad.text.contains("50.0 % certified, less than 60 %"));
    }

    #[test]
    fn crashes_and_costs_are_failures() {
        for (run, reason) in [
            (failed("a", None), "a: crash"),
            (failed("a", Some("internal")), "a: internal"),
            (done("a", 61.0), "a: 61 CPU s, more than 60"),
        ] {
            let runs = [done("b", 1.0), done("c", 1.0), run];
            let section = section(&runs, &args(false));
            assert!(!section.passed && section.text.contains(reason), "{}", section.text);
        }
        // What is no surface does not count.
        let runs =
            [done("b", 1.0), failed("a", Some("not-a-surface")), failed("c", Some("unreadable"))];
        assert!(section(&runs, &args(false)).passed);
    }
}
