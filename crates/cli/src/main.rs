//! The `seamstress` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    seamstress_cli::run(std::env::args_os()).into()
}
