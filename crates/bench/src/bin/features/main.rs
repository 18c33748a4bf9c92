//! Maps with aligned features beside maps without.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

mod verify;
mod weights;

use clap::Parser;
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{self, Mesh};
use seamstress_bench::process::{cpu_seconds, exit_code};
use seamstress_mesh::features::{EdgeSet, sharp_edges};
use seamstress_mesh::{Halfedge, Metric, VertexData};
use seamstress_parametrize::{MapOptions, MapSolution, Sectors, make_aligned_map};
use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use verify::Verifier;

/// Maps meshes with their features aligned, and without
///
/// Features are the edges named in a `.sharp` file beside the mesh, or else the edges whose dihedral
/// angle exceeds a limit. The boundary is aligned too.
#[derive(Debug, Parser)]
struct Args {
    /// Mesh files
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

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
    #[arg(long, value_name = "X", default_value_t = 0.0006)]
    cone_price: f64,

    /// Map with `seamstress map` as well and check its map with `python3 SCRIPT --strict SOURCE MAP
    /// --features PAIRS`, which prints a JSON object
    #[arg(long, value_name = "SCRIPT")]
    verify: Option<PathBuf>,

    /// Keep the maps that are checked, and their kept features as vertex pairs, in this folder
    #[arg(long, value_name = "DIR", requires = "verify")]
    maps: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

const TITLES: [&str; 14] = [
    "mesh",
    "triangles",
    "features",
    "dropped",
    "relaxed",
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

/// Whether all went well.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    if !args.corner_weights.is_empty() {
        print!("{}", weights::table(args, &args.corner_weights)?);
        return Ok(true);
    }
    let temporary = tempfile::tempdir()?;
    let folder = args.maps.as_deref().unwrap_or(temporary.path()).to_owned();
    fs::create_dir_all(&folder)?;
    let seamstress = std::env::current_exe()?.with_file_name("seamstress");
    let verifier = args.verify.clone().map(|script| Verifier { seamstress, script, folder });
    let mut table = Table::new(TITLES);
    let mut all_well = true;
    for path in &args.meshes {
        let mesh = meshes::load(path)?;
        match row(path, &mesh, args, verifier.as_ref()) {
            Ok(row) => {
                eprintln!("| {} |", row.join(" | "));
                table.push(row);
            }
            Err(error) => {
                eprintln!("{}: {error}", meshes::name(path));
                all_well = false;
            }
        }
    }
    print!("{table}");
    Ok(all_well)
}

fn row(
    path: &Path,
    mesh: &Mesh,
    args: &Args,
    verifier: Option<&Verifier>,
) -> Result<Vec<String>, Box<dyn Error>> {
    let connectivity = &mesh.connectivity;
    let (features, source) = features_of(path, mesh, args)?;
    let mut options = MapOptions::default();
    options.rounding.corner_weight = args.corner_weight;
    options.cone_price = Some(args.cone_price);
    let (plain, plain_cpu) = solve(mesh, &EdgeSet::new(connectivity, []), &options)?;
    let (aligned, aligned_cpu) = solve(mesh, &features, &options)?;
    let verdict = verifier.map(|verifier| {
        let arguments = [
            "--features",
            &source,
            "--align-boundary",
            "--corner-weight",
            &args.corner_weight.to_string(),
            "--cone-price",
            &args.cone_price.to_string(),
        ];
        verifier.verify(path, mesh, &arguments.map(str::to_owned), &aligned)
    });
    let verdict = verdict.transpose()?;
    let relaxed = aligned
        .released
        .iter()
        .filter(|r| r.reason == seamstress_parametrize::ReleaseReason::NoLayout);
    let relaxed = relaxed.count();
    let (a, p) = (&aligned.distortion, &plain.distortion);
    Ok(vec![
        meshes::name(path),
        connectivity.n_faces().to_string(),
        features.len().to_string(),
        (aligned.released.len() - relaxed).to_string(),
        relaxed.to_string(),
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

/// The features of a mesh and the boundary; and how to ask `seamstress map` for the former.
fn features_of(path: &Path, mesh: &Mesh, args: &Args) -> Result<(EdgeSet, String), Box<dyn Error>> {
    let connectivity = &mesh.connectivity;
    let sharp = path.with_extension("sharp");
    let (interior, source) = if sharp.is_file() {
        let lines = seamstress_io::read_sharp(&sharp)?;
        let side = |line: seamstress_io::SharpLine| Halfedge(3 * line.face + line.side);
        let edges = EdgeSet::new(connectivity, lines.into_iter().map(side));
        (edges, format!("sharp:{}", sharp.display()))
    } else {
        let edges = sharp_edges(connectivity, &mesh.positions, args.angle.to_radians());
        (edges, format!("angle:{}", args.angle))
    };
    Ok((interior.union(connectivity, &EdgeSet::boundary(connectivity)), source))
}

/// A map, and the CPU seconds it took.
fn solve(
    mesh: &Mesh,
    features: &EdgeSet,
    options: &MapOptions,
) -> Result<(MapSolution, f64), Box<dyn Error>> {
    let start = cpu_seconds().unwrap_or_default();
    let mut go_on = |_| ControlFlow::Continue(());
    let solution =
        make_aligned_map(&mesh.connectivity, &mesh.positions, features, options, &mut go_on)?;
    Ok((solution, cpu_seconds().unwrap_or_default() - start))
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
