//! Good maps damaged and recovered.

mod damage;
mod recover;

use crate::markdown::Table;
use crate::meshes::Selection;
use crate::output::Section;
use damage::Damage;
use recover::{Outcome, Subject};
use seamstress_parametrize::consistency::AngleNorm;
use std::error::Error;

/// Recovery: good maps damaged, made consistent and laid out again
///
/// How many passed the conditions of consistency, by a checker of its own, and ended with a certified map; and
/// what the consistency step cost.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

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
pub(super) enum Norm {
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

/// Damages and recovers every map; passes if all were recovered.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let kinds = args.damage.map_or(Damage::ALL.to_vec(), |damage| vec![damage]);
    let mut table = Table::new(Outcome::TITLES);
    let mut counts = vec![Counts::default(); kinds.len()];
    let failures = args.selection.survey(|map| {
        let subject = Subject::new(&map.mesh)?;
        let mut lost = Vec::new();
        for (&kind, counts) in kinds.iter().zip(&mut counts) {
            let outcome = subject.recover(kind, args.norm.into(), !args.no_layout);
            counts.add(&outcome);
            if outcome.faults > 0 || (!outcome.mapped && !args.no_layout) {
                lost.push(kind.to_string());
            }
            table.report(outcome.cells(&map.name, kind));
        }
        if lost.is_empty() { Ok(()) } else { Err(lost.join(", ").into()) }
    })?;
    let lines: String = kinds.iter().zip(&counts).map(|(kind, c)| c.line(*kind)).collect();
    Ok(Section::new(format!("{table}\n{lines}"), &failures))
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
