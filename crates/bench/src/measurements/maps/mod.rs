//! Maps of every mesh, by the command `seamstress map`.

mod report;

use crate::jobs;
use crate::markdown::{Table, escape};
use crate::meshes::{Selection, name};
use crate::output::{Section, list, progress};
use crate::process::sibling;
use crate::program::{Outcome, Program, Report};
use crate::verify::{Verdict, Verifier};
use clap::value_parser;
use std::error::Error;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Maps: distortion, cones, time and memory
///
/// Runs the `seamstress map` that lies next to this program. `loops` are boundary loops, `parts` connected
/// components; `SD` is the mean symmetric Dirichlet energy at its best scale (4 is an isometry); `p99` the 99th
/// percentile of `max(s sigma_1, 1 / (s sigma_2))` at the scale of tau; `seams` are the edges across which the map
/// jumps; `route` says how the exact layout was reached. All columns but times and memory are the same in every
/// run; use `--jobs 1` to compare times.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Keep the maps and their reports in this folder, made if it does not exist
    #[arg(long, value_name = "DIR")]
    maps: Option<PathBuf>,

    /// Meshes that are mapped at the same time; give each few threads with `-- --threads N`
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u16).range(1..=256))]
    jobs: u16,

    /// Check every map with `python3 SCRIPT --strict SOURCE MAP`, which prints a JSON object
    #[arg(long, value_name = "SCRIPT")]
    verify: Option<PathBuf>,

    /// Give up on a mesh after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u32).range(1..))]
    time_limit: Option<u32>,

    /// More arguments for `seamstress map`
    #[arg(last = true, value_name = "ARGS")]
    map_args: Vec<OsString>,
}

/// Maps the meshes; passes if every mesh was mapped or refused as no mesh, and every verification passed.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let start = Instant::now();
    let paths = args.selection.paths()?;
    let temporary = tempfile::tempdir()?;
    let folder = args.maps.as_deref().unwrap_or(temporary.path());
    fs::create_dir_all(folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    let path = sibling("seamstress")?;
    let program = Program { path, time_limit: args.time_limit, threads: None };
    let verifier = args.verify.as_deref().map(Verifier::new);
    let done = AtomicUsize::new(0);
    let runs = jobs::map(&paths, args.jobs.into(), |mesh| {
        let run = Run::new(mesh, &program, &args.map_args, folder, verifier.as_ref());
        let k = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress(&format!("[{k}/{}] {}", paths.len(), run.line()));
        run
    });
    Ok(section(&runs, verifier.is_some(), start.elapsed().as_secs_f64()))
}

/// One mesh.
struct Run {
    name: String,
    outcome: Outcome,
    /// Of the verifier, if there is one and a map.
    verdict: Option<Verdict>,
}

impl Run {
    fn new(
        mesh: &Path,
        program: &Program,
        arguments: &[OsString],
        folder: &Path,
        verifier: Option<&Verifier>,
    ) -> Self {
        // The whole file name stays, since files may differ in their extensions only.
        let output = |extension: &str| folder.join(name(mesh) + extension);
        let map = output(".obj");
        let report = [OsString::from("--report"), output(".json").into_os_string()];
        let outcome = program.run("map", mesh, &map, &[&report, arguments].concat());
        let verdict = verifier
            .zip(outcome.report())
            .map(|(verifier, report)| verify(verifier, mesh, &map, &output(".source.obj"), report));
        Self { name: name(mesh), outcome, verdict }
    }

    /// The row of a mapped mesh.
    fn row(&self, report: &Report) -> Vec<String> {
        let mut cells = vec![self.name.clone()];
        cells.extend(report::cells(report));
        cells.extend(self.verdict.as_ref().map(Verdict::cell));
        cells
    }

    fn line(&self) -> String {
        match &self.outcome {
            Outcome::Done(report) => format!("| {} |", self.row(report).join(" | ")),
            Outcome::Refused(reason) => format!("{}: refused: {reason}", self.name),
            Outcome::Failed(reason) => format!("{}: FAILED: {reason}", self.name),
        }
    }
}

/// The table, what is not in it, and a summary.
fn section(runs: &[Run], with_verdicts: bool, seconds: f64) -> Section {
    let mut titles = vec!["mesh"];
    titles.extend(report::TITLES);
    if with_verdicts {
        titles.push("verified");
    }
    let mut table = Table::new(titles);
    let (mut refused, mut failed, mut unverified) = (Vec::new(), Vec::new(), Vec::new());
    let (mut mapped, mut cpu_seconds) = (0, 0.0);
    for run in runs {
        let item = |reason: &dyn ToString| {
            format!("{}: {}", escape(&run.name), escape(&reason.to_string()))
        };
        match &run.outcome {
            Outcome::Refused(reason) => refused.push(item(reason)),
            Outcome::Failed(reason) => failed.push(item(reason)),
            Outcome::Done(report) => {
                table.push(run.row(report));
                let fault = run.verdict.as_ref().and_then(|verdict| verdict.fault.as_deref());
                unverified.extend(fault.map(|fault| item(&fault)));
                mapped += 1;
                cpu_seconds += report.cpu_seconds().unwrap_or(0.0);
            }
        }
    }
    let mut text = table.to_string();
    text += &list("Refused as no mesh", &refused);
    text += &list("Failed", &failed);
    text += &list("Verification failed", &unverified);
    text += &format!(
        "\nMeshes: {}; {mapped} mapped, {} refused, {} failed",
        runs.len(),
        refused.len(),
        failed.len()
    );
    if with_verdicts {
        text += &format!("; {} verified, {} not", mapped - unverified.len(), unverified.len());
    }
    text += &format!("; {cpu_seconds:.0} CPU s of maps, {seconds:.0} s in all\n");
    Section { text, passed: failed.is_empty() && unverified.is_empty() }
}

/// Runs the script. It reads triangles in OBJ and OFF; of other meshes it is given the triangles that the map was
/// made of.
fn verify(
    verifier: &Verifier,
    mesh: &Path,
    map: &Path,
    triangulated: &Path,
    report: &Report,
) -> Verdict {
    if holds_the_triangles(report) {
        return verifier.check(mesh, map, &[]);
    }
    // Where they cannot be written the script says so.
    let _ = write_source(map, triangulated);
    verifier.check(triangulated, map, &[])
}

/// Whether the file itself holds the triangles that were mapped, in a format of the script.
fn holds_the_triangles(report: &Report) -> bool {
    let has_format = matches!(report.get("/input/format").as_str(), Some("OBJ" | "OFF"));
    let repairs = report.get("/input/repairs").as_array();
    has_format
        && report.get("/input/polygons_read") == report.get("/input/faces")
        && repairs.is_none_or(Vec::is_empty)
}

/// Writes the vertices and faces of a map without its texture coordinates.
fn write_source(map: &Path, source: &Path) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(source)?);
    for line in BufReader::new(File::open(map)?).lines() {
        let line = line?;
        if line.starts_with("v ") {
            writeln!(out, "{line}")?;
        } else if let Some(corners) = line.strip_prefix("f ") {
            let vertices =
                corners.split_whitespace().map(|corner| corner.split('/').next().unwrap_or(corner));
            writeln!(out, "f {}", vertices.collect::<Vec<_>>().join(" "))?;
        }
    }
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_source_of_a_map_is_the_map_without_its_texture() {
        let folder = tempfile::tempdir().unwrap();
        let (map, source) = (folder.path().join("m.obj"), folder.path().join("s.obj"));
        fs::write(&map, "# a map\nv 0 0 0\nvt 0 0\nf 1/1 2/2 3/1\n").unwrap();
        write_source(&map, &source).unwrap();
        assert_eq!(fs::read_to_string(source).unwrap(), "v 0 0 0\nf 1 2 3\n");
    }

    #[test]
    fn what_has_no_map_is_listed() {
        let run = |name: &str, outcome| Run { name: name.into(), outcome, verdict: None };
        let done = || Outcome::Done(Report::parse(b"{}").unwrap());
        let mut runs =
            vec![run("a", done()), run("b", Outcome::Refused("a fan".to_owned().into()))];
        let good = section(&runs, false, 0.0);
        assert!(good.passed && good.text.contains("* b: a fan\n"), "{}", good.text);
        runs.push(run("c", Outcome::Failed("no layout".to_owned().into())));
        let bad = section(&runs, false, 0.0);
        assert!(!bad.passed && bad.text.contains("3; 1 mapped, 1 refused, 1 failed"));
    }
}
