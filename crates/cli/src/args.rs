//! Arguments that commands have in common.

use clap::Args;
use seamstress::{FeatureSource, Features, GridSize};
use std::path::Path;
use std::time::Duration;

/// The end of every help.
pub(crate) const EXIT_CODES: &str = "\
Exit codes:
  0  done; any map written or checked is certified (unless written with `--allow-flips`)
  1  the input is at fault: unreadable, not a mesh, not a seamless map, not a field of the mesh, or
     cones that no map can have
  2  wrong usage: unknown option, or an output that cannot be written
  3  no certified map could be made, or its quads are no manifold; nothing is written, or with
     `--partial` what could be made of the other connected parts
  4  stopped by the time limit, the memory limit or Ctrl-C; nothing is written";

/// The help's end: examples and exit codes.
pub(crate) fn after_help(examples: &str) -> String {
    format!("{examples}\n\n{EXIT_CODES}")
}

/// What every command that may take long has.
#[derive(Debug, Clone, Copy, Default, Args)]
pub(crate) struct RunArgs {
    /// Give up when the work is not done after this many seconds [default: no limit]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<Duration>,

    /// Refuse work that is expected to take more memory than this, before it starts: bytes, or a number with kB, MB, GB,
    /// KiB, MiB or GiB [default: no limit]
    #[arg(long, value_name = "SIZE", value_parser = bytes, hide_short_help = true)]
    pub(crate) memory_limit: Option<u64>,

    /// Number of threads; the result does not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<u32>,

    /// Print the report as JSON on standard output instead of the summary
    #[arg(long)]
    pub(crate) json: bool,

    /// Print no summary, progress, notes or warnings, only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

impl RunArgs {
    /// Those of a command that takes no time.
    pub(crate) fn quick(json: bool) -> Self {
        Self { json, ..Self::default() }
    }
}

/// Edges that a map should follow.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct FeatureArgs {
    /// Feature edges, from one of these sources; may be given several times
    ///
    ///   auto           the boundary, and creases found by their shape
    ///   none           no edge, where `auto` would be the default
    ///   angle:DEGREES  where the surface bends by that much or more
    ///   boundary       the boundary
    ///   lines          the `l` elements of the mesh, an OBJ file
    ///   material       borders of materials (`usemtl` in OBJ, or glTF)
    ///   group          borders of groups and objects (`g` and `o`)
    ///   smoothing      borders of smoothing groups (`s`)
    ///   uv-seams       where the `vt` differ on both sides
    ///   edges:A-B,...  edges by their vertices, counted from 0
    ///   pairs:FILE     two vertices a line, from 0; # starts a comment
    ///   sharp:FILE     of QuadWild: count, then `type,face,side`
    ///
    /// Vertices and faces are those of the file, also with `--repair`.
    /// The default is `auto` for quads and integer-grid maps of a mesh.
    #[arg(long, value_name = "SOURCE", value_parser = source, verbatim_doc_comment)]
    features: Vec<Option<FeatureSource>>,

    /// The boundary as well, as with `--features boundary`
    #[arg(long)]
    align_boundary: bool,
}

impl FeatureArgs {
    /// All sources, or these if none is given.
    pub(crate) fn or(&self, default: Features) -> Features {
        if self.features.is_empty() && !self.align_boundary {
            return default;
        }
        let boundary = self.align_boundary.then_some(FeatureSource::Boundary);
        self.sources().cloned().chain(boundary).fold(Features::none(), Features::and)
    }

    /// The files that features are read from.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        self.sources().filter_map(FeatureSource::file)
    }

    fn sources(&self) -> impl Iterator<Item = &FeatureSource> {
        self.features.iter().flatten()
    }
}

fn source(text: &str) -> Result<Option<FeatureSource>, String> {
    match text {
        "none" => Ok(None),
        _ => text.parse().map(Some),
    }
}

/// How fine a grid is to be.
#[derive(Debug, Clone, Copy, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct SizeArgs {
    /// About so many quads in all
    #[arg(long, value_name = "N", value_parser = positive)]
    quads: Option<f64>,

    /// Mean edge length of the quads, in mesh units
    #[arg(long, value_name = "L", value_parser = positive)]
    edge_length: Option<f64>,

    /// Grid units per mesh unit: the number of quads along a length of 1, the inverse of `--edge-length`
    #[arg(long, value_name = "S", value_parser = positive)]
    scale: Option<f64>,
}

impl SizeArgs {
    /// The one that is given; the parser sees to it that there is one.
    pub(crate) fn grid(&self) -> GridSize {
        let given = self.quads.map(GridSize::Quads);
        let given = given.or(self.edge_length.map(GridSize::EdgeLength));
        given.or(self.scale.map(GridSize::Scale)).unwrap_or_default()
    }
}

pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("expected a number, 0 or larger".into()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match not_negative(text) {
        Ok(x) if x > 0.0 => Ok(x),
        _ => Err("expected a number larger than 0".into()),
    }
}

/// The longest time limit: a year. Whoever gives more wants none.
const LONGEST: Duration = Duration::from_secs(365 * 24 * 60 * 60);

fn seconds(text: &str) -> Result<Duration, String> {
    let time = text.parse().ok().and_then(|x| Duration::try_from_secs_f64(x).ok());
    time.filter(|&time| !time.is_zero() && time <= LONGEST).ok_or_else(|| {
        "expected a number of seconds, larger than 0 and at most a year; leave the option out for no limit".into()
    })
}

/// Bytes in a size such as `800MB` or `1.5 GiB`.
fn bytes(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 8] = [
        ("", 1.0),
        ("b", 1.0),
        ("kb", 1e3),
        ("mb", 1e6),
        ("gb", 1e9),
        ("kib", 1024.0),
        ("mib", 1048576.0),
        ("gib", 1073741824.0),
    ];
    let end = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let unit = UNITS.iter().find(|(name, _)| unit.eq_ignore_ascii_case(name));
    let number = number.trim().parse().ok().filter(|&x: &f64| x.is_finite() && x > 0.0);
    let bytes = number.zip(unit).map(|(number, (_, unit))| number * unit);
    bytes.map(|bytes| bytes as u64).ok_or_else(|| "expected a size such as 800MB or 1.5GiB".into())
}

/// The most threads.
const MOST_THREADS: u32 = 1024;

fn threads(text: &str) -> Result<u32, String> {
    let count = text.parse().ok().filter(|count| (1..=MOST_THREADS).contains(count));
    count.ok_or_else(|| {
        format!("expected a number of threads, from 1 to {MOST_THREADS}; leave the option out for all cores")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        for (text, expected) in [
            ("4000000", 4_000_000),
            ("800MB", 800_000_000),
            ("1.5 GiB", 1_610_612_736),
            ("2gb", 2_000_000_000),
            ("64k", 0),
            ("0", 0),
            ("-1GB", 0),
            ("much", 0),
            ("infGB", 0),
            ("1e3b", 0),
        ] {
            assert_eq!(bytes(text).ok(), Some(expected).filter(|&bytes| bytes > 0), "{text}");
        }
    }

    #[test]
    fn seconds_are_positive_and_finite() {
        assert_eq!(seconds("0.25"), Ok(Duration::from_millis(250)));
        for text in ["0", "7e-17", "-1", "nan", "inf", "1e300", "soon", ""] {
            assert!(seconds(text).is_err(), "{text}");
        }
    }
}
