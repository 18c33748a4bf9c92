//! The `seamstress` command: arguments in, library calls, a report out.

mod args;
mod check;
mod extract;
mod faults;
mod features;
mod field;
mod input;
mod integer;
mod job;
mod layout;
mod layout_quads;
mod made;
mod map;
mod map_file;
mod measure;
mod outcome;
mod output;
mod pictures;
mod progress;
mod quad;
mod quad_file;
mod quality;
mod repair_matchings;
mod report;
mod shape;
mod start;
mod stop;
mod stretches;
mod summary;
mod system;
mod text;
mod verdict;
mod writers;

use args::{Args, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = Args::parse();
    let done = match &args.command {
        Command::Map(args) => map::run(args),
        Command::Quad(args) => quad::run(args),
        Command::Integer(args) => integer::run(args),
        Command::Check(args) => check::run(args),
        Command::Extract(args) => extract::run(args),
        Command::Field(args) => field::run(args),
        Command::RepairMatchings(args) => repair_matchings::run(args),
        Command::LayoutQuads(args) => layout_quads::run(args),
        Command::Quality(args) => quality::run(args),
        Command::Measure(args) => measure::run(args),
        Command::Layout(args) => layout::run(args),
    };
    match done {
        Ok(status) => status.into(),
        Err(failure) => {
            text::tell(&format!("error: {failure}"));
            failure.status().into()
        }
    }
}
