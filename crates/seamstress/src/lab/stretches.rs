//! Files of wanted stretches.

use crate::error::{Error, ErrorKind, Stage};
use seamstress_parametrize::Stretch;
use std::fs;
use std::path::Path;

/// Reads five numbers per line: a direction in space, and the stretch along and across it. Empty lines and
/// those that start with `#` do not count.
///
/// # Errors
/// [`ErrorKind::BadStart`], naming the line.
pub fn read_stretches(path: impl AsRef<Path>) -> Result<Vec<Stretch>, Error> {
    let path = path.as_ref();
    let bad = |text: String| {
        Error::new(ErrorKind::BadStart, text)
            .at_stage(Some(Stage::Files))
            .of(Some(&path.display().to_string()))
    };
    let text = fs::read_to_string(path).map_err(|cause| bad(cause.to_string()))?;
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
