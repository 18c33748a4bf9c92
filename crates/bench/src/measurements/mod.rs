//! What can be measured: one subcommand each.

mod collection;
mod conic;
mod consistency;
mod direction;
mod factorisations;
mod features;
mod fields;
mod integer;
mod maps;
mod methods;
mod miq;
mod objectives;
mod quads;
mod recovery;
mod rounding;
mod sizes;
mod speed;

use crate::compare;
use crate::output::Section;
use std::error::Error;

/// A measurement with its options.
#[derive(Debug, clap::Subcommand)]
#[expect(missing_docs, reason = "a comment here would replace that of the options in the help")]
pub enum Measurement {
    Compare(compare::Args),
    Collection(collection::Args),
    Maps(maps::Args),
    Speed(speed::Args),
    Factorisations(factorisations::Args),
    Rounding(rounding::Args),
    Objectives(objectives::Args),
    Conic(conic::Args),
    Features(features::Args),
    Integer(integer::Args),
    Quads(quads::Args),
    Direction(direction::Args),
    Sizes(sizes::Args),
    Fields(fields::Args),
    Methods(methods::Args),
    Miq(miq::Args),
    Consistency(consistency::Args),
    Recovery(recovery::Args),
}

impl Measurement {
    /// Measures.
    ///
    /// # Errors
    /// If there is nothing to measure, or a file cannot be read or written.
    pub fn run(&self) -> Result<Section, Box<dyn Error>> {
        match self {
            Self::Compare(args) => compare::measure(args),
            Self::Collection(args) => collection::measure(args),
            Self::Maps(args) => maps::measure(args),
            Self::Speed(args) => speed::measure(args),
            Self::Factorisations(args) => factorisations::measure(args),
            Self::Rounding(args) => rounding::measure(args),
            Self::Objectives(args) => objectives::measure(args),
            Self::Conic(args) => conic::measure(args),
            Self::Features(args) => features::measure(args),
            Self::Integer(args) => integer::measure(args),
            Self::Quads(args) => quads::measure(args),
            Self::Direction(args) => direction::measure(args),
            Self::Sizes(args) => sizes::measure(args),
            Self::Fields(args) => fields::measure(args),
            Self::Methods(args) => methods::measure(args),
            Self::Miq(args) => miq::measure(args),
            Self::Consistency(args) => consistency::measure(args),
            Self::Recovery(args) => recovery::measure(args),
        }
    }
}
