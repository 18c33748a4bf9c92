//! How far quads are from the directions of principal curvature, beside those of other programs.

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
/// A script that shares no code with the program judges the quads of each mesh, with default options, and those of Instant Meshes
/// and QuadriFlow where the Python packages `pynanoinstantmeshes` and `pyQuadriFlow` are installed. Columns, each `here; Instant
/// Meshes; QuadriFlow`: quads; the mean angle between their edges and
/// the principal directions, degrees (22.5 is random); irregular vertices; pairs of them that are adjacent, of valence 3 and 5;
/// area of the quads by that of the source; smallest angle of corners, 1 %. Then of those here tau, mean symmetric Dirichlet energy
/// and CPU seconds; in brackets without directions (`--align 0`). Passes if the angle is no larger than that of Instant Meshes and
/// irregular vertices are at most half as many, and fewer than those of QuadriFlow where its angle is no larger, on all meshes, and
/// the angle is at most 10 degrees in the median.
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

/// Another program, through its Python package.
struct Peer {
    name: &'static str,
    /// As imported, and a script that uses it.
    package: &'static str,
    script: &'static str,
}

const PEERS: [Peer; 2] = [
    Peer {
        name: "Instant Meshes",
        package: "pynanoinstantmeshes",
        script: include_str!("instant_meshes.py"),
    },
    Peer { name: "QuadriFlow", package: "pyQuadriFlow", script: include_str!("quadriflow.py") },
];

impl Peer {
    fn is_installed(&self) -> bool {
        let import = format!("import {}", self.package);
        let output = Command::new("python3").args(["-c", &import]).output();
        output.is_ok_and(|output| output.status.success())
    }
}

/// Makes and judges the quads of every mesh at every count.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let bench = Bench {
        program: Program { path: sibling("seamstress")?, time_limit: None, threads: Some(1) },
        script: folder.path().join("peer.py"),
        source: folder.path().join("source.obj"),
        quads: folder.path().join("quads.obj"),
        judge: args.judge.clone(),
    };
    let peers = PEERS.each_ref().map(|peer| Some(peer).filter(|peer| peer.is_installed()));
    let mut text = String::new();
    let (mut failures, mut missed) = (Vec::new(), Vec::new());
    for &asked in &args.quads {
        let mut table = Table::new(TITLES);
        let mut angles = Vec::new();
        let failed = args.selection.survey(|subject| {
            let row = bench.row(subject, asked, peers)?;
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
    for peer in PEERS.iter().zip(peers).filter(|(_, found)| found.is_none()).map(|(peer, _)| peer) {
        progress(&format!("without {}: no Python package `{}`", peer.name, peer.package));
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
    /// What the script says of those here, and of those of [`PEERS`].
    here: Report,
    there: [Option<Report>; 2],
    /// How they were made, with directions and without.
    made: Report,
    plain: Report,
}

impl Bench {
    fn row(
        &self,
        subject: &Subject,
        asked: f64,
        [instant_meshes, quadriflow]: [Option<&Peer>; 2],
    ) -> Result<Row, Box<dyn Error>> {
        let plain = self.make(&subject.path, asked, &["--align", "0"])?;
        let made = self.make(&subject.path, asked, &[])?;
        let here = self.judged(&subject.path, asked)?;
        write_mesh(&self.source, &subject.mesh)?;
        let there = [self.peer(instant_meshes, asked)?, self.peer(quadriflow, asked)?];
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

    /// What the script says of quads by another program, if there are any.
    fn peer(&self, peer: Option<&Peer>, asked: f64) -> Result<Option<Report>, Box<dyn Error>> {
        let Some(peer) = peer else { return Ok(None) };
        fs::write(&self.script, peer.script)?;
        let mut command = Command::new("python3");
        command.args([&self.script, &self.source, &self.quads]).arg(asked.to_string());
        match command.output()?.status.success() {
            true => self.judged(&self.source, asked).map(Some),
            false => Ok(None),
        }
    }

    fn judged(&self, source: &Path, asked: f64) -> Result<Report, Box<dyn Error>> {
        judge(&self.judge, asked, source, &self.quads).map(Report::from)
    }
}

impl Row {
    /// A number here, of Instant Meshes and of QuadriFlow.
    fn all(&self, pointer: &str) -> [Option<f64>; 3] {
        let of = |report: &Report| report.number(pointer);
        let [instant_meshes, quadriflow] = self.there.each_ref().map(|r| r.as_ref().and_then(of));
        [of(&self.here), instant_meshes, quadriflow]
    }

    fn cells(&self, name: &str) -> Vec<String> {
        let pair = |key: &str, digits: usize| {
            let shown = self.all(key).map(|x| x.map_or("-".into(), |x| format!("{x:.digits$}")));
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
        let [angles, irregular] = ["/direction", "/irregular"].map(|pointer| self.all(pointer));
        let mut faults = Vec::new();
        if let [Some(here), Some(there), _] = angles
            && here > there
        {
            faults.push(format!("{here:.1} degrees, there {there:.1}"));
        }
        if let [Some(here), Some(there), _] = irregular
            && here > 0.5 * there
        {
            faults.push(format!("{here} irregular vertices, there {there}"));
        }
        if let ([Some(angle), _, Some(other)], [Some(here), _, Some(there)]) = (angles, irregular)
            && other <= angle
            && here >= there
        {
            let text =
                format!("{here} irregular vertices, of QuadriFlow {there} at {other:.1} degrees");
            faults.push(text);
        }
        faults.into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn row(here: Value, there: [Option<Value>; 2]) -> Row {
        let made = json!({"distortion": {"tau": 2.0, "symmetric_dirichlet": 4.1}});
        let [made, plain] = [made.clone(), made].map(Report::from);
        Row { here: here.into(), there: there.map(|there| there.map(Report::from)), made, plain }
    }

    #[test]
    fn a_row_fails_where_the_other_program_is_better() {
        let there = || [Some(json!({"direction": 9.0, "irregular": 100})), None];
        let faults = |here, there| row(here, there).faults().collect::<Vec<_>>();
        assert!(faults(json!({"direction": 9.0, "irregular": 50}), there()).is_empty());
        assert!(faults(json!({"direction": 30.0, "irregular": 500}), [None, None]).is_empty());
        assert_eq!(
            faults(json!({"direction": 9.1, "irregular": 51}), there()),
            ["9.1 degrees, there 9.0", "51 irregular vertices, there 100"]
        );
        let quadriflow = |angle: f64| [None, Some(json!({"direction": angle, "irregular": 50}))];
        let here = || json!({"direction": 9.0, "irregular": 50});
        assert!(faults(here(), quadriflow(9.1)).is_empty());
        let fault = "50 irregular vertices, of QuadriFlow 50 at 9.0 degrees";
        assert_eq!(faults(here(), quadriflow(9.0)), [fault]);
    }

    #[test]
    fn a_row_has_a_cell_for_every_title() {
        let cells = row(json!({"direction": 9.04}), [None, None]).cells("m");
        assert_eq!(cells.len(), TITLES.len());
        assert_eq!((cells[2].as_str(), cells[8].as_str()), ("9.0; -; -", "4.100 (4.100)"));
    }
}
