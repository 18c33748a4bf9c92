//! What the documents tell people to type works: commands on samples are run, the others must at least be commands.

use crate::harness::Folder;
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// How commands of this program begin, in documents.
const OURS: [&str; 2] = ["seamstress ", "cargo run --release -p seamstress-cli -- "];

/// Other commands that documents may show.
const OTHERS: [&str; 9] = [
    "cargo ",
    "git ",
    "pip ",
    "python ",
    "INSTA_UPDATE=",
    "target/release/",
    ".ci/",
    "SEAMSTRESS_",
    "seamstress-bench ",
];

/// Stand-ins of documents for numbers and names, and what is typed in their place.
const STAND_INS: [(&str, &str); 4] = [("N", "100"), ("X", "1"), ("L", "1"), ("NAME", "arap")];

fn documents() -> Vec<PathBuf> {
    let root = Path::new(ROOT);
    let mut found: Vec<PathBuf> =
        ["README.md", "CONTRIBUTING.md", "samples/README.md"].map(|name| root.join(name)).into();
    let mut folders = vec![root.join("docs")];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The lines of the blocks marked `sh`, without comments.
fn commands(text: &str) -> Vec<&str> {
    let mut is_shell = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if let Some(language) = line.strip_prefix("```") {
            is_shell = language == "sh";
        } else if is_shell {
            found.push(line.split(" #").next().unwrap().trim());
        }
    }
    found.retain(|line| !line.is_empty() && !line.starts_with('#'));
    found
}

/// The arguments as typed: nothing optional, and numbers and names where the document has stand-ins.
fn typed(arguments: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut is_optional = false;
    for word in arguments.split_whitespace() {
        is_optional |= word.starts_with('[');
        if !is_optional {
            let stand_in = STAND_INS.iter().find(|(name, _)| *name == word);
            found.push(stand_in.map_or(word, |(_, typed)| typed));
        }
        is_optional &= !word.ends_with(']');
    }
    found
}

#[test]
fn commands_of_the_documents_work() {
    let (mut ran, mut parsed) = (0, 0);
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        let folder = Folder::new();
        fs::create_dir(folder.path("samples")).unwrap();
        for entry in fs::read_dir(Path::new(ROOT).join("samples")).unwrap().map(Result::unwrap) {
            fs::copy(entry.path(), folder.path("samples").join(entry.file_name())).unwrap();
        }
        for line in commands(&text) {
            let at = format!("{}: {line}", document.display());
            let Some(arguments) = OURS.iter().find_map(|ours| line.strip_prefix(ours)) else {
                let is_known = OTHERS.iter().any(|other| line.starts_with(other));
                assert!(is_known, "{at}: neither of this program nor among the known ones");
                continue;
            };
            let run = folder.run(&typed(arguments));
            if arguments.contains("samples/") {
                assert_eq!(run.code, Some(0), "{at}: {run:#?}");
                ran += 1;
            } else {
                // Files that are not there are the input's fault; wrong usage is the document's.
                assert!(matches!(run.code, Some(0 | 1)), "{at}: {run:#?}");
                parsed += 1;
            }
        }
    }
    assert!(ran >= 4 && parsed >= 10, "{ran} run and {parsed} parsed: too few to be all");
}

#[test]
fn blocks_are_read_as_people_read_them() {
    let text = "a\n```sh\nseamstress map M.obj [M2.obj] -o N [options]   # comment\n\n# all\n```\n```rust\nlet x;\n```\n";
    assert_eq!(commands(text), ["seamstress map M.obj [M2.obj] -o N [options]"]);
    assert_eq!(
        typed("map M.obj [M2.obj] -o N [options] --picture P"),
        ["map", "M.obj", "-o", "100", "--picture", "P"]
    );
}
