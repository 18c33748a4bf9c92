//! What all commands have in common, and how one is run.

use crate::args::RunArgs;
use crate::failure::{Failure, Status, print};
use crate::job::{Cost, Job};
use crate::output::{Kind, Plan, Target, is_standard_stream};
use crate::summary;
use crate::text::{self, as_options, listing, row};
use seamstress::{Context, Error, Inspection, Page, Surface, SurfaceOptions, listing as lines};
use serde::Serialize;
use serde_json::{Value, json};
use std::io::{self, Read};
use std::path::Path;
use std::time::Instant;

/// A command: what it reads and writes, and the calls of the library in between.
pub(crate) trait Command: Clone + Send + 'static {
    /// Its name in reports.
    const NAME: &'static str;
    /// The work done, and nothing written yet.
    type Product: Send + 'static;

    /// Threads, limits, and what is printed.
    fn run_args(&self) -> RunArgs;

    /// The file that messages are about.
    fn input(&self) -> &Path;

    /// The files that it writes, checked against those that it reads.
    ///
    /// # Errors
    /// If an output would replace an input or another output, or cannot be written.
    fn plan(&self) -> Result<Plan, Failure>;

    /// Does the work.
    fn make(&self, session: &Session) -> Result<Self::Product, Failure>;

    /// The pictures among its files, in their order.
    fn pictures(&self, _: &Self::Product) -> Result<Vec<Vec<u8>>, Error> {
        Ok(Vec::new())
    }

    /// A page to look at the result, if there is one.
    fn page(&self, _: &Self::Product) -> Option<Page> {
        None
    }

    /// Writes a file that is neither picture nor report.
    fn write(&self, _: &Self::Product, _: &Target, _: &mut dyn io::Write) -> io::Result<()> {
        Ok(())
    }

    /// The report, to which the command, its files and its cost are added.
    fn report(&self, product: &Self::Product) -> Value;

    /// The rows of the summary.
    fn summary(&self, product: &Self::Product) -> Vec<String>;

    /// Seconds by stage, for the summary; none for a command that takes no time.
    fn stages(&self, _: &Self::Product) -> Option<Vec<(&'static str, f64)>> {
        None
    }

    /// How the run ends.
    fn status(&self, _: &Self::Product) -> Status {
        Status::Done
    }
}

/// What the work of a command needs to know of its run.
pub(crate) struct Session {
    context: Context,
    quiet: bool,
}

impl Session {
    /// Reads a mesh, and reports what was found and done on reading it.
    pub(crate) fn inspect(
        &self,
        path: &Path,
        options: &SurfaceOptions,
    ) -> Result<Inspection, Failure> {
        let inspection = read_mesh(path, options)?;
        self.report_findings(&inspection);
        Ok(inspection)
    }

    /// Reads a surface.
    pub(crate) fn open(&self, path: &Path, options: &SurfaceOptions) -> Result<Surface, Failure> {
        self.surface(self.inspect(path, options)?)
    }

    /// The surface of what was read.
    pub(crate) fn surface(&self, inspection: Inspection) -> Result<Surface, Failure> {
        Ok(inspection.surface()?.with_context(self.context.clone()))
    }

    /// Notes, warnings and repairs, on standard error.
    pub(crate) fn report_findings(&self, inspection: &Inspection) {
        let report = inspection.report();
        for note in &report.notes {
            self.report(&format!("note: {}", as_options(note)));
        }
        for repair in listing(&report.repairs, SHOWN_REPAIRS) {
            self.report(&format!("repair: {repair}"));
        }
        if !report.repairs.is_empty() {
            self.report("note: the result is of the repaired mesh");
        }
        for warning in lines(&report.warnings, SHOWN_WARNINGS) {
            self.report(&format!("warning: {warning}"));
        }
    }

    /// A line on standard error, unless the run is quiet.
    pub(crate) fn report(&self, line: &str) {
        if !self.quiet {
            text::report(line);
        }
    }
}

/// Reads a mesh, from standard input where the path is `-`.
pub(crate) fn read_mesh(path: &Path, options: &SurfaceOptions) -> Result<Inspection, Failure> {
    if !is_standard_stream(path) {
        return Ok(Inspection::read(path, options)?);
    }
    let mut content = Vec::new();
    io::stdin().lock().read_to_end(&mut content).map_err(Failure::StandardInput)?;
    Ok(Inspection::of_file_content(&content, path, options)?)
}

/// Warnings of each kind that are shown; the report has them all.
const SHOWN_WARNINGS: usize = 5;
/// Repairs that are shown; the report has them all.
const SHOWN_REPAIRS: usize = 20;

/// Plans, works, writes, and prints the report or the summary. Where reports are printed as JSON, a failure is one.
pub(crate) fn run<C: Command>(command: &C) -> Result<Status, Failure> {
    let job = Job::new(command.run_args());
    let plan = command.plan();
    let has_output = plan.as_ref().is_ok_and(Plan::writes_to_standard_output);
    let ended = plan.and_then(|plan| work(command, &job, &plan));
    if let (Err(failure), true) = (&ended, command.run_args().json && !has_output) {
        let report = json!({
            "seamstress": seamstress::VERSION,
            "command": C::NAME,
            "error": failure.report(),
            "cost": job.cost(),
        });
        print(&serde_json::to_string_pretty(&report).unwrap_or_default())?;
    }
    ended
}

fn work<C: Command>(command: &C, job: &Job, plan: &Plan) -> Result<Status, Failure> {
    let run = command.run_args();
    if run.json && plan.writes_to_standard_output() {
        let text = "`--json` prints the report on standard output; write the result to a file";
        return Err(Failure::Usage(text.into()));
    }
    let input = command.input().display().to_string();
    let (owned, session) = (command.clone(), Session { context: job.context(), quiet: run.quiet });
    let has_page = plan.targets.iter().any(|target| target.kind == Kind::Page);
    let (product, pictures, page, drawing) = job.supervise(&input, move || {
        let product = owned.make(&session)?;
        let start = Instant::now();
        let pictures = owned.pictures(&product)?;
        let drawing = start.elapsed().as_secs_f64();
        let page = if has_page { owned.page(&product) } else { None };
        Ok((product, pictures, page, drawing))
    })?;

    let drawing = (!pictures.is_empty()).then_some(("pictures", drawing));
    let mut pictures = pictures.into_iter();
    let cost = job.cost();
    let report = report_of(command, &product, plan, cost);
    let page = page.map(|page| page.of_run(report.clone(), Some(command_line())).html());
    let report = serde_json::to_string_pretty(&report).unwrap_or_default();
    let mut batch = plan.begin()?;
    for target in &plan.targets {
        let content = match target.kind {
            Kind::Picture => match pictures.next() {
                Some(picture) => picture,
                // There was nothing to draw.
                None => continue,
            },
            Kind::Page => match &page {
                Some(page) => page.clone().into_bytes(),
                // There is nothing to look at.
                None => continue,
            },
            _ => Vec::new(),
        };
        batch.write(&target.path, |file| match target.kind {
            Kind::Picture | Kind::Page => file.write_all(&content),
            Kind::Report => writeln!(file, "{report}"),
            _ => command.write(&product, target, file),
        })?;
    }
    job.check_stopped(&input)?;
    batch.commit()?;
    match (run.json, run.quiet || plan.writes_to_standard_output()) {
        (true, _) => print(&report)?,
        (false, true) => {}
        (false, false) => print(&summary_text(command, &product, plan, &cost, drawing))?,
    }
    Ok(command.status(&product))
}

fn report_of<C: Command>(command: &C, product: &C::Product, plan: &Plan, cost: Cost) -> Value {
    let run = command.run_args();
    let mut value = command.report(product);
    value["command"] = C::NAME.into();
    value["run"] = json!({
        "time_limit": run.time_limit.map(|limit| limit.as_secs_f64()),
        "memory_limit": run.memory_limit,
        "threads": run.threads,
    });
    value["files"] = json!(plan.targets);
    value["cost"] = json!(cost);
    value
}

/// The command line of this process, for a shell.
fn command_line() -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:=,+@%".contains(c);
    let quoted = |word: std::ffi::OsString| match word.to_string_lossy() {
        plain if !plain.is_empty() && plain.chars().all(is_plain) => plain.into_owned(),
        other => format!("'{}'", other.replace('\'', "'\\''")),
    };
    let arguments = std::env::args_os().skip(1).map(quoted);
    std::iter::once("seamstress".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

fn summary_text<C: Command>(
    command: &C,
    product: &C::Product,
    plan: &Plan,
    cost: &Cost,
    drawing: Option<(&'static str, f64)>,
) -> String {
    let mut rows = command.summary(product);
    rows.extend(command.stages(product).map(|mut stages| {
        stages.extend(drawing);
        summary::cost_row(cost, &stages)
    }));
    let names = plan.targets.iter().rev().map(|target| target.path.display().to_string());
    let names: Vec<String> = names.collect();
    if !names.is_empty() {
        rows.push(row("written", &names.join(", ")));
    }
    rows.join("\n")
}

/// A report of the library as JSON.
pub(crate) fn to_json(report: &impl Serialize) -> Value {
    serde_json::to_value(report).unwrap_or_default()
}
