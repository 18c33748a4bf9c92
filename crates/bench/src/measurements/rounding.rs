//! The strategies of rounding side by side.

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection, Subject};
use crate::output::Section;
use crate::process::Clock;
use crate::statistics::mean_ratio;
use clap::value_parser;
use seamstress_parametrize::mixed_integer::MixedIntegerOptions;
use seamstress_parametrize::rounding::RoundingStrategy;
use seamstress_parametrize::{MapError, MapOptions, MapSolution, make_map};
use std::error::Error;
use std::time::Duration;

/// Rounding: two strategies on the same meshes
///
/// The distortion, the cones and the times of both, and how they compare over all meshes, all later steps
/// included. Times are of the processor, all threads together, where the system reports them.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// What to compare the default strategy with
    #[arg(long, value_enum, default_value_t = Against::LocalEstimation)]
    against: Against,

    /// Maximum number of integer variables at a time in mixed-integer rounding
    #[arg(long, default_value_t = MixedIntegerOptions::default().batch)]
    batch: usize,

    /// Maximum number of programs for each batch
    #[arg(long, default_value_t = MixedIntegerOptions::default().nodes)]
    nodes: usize,

    /// Give up on a map after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u32).range(1..))]
    time_limit: Option<u32>,

    /// How much both avoid cones
    #[arg(long, value_name = "X", default_value_t = MapOptions::default().rounding.cone_bias)]
    cone_bias: f64,
}

/// Names of the strategies other than the default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Against {
    /// Effect on a small patch
    LocalEstimation,
    /// Integer variables in the program that minimises tau
    MixedInteger,
}

/// Maps every mesh with both strategies; passes if all are mapped.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let names = args.strategies().map(|(_, name)| name);
    let mut table = Table::new(titles(names));
    let mut rows = Vec::new();
    let failures = args.selection.survey(|subject| {
        let row = Row::new(subject, args)?;
        table.report(row.cells());
        rows.push(row);
        Ok(())
    })?;
    Ok(Section::new(format!("{table}\n{}", comparison(&rows, names)), &failures))
}

impl Args {
    /// The strategies, with short names.
    fn strategies(&self) -> [(RoundingStrategy, &'static str); 2] {
        let other = match self.against {
            Against::LocalEstimation => (RoundingStrategy::LocalEstimation, "local"),
            Against::MixedInteger => (RoundingStrategy::MixedInteger, "mixed"),
        };
        [(RoundingStrategy::ConeBias, "bias"), other]
    }
}

/// A metric of a map: its title, its decimals, its value.
type Metric = (&'static str, usize, fn(&Made) -> f64);

const METRICS: [Metric; 5] = [
    ("tau", 3, |made| made.solution.distortion.tau),
    ("SD", 4, |made| made.solution.distortion.symmetric_dirichlet),
    ("p99", 3, |made| made.solution.distortion.tau_t.p99),
    ("cones", 0, |made| made.solution.map.cones().len() as f64),
    ("CPU s", 2, |made| made.seconds),
];

fn titles(names: [&str; 2]) -> Vec<String> {
    let mut titles = vec!["mesh".to_owned(), "triangles".to_owned()];
    for (title, ..) in METRICS {
        titles.extend(names.map(|name| format!("{title}, {name}")));
    }
    titles
}

/// A map and its time.
struct Made {
    solution: MapSolution,
    seconds: f64,
}

impl Made {
    fn new(mesh: &Mesh, strategy: RoundingStrategy, args: &Args) -> Result<Self, MapError> {
        let mut options = MapOptions::default();
        options.rounding.strategy = strategy;
        options.rounding.cone_bias = args.cone_bias;
        options.rounding.mixed_integer.batch = args.batch;
        options.rounding.mixed_integer.nodes = args.nodes;
        let limit = args.time_limit.map(|seconds| Duration::from_secs(seconds.into()));
        let clock = Clock::start();
        let mut observe = clock.limit(limit);
        let solution = make_map(&mesh.connectivity, &mesh.positions, &options, &mut observe)?;
        Ok(Self { solution, seconds: clock.seconds() })
    }
}

/// The maps of one mesh, one for each strategy.
struct Row {
    name: String,
    triangles: usize,
    made: [Made; 2],
}

impl Row {
    fn new(subject: &Subject, args: &Args) -> Result<Self, String> {
        let [first, second] = args.strategies().map(|(strategy, name)| {
            Made::new(&subject.mesh, strategy, args).map_err(|error| format!("{name}: {error}"))
        });
        Ok(Self {
            name: subject.name.clone(),
            triangles: subject.mesh.connectivity.n_faces(),
            made: [first?, second?],
        })
    }

    fn cells(&self) -> Vec<String> {
        let mut cells = vec![self.name.clone(), self.triangles.to_string()];
        for (_, decimals, value) in METRICS {
            cells.extend(self.made.each_ref().map(|made| format!("{:.decimals$}", value(made))));
        }
        cells
    }
}

/// How the second strategy compares with the first over all meshes.
fn comparison(rows: &[Row], [first, second]: [&str; 2]) -> String {
    let mut text = format!("{second} against {first} over {} meshes:\n\n", rows.len());
    let line = |title: &str, value: &dyn Fn(&Made) -> f64| {
        let pairs: Vec<[f64; 2]> = rows.iter().map(|r| r.made.each_ref().map(value)).collect();
        let lower = pairs.iter().filter(|[a, b]| b < a).count();
        let higher = pairs.iter().filter(|[a, b]| b > a).count();
        let mean = mean_ratio(&pairs).map_or("-".into(), |mean| format!("{mean:.3}"));
        format!("* {title}: lower on {lower}, higher on {higher}; mean ratio {mean}\n")
    };
    for (title, _, value) in METRICS {
        text += &match title {
            // An isometry has 4.
            "SD" => line("SD - 4", &|made| value(made) - 4.0),
            _ => line(title, &value),
        };
    }
    text
}
