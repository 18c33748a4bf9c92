//! How far quads are from the directions of principal curvature, beside those of Instant Meshes.

use crate::map_files::write_mesh;
use crate::markdown::Table;
use crate::meshes::{Selection, Subject};
use crate::output::{Section, progress};
use crate::process::sibling;
use crate::program::{Outcome, Program, Report};
use crate::statistics::median;
use crate::verify::judge;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Direction: do quads follow the principal directions?
///
/// A script that shares no code with the program judges the quads of each mesh, with default options, and those of Instant Meshes where the
/// Python package `pynanoinstantmeshes` is installed. Columns, each `here; there`: quads; the mean angle between their edges and
/// the principal directions, degrees (22.5 is random); irregular vertices; pairs of them that are adjacent, of valence 3 and 5;
/// area of the quads by that of the source; smallest angle of corners, 1 %. Then of those here tau, mean symmetric Dirichlet energy
/// and CPU seconds; in brackets without directions (`--align 0`). Passes if the angle is no larger than there and irregular
/// vertices are at most half as many, on all meshes, and the angle is at most 10 degrees in the median.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Quads asked for
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [2500.0, 10000.0])]
    quads: Vec<f64>,

    /// Judge quads by this Python script
    ///
    /// It is called as `python3 SCRIPT --json --asked N SOURCE QUADS` and prints a JSON object with `direction`, degrees, and
    /// `quads`, `irregular`, `pairs`, `cover` and `angle_min`.
    #[arg(long, value_name = "SCRIPT")]
    judge: PathBuf,
}

const TITLES: [&str; 10] = [
    "mesh",
    "quads",
    "direction",
    "irregular",
    "pairs",
    "cover",
    "angle",
    "tau",
    "energy",
    "CPU s",
];

/// The largest angle in the median over the meshes, degrees.
const MEDIAN: f64 = 10.0;
/// Instant Meshes as a Python script.
const PEER: &str = include_str!("instant_meshes.py");

/// Makes and judges the quads of every mesh at every count.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let bench = Bench {
        program: Program { path: sibling("seamstress")?, time_limit: None, threads: Some(1) },
        script: folder.path().join("instant_meshes.py"),
        source: folder.path().join("source.obj"),
        quads: folder.path().join("quads.obj"),
        judge: args.judge.clone(),
    };
    fs::write(&bench.script, PEER)?;
    let has_peer = Command::new("python3").args(["-c", "import pynanoinstantmeshes"]).output();
    let has_peer = has_peer.is_ok_and(|output| output.status.success());
    let mut text = String::new();
    let (mut failures, mut missed) = (Vec::new(), Vec::new());
    for &asked in &args.quads {
        let mut table = Table::new(TITLES);
        let mut angles = Vec::new();
        let failed = args.selection.survey(|subject| {
            let row = bench.row(subject, asked, has_peer)?;
            table.report(row.cells(&subject.name));
            let named = |fault| format!("{}, {asked} quads: {fault}", subject.name);
            missed.extend(row.faults().map(named));
            angles.extend(row.here.number("/direction"));
            Ok(())
        })?;
        failures.extend(failed);
        text += &format!("\n### {asked} quads\n\n{table}");
        if let Some(angle) = median(angles, |&angle| angle) {
            text += &format!("\nThe median of the angles is {angle:.1} degrees.\n");
            if angle > MEDIAN {
                missed.push(format!("{asked} quads: the median is above {MEDIAN} degrees"));
            }
        }
    }
    if !has_peer {
        progress("without Instant Meshes: no Python package `pynanoinstantmeshes`");
    }
    Ok(Section::new(text.trim_start(), &[failures, missed].concat()))
}

/// What is run.
struct Bench {
    program: Program,
    script: PathBuf,
    source: PathBuf,
    quads: PathBuf,
    judge: PathBuf,
}

/// Quads of one mesh at one count.
struct Row {
    /// What the script says of those here, and of those of Instant Meshes.
    here: Report,
    there: Option<Report>,
    /// How they were made, with directions and without.
    made: Report,
    plain: Report,
}

impl Bench {
    fn row(&self, subject: &Subject, asked: f64, has_peer: bool) -> Result<Row, Box<dyn Error>> {
        let plain = self.make(&subject.path, asked, &["--align", "0"])?;
        let made = self.make(&subject.path, asked, &[])?;
        let here = self.judged(&subject.path, asked)?;
        let there = match has_peer {
            true => {
                write_mesh(&self.source, &subject.mesh)?;
                self.peer(asked).map(|()| self.judged(&self.source, asked)).transpose()?
            }
            false => None,
        };
        Ok(Row { here, there, made, plain })
    }

    /// Quads by the program, and their report.
    fn make(&self, mesh: &Path, asked: f64, more: &[&str]) -> Result<Report, Box<dyn Error>> {
        let asked = asked.to_string();
        let options = [&["--quads", &asked], more].concat();
        match self.program.run("quad", mesh, &self.quads, &options) {
            Outcome::Done(report) => Ok(report),
            Outcome::Refused(reason) | Outcome::Failed(reason) => Err(reason.to_string().into()),
        }
    }

    /// Quads by Instant Meshes, if there are any.
    fn peer(&self, asked: f64) -> Option<()> {
        let mut command = Command::new("python3");
        command.args([&self.script, &self.source, &self.quads]).arg(asked.to_string());
        command.output().ok().filter(|output| output.status.success()).map(drop)
    }

    fn judged(&self, source: &Path, asked: f64) -> Result<Report, Box<dyn Error>> {
        judge(&self.judge, asked, source, &self.quads).map(Report::from)
    }
}

impl Row {
    fn both(&self, pointer: &str) -> [Option<f64>; 2] {
        let of = |report: &Report| report.number(pointer);
        [of(&self.here), self.there.as_ref().and_then(of)]
    }

    fn cells(&self, name: &str) -> Vec<String> {
        let pair = |key: &str, digits: usize| {
            let shown = self.both(key).map(|x| x.map_or("-".into(), |x| format!("{x:.digits$}")));
            shown.join("; ")
        };
        let against = |pointer: &str, digits: usize| {
            let of = |report: &Report| report.number(pointer).unwrap_or(f64::NAN);
            format!("{:.digits$} ({:.digits$})", of(&self.made), of(&self.plain))
        };
        vec![
            name.to_owned(),
            pair("/quads", 0),
            pair("/direction", 1),
            pair("/irregular", 0),
            pair("/pairs", 0),
            pair("/cover", 2),
            pair("/angle_min", 0),
            against("/distortion/tau", 1),
            against("/distortion/symmetric_dirichlet", 3),
            against("/cost/cpu_seconds", 1),
        ]
    }

    /// What is not as it should be.
    fn faults(&self) -> impl Iterator<Item = String> {
        let above = |pointer: &str, part: f64| match self.both(pointer) {
            [Some(here), Some(there)] if here > part * there => Some((here, there)),
            _ => None,
        };
        let angle = above("/direction", 1.0)
            .map(|(here, there)| format!("{here:.1} degrees, there {there:.1}"));
        let irregular = above("/irregular", 0.5)
            .map(|(here, there)| format!("{here} irregular vertices, there {there}"));
        angle.into_iter().chain(irregular)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn row(here: Value, there: Option<Value>) -> Row {
        let made = json!({"distortion": {"tau": 2.0, "symmetric_dirichlet": 4.1}});
        let [made, plain] = [made.clone(), made].map(Report::from);
        Row { here: here.into(), there: there.map(Report::from), made, plain }
    }

    #[test]
    fn a_row_fails_where_the_other_program_is_better() {
        let there = || Some(json!({"direction": 9.0, "irregular": 100}));
        let faults = |here, there| row(here, there).faults().collect::<Vec<_>>();
        assert!(faults(json!({"direction": 9.0, "irregular": 50}), there()).is_empty());
        assert!(faults(json!({"direction": 30.0, "irregular": 500}), None).is_empty());
        assert_eq!(
            faults(json!({"direction": 9.1, "irregular": 51}), there()),
            ["9.1 degrees, there 9.0", "51 irregular vertices, there 100"]
        );
    }

    #[test]
    fn a_row_has_a_cell_for_every_title() {
        let cells = row(json!({"direction": 9.04}), None).cells("m");
        assert_eq!(cells.len(), TITLES.len());
        assert_eq!((cells[2].as_str(), cells[8].as_str()), ("9.0; -", "4.100 (4.100)"));
    }
}
