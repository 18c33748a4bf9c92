//! The command `seamstress-bench`.

use clap::{Parser, Subcommand};
use seamstress_bench::compare;
use seamstress_bench::process::exit_code;
use std::process::ExitCode;

/// Measures Seamstress
#[derive(Debug, Parser)]
#[command(name = "seamstress-bench", version)]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Compare(compare::Args),
}

fn main() -> ExitCode {
    exit_code(match &Args::parse().command {
        Command::Compare(args) => compare::run(args),
    })
}
