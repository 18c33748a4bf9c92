//! Hostile files from the wild, if a folder of them is at hand.

use crate::harness::{Folder, Run};
use seamstress_testkit as testkit;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// What still runs then hangs, however busy the machine is.
const PATIENCE: Duration = Duration::from_secs(300);
const THREADS: usize = 2;

#[test]
fn bad_files_end_in_a_map_or_a_message() {
    let Some(folder) = testkit::in_collection("bad") else { return };
    let entries = std::fs::read_dir(&folder).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.reverse();
    let files = Mutex::new(files);
    let complaints = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                loop {
                    let Some(file) = files.lock().unwrap().pop() else {
                        break;
                    };
                    if let Err(complaint) = try_file(&file) {
                        complaints.lock().unwrap().push(complaint);
                    }
                }
            });
        }
    });
    let complaints = complaints.into_inner().unwrap();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

fn try_file(file: &Path) -> Result<(), String> {
    let folder = Folder::new();
    let path = file.to_str().ok_or("a name that is not UTF-8")?;
    let name = file.file_name().and_then(|name| name.to_str()).unwrap_or(path);
    let run = wait_patiently(folder.start(&["map", path, "-o", "map.obj", "--threads", "1"]))
        .ok_or_else(|| format!("{name}: still running after {PATIENCE:?}"))?;
    println!("{name}: {:?}", run.code);
    let complain = |what: &str| Err(format!("{name}: {what}: {run:#?}"));
    if run.stderr.contains("panicked") || !matches!(run.code, Some(0 | 1 | 3)) {
        return complain("not an orderly end");
    }
    let names = folder.names();
    if run.code == Some(0) {
        let check = folder.run(&["check", path, "map.obj"]);
        if check.code != Some(0) || names != ["map.obj"] {
            return complain(&format!("the map does not stand: {check:#?}"));
        }
    } else if !names.is_empty() {
        return complain(&format!("files were left: {names:?}"));
    } else if !run.stderr.contains("error: ") || !run.stderr.contains(name) {
        return complain("no message that names the file");
    }
    Ok(())
}

/// Waits for a process whose output is short; kills it when it takes too long.
fn wait_patiently(mut child: Child) -> Option<Run> {
    let start = Instant::now();
    while child.try_wait().ok()?.is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().ok()?;
            child.wait().ok()?;
            return None;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Some(crate::harness::wait(child))
}
