//! Running the command in a folder of its own.

use seamstress_mesh::soup::TriangleSoup;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// A folder that vanishes with its files.
pub(crate) struct Folder(TempDir);

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    pub(crate) fn write_obj(&self, name: &str, soup: &TriangleSoup) {
        self.write(name, obj(soup));
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// All names in the folder and its subfolders, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        list(self.0.path(), "", &mut names);
        names.sort();
        names
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_seamstress"));
        command.args(arguments).current_dir(self.0.path());
        // Help is wrapped to the width of the terminal.
        command.env_remove("COLUMNS").env_remove("LINES");
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub(crate) fn start(&self, arguments: &[&str]) -> Child {
        self.command(arguments).spawn().unwrap()
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        wait(self.start(arguments))
    }

    /// Runs the command with a file as its standard input.
    pub(crate) fn fed(&self, name: &str, arguments: &[&str]) -> Run {
        let file = fs::File::open(self.path(name)).unwrap();
        wait(self.command(arguments).stdin(file).spawn().unwrap())
    }

    /// Runs the command, which must end with this exit code.
    #[track_caller]
    pub(crate) fn expect(&self, code: i32, arguments: &[&str]) -> Run {
        let run = self.run(arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}: {run:#?}");
        run
    }
}

pub(crate) fn wait(child: Child) -> Run {
    let output = child.wait_with_output().unwrap();
    Run {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn list(folder: &Path, prefix: &str, names: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            list(&entry.path(), &format!("{name}/"), names);
        }
        names.push(name);
    }
}

pub(crate) fn obj(soup: &TriangleSoup) -> String {
    let mut text = String::new();
    for [x, y, z] in &soup.positions {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for face in &soup.faces {
        let [a, b, c] = face.map(|v| v + 1);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text
}

pub(crate) fn off(soup: &TriangleSoup) -> String {
    let mut text = format!("OFF\n{} {} 0\n", soup.positions.len(), soup.faces.len());
    for [x, y, z] in &soup.positions {
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    for [a, b, c] in &soup.faces {
        writeln!(text, "3 {a} {b} {c}").unwrap();
    }
    text
}

/// The positions and faces of an OBJ file, as text.
pub(crate) fn lines_of<'a>(obj: &'a str, keyword: &str) -> Vec<&'a str> {
    let prefix = format!("{keyword} ");
    obj.lines().filter_map(|line| line.strip_prefix(&prefix)).collect()
}

/// The faces of an OBJ file without texture coordinates.
pub(crate) fn bare_faces(obj: &str) -> Vec<String> {
    let bare = |line: &str| {
        let corners = line.split(' ').map(|corner| corner.split('/').next().unwrap());
        corners.collect::<Vec<_>>().join(" ")
    };
    lines_of(obj, "f").into_iter().map(bare).collect()
}
