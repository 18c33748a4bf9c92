//! `seamstress report`.

use super::{inputs, targets};
use crate::args::{RunArgs, after_help};
use crate::command::{Command, Session};
use crate::failure::Failure;
use crate::output::{Kind, Plan, Target};
use crate::text::{counted, row};
use seamstress::Page;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress quad bunny.ply --quads 2000 -o coarse.obj --report coarse.html
  seamstress quad bunny.ply --quads 8000 -o fine.obj --report fine.html
  seamstress report coarse.html fine.html -o both.html";

/// Put report pages side by side in one page
///
/// Takes pages that other commands have written with `--report FILE.html`. Their views turn together, and a table
/// compares their numbers. The page needs no other file.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct ReportArgs {
    /// The pages
    #[arg(value_name = "REPORT.html", required = true)]
    pages: Vec<PathBuf>,

    /// Write the page to this file, replacing an existing one; `-` is standard output
    #[arg(short, long, value_name = "PAGE.html")]
    output: PathBuf,

    /// Print the report as JSON on standard output instead of the summary
    #[arg(long)]
    json: bool,
}

impl Command for ReportArgs {
    const NAME: &'static str = "report";
    type Product = String;

    fn run_args(&self) -> RunArgs {
        RunArgs::quick(self.json)
    }

    fn input(&self) -> &Path {
        self.pages.first().map_or(Path::new(""), PathBuf::as_path)
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let others = self.pages.iter().skip(1).map(PathBuf::as_path);
        Plan::new(&inputs(self.input(), others), None, targets(Kind::Comparison, [&self.output]))
    }

    fn make(&self, _: &Session) -> Result<String, Failure> {
        Ok(Page::side_by_side(&self.pages)?)
    }

    fn write(&self, page: &String, _: &Target, file: &mut dyn Write) -> io::Result<()> {
        file.write_all(page.as_bytes())
    }

    fn report(&self, _: &String) -> Value {
        json!({ "seamstress": seamstress::VERSION, "pages": self.pages })
    }

    fn summary(&self, _: &String) -> Vec<String> {
        vec![row("report", &counted(self.pages.len(), "page"))]
    }
}
