//! Good maps damaged and recovered.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

mod damage;
mod recover;

use clap::Parser;
use damage::Damage;
use recover::{Outcome, Subject};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes;
use seamstress_bench::process::exit_code;
use seamstress_parametrize::consistency::AngleNorm;
use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Damages good maps of every mesh of a folder, makes the matchings consistent and lays out again
///
/// Prints how many of how many passed the conditions of consistency, by a checker of its own, and ended
/// with a certified map, and what the consistency step cost.
#[derive(Debug, Parser)]
struct Args {
    /// The folder of meshes; its subfolders are left out
    folder: PathBuf,

    /// Write the table to this file as well
    #[arg(long, value_name = "TABLE.md")]
    out: Option<PathBuf>,

    /// Take only the files whose name contains this
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,

    /// Leave out meshes of more triangles
    #[arg(long, value_name = "TRIANGLES", default_value_t = usize::MAX)]
    largest: usize,

    /// Only this kind of damage
    #[arg(long, value_enum)]
    damage: Option<Damage>,

    /// How the distance of angles is measured
    #[arg(long, value_enum, default_value_t = Norm::L2)]
    norm: Norm,

    /// Make the matchings consistent, and lay nothing out
    #[arg(long)]
    no_layout: bool,
}

/// Names of the norms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Norm {
    /// Sum of squares
    L2,
    /// Sum of absolute values
    L1,
}

impl From<Norm> for AngleNorm {
    fn from(norm: Norm) -> Self {
        match norm {
            Norm::L2 => AngleNorm::L2,
            Norm::L1 => AngleNorm::L1,
        }
    }
}

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

/// Whether every map was recovered.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let kinds = args.damage.map_or(Damage::ALL.to_vec(), |damage| vec![damage]);
    let mut table = Table::new(Outcome::TITLES);
    let mut counts = vec![Counts::default(); kinds.len()];
    for path in meshes::list(&args.folder, args.only.as_deref())? {
        let mesh = match meshes::load(&path) {
            Ok(mesh) if mesh.connectivity.n_faces() <= args.largest => mesh,
            Ok(_) => continue,
            Err(error) => {
                eprintln!("refused: {error}");
                continue;
            }
        };
        let subject = match Subject::new(&mesh) {
            Ok(subject) => subject,
            Err(error) => {
                eprintln!("{}: {error}", meshes::name(&path));
                continue;
            }
        };
        for (&kind, counts) in kinds.iter().zip(&mut counts) {
            let outcome = subject.recover(kind, args.norm.into(), !args.no_layout);
            counts.add(&outcome);
            let cells = outcome.cells(&meshes::name(&path), kind);
            eprintln!("| {} |", cells.join(" | "));
            table.push(cells);
        }
    }
    let mut text = format!("{table}\n");
    for (kind, counts) in kinds.iter().zip(&counts) {
        text += &counts.line(*kind);
    }
    print!("{text}");
    if let Some(path) = &args.out {
        fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(counts.iter().all(|c| c.consistent == c.tried && (args.no_layout || c.mapped == c.tried)))
}

/// How many of how many.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    tried: usize,
    consistent: usize,
    mapped: usize,
}

impl Counts {
    fn add(&mut self, outcome: &Outcome) {
        self.tried += 1;
        self.consistent += usize::from(outcome.faults == 0);
        self.mapped += usize::from(outcome.mapped);
    }

    fn line(&self, kind: Damage) -> String {
        let Self { tried, consistent, mapped } = self;
        format!("* {kind}: {consistent} of {tried} consistent, {mapped} of {tried} certified\n")
    }
}
