//! Text for people.

use crate::outcome::Failure;
use std::io::{ErrorKind, Write};

/// Prints lines on standard output. A reader that has gone away is no fault.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let written = writeln!(out, "{text}").and_then(|()| out.flush());
    match written {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Output { path: "to standard output".into(), cause })
        }
        _ => Ok(()),
    }
}

/// Prints lines on standard error, if anyone reads it.
pub(crate) fn tell(text: &str) {
    // There is no better place to report that this fails.
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// "1 face", "2 faces".
pub(crate) fn counted(count: usize, noun: &str) -> String {
    match (count, noun.strip_suffix("ex")) {
        (1, _) => format!("1 {noun}"),
        (_, Some(stem)) => format!("{count} {stem}ices"),
        (_, None) => format!("{count} {noun}s"),
    }
}

/// A number with about four digits.
pub(crate) fn figure(x: f64) -> String {
    if x.is_nan() {
        "undefined".into()
    } else if x.is_infinite() {
        "infinite".into()
    } else if x == 0.0 {
        "0".into()
    } else if (0.001..1e5).contains(&x.abs()) {
        format!("{x:.4}")
    } else {
        format!("{x:.2e}")
    }
}

/// A row of a summary: a label and its text.
pub(crate) fn row(label: &str, text: &str) -> String {
    format!("{label:<13}{text}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_nouns() {
        assert_eq!(counted(1, "vertex"), "1 vertex");
        assert_eq!(counted(3, "vertex"), "3 vertices");
        assert_eq!(counted(0, "face"), "0 faces");
        assert_eq!(figure(f64::INFINITY), "infinite");
        assert_eq!(figure(2.345_67), "2.3457");
        assert_eq!(figure(1.234e-12), "1.23e-12");
    }
}
