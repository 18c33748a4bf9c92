//! Where tables and progress go.

use std::error::Error;
use std::fs;
use std::path::Path;

/// Prints text on standard output and, if a file is given, writes it there too.
///
/// # Errors
/// If the file cannot be written.
#[expect(clippy::print_stdout, reason = "tables are what these programs are for")]
pub fn publish(text: &str, file: Option<&Path>) -> Result<(), Box<dyn Error>> {
    print!("{text}");
    if let Some(path) = file {
        fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(())
}

/// Shows a line of progress on standard error.
#[expect(clippy::print_stderr, reason = "progress goes there, apart from the tables")]
pub fn progress(line: &str) {
    eprintln!("{line}");
}
