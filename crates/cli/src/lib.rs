//! The `seamstress` command: arguments in, calls of the library, messages and files out.
//!
//! A library, so that other packages can bring the command along: [`run`] is all of it.

mod args;
mod command;
mod command_line;
mod commands;
mod failure;
mod job;
mod output;
mod progress;
mod summary;
mod system;
mod text;

#[cfg(all(feature = "app", fuzzing))]
pub use commands::serve_forever;

use clap::FromArgMatches;
use command_line::CommandLine;
use std::ffi::OsString;

/// Runs the command with these arguments, the first of which is its name; returns its exit code.
///
/// It listens to Ctrl-C from then on: meant for processes that run one command and end.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let parsed = definition().try_get_matches_from(arguments);
    let command = match parsed.and_then(|matches| CommandLine::from_arg_matches(&matches)) {
        Ok(command) => command,
        // Help and versions are errors too, printed on standard output.
        Err(error) => {
            // A reader that has gone away is no fault.
            let _ = error.print();
            return error.exit_code() as u8;
        }
    };
    match command.run() {
        Ok(status) => status as u8,
        Err(failure) => {
            text::report(&format!("error: {failure}"));
            failure.status() as u8
        }
    }
}

/// The command line as clap describes it: commands, flags and their help texts.
pub fn definition() -> clap::Command {
    command_line::definition()
}
