//! The `seamstress` command, what its flags mean, and files as it writes them.

use crate::errors;
use pyo3::prelude::*;
use seamstress::Output;
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

/// Runs the command with these arguments, the first of which is its name; returns its exit code.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| seamstress_cli::run(arguments))
}

/// The flags of a command, such as `map`: for each its keyword, its help and its default, as texts.
#[pyfunction]
pub(crate) fn flags(command: &str) -> Vec<(String, String, Option<String>)> {
    let definition = seamstress_cli::definition();
    let mut found = Some(&definition);
    for name in command.split(' ') {
        found = found.and_then(|command| command.find_subcommand(name));
    }
    let arguments = found.into_iter().flat_map(|command| command.get_arguments());
    let named = arguments.filter_map(|argument| {
        let keyword = argument.get_long()?.replace('-', "_");
        let help = argument.get_long_help().or_else(|| argument.get_help());
        let default = argument.get_default_values().first();
        let default = default.map(|value| value.to_string_lossy().into_owned());
        let takes_value = argument.get_action().takes_values();
        Some((
            keyword,
            help.map(ToString::to_string).unwrap_or_default(),
            default.filter(|_| takes_value),
        ))
    });
    named.collect()
}

/// Writes a file of a `map`, or of `quads`, which appears only when it is complete; compressed if its name says so.
#[pyfunction]
pub(crate) fn write_file(
    py: Python<'_>,
    path: PathBuf,
    kind: &str,
    content: &[u8],
) -> PyResult<()> {
    let output = match kind {
        "map" => Output::Map,
        _ => Output::Quads,
    };
    let written = py.detach(|| output.write(&path, |file| file.write_all(content)));
    written.map_err(|error| errors::exception(py, &error))
}
