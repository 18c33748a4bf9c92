//! What the sources of the libraries must not contain, and no compiler sees.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

/// Crates that browsers run.
const LIBRARIES: [&str; 8] =
    ["io", "linalg", "mesh", "parametrize", "quads", "quantize", "render", "seamstress"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The first reason against a line.
fn objection(line: &str) -> Option<&'static str> {
    let imports_instant = line.contains("std::time::") && line.contains("Instant");
    if imports_instant {
        return Some("std's clock panics in browsers: web_time::Instant");
    }
    if line.contains("rayon::") {
        return Some("builds without threads: seamstress_parallel");
    }
    line.contains("std::thread").then_some("browsers have no threads to start")
}

#[test]
fn libraries_keep_to_what_browsers_have() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    LIBRARIES.iter().for_each(|name| sources(&crates.join(name).join("src"), &mut files));
    assert!(files.len() > 100, "{} files cannot be all", files.len());
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        for (k, line) in text.lines().enumerate() {
            let found = objection(line);
            assert!(found.is_none(), "{}:{}: {}", file.display(), k + 1, found.unwrap());
        }
    }
}

#[test]
fn objections_are_raised() {
    for line in
        ["use std::time::{Duration, Instant};", "use rayon::prelude::*;", "std::thread::spawn(f)"]
    {
        assert!(objection(line).is_some(), "{line}");
    }
    assert!(objection("use std::time::Duration;").is_none());
}
