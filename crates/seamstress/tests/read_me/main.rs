//! The program in README.md is `program.rs` beside this file, and it runs.
#![cfg(feature = "io")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod example {
    include!("program.rs");

    pub(super) fn run() -> Result<(), Box<dyn std::error::Error>> {
        main()
    }
}

use std::fs;
use std::path::Path;

#[test]
fn the_program_of_the_read_me_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read_me = fs::read_to_string(root.join("README.md")).unwrap();
    let (_, from_block) = read_me.split_once("```rust").unwrap();
    let (_, from_program) = from_block.split_once('\n').unwrap();
    let (program, rest) = from_program.split_once("```").unwrap();
    assert_eq!(
        program,
        include_str!("program.rs"),
        "README.md does not show the program that runs"
    );
    assert!(!rest.contains("```rust"), "only the first program is run");
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("samples")).unwrap();
    let sample = "samples/bracket.obj";
    fs::copy(root.join(sample), folder.path().join(sample)).unwrap();
    // Alone in this program: no other test depends on the folder.
    std::env::set_current_dir(&folder).unwrap();
    example::run().unwrap();
    for written in ["bracket_map.obj", "bracket_quads.obj"] {
        assert!(folder.path().join(written).is_file(), "{written}");
    }
    std::env::set_current_dir(root).unwrap();
}
