//! Text for people.

pub(crate) use seamstress::words::{counted, rounded};
use std::io::{self, ErrorKind, Write};

/// Prints lines on standard output. A reader that has gone away is no fault.
pub(crate) fn print(text: &str) -> io::Result<()> {
    write(format!("{text}\n").as_bytes())
}

/// Writes to standard output. A reader that has gone away is no fault.
pub(crate) fn write(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(bytes).and_then(|()| out.flush());
    match written {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => Err(cause),
        _ => Ok(()),
    }
}

/// Prints lines on standard error, if anyone reads it.
pub(crate) fn report(text: &str) {
    // There is no better place to report that this fails.
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// A row of a summary: a label and its text.
pub(crate) fn row(label: &str, text: &str) -> String {
    format!("{label:<13}{text}")
}

/// The first lines, and how many more there are.
pub(crate) fn listing(lines: &[String], limit: usize) -> Vec<String> {
    let more = lines.len().saturating_sub(limit);
    let more = (more > 0).then(|| format!("and {more} more"));
    lines.iter().take(limit).cloned().chain(more).collect()
}

/// A text of the library with its options and calls as they are spelled here: `cone_bias` becomes `--cone-bias`.
pub(crate) fn as_options(text: &str) -> String {
    let mut parts = text.split('`');
    let mut out: String = parts.next().unwrap_or_default().into();
    while let Some(quoted) = parts.next() {
        let command = COMMANDS.iter().find(|(call, _)| *call == quoted);
        let name = match command {
            Some((_, command)) => (*command).into(),
            None if OPTIONS.contains(&quoted) => format!("--{}", quoted.replace('_', "-")),
            None => quoted.into(),
        };
        out += &format!("`{name}`{}", parts.next().unwrap_or_default());
    }
    out
}

/// Options of the library that its messages name.
pub(crate) const OPTIONS: [&str; 16] = [
    "allow_flips",
    "alignment_tolerance",
    "best_effort",
    "cone_bias",
    "exact",
    "features_strict",
    "format",
    "free_cones",
    "partial",
    "pictures",
    "repair",
    "rounding",
    "small_parts",
    "time_limit",
    "tolerance",
    "weld",
];

/// Calls of the library that its messages name, and the commands that make them.
const COMMANDS: [(&str, &str); 3] = [
    ("inspect", "seamstress check"),
    ("integer_map", "seamstress integer"),
    ("parametrize", "seamstress map"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_spelled_as_arguments() {
        let text = "try another `cone_bias`, or `l` elements";
        assert_eq!(as_options(text), "try another `--cone-bias`, or `l` elements");
        assert_eq!(as_options("`inspect` tells"), "`seamstress check` tells");
    }
}
