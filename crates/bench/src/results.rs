//! All pages of `docs/results`, by one command.

use crate::family;
use crate::machine::provenance;
use crate::measurements::Measurement;
use crate::meshes::{Selection, name};
use crate::output::{Section, write_page};
use crate::process::sibling;
use clap::{FromArgMatches, Subcommand};
use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// A page: the name of its file, its title, and the measurements on it.
struct Page {
    file: &'static str,
    title: &'static str,
    commands: &'static [&'static str],
}

/// In a command, `MESHES` stands for the meshes given, `FAMILY` for a folder of the generated ones, and `SEAMSTRESS` for the
/// program.
const PAGES: &[Page] = &[
    Page { file: "maps", title: "Maps", commands: &["maps MESHES"] },
    Page {
        file: "collection",
        title: "Collections",
        commands: &["collection FAMILY --kinds", "collection MESHES"],
    },
    Page { file: "speed", title: "Speed", commands: &["speed MESHES --largest 100000"] },
    Page {
        file: "polish",
        title: "The polish of tau",
        commands: &["compare SEAMSTRESS SEAMSTRESS MESHES --old-args=--no-tau-polish"],
    },
    Page {
        file: "rounding",
        title: "Strategies of rounding",
        commands: &[
            "rounding MESHES --largest 50000",
            "rounding MESHES --against mixed-integer --smallest 1000 --largest 5000",
        ],
    },
    Page {
        file: "objectives",
        title: "Objectives",
        commands: &["objectives MESHES --largest 5000"],
    },
    Page {
        file: "conic",
        title: "Conic programs",
        commands: &["conic MESHES --smallest 1000 --largest 25000"],
    },
    Page {
        file: "features",
        title: "Features",
        commands: &[
            "features MESHES --largest 100000",
            "features MESHES --largest 20000 --corner-weights 0.5,1,2",
        ],
    },
    Page {
        file: "integer",
        title: "Integer-grid maps",
        commands: &["integer MESHES --largest 100000"],
    },
    Page {
        file: "quads",
        title: "Quad meshes",
        commands: &[
            "quads MESHES --largest 100000 --quads 500,2500,10000",
            "quads MESHES --largest 100000 --quads 2500 --raw",
            "quads MESHES --largest 100000 --quads 2500 --smooth 5",
        ],
    },
    Page { file: "sizes", title: "Sizes of quads", commands: &["sizes MESHES --largest 100000"] },
    Page { file: "fields", title: "Cross fields", commands: &["fields MESHES"] },
    Page {
        file: "methods",
        title: "The direct method against the classical pipeline",
        commands: &["methods MESHES --time-limit 400"],
    },
    Page { file: "consistency", title: "Consistent matchings", commands: &["consistency MESHES"] },
    Page {
        file: "recovery",
        title: "Recovery of damaged maps",
        commands: &["recovery MESHES --largest 11000"],
    },
];

/// Write the pages of `docs/results`
///
/// Each page gets its date, machine, program and commands. What is written on a page by hand, outside the marks of
/// the measured part, stays.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Only these pages
    #[arg(long, value_name = "PAGE", value_delimiter = ',', value_parser = PAGES.iter().map(|page| page.file).collect::<Vec<_>>())]
    pages: Vec<String>,
}

/// Measures and writes all pages into a folder; whether everything measured is as it should be.
///
/// # Errors
/// If a measurement cannot be made, or a page cannot be written.
pub fn run(args: &Args, folder: &Path) -> Result<bool, Box<dyn Error>> {
    fs::create_dir_all(folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    let temporary = tempfile::tempdir()?;
    let generated = temporary.path().join("family");
    let mut passed = true;
    for page in PAGES {
        if !args.pages.is_empty() && !args.pages.iter().any(|file| file == page.file) {
            continue;
        }
        let (mut text, mut described) = (String::new(), String::new());
        for command in page.commands {
            let words = words(command, &args.selection, &generated)?;
            if command.contains("FAMILY") && !generated.exists() {
                family::write(&generated, 0, family::FAMILY)?;
            }
            let (measurement, about) = parse(&words)?;
            let section = measurement.run()?;
            passed &= section.passed;
            if about != described {
                text += &description(&about);
            }
            text += &render(&words, &section);
            described = about;
        }
        write_page(&folder.join(page.file).with_extension("md"), page.title, &text)?;
    }
    Ok(passed)
}

/// A command as it is run.
fn words(
    command: &str,
    selection: &Selection,
    family: &Path,
) -> Result<Vec<OsString>, Box<dyn Error>> {
    let mut words = Vec::new();
    for word in command.split(' ') {
        match word {
            "MESHES" => words.extend(selection.meshes.iter().map(OsString::from)),
            "FAMILY" => words.push(family.into()),
            "SEAMSTRESS" => words.push(sibling("seamstress")?.into_os_string()),
            _ => words.push(word.into()),
        }
    }
    if !selection.only.is_empty() {
        words.extend(["--only".into(), selection.only.join(",").into()]);
    }
    let sizes = [("--smallest", selection.smallest), ("--largest", selection.largest)];
    for (option, size) in sizes {
        if let Some(size) = size.filter(|_| !words.iter().any(|word| word == option)) {
            words.extend([option.into(), size.to_string().into()]);
        }
    }
    Ok(words)
}

/// A measurement from its command, and what its help says of it.
///
/// # Errors
/// If it is no such command.
pub fn parse(words: &[OsString]) -> Result<(Measurement, String), Box<dyn Error>> {
    let command = Measurement::augment_subcommands(clap::Command::new("seamstress-bench"));
    let name = words.first().map(|word| word.to_string_lossy().into_owned()).unwrap_or_default();
    let described = command.find_subcommand(&name);
    let about = described.and_then(|command| command.get_long_about().or(command.get_about()));
    let about = about.map(ToString::to_string).unwrap_or_default();
    let program = OsString::from("seamstress-bench");
    let matches = command.try_get_matches_from(std::iter::once(&program).chain(words))?;
    Ok((Measurement::from_arg_matches(&matches)?, about))
}

/// The heading of a measurement and what its help says of it.
pub fn description(about: &str) -> String {
    let (title, about) = about.split_once('\n').unwrap_or((about, ""));
    format!("## {title}\n\n{}\n\n", about.trim().replace('\n', " "))
}

/// A measurement as a part of a page: where and when it was made, by what command, and its result.
pub fn render(words: &[OsString], section: &Section) -> String {
    let command: Vec<String> = words.iter().map(shown).collect();
    let (command, text) = (command.join(" "), section.text.trim());
    format!("{}:\n\n```sh\nseamstress-bench {command}\n```\n\n{text}\n\n", provenance())
}

/// A word of a command; of a path only the last part.
fn shown(word: &OsString) -> String {
    let path = PathBuf::from(word);
    if path.exists() { name(&path) } else { word.to_string_lossy().into_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_one_and_has_a_description() {
        let selection = Selection {
            meshes: vec!["a.obj".into(), "b.obj".into()],
            only: vec!["a".into()],
            smallest: None,
            largest: Some(100),
        };
        for command in PAGES.iter().flat_map(|page| page.commands) {
            // The program is not beside the tests.
            let command = command.replace("SEAMSTRESS", "seamstress");
            let words = words(&command, &selection, Path::new("family")).unwrap();
            let (_, about) = parse(&words).unwrap();
            assert!(about.lines().count() > 1, "{command}: {about}");
            let count = |option: &str| words.iter().filter(|word| *word == option).count();
            let meshes = count("b.obj") + count("family");
            assert_eq!((count("--largest"), count("--only"), meshes), (1, 1, 1));
        }
        assert!(parse(&["nothing".into()]).is_err());
    }

    #[test]
    fn a_description_has_its_title_and_one_paragraph() {
        let text = description("Maps: a title\n\nFirst line.\nSecond.");
        assert_eq!(text, "## Maps: a title\n\nFirst line. Second.\n\n");
    }

    #[test]
    fn a_section_names_its_command_without_folders() {
        let folder = tempfile::tempdir().unwrap();
        let words = ["maps".into(), folder.path().as_os_str().to_owned(), "--jobs".into()];
        let section = Section { text: "| table |\n".into(), passed: true };
        let text = render(&words, &section);
        let file = name(folder.path());
        assert!(text.starts_with("Measured on 20"));
        assert!(
            text.ends_with(&format!("\nseamstress-bench maps {file} --jobs\n```\n\n| table |\n\n"))
        );
    }
}
