//! Commands and flags that scripts rely on: each must stay known, hidden from the help or not.

use crate::harness::Folder;

/// Every command with all its flags.
#[rustfmt::skip]
pub(super) const COMMANDS: [(&str, &[&str]); 12] = [
    ("map", &["--align-boundary", "--allow-flips", "--batch", "--cone-bias", "--cone-price", "--cones",
        "--corner-weight", "--exact", "--features", "--features-strict", "--fast", "--field", "--free-cones", "--from",
        "--json", "--memory-limit", "--local-global", "--matching", "--max-energy-rise", "--method", "--no-tau-polish", "--nodes",
        "--objective", "--output", "--pictures", "--polish-time", "--quiet", "--repair", "--report", "--rounding",
        "--rounding-time", "--sing", "--symmetry", "--texture-angle", "--texture-period", "--texture-shift", "--threads",
        "--time-limit"]),
    ("quad", &["--align-boundary", "--cone-bias", "--cone-price", "--edge-length", "--fast", "--features", "--json", "--memory-limit",
        "--output", "--picture", "--quads", "--quiet", "--raw", "--repair", "--report", "--scale", "--smooth",
        "--symmetry", "--threads", "--time-limit"]),
    ("integer", &["--align-boundary", "--cone-bias", "--cone-price", "--edge-length", "--features",
        "--json", "--memory-limit", "--output", "--pictures", "--quads", "--quiet", "--repair", "--report", "--rounding", "--scale",
        "--texture-angle", "--texture-period", "--texture-shift", "--threads", "--time-limit", "--tolerance"]),
    ("check", &["--align-boundary", "--alignment-tolerance", "--features", "--json", "--picture",
        "--repair", "--report", "--tolerance"]),
    ("extract", &["--best-effort", "--features", "--json", "--memory-limit", "--output", "--picture", "--quiet", "--raw",
        "--report", "--smooth", "--threads", "--time-limit", "--tolerance"]),
    ("field", &["--json", "--matching", "--output", "--repair", "--sing", "--tolerance"]),
    ("repair-matchings", &["--field", "--from", "--json", "--memory-limit", "--matching", "--norm", "--output", "--quiet",
        "--repair", "--sing", "--threads", "--time-limit"]),
    ("layout-quads", &["--json", "--method", "--output", "--pictures", "--texture-angle",
        "--texture-period", "--texture-shift"]),
    ("quality", &["--json", "--of", "--picture", "--samples", "--source"]),
    ("report", &["--json", "--output"]),
    ("measure", &["--json", "--of", "--picture", "--repair", "--tolerance"]),
    ("layout", &["--align-boundary", "--anisotropy", "--features", "--features-strict", "--json", "--memory-limit",
        "--objective", "--output", "--pictures", "--quiet", "--repair", "--report", "--solver", "--texture-angle",
        "--texture-period", "--texture-shift", "--threads", "--time-limit", "--tolerance"]),
];

#[test]
fn commands_and_flags_stay_known() {
    let folder = Folder::new();
    for (command, flags) in COMMANDS {
        for flag in flags {
            // Other arguments are missing, which is wrong usage; but the flag must not be what is wrong.
            let run = folder.run(&[command, flag]);
            let unknown = ["unexpected argument", "unrecognized subcommand"];
            let is_known = unknown.iter().all(|text| !run.stderr.contains(text));
            assert!(is_known, "{command} {flag}: {}", run.stderr);
        }
    }
    let run = folder.expect(2, &["map", "--sew"]);
    assert!(
        run.stderr.contains("unexpected argument"),
        "the words of the check are out of date: {run:?}"
    );
}

#[test]
fn the_command_line_is_consistent() {
    seamstress_cli::definition().debug_assert();
}

#[test]
fn everyday_commands_show_few_options() {
    let is_shown = |arg: &&clap::Arg| !(arg.is_hide_set() || arg.is_hide_short_help_set());
    for name in
        ["map", "quad", "integer", "check", "measure", "features", "extract", "quality", "report"]
    {
        let command = seamstress_cli::definition();
        let options = command.find_subcommand(name).unwrap().get_opts();
        let shown = options.filter(is_shown).count();
        assert!(shown <= 15, "{name} shows {shown} options");
    }
}
