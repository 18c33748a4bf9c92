//! The `seamstress` command: arguments in, calls of the library, messages and files out.

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

use std::process::ExitCode;

fn main() -> ExitCode {
    let command = command_line::parse();
    match command.run() {
        Ok(status) => status.into(),
        Err(failure) => {
            text::report(&format!("error: {failure}"));
            failure.status().into()
        }
    }
}
