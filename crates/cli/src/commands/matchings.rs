//! `seamstress lab repair-matchings`.

use super::{inputs, targets};
use crate::args::{RunArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan, Target};
use crate::summary;
use crate::text::{counted, rounded, row};
use seamstress::lab::{ConsistentMatchings, MatchingOptions};
use seamstress::{Surface, SurfaceOptions, write_cones, write_matchings};
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress lab repair-matchings bunny.ply --from broken.obj -o bunny.matching
  seamstress lab repair-matchings bunny.ply --field bunny.rawfield -o bunny.matching --sing bunny.sing
  seamstress lab map bunny.ply --matching bunny.matching -o bunny.obj";

/// Find consistent matchings near those of a map with foldovers, or of a cross field
///
/// Matchings, indices and angles that triangles can have: positive angles with the right sums, and no vertex
/// without an angle. On small meshes they are the nearest ones; on others nearer ones may exist. The summary says
/// how far the angles moved, and whether that is proven least or by how much others may be nearer.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct MatchingsArgs {
    /// The mesh: OBJ, OFF, PLY, STL or glTF
    mesh: PathBuf,

    #[command(flatten)]
    options: MatchingOptions,

    /// Write the matchings modulo 4 to this file
    #[arg(short, long, value_name = "FILE.matching")]
    output: PathBuf,

    /// Write the cones to this file: vertex (counted from 0) and index in quarters of a turn
    #[arg(long, value_name = "FILE.sing")]
    sing: Option<PathBuf>,

    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    run: RunArgs,
}

impl Command for MatchingsArgs {
    const NAME: &'static str = "repair-matchings";
    type Product = (Surface, ConsistentMatchings);

    fn run_args(&self) -> RunArgs {
        self.run
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let mut files = targets(Kind::Cones, &self.sing);
        files.extend(targets(Kind::Matching, [&self.output]));
        Plan::new(&inputs(&self.mesh, self.options.files()), None, files)
    }

    fn make(&self, session: &Session) -> Result<Self::Product, Failure> {
        let surface = session.open(&self.mesh, &self.surface)?;
        let made = surface.consistent_matchings(&self.options)?;
        Ok((surface, made))
    }

    fn write(
        &self,
        (surface, made): &Self::Product,
        target: &Target,
        mut file: &mut dyn Write,
    ) -> io::Result<()> {
        match target.kind {
            Kind::Cones => write_cones(made.cones(), &mut file),
            _ => write_matchings(surface, made.matchings(), &mut file),
        }
    }

    fn report(&self, (_, made): &Self::Product) -> Value {
        to_json(made.report())
    }

    fn summary(&self, (_, made): &Self::Product) -> Vec<String> {
        let report = made.report();
        let mut rows = summary::surface_rows(&report.input);
        let text = format!("{} given, {} now", report.cones_before, report.cones.len());
        rows.push(row("cones", &text));
        let text = format!(
            "{} in {}; the index of {}",
            counted(report.stats.changed_matchings, "matching"),
            report.seams,
            counted(report.stats.changed_indices, "vertex"),
        );
        rows.push(row("changed", &text));
        if !report.real_matchings.is_empty() {
            let text = format!("{}, rounded in files", report.real_matchings.len());
            rows.push(row("real", &text));
        }
        let proof = match report.optimal {
            true => "proven nearest".into(),
            false => format!(
                "others are at most {:.1} % nearer ({} at least)",
                100.0 * report.gap,
                rounded(report.lower_bound),
            ),
        };
        rows.push(row(
            "angles",
            &format!("{} from those given; {proof}", rounded(report.objective)),
        ));
        rows
    }
}
