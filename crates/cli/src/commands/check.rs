//! `seamstress check`.

use super::{inputs, reports, targets};
use crate::args::{FeatureArgs, RunArgs, after_help, not_negative};
use crate::command::{Command, Session, read_mesh, to_json};
use crate::failure::{Failure, Status};
use crate::output::{Kind, Plan};
use crate::summary;
use crate::text::{as_options, counted, row};
use seamstress::command_reports::{CheckReport, CheckedMapReport};
use seamstress::{
    CertifyOptions, Error, FeatureCurves, Features, Finding, Inspection, MapFile, Page, Severity,
    Surface, SurfaceOptions, Verdict, ViewOptions, listing,
};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress check bunny.ply
  seamstress check bunny.ply bunny.obj
  seamstress check bunny.ply other_program.obj --tolerance 1e-5
  seamstress check part.obj --features angle:40 --align-boundary --picture part.png
  seamstress check part.obj part_map.obj --features sharp:part.sharp
  seamstress check part.obj grid.obj --integer --features angle:40 --align-boundary
  seamstress check scan.stl --json | jq '.faults[].message'";

/// Faults and violations that are printed, of all kinds together.
const SHOWN: usize = 10;
/// An angle to an axis, in degrees, that numbers of few digits may explain.
const FEW_DIGITS: f64 = 0.01;

/// List the faults of a mesh, or certify a map
///
/// With a mesh alone: its size, its topology, and everything that keeps it from being mapped. With a
/// map as well: whether the map has the mesh's vertices and faces and is seamless, and its distortion;
/// or else everything that is wrong with it. With features: their curves and corners, and whether the
/// map has them along its axes. With `--integer`: whether the map is an integer-grid map, with the
/// features on its grid lines. Vertices, faces and components are counted from 0.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct CheckArgs {
    /// The mesh: OBJ, OFF, PLY, STL or glTF
    mesh: PathBuf,

    /// A map of the mesh: an OBJ file with a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    map: Option<PathBuf>,

    #[command(flatten)]
    surface: SurfaceOptions,

    /// Check that the map is an integer-grid map, in grid units
    ///
    /// Translations across seams and places of cones have to be integers, and features have to lie on
    /// lines of the grid, with their corners at grid points.
    #[arg(long, requires = "map")]
    integer: bool,

    /// How far the sides of a seam may be apart, in lengths of the edge, at most 0.01; maps written with
    /// few digits need more than the default [default: 1e-9]
    #[arg(long, value_name = "X", value_parser = not_negative, requires = "map")]
    tolerance: Option<f64>,

    #[command(flatten)]
    features: FeatureArgs,

    /// How far translations, cones and features may be from integers, in grid units, at most 0.01; maps
    /// written with few digits need it [default: exact]
    #[arg(long, value_name = "X", value_parser = not_negative, requires = "integer")]
    integer_tolerance: Option<f64>,

    /// How far a feature may be off the axes of the map, in degrees, at most 1; maps written with few digits
    /// need more than the default [default: 1e-9]
    #[arg(long, value_name = "DEGREES", value_parser = not_negative, requires = "map")]
    alignment_tolerance: Option<f64>,

    /// Draw the mesh with its features to this PNG file
    #[arg(long, value_name = "FILE.png", conflicts_with = "map", group = "drawn")]
    picture: Option<PathBuf>,

    /// Write everything to this file: a page to look at with a name in .html, else JSON; may be given several times
    #[arg(long, value_name = "FILE")]
    report: Vec<PathBuf>,

    /// Print everything as JSON on standard output, with all faults
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    view: ViewOptions,
}

/// What was found.
pub(crate) struct Checked {
    inspection: Inspection,
    /// The surface, if it is one, with its features.
    surface: Option<(Surface, Option<FeatureCurves>)>,
    map: Option<CheckedMap>,
}

impl Checked {
    fn curves(&self) -> Option<&FeatureCurves> {
        self.surface.as_ref()?.1.as_ref()
    }
}

struct CheckedMap {
    file: MapFile,
    differences: Vec<Finding>,
    /// Of maps whose faces are those of the mesh.
    verdict: Option<Verdict>,
}

impl CheckArgs {
    fn options(&self) -> CertifyOptions {
        let mut options = CertifyOptions::default().features(self.features.or(Features::none()));
        options.tolerance = self.tolerance.unwrap_or(options.tolerance);
        options.alignment_tolerance =
            self.alignment_tolerance.unwrap_or(options.alignment_tolerance);
        options.integer = self.integer;
        options.integer_tolerance = self.integer_tolerance.unwrap_or(options.integer_tolerance);
        options
    }

    fn check_map(&self, surface: &Surface, path: &Path) -> Result<CheckedMap, Failure> {
        let file = MapFile::read(path)?;
        let differences = file.differences(surface);
        let certify = || surface.certify_with(file.uvs(), file.face_uvs(), &self.options());
        let verdict = file.require_faces_of(surface).is_ok().then(certify).transpose()?;
        Ok(CheckedMap { file, differences, verdict })
    }
}

impl CheckedMap {
    fn is_certified(&self) -> bool {
        self.differences.is_empty() && self.verdict.as_ref().is_some_and(|v| v.certified)
    }

    fn is_passed(&self) -> bool {
        self.is_certified() && self.verdict.as_ref().is_some_and(Verdict::is_passed)
    }

    fn violations(&self) -> Vec<Finding> {
        let found = self.verdict.iter().flat_map(|verdict| &verdict.violations);
        self.differences.iter().chain(found).cloned().collect()
    }

    fn report(&self, path: &Path) -> CheckedMapReport {
        let file = path.to_string_lossy().into();
        CheckedMapReport::new(file, &self.differences, self.verdict.as_ref())
    }

    /// What was found in one line.
    fn verdict_text(&self) -> String {
        let Some(verdict) = self.verdict.as_ref().filter(|_| self.is_certified()) else {
            return "failed: not a seamless map of the mesh".into();
        };
        let checks = [
            (verdict.aligned, ["features on its axes", "features off its axes"]),
            (verdict.integral, ["an integer-grid map", "no integer-grid map"]),
        ];
        let word = if self.is_passed() { "passed" } else { "failed" };
        let found =
            checks.iter().filter_map(|&(passed, [yes, no])| Some(if passed? { yes } else { no }));
        let found: Vec<&str> = std::iter::once("a seamless map").chain(found).collect();
        format!("{word}: {}", found.join(", "))
    }

    fn rows(&self) -> Vec<String> {
        let verdict = self.verdict.as_ref();
        let mut rows = vec![row("verdict", &self.verdict_text())];
        rows.extend(verdict.iter().flat_map(|v| summary::distortion_rows(&v.distortion)));
        let Some(verdict) = verdict.filter(|_| self.is_certified()) else {
            if self.verdict.as_ref().is_some_and(|verdict| verdict.integral.is_some()) {
                rows.push(row("integers", "not checked, since the map is not seamless"));
            }
            let violations = self.violations();
            let hint = " (elements counted from 0)";
            rows.extend(failed_rows("certificate", hint, tolerance_row(&violations), &violations));
            return rows;
        };
        if let (Some(cones), Some(certificate)) = (&verdict.cones, &verdict.certificate) {
            rows.extend(summary::certificate_rows(cones, certificate));
        }
        rows.extend(verdict.alignment.iter().map(summary::alignment_row));
        if verdict.aligned == Some(false) {
            let violations = &verdict.alignment_violations;
            rows.extend(failed_rows("alignment", "", off_axis_row(violations), violations));
        }
        rows.extend(verdict.integer_certificate.iter().map(summary::integers_row));
        if verdict.integral == Some(false) {
            let hint = "; maps written with few digits need `--integer-tolerance`";
            rows.extend(failed_rows("integers", hint, None, &verdict.integer_violations));
        }
        rows
    }
}

impl Command for CheckArgs {
    const NAME: &'static str = "check";
    type Product = Checked;

    fn run_args(&self) -> RunArgs {
        RunArgs::quick(self.json)
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let mut files = targets(Kind::Picture, &self.picture);
        files.extend(reports(&self.report));
        let others = self.map.as_deref().into_iter().chain(self.features.files());
        Plan::new(&inputs(&self.mesh, others), None, files)
    }

    fn make(&self, session: &Session) -> Result<Checked, Failure> {
        let inspection = read_mesh(&self.mesh, &self.surface)?;
        if self.map.is_none() && !inspection.is_surface() {
            return Ok(Checked { inspection, surface: None, map: None });
        }
        let surface = session.surface(inspection.clone())?;
        let features = self.features.or(Features::none());
        let curves = (!features.is_none()).then(|| surface.features(&features)).transpose()?;
        let map = self.map.as_ref().map(|path| self.check_map(&surface, path)).transpose()?;
        Ok(Checked { inspection, surface: Some((surface, curves)), map })
    }

    fn pictures(&self, checked: &Checked) -> Result<Vec<Vec<u8>>, Error> {
        let draw = |(surface, curves): &(Surface, Option<FeatureCurves>)| {
            surface.picture(curves.as_ref(), &self.view)
        };
        checked.surface.iter().filter(|_| self.picture.is_some()).map(draw).collect()
    }

    fn page(&self, checked: &Checked) -> Option<Page> {
        Some(match (&checked.surface, &checked.map) {
            (Some((surface, curves)), Some(map)) => {
                let uvs = (map.file.uvs(), map.file.face_uvs());
                let found = (map.differences.as_slice(), map.verdict.as_ref());
                Page::of_map(surface, uvs, found, curves.as_ref())
            }
            _ => Page::of_mesh(&checked.inspection, checked.curves()),
        })
    }

    fn report(&self, checked: &Checked) -> Value {
        let features = checked.curves().map(FeatureCurves::report);
        let map = checked.map.as_ref().zip(self.map.as_ref());
        let map = map.map(|(map, path)| map.report(path));
        let options = (self.surface, self.options());
        to_json(&CheckReport::new(&checked.inspection, features, map, options))
    }

    fn summary(&self, checked: &Checked) -> Vec<String> {
        let inspection = &checked.inspection;
        let mut rows = summary::surface_rows(inspection.report());
        let curves = checked.curves().map(FeatureCurves::report);
        let features = curves.into_iter().flat_map(summary::feature_rows);
        if let (Some(map), Some(path)) = (&checked.map, &self.map) {
            rows.extend(features);
            rows.push(row("map", &path.display().to_string()));
            rows.extend(map.rows());
            return rows;
        }
        rows.push(row("verdict", &verdict_text(inspection)));
        rows.extend(summary::size_rows(inspection.report()));
        rows.extend(features);
        let notes = &inspection.report().notes;
        rows.extend(notes.iter().map(|note| row("note", &as_options(note))));
        let repairs = &inspection.report().repairs;
        rows.extend(repairs.iter().map(|repair| row("repair", repair)));
        for (severity, label) in [(Severity::Warning, "warning"), (Severity::Error, "fault")] {
            let found = inspection.findings().iter().filter(|f| f.severity == severity);
            rows.extend(listed(label, found));
        }
        rows
    }

    fn status(&self, checked: &Checked) -> Status {
        let is_surface = checked.inspection.is_surface();
        if checked.map.as_ref().map_or(is_surface, CheckedMap::is_passed) {
            Status::Done
        } else {
            Status::BadInput
        }
    }
}

fn verdict_text(inspection: &Inspection) -> String {
    let count = |severity| inspection.findings().iter().filter(|f| f.severity == severity).count();
    let mut text = match (count(Severity::Error), inspection.is_repairable()) {
        (0, _) => "a mesh that can be mapped".into(),
        (n, true) => format!("not a mesh; `--repair` can mend its {}", counted(n, "fault")),
        (n, false) => format!("not a mesh: {}", counted(n, "fault")),
    };
    if let n @ 1.. = count(Severity::Warning) {
        text += &format!(", {}", counted(n, "warning"));
    }
    if !inspection.findings().is_empty() {
        text += " (elements counted from 0)";
    }
    text
}

/// That a check failed, what the worst violation may come from, and the first violations.
fn failed_rows(label: &str, hint: &str, worst: Option<String>, found: &[Finding]) -> Vec<String> {
    let text = format!("failed: {}{hint}", counted(found.len(), "violation"));
    let rows = [row(label, &text)].into_iter().chain(worst);
    rows.chain(listed("violation", found)).collect()
}

/// The first findings of every kind, and how many more there are.
fn listed<'a>(label: &str, findings: impl IntoIterator<Item = &'a Finding>) -> Vec<String> {
    let findings: Vec<&Finding> = findings.into_iter().collect();
    let kinds: BTreeSet<&str> = findings.iter().map(|finding| finding.kind.as_str()).collect();
    let of_each = (SHOWN / kinds.len().max(1)).max(1);
    listing(findings, of_each).iter().map(|line| row(label, line)).collect()
}

/// The largest value of a number that violations of a kind have.
fn worst(violations: &[Finding], kind: &str, number: &str) -> Option<f64> {
    let of_kind = violations.iter().filter(|violation| violation.kind == kind);
    of_kind.filter_map(|v| v.details.get(number)?.as_f64()).max_by(f64::total_cmp)
}

/// How far the worst seam is open, and what that may come from.
fn tolerance_row(violations: &[Finding]) -> Option<String> {
    let worst = worst(violations, "open-seam", "residual")?;
    let hint = "maps written with few digits need `--tolerance`";
    Some(row("seams", &format!("open by up to {worst:.1e} edge lengths; {hint}")))
}

/// How far the worst feature is off, and what that may come from.
fn off_axis_row(violations: &[Finding]) -> Option<String> {
    let worst = worst(violations, "off-axis", "degrees")?;
    let mut text = format!("off the axes by up to {worst:.1e} degrees");
    if worst < FEW_DIGITS {
        text += "; maps written with few digits need `--alignment-tolerance`";
    }
    Some(row("features", &text))
}
