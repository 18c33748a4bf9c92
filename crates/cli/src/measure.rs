//! `seamstress measure`.

use crate::args::MeasureArgs;
use crate::input::LoadedMesh;
use crate::map_file::MapFile;
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, VERSION};
use crate::summary;
use crate::text::{self, counted, figure, row};
use seamstress_mesh::Metric;
use seamstress_parametrize::quality::{Aggregate, Measure, SingularValues, Summary, measure_all};
use seamstress_parametrize::{Objective, SeamlessMap};
use serde_json::{Value, json};
use std::io::Write;

/// Runs the command.
pub(crate) fn run(args: &MeasureArgs) -> Result<Status, Failure> {
    let targets = args.picture.iter().map(|path| Target::new(Kind::Picture, path)).collect();
    let plan = Plan::new(&[&args.mesh, &args.map], None, targets)?;
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    let connectivity = mesh.connect()?;
    let map = MapFile::read(&args.map)?;
    map.require_faces_of(&mesh, &args.map)?;
    let metric = Metric::from_positions(&connectivity, &mesh.soup.positions);
    let singular = SingularValues::new(&connectivity, &metric, &map.corner_uvs);
    let measured = Measured {
        flipped: singular.flipped(),
        degenerate: singular.degenerate(),
        summaries: measure_all(&singular),
        fault: SeamlessMap::certify(&connectivity, map.corner_uvs, &args.tolerance())
            .err()
            .map(|violations| violations.to_string()),
    };
    let mut batch = plan.begin()?;
    for target in &plan.targets {
        let picture = measured
            .summaries
            .iter()
            .find(|summary| summary.measure == args.of)
            .map(|summary| pictures::heat(&mesh.soup, summary))
            .transpose()
            .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
        batch.write(&target.path, |file| file.write_all(&picture.unwrap_or_default()))?;
    }
    batch.commit()?;
    if args.json {
        text::print(&report::to_text(&measured.json(args, &mesh)))?;
    } else {
        text::print(&measured.text(args, &mesh))?;
    }
    Ok(Status::Done)
}

/// All there is to say about a map.
struct Measured {
    summaries: Vec<Summary>,
    flipped: usize,
    degenerate: usize,
    /// Why it is no seamless map, if it is none.
    fault: Option<String>,
}

impl Measured {
    fn json(&self, args: &MeasureArgs, mesh: &LoadedMesh) -> Value {
        json!({
            "seamstress": VERSION,
            "command": "measure",
            "options": { "repair": args.repair, "tolerance": args.tolerance().seam },
            "input": report::input_json(mesh),
            "map": {
                "file": args.map.to_string_lossy(),
                "flipped": self.flipped,
                "degenerate": self.degenerate,
                "certified": self.fault.is_none(),
                "fault": self.fault,
            },
            "measures": self.summaries.iter().map(report::measure_json).collect::<Vec<_>>(),
        })
    }

    fn text(&self, args: &MeasureArgs, mesh: &LoadedMesh) -> String {
        let mut rows = summary::mesh_rows(mesh);
        rows.push(row("map", &args.map.display().to_string()));
        let seamless = match &self.fault {
            None => "certified: no flips, every seam fits".into(),
            Some(fault) => format!("not a seamless map: {fault}"),
        };
        rows.push(row("certificate", &seamless));
        if self.flipped > 0 {
            let triangles = counted(self.flipped, "triangle");
            rows.push(row(
                "flips",
                &format!(
                    "{triangles} flipped or collapsed: infinite tau, symmetric Dirichlet energy and \
                     dilatation there; ARAP and ASAP with the negative sigma_2"
                ),
            ));
        }
        if self.degenerate > 0 {
            let triangles = counted(self.degenerate, "triangle");
            rows.push(row("left out", &format!("{triangles} without area on the surface")));
        }
        rows.push(String::new());
        rows.push(line(TITLES));
        let is_goal = |measure: Measure, aggregate| {
            let is_goal = Objective::ALL.iter().any(|o| o.measure() == Some(measure));
            is_goal && measure.aggregate() == aggregate
        };
        rows.extend(self.summaries.iter().map(|summary| summary_line(summary, is_goal)));
        rows.push(String::new());
        rows.push("* what `seamstress layout` can minimise".into());
        if let Some(path) = &args.picture {
            rows.push(row("written", &path.display().to_string()));
        }
        rows.join("\n")
    }
}

/// Titles of the table of measures.
pub(crate) const TITLES: [&str; 8] =
    ["measure", "ideal", "scale", "mean", "maximum", "median", "95%", "99%"];

/// A row of that table; figures that `has_star` gets one.
pub(crate) fn summary_line(
    summary: &Summary,
    has_star: impl Fn(Measure, Aggregate) -> bool,
) -> String {
    let percentiles = summary.percentiles;
    let mark = |aggregate, x: f64| {
        let star = if has_star(summary.measure, aggregate) { "*" } else { " " };
        format!("{}{star}", figure(x))
    };
    line([
        summary.measure.name(),
        &figure(summary.measure.ideal()),
        &if is_scaled(summary.measure) { figure(summary.scale) } else { "-".into() },
        &mark(Aggregate::Mean, summary.mean),
        &mark(Aggregate::Max, summary.max),
        &figure(percentiles.p50),
        &figure(percentiles.p95),
        &figure(percentiles.p99),
    ])
}

fn is_scaled(measure: Measure) -> bool {
    !matches!(measure, Measure::TauTilde | Measure::AsapMax | Measure::Dilatation)
}

/// A row of the table.
pub(crate) fn line([name, figures @ ..]: [&str; 8]) -> String {
    let cells: Vec<String> = figures.iter().map(|cell| format!("{cell:>10}")).collect();
    format!("{name:<20}{}", cells.join(" "))
}
