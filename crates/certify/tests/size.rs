//! The checker stays so small that it can be read in one sitting.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test")]

use std::fs;
use std::path::Path;

/// Lines of code.
const MOST: usize = 799;

/// Lines that are neither blank nor comments, up to the tests of a file, which stand at its end.
fn lines_of_code(text: &str) -> usize {
    let is_code = |line: &&str| !line.is_empty() && !line.starts_with("//");
    text.lines().map(str::trim).take_while(|line| *line != "#[cfg(test)]").filter(is_code).count()
}

#[test]
fn lines_are_counted_without_comments_blanks_and_tests() {
    let text = "//! Doc.\n\nuse a;\n/// Doc.\nfn f() {\n    // why\n    g() // so\n}\n\n#[cfg(test)]\nmod tests {}\n";
    assert_eq!(lines_of_code(text), 4);
}

#[test]
fn the_checker_is_small() {
    let sources = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("src")).unwrap();
    let texts = sources.map(|entry| fs::read_to_string(entry.unwrap().path()).unwrap());
    let all: usize = texts.map(|text| lines_of_code(&text)).sum();
    println!("{all} lines of code");
    assert!(all > 100 && all <= MOST, "{all}");
}
