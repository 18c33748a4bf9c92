//! When, where and by what something was measured.

use std::fs;
use std::process::Command;
use std::thread::available_parallelism;
use std::time::{SystemTime, UNIX_EPOCH};

/// The day, the state of the program and the machine, in a few words.
pub(crate) fn provenance() -> String {
    let mut version = format!("seamstress {}", env!("CARGO_PKG_VERSION"));
    if let Some(commit) = commit() {
        version += &format!(" ({commit})");
    }
    let cores = available_parallelism().map_or(1, std::num::NonZero::get);
    let plural = if cores == 1 { "" } else { "s" };
    format!("Measured on {} with {version} on {}, {cores} core{plural}", today(), processor())
}

/// The state of the repository that this is run in; changes that are not committed are marked as `-dirty`.
fn commit() -> Option<String> {
    let output = Command::new("git").args(["describe", "--always", "--dirty"]).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    (output.status.success() && !text.trim().is_empty()).then(|| text.trim().to_owned())
}

/// The name of the processor on Linux, else the architecture and the system.
fn processor() -> String {
    let name = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.split_whitespace().collect::<Vec<_>>().join(" "))
    });
    let system = std::env::consts::OS;
    match name {
        Some(name) => format!("{name}, {system}"),
        None => format!("{}, {system}", std::env::consts::ARCH),
    }
}

/// Today's date in UTC.
fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (year, month, day) = date(seconds / SECONDS_PER_DAY);
    format!("{year}-{month:02}-{day:02}")
}

const SECONDS_PER_DAY: u64 = 86_400;

/// Year, month and day from the days since the first of January 1970, in the Gregorian calendar.
fn date(days: u64) -> (u64, usize, u64) {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let (mut year, mut left) = (1970, days);
    while left >= 365 + u64::from(is_leap(year)) {
        left -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let mut months = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    months[1] += u64::from(is_leap(year));
    let mut month = 0;
    while left >= months[month] {
        left -= months[month];
        month += 1;
    }
    (year, month + 1, left + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_dates() {
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(date(58), (1970, 2, 28));
        assert_eq!(date(59), (1970, 3, 1));
        assert_eq!(date(11_016), (2000, 2, 29));
        assert_eq!(date(19_722), (2023, 12, 31));
        assert_eq!(date(19_723 + 365), (2024, 12, 31));
        assert_eq!(date(20_454), (2026, 1, 1));
    }

    #[test]
    fn the_provenance_has_a_date_and_a_version() {
        let text = provenance();
        assert!(text.starts_with("Measured on 20") && text.contains(env!("CARGO_PKG_VERSION")));
    }
}
