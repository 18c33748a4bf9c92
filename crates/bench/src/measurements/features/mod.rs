//! Maps with aligned features beside maps without.

mod weights;

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection, Subject};
use crate::output::Section;
use crate::process::Clock;
use crate::verify::Verifier;
use seamstress_mesh::features::{EdgeSet, sharp_edges};
use seamstress_mesh::{Halfedge, Metric, VertexData};
use seamstress_parametrize::{MapOptions, MapSolution, ReleaseReason, Sectors, make_aligned_map};
use serde_json::Value;
use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Features: maps that align them beside maps that do not
///
/// Features are the edges named in a `.sharp` file beside the mesh, or else the edges whose dihedral angle exceeds
/// a limit; the boundary is aligned too. `conflicting` are features dropped because they contradict each other,
/// `no layout` those dropped because no layout was found near them; `unal.` is the column before it without
/// features; `corners off` are corners whose angle in the map is not the nearest whole number of quarters. With
/// `--verify` the last column has flips and the largest angle between a kept feature and an axis, in degrees.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Smallest dihedral angle of a feature, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 40.0)]
    angle: f64,

    /// Weight of the corners in the rounding
    #[arg(long, value_name = "X", default_value_t = MapOptions::default().rounding.corner_weight)]
    corner_weight: f64,

    /// Compare the maps for these weights instead
    #[arg(long, value_name = "X,X,...", value_delimiter = ',', conflicts_with = "verify")]
    corner_weights: Vec<f64>,

    /// Distortion that may be paid for one cone fewer
    #[arg(long, value_name = "X", default_value_t = 0.0005)]
    cone_price: f64,

    /// Check every map with `python3 SCRIPT --strict --features PAIRS SOURCE MAP`, which prints a JSON object
    #[arg(long, value_name = "SCRIPT")]
    verify: Option<PathBuf>,
}

const TITLES: [&str; 14] = [
    "mesh",
    "triangles",
    "features",
    "conflicting",
    "no layout",
    "cones",
    "unal.",
    "corners off",
    "tau",
    "unal.",
    "SD",
    "unal.",
    "CPU s (unal.)",
    "verified",
];

/// Maps every mesh with and without its features; passes if all are mapped and verified.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    if !args.corner_weights.is_empty() {
        return weights::measure(args, &args.corner_weights);
    }
    let mut table = Table::new(TITLES);
    let failures = args.selection.survey(|subject| {
        table.report(row(subject, args)?);
        Ok(())
    })?;
    Ok(Section::new(table, &failures))
}

fn row(subject: &Subject, args: &Args) -> Result<Vec<String>, Box<dyn Error>> {
    let mesh = &subject.mesh;
    let connectivity = &mesh.connectivity;
    let features = features_of(subject, args.angle)?;
    let mut options = MapOptions::default();
    options.rounding.corner_weight = args.corner_weight;
    options.cone_price = Some(args.cone_price);
    let (plain, plain_cpu) = solve(mesh, &EdgeSet::new(connectivity, []), &options)?;
    let (aligned, aligned_cpu) = solve(mesh, &features, &options)?;
    let verdict =
        args.verify.as_deref().map(|script| verify(script, mesh, &aligned)).transpose()?;
    let without_layout =
        aligned.released.iter().filter(|r| r.reason == ReleaseReason::NoLayout).count();
    let (a, p) = (&aligned.distortion, &plain.distortion);
    Ok(vec![
        subject.name.clone(),
        connectivity.n_faces().to_string(),
        features.len().to_string(),
        (aligned.released.len() - without_layout).to_string(),
        without_layout.to_string(),
        aligned.map.cones().len().to_string(),
        plain.map.cones().len().to_string(),
        corners_off(mesh, &aligned).0.to_string(),
        format!("{:.2}", a.tau),
        format!("{:.2}", p.tau),
        format!("{:.3}", a.symmetric_dirichlet),
        format!("{:.3}", p.symmetric_dirichlet),
        format!("{aligned_cpu:.2} ({plain_cpu:.2})"),
        verdict.unwrap_or_default(),
    ])
}

/// The features of a mesh and its boundary.
fn features_of(subject: &Subject, degrees: f64) -> Result<EdgeSet, Box<dyn Error>> {
    let connectivity = &subject.mesh.connectivity;
    let sharp = subject.path.with_extension("sharp");
    let interior = if sharp.is_file() {
        let lines = seamstress_io::read_sharp(&sharp)?;
        let side = |line: seamstress_io::SharpLine| Halfedge(3 * line.face + line.side);
        EdgeSet::new(connectivity, lines.into_iter().map(side))
    } else {
        sharp_edges(connectivity, &subject.mesh.positions, degrees.to_radians())
    };
    Ok(interior.union(connectivity, &EdgeSet::boundary(connectivity)))
}

/// Maximum angle in degrees between a feature and an axis.
const TOLERANCE: f64 = 1e-9;

/// Has the script check a map with the features that it keeps. Gives a cell of the table.
fn verify(script: &Path, mesh: &Mesh, solution: &MapSolution) -> Result<String, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let pairs = folder.path().join("features");
    let kept = solution.features.vertex_pairs(&mesh.connectivity);
    fs::write(&pairs, kept.iter().map(|[a, b]| format!("{a} {b}\n")).collect::<String>())?;
    let options = ["--features".as_ref(), pairs.as_os_str()];
    let verdict = Verifier::new(script).check_uvs(mesh, solution.map.corner_uvs(), &options)?;
    verdict_cell(&verdict.json, kept.len())
}

/// Flips and the largest angle between a feature and the nearer axis.
fn verdict_cell(verdict: &Value, kept: usize) -> Result<String, Box<dyn Error>> {
    let features = &verdict["features"];
    let is_good = verdict["ok"] == true
        && features["edges"].as_u64() == Some(kept as u64)
        && features["not_in_mesh"] == 0;
    let flips = &verdict["flipped_or_degenerate"];
    match features["max_axis_deviation_deg"].as_f64() {
        Some(degrees) if is_good && degrees <= TOLERANCE => {
            Ok(format!("{flips} flips, {degrees:.0e}"))
        }
        _ => Err(format!("not verified: {verdict}").into()),
    }
}

/// A map, and the CPU seconds it took.
fn solve(
    mesh: &Mesh,
    features: &EdgeSet,
    options: &MapOptions,
) -> Result<(MapSolution, f64), Box<dyn Error>> {
    let clock = Clock::start();
    let mut go_on = |_| ControlFlow::Continue(());
    let solution =
        make_aligned_map(&mesh.connectivity, &mesh.positions, features, options, &mut go_on)?;
    Ok((solution, clock.seconds()))
}

/// Corners between kept features whose angle in the map is not the multiple of a quarter turn nearest to that
/// on the surface; and all corners.
fn corners_off(mesh: &Mesh, solution: &MapSolution) -> (usize, usize) {
    let connectivity = &mesh.connectivity;
    let metric = Metric::from_positions(connectivity, &mesh.positions);
    let sectors = Sectors::new(connectivity, &metric, &solution.features);
    let slit = sectors.slit();
    let mut quarters = VertexData::filled(slit.n_vertices(), 0.0);
    for h in connectivity.halfedges() {
        let [a, b, c] = [h, h.next(), h.prev()].map(|c| solution.map.corner_uvs()[c.at()]);
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let angle = (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]);
        quarters[slit.origin(h)] += angle / FRAC_PI_2;
    }
    let is_off = |&s: &_| {
        let preferred = sectors.quarters(s, f64::from(sectors.preferred(s)));
        (quarters[s] - preferred).abs() > 0.5
    };
    let corners = || slit.vertices().filter(|&s| sectors.is_corner(s));
    (corners().filter(is_off).count(), corners().count())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn verdicts() {
        let verdict = |ok: bool, degrees: f64, not_in_mesh: u32| {
            let features = json!({
                "edges": 3,
                "max_axis_deviation_deg": degrees,
                "not_in_mesh": not_in_mesh,
            });
            json!({ "ok": ok, "flipped_or_degenerate": 0, "features": features })
        };
        assert_eq!(verdict_cell(&verdict(true, 2e-12, 0), 3).unwrap(), "0 flips, 2e-12");
        for (bad, kept) in [
            (verdict(false, 2e-12, 0), 3),
            (verdict(true, 2e-8, 0), 3),
            (verdict(true, 2e-12, 1), 3),
            (verdict(true, 2e-12, 0), 4),
            (json!({ "error": "no uv" }), 3),
        ] {
            assert!(verdict_cell(&bad, kept).is_err());
        }
    }
}
