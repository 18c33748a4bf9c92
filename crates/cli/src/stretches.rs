//! Files of wanted stretches.

use crate::outcome::Failure;
use seamstress_parametrize::Stretch;
use std::fs;
use std::path::Path;

/// Reads five numbers per line: a direction in space, and the stretch along and across it. Empty lines and
/// those that start with `#` do not count.
pub(crate) fn read_stretches(path: &Path) -> Result<Vec<Stretch>, Failure> {
    let bad = |text: String| Failure::BadStretches { file: path.to_owned(), text };
    let text = fs::read_to_string(path).map_err(|error| bad(error.to_string()))?;
    let lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim()));
    let wanted = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let parse = |(number, line): (usize, &str)| {
        let numbers: Option<Vec<f64>> = line.split_whitespace().map(|x| x.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, z, along, across]) => Ok(Stretch { direction: [x, y, z], along, across }),
            _ => Err(bad(format!(
                "line {number}: expected five numbers, a direction and the stretch along and across it"
            ))),
        }
    };
    wanted.map(parse).collect()
}
