//! A verifier of maps that shares no code with this one comes to the same verdict, on good and broken files alike.
//!
//! It is a Python program with NumPy, not part of this repository: `SEAMSTRESS_VERIFIER`, or `../shared/tools/verify_seamless.py`
//! beside the repository, run by `SEAMSTRESS_PYTHON`, or `python3`. Where it is missing, the test says so.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test")]

mod common;

use common::mutations::MUTATIONS;
use common::{Case, ten};
use seamstress_testkit::Rng;
use std::env;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the verifier does not look at: edges that should be aligned, quads, fans of vertices, UVs that no face has.
const NOT_ITS_OWN: [&str; 22] = [
    "a UV too many",
    "two vertices made one",
    "an aligned edge that is none",
    "an aligned edge of no vertex",
    "a vertex off its isolines",
    "a vertex off its isolines by little",
    "a diagonal as an aligned edge",
    "a quad with a vertex that is not there",
    "a quad with a vertex twice",
    "a quad the other way round",
    "a quad twice",
    "two vertices of quads made one",
    "a quad less",
    "a corner of a quad come off",
    "a copy of all quads",
    "a quad from nowhere",
    "a quad to another component",
    "quads inside of a quad",
    "quads inside of all quads",
    "a cone that no vertex has",
    "a cone of another index",
    "a cell that has no quad",
];

/// What it allows: its tolerances are a millionth of the mean edge, of a cell and of a coordinate.
const ALLOWED: [&str; 6] = [
    "a corner moved by little more than is allowed",
    "a face scaled by little",
    "a face turned by little",
    "a vertex moved by the last bit",
    "a chart moved by little",
    "a last bit",
];

struct Verifier {
    python: PathBuf,
    program: PathBuf,
}

impl Verifier {
    fn find() -> Option<Self> {
        let beside =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/tools/verify_seamless.py");
        let program = env::var_os("SEAMSTRESS_VERIFIER").map_or(beside, PathBuf::from);
        let python = env::var_os("SEAMSTRESS_PYTHON").map_or("python3".into(), PathBuf::from);
        let has_numpy = Command::new(&python).args(["-c", "import numpy, scipy"]).status();
        (program.is_file() && has_numpy.is_ok_and(|status| status.success()))
            .then_some(Self { python, program })
    }

    /// Whether it takes a map in a file for an integer-grid map of a mesh in another.
    fn accepts(&self, folder: &Path, case: &Case) -> bool {
        let (source, map) = (folder.join("source.obj"), folder.join("map.obj"));
        fs::write(&source, obj(&case.source.0, &case.source.1, &[])).unwrap();
        fs::write(&map, obj(&case.positions, &case.faces, &case.uvs)).unwrap();
        let mut command = Command::new(&self.python);
        command.arg(&self.program).args([source, map]).args(["--strict", "--integer"]);
        command.output().unwrap().status.success()
    }
}

/// The text of an OBJ file, with a UV for every corner if there are any.
fn obj(positions: &[[f64; 3]], faces: &[[u32; 3]], uvs: &[[f64; 2]]) -> String {
    let mut text = String::new();
    positions.iter().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").unwrap());
    uvs.iter().for_each(|[u, v]| writeln!(text, "vt {u} {v}").unwrap());
    for (face, first) in faces.iter().zip((1..).step_by(3)) {
        let [a, b, c] = face.map(|v| v + 1);
        match uvs.is_empty() {
            true => writeln!(text, "f {a} {b} {c}").unwrap(),
            false => writeln!(text, "f {a}/{first} {b}/{} {c}/{}", first + 1, first + 2).unwrap(),
        }
    }
    text
}

#[test]
#[ignore = "a minute of another program"]
fn another_verifier_agrees() {
    let Some(verifier) = Verifier::find() else {
        eprintln!("skipped: there is no other verifier here");
        return;
    };
    let folder = env::temp_dir().join(format!("seamstress-agreement-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let cases = ten();
    for (number, case) in cases.iter().enumerate() {
        assert!(verifier.accepts(&folder, case), "good mesh {number}");
    }
    let is_its_own = |what: &&str| !NOT_ITS_OWN.contains(what) && !ALLOWED.contains(what);
    let mut disagree = Vec::new();
    for (k, (what, _, spoil)) in MUTATIONS.iter().enumerate().filter(|(_, m)| is_its_own(&m.0)) {
        let (mut case, mut rng) = (cases[k % cases.len()].clone(), Rng::new(k as u64));
        spoil(&mut case, &mut rng);
        if verifier.accepts(&folder, &case) {
            disagree.push(what);
        }
    }
    fs::remove_dir_all(&folder).unwrap();
    assert!(disagree.is_empty(), "{disagree:#?}");
}
