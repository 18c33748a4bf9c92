//! Exit codes, messages, and that a failure leaves nothing behind.

use crate::harness::Folder;
#[cfg(unix)]
use crate::harness::wait;
use seamstress_testkit as testkit;
#[cfg(unix)]
use std::time::Duration;

#[test]
fn help_and_version() {
    let folder = Folder::new();
    for arguments in [&["--help"][..], &["map", "--help"], &["check", "--help"]] {
        let run = folder.expect(0, arguments);
        for text in ["Examples:", "Exit codes:"] {
            assert!(run.stdout.contains(text), "{arguments:?}");
        }
    }
    let version = folder.expect(0, &["--version"]).stdout;
    assert_eq!(version, format!("seamstress {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn unreadable_input_is_1() {
    let folder = Folder::new();
    folder.write("broken.obj", "v 0 0 0\nf 1 2 3\n");
    for name in ["missing.obj", "broken.obj"] {
        for arguments in [&["map", name, "-o", "a.obj"][..], &["check", name]] {
            let run = folder.expect(1, arguments);
            assert!(run.stderr.starts_with("error: "), "{run:?}");
            assert!(run.stderr.contains(name), "{run:?}");
        }
    }
    let run = folder.run(&["map", "broken.obj", "-o", "a.obj"]);
    assert!(run.stderr.contains("line 2"), "{run:?}");
    assert_eq!(folder.names(), ["broken.obj"]);
}

#[test]
fn faults_are_1_and_name_elements() {
    let folder = Folder::new();
    let fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    folder.write("fan.obj", fan);
    let run = folder.expect(1, &["map", "fan.obj", "-o", "a.obj"]);
    assert!(run.stderr.starts_with("error: fan.obj: "), "{run:?}");
    assert!(run.stderr.contains("edge 0-1 has 3 faces: 0, 1, 2"), "{run:?}");
    assert!(run.stderr.contains("add `--repair`"), "{run:?}");
    assert_eq!(folder.names(), ["fan.obj"]);
    // A face that touches itself in a vertex is mended by no repair, and nobody is told to repair again.
    folder.write("touch.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3 1 4 5\n");
    let run = folder.expect(1, &["map", "touch.obj", "-o", "a.obj"]);
    assert!(run.stderr.contains("`--repair` cannot mend all of them"), "{run:?}");
    let run = folder.expect(1, &["map", "touch.obj", "-o", "a.obj", "--repair"]);
    assert!(run.stderr.contains("face 0 uses vertex 0 more than once"), "{run:?}");
    assert!(!run.stderr.contains("--repair"), "{run:?}");
}

#[test]
fn wrong_arguments_are_2() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::cube());
    let wrong: [&[&str]; 15] = [
        &[],
        &["sew"],
        &["map", "in.obj"],
        &["map", "in.obj", "-o", "a.obj", "--threads", "0"],
        &["map", "in.obj", "-o", "a.obj", "--time-limit", "0"],
        &["map", "in.obj", "-o", "a.obj", "--time-limit", "soon"],
        &["map", "in.obj", "-o", "a.obj", "--memory-limit", "much"],
        &["map", "in.obj", "-o", "a.obj", "--cone-bias", "nan"],
        &["map", "in.obj", "-o", "in.obj"],
        &["map", "in.obj", "-o", "./in.obj"],
        &["map", "in.obj", "-o", "a.obj", "--report", "in.obj"],
        &["map", "in.obj", "-o", "a.obj", "--report", "a.obj"],
        &["map", "in.obj", "-o", "a.obj", "--sing", "./a.obj"],
        &["map", "in.obj", "-o", "a.off"],
        &["check", "in.obj", "--tolerance", "1"],
    ];
    let before = folder.read("in.obj");
    for arguments in wrong {
        folder.expect(2, arguments);
    }
    assert_eq!(folder.names(), ["in.obj"]);
    assert_eq!(folder.read("in.obj"), before);
}

#[test]
fn outputs_that_cannot_be_written_are_2_and_found_first() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::torus(300, 200, 1.0, 0.4));
    folder.write("file", "");
    std::fs::create_dir(folder.path("folder.obj")).unwrap();
    let wrong: [&[&str]; 5] = [
        &["-o", "missing/a.obj"],
        &["-o", "folder.obj"],
        &["-o", "a.obj", "--report", "missing/r.json"],
        &["-o", "a.obj", "--pictures", "file"],
        &["-o", "a.obj", "--pictures", "file/deeper"],
    ];
    for arguments in wrong {
        // Were they found last, the time limit would come first.
        let run =
            folder.expect(2, &[&["map", "in.obj", "--time-limit", "0.001"], arguments].concat());
        assert!(run.stderr.starts_with("error: cannot write "), "{run:?}");
    }
    assert_eq!(folder.names(), ["file", "folder.obj", "in.obj"]);
}

#[test]
fn failures_are_json_where_reports_are() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::torus(300, 200, 1.0, 0.4));
    folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n");
    let cases: [(i32, &[&str], &str); 5] = [
        (1, &["none.obj", "-o", "a.obj"], "unreadable"),
        (1, &["bad.obj", "-o", "a.obj"], "not-a-surface"),
        (2, &["in.obj", "-o", "in.obj"], "usage"),
        (4, &["in.obj", "-o", "a.obj", "--time-limit", "0.01"], "time-limit"),
        (4, &["in.obj", "-o", "a.obj", "--memory-limit", "200MB"], "memory-limit"),
    ];
    for (code, arguments, name) in cases {
        let run = folder.expect(code, &[&["map", "--json"], arguments].concat());
        assert!(run.stderr.starts_with("error: "), "{run:?}");
        let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(report["command"], "map");
        assert_eq!(report["error"]["code"], name, "{report}");
        assert!(!report["error"]["message"].as_str().unwrap().is_empty());
        assert!(report["cost"]["wall_seconds"].as_f64().unwrap() > 0.0);
        if name == "not-a-surface" {
            assert_eq!(report["error"]["stage"], "check");
            assert_eq!(report["error"]["findings"][0]["severity"], "error");
        }
    }
}

#[test]
fn the_time_limit_is_4_and_leaves_nothing() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::torus(300, 200, 1.0, 0.4));
    for limit in ["0.01", "0.5"] {
        let arguments = [
            "map",
            "in.obj",
            "-o",
            "a.obj",
            "--pictures",
            "new",
            "--report",
            "new/r.json",
            "--time-limit",
            limit,
        ];
        let run = folder.expect(4, &arguments);
        assert!(run.stderr.starts_with("error: in.obj: stopped"), "{run:?}");
        assert_eq!(folder.names(), ["in.obj"]);
    }
}

/// By then the command has begun, and it works for much longer, however busy the machine is.
#[cfg(unix)]
const STARTED: Duration = Duration::from_secs(2);

#[cfg(unix)]
#[test]
fn an_interrupt_is_4_and_leaves_nothing() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::torus(300, 200, 1.0, 0.4));
    let child = folder.start(&["map", "in.obj", "-o", "a.obj"]);
    std::thread::sleep(STARTED);
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    let run = wait(child);
    assert_eq!(run.code, Some(4), "{run:?}");
    assert!(run.stderr.contains("interrupted"), "{run:?}");
    assert_eq!(folder.names(), ["in.obj"]);
}

/// A process that is killed cannot tidy up, but what it was to write is there as a whole or not at all.
#[cfg(unix)]
#[test]
fn a_kill_at_any_moment_leaves_no_half_file() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::torus(24, 16, 1.0, 0.4));
    folder.expect(0, &["map", "in.obj", "-o", "whole.obj"]);
    let whole = folder.read("whole.obj");
    let start = std::time::Instant::now();
    folder.expect(0, &["map", "in.obj", "-o", "a.obj"]);
    let whole_time = start.elapsed();
    for step in 0..=12 {
        folder.write("a.obj", "old");
        let mut child = folder.start(&["map", "in.obj", "-o", "a.obj"]);
        std::thread::sleep(whole_time * step / 10);
        child.kill().unwrap();
        child.wait().unwrap();
        let found = folder.read("a.obj");
        assert!(found == "old" || found == whole, "step {step}");
    }
}

/// A limit on the size of files is what a full disk is to a program: a write that fails.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_2_and_leaves_nothing() {
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::torus(24, 16, 1.0, 0.4));
    folder.write("a.obj", "old");
    for name in ["a.obj", "b.obj.gz", "c.html"] {
        let arguments = match name {
            "c.html" => format!("map in.obj -o b.obj --report {name}"),
            _ => format!("map in.obj -o {name}"),
        };
        let program = env!("CARGO_BIN_EXE_seamstress");
        let script = format!("trap '' XFSZ; ulimit -f 4; exec {program} {arguments}");
        let mut command = std::process::Command::new("bash");
        let run = command.args(["-c", &script]).current_dir(folder.path("")).output().unwrap();
        let message = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{name}: {message}");
        assert!(message.starts_with(&format!("error: cannot write {name}: ")), "{message}");
        assert!(!message.contains(".tmp"), "{message}");
        assert_eq!(folder.names(), ["a.obj", "in.obj"], "{name}");
        assert_eq!(folder.read("a.obj"), "old");
    }
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_2() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.write_obj("in.obj", &testkit::cube());
    let closed = folder.path("closed");
    std::fs::create_dir(&closed).unwrap();
    std::fs::set_permissions(&closed, std::fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser may write everywhere.
    if std::fs::write(closed.join("probe"), "").is_err() {
        let run = folder.expect(2, &["map", "in.obj", "-o", "closed/a.obj"]);
        assert!(run.stderr.contains("the directory cannot be written"), "{run:?}");
    }
    std::fs::set_permissions(&closed, std::fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn a_failure_keeps_what_was_there() {
    let folder = Folder::new();
    folder.write("broken.obj", "v 0 0 0\nf 1 2 3\n");
    folder.write("a.obj", "old");
    folder.expect(1, &["map", "broken.obj", "-o", "a.obj"]);
    assert_eq!(folder.read("a.obj"), "old");
}
