//! Everything that people read, compared with what it was: help, summaries, reports, messages.
//!
//! The texts are in `crates/cli/tests/snapshots`. After a change that is meant, run the tests once with
//! `INSTA_UPDATE=always` and read the difference before it is committed.

mod flags;
mod normalize;

use crate::harness::{Folder, Run};
use seamstress_testkit as testkit;
use std::path::Path;

const SNAPSHOTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/snapshots");

fn compare(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(SNAPSHOTS);
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

/// A run with a name, its exit code and its arguments, which are separated by spaces.
type Case = (&'static str, i32, &'static str);

fn shown(arguments: &str, run: &Run) -> String {
    let parts = [("", &run.stdout), ("-- standard error\n", &run.stderr)];
    let parts = parts.iter().filter(|(_, text)| !text.is_empty());
    let output: Vec<String> =
        parts.map(|(title, text)| format!("{title}{}", normalize::text(text))).collect();
    format!("$ seamstress {arguments}\n{}", output.join("\n"))
}

fn run(folder: &Folder, (_, code, arguments): Case) -> Run {
    folder.expect(code, &arguments.split_whitespace().collect::<Vec<_>>())
}

/// An L of ten cubes: its map is an isometry, with cones at the corners, whatever the machine.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write_obj("l.obj", &testkit::l_bracket());
    folder.write_obj("disk.obj", &testkit::disk_grid(4, 4));
    folder
}

/// Commands that the help lists.
const HELP: [&str; 18] = [
    "map",
    "quad",
    "integer",
    "check",
    "measure",
    "features",
    "extract",
    "quality",
    "report",
    "app",
    "lab",
    "lab map",
    "lab optimize",
    "lab field",
    "lab repair-matchings",
    "lab layout-quads",
    "completions",
    "man",
];

#[test]
fn help() {
    let folder = Folder::new();
    compare("help", &normalize::text(&folder.expect(0, &["--help"]).stdout));
    for command in HELP {
        let words: Vec<&str> = command.split(' ').chain(["--help"]).collect();
        compare(&help_name(command), &normalize::text(&folder.expect(0, &words).stdout));
    }
}

#[test]
fn manual_pages_keep_the_lines_of_tables() {
    let folder = Folder::new();
    folder.expect(0, &["man", "pages"]);
    let page = folder.read("pages/seamstress-quad.1");
    let table: Vec<&str> = page
        .lines()
        .skip_while(|line| !line.contains("the boundary, and creases"))
        .take_while(|line| !line.is_empty())
        .collect();
    // A line that begins with a space is not filled with others.
    assert_eq!(table.len(), 12);
    assert!(table.iter().all(|line| line.starts_with("  ") && line.len() < 65), "{table:?}");
}

fn help_name(command: &str) -> String {
    format!("help-{}", command.replace(' ', "-"))
}

/// One run of each command with a summary, in an order in which later ones find the files of earlier ones.
const SUMMARIES: [Case; 18] = [
    ("check-mesh", 0, "check l.obj"),
    ("check-features", 0, "check l.obj --features angle:40 --picture features.png"),
    ("map", 0, "map l.obj -o map.obj --report map.json --sing map.sing --threads 1"),
    (
        "map-features",
        0,
        "map l.obj -o aligned.obj --features angle:40 --report aligned.json --threads 1",
    ),
    ("check-map", 0, "check l.obj map.obj"),
    ("check-alignment", 0, "check l.obj aligned.obj --features angle:40"),
    ("integer", 0, "integer l.obj -o integer.obj --quads 136 --report integer.json --threads 1"),
    ("quad", 0, "quad l.obj -o quad.obj --quads 136 --report quad.json --threads 1"),
    ("extract", 0, "extract integer.obj -o quads.obj --report extract.json --threads 1"),
    ("quality", 0, "quality quads.obj --source l.obj"),
    ("layout-quads", 0, "layout-quads quads.obj -o unfolded.obj"),
    ("measure", 0, "measure l.obj map.obj"),
    (
        "layout",
        0,
        "layout l.obj map.obj --objective arap -o arap.obj --report layout.json --threads 1",
    ),
    ("layout-disk", 0, "layout disk.obj --objective symmetric-dirichlet -o flat.obj --threads 1"),
    ("field", 0, "field l.obj map.obj -o field.rawfield"),
    (
        "repair-matchings",
        0,
        "repair-matchings l.obj --field field.rawfield -o field.matching --threads 1",
    ),
    ("map-from-cones", 0, "map l.obj -o again.obj --cones map.sing --threads 1"),
    ("quad-json", 0, "quad l.obj -o quad2.obj --quads 136 --json --threads 1"),
];

/// Files of [`SUMMARIES`], and runs with `--json` where a command has no `--report`.
const REPORTS: [&str; 6] =
    ["map.json", "aligned.json", "integer.json", "quad.json", "extract.json", "layout.json"];
const JSON: [Case; 7] = [
    ("json-check-mesh", 0, "check l.obj --json"),
    ("json-check-map", 0, "check l.obj map.obj --json"),
    ("json-quality", 0, "quality quads.obj --source l.obj --json"),
    ("json-layout-quads", 0, "layout-quads quads.obj -o unfolded.obj --json"),
    ("json-measure", 0, "measure l.obj map.obj --json"),
    ("json-field", 0, "field l.obj map.obj -o field.rawfield --json"),
    (
        "json-repair-matchings",
        0,
        "repair-matchings l.obj --field field.rawfield -o f.matching --json",
    ),
];

#[test]
fn summaries_and_reports() {
    let folder = folder();
    for case in SUMMARIES {
        let found = run(&folder, case);
        match case.2.contains("--json") {
            true => compare(case.0, &normalize::report(&found.stdout)),
            false => compare(&format!("summary-{}", case.0), &shown(case.2, &found)),
        }
    }
    for file in REPORTS {
        let name = format!("report-{}", file.trim_end_matches(".json"));
        compare(&name, &normalize::report(&folder.read(file)));
    }
    for case in JSON {
        compare(case.0, &normalize::report(&run(&folder, case).stdout));
    }
}

const ERRORS: [Case; 25] = [
    ("no-command", 2, ""),
    ("unknown-command", 2, "sew l.obj"),
    ("unknown-option", 2, "map l.obj -o a.obj --sew"),
    ("no-output", 2, "map l.obj"),
    ("not-a-number", 2, "map l.obj -o a.obj --cone-bias high"),
    ("unknown-value", 2, "map l.obj -o a.obj --rounding nearest"),
    ("unknown-objective", 2, "layout l.obj map.obj --objective beauty -o a.obj"),
    ("unknown-features", 2, "map l.obj -o a.obj --features beauty"),
    ("no-size", 2, "quad l.obj -o a.obj"),
    ("two-sizes", 2, "quad l.obj -o a.obj --quads 10 --scale 2"),
    ("output-is-input", 2, "map l.obj -o l.obj"),
    ("output-twice", 2, "map l.obj -o a.obj --report a.obj"),
    ("output-format", 2, "map l.obj -o a.off"),
    ("output-folder", 2, "map l.obj -o missing/a.obj"),
    ("missing-file", 1, "map missing.obj -o a.obj"),
    ("broken-file", 1, "check broken.obj"),
    ("three-faces", 1, "map fan.obj -o a.obj"),
    ("faults", 1, "check fan.obj"),
    ("repair-fails", 1, "map touch.obj -o a.obj --repair"),
    ("no-map", 1, "check l.obj l.obj"),
    ("not-this-mesh", 1, "check disk.obj map.obj"),
    ("open-seams", 1, "check l.obj open.obj"),
    ("not-integer", 1, "extract open.obj -o a.obj"),
    ("cone-sum", 1, "map l.obj -o a.obj --cones wrong.sing"),
    ("not-an-edge", 1, "map l.obj -o a.obj --features pairs:pairs.txt"),
];

#[test]
fn messages() {
    let folder = folder();
    folder.write("broken.obj", "v 0 0 0\nf 1 2 3\n");
    folder.write(
        "fan.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n",
    );
    folder.write("touch.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3 1 4 5\n");
    folder.write("wrong.sing", "4 1\n0 1\n");
    folder.write("pairs.txt", "# an edge, no edge, no vertex\n0 1\n0 35\n0 40\n");
    folder.expect(0, &["map", "l.obj", "-o", "map.obj", "--threads", "1"]);
    folder.write("open.obj", opened(&folder.read("map.obj")));
    for case in ERRORS {
        compare(&format!("error-{}", case.0), &shown(case.2, &run(&folder, case)));
    }
}

/// The map with one texture coordinate moved, which opens seams.
fn opened(map: &str) -> String {
    let first = map.lines().position(|line| line.starts_with("vt ")).unwrap();
    let moved = |(k, line)| if k == first { "vt 0.123 0.456" } else { line };
    map.lines().enumerate().map(moved).collect::<Vec<_>>().join("\n")
}

/// A snapshot without a test would look like a promise.
#[test]
fn no_snapshot_is_left_over() {
    let mut known = vec!["help".to_owned()];
    known.extend(HELP.map(help_name));
    known.extend(SUMMARIES.iter().map(|case| match case.2.contains("--json") {
        true => case.0.to_owned(),
        false => format!("summary-{}", case.0),
    }));
    known.extend(REPORTS.map(|file| format!("report-{}", file.trim_end_matches(".json"))));
    known.extend(JSON.map(|case| case.0.to_owned()));
    known.extend(ERRORS.map(|case| format!("error-{}", case.0)));
    for entry in Path::new(SNAPSHOTS).read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "snap") {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            assert!(known.contains(&name), "{name} belongs to no test");
        }
    }
}
