//! The command `seamstress-bench`.

use clap::{Parser, Subcommand};
use seamstress_bench::family;
use seamstress_bench::measurements::Measurement;
use seamstress_bench::output::{show, write_page};
use seamstress_bench::process::exit_code;
use seamstress_bench::results::{self, description, parse, render};
use std::error::Error;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// Measures Seamstress
///
/// The exit code is 0 if everything measured is as it should be, 1 if something is not, 2 after an error.
#[derive(Debug, Parser)]
#[command(name = "seamstress-bench", version)]
struct Args {
    #[command(subcommand)]
    command: Command,

    /// Write the page to this file as well; `results`: the folder of the pages
    #[arg(long, global = true, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Results(results::Args),
    Family(family::Args),
    #[command(flatten)]
    Measure(Measurement),
}

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let measurement = match &args.command {
        Command::Measure(measurement) => measurement,
        Command::Family(family) => return family::run(family),
        Command::Results(results) => {
            let folder = args.out.clone().unwrap_or_else(|| PathBuf::from("docs/results"));
            return results::run(results, &folder);
        }
    };
    let section = measurement.run()?;
    let words = command_line();
    let (_, about) = parse(&words)?;
    let text = description(&about) + &render(&words, &section);
    show(&text);
    if let Some(file) = &args.out {
        let title = about.lines().next().unwrap_or_default();
        write_page(file, title, &text)?;
    }
    Ok(section.passed)
}

/// The arguments of this process without `--out`.
fn command_line() -> Vec<OsString> {
    let mut words = Vec::new();
    let mut arguments = std::env::args_os().skip(1);
    while let Some(word) = arguments.next() {
        if word == "--out" {
            arguments.next();
        } else if !word.to_string_lossy().starts_with("--out=") {
            words.push(word);
        }
    }
    words
}
