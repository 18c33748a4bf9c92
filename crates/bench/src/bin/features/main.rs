//! Maps with aligned features beside maps without.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

use clap::Parser;
use seamstress::{MapOptions, MapSolution, make_aligned_map};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{self, Mesh};
use seamstress_bench::process::cpu_seconds;
use seamstress_surface::features::{EdgeSet, sharp_edges};
use seamstress_surface::{Halfedge, TriMesh};
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

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

    /// Distortion that may be paid for one cone fewer
    #[arg(long, value_name = "X", default_value_t = MapOptions::default().cone_price)]
    cone_price: f64,

    /// Write the maps (OBJ) and the kept features (vertex pairs) to this folder
    #[arg(long, value_name = "DIR")]
    maps: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

const TITLES: [&str; 13] = [
    "mesh",
    "triangles",
    "features",
    "dropped",
    "relaxed",
    "cones",
    "unal.",
    "S = 3",
    "tau",
    "unal.",
    "SD",
    "unal.",
    "CPU ratio",
];

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    let mut table = Table::new(TITLES);
    for path in &args.meshes {
        let mesh = meshes::load(path)?;
        match row(path, &mesh, args) {
            Ok(row) => {
                eprintln!("| {} |", row.join(" | "));
                table.push(row);
            }
            Err(error) => eprintln!("{}: {error}", meshes::name(path)),
        }
    }
    print!("{table}");
    Ok(())
}

fn row(path: &Path, mesh: &Mesh, args: &Args) -> Result<Vec<String>, Box<dyn Error>> {
    let connectivity = &mesh.connectivity;
    let sharp = path.with_extension("sharp");
    let interior = if sharp.is_file() {
        let lines = seamstress_io::read_sharp(&sharp)?;
        let side = |line: seamstress_io::SharpLine| Halfedge(3 * line.face + line.side);
        EdgeSet::new(connectivity, lines.into_iter().map(side))
    } else {
        sharp_edges(connectivity, &mesh.positions, args.angle.to_radians())
    };
    let features = interior.union(connectivity, &EdgeSet::boundary(connectivity));
    let (plain, plain_cpu) = timed(mesh, &EdgeSet::new(connectivity, []), args)?;
    let (aligned, aligned_cpu) = timed(mesh, &features, args)?;
    if let Some(folder) = &args.maps {
        write(folder, path, mesh, &aligned)?;
    }
    let relaxed =
        aligned.released.iter().filter(|r| r.reason == seamstress::ReleaseReason::NoLayout);
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
        corners_of_three(connectivity, &aligned).to_string(),
        format!("{:.2}", a.tau),
        format!("{:.2}", p.tau),
        format!("{:.3}", a.symmetric_dirichlet),
        format!("{:.3}", p.symmetric_dirichlet),
        format!("{aligned_cpu:.2} / {plain_cpu:.2}"),
    ])
}

fn timed(
    mesh: &Mesh,
    features: &EdgeSet,
    args: &Args,
) -> Result<(MapSolution, f64), Box<dyn Error>> {
    let mut options = MapOptions::default();
    options.rounding.corner_weight = args.corner_weight;
    options.cone_price = args.cone_price;
    let start = cpu_seconds().unwrap_or_default();
    let mut go_on = |_| ControlFlow::Continue(());
    let solution =
        make_aligned_map(&mesh.connectivity, &mesh.positions, features, &options, &mut go_on)?;
    Ok((solution, cpu_seconds().unwrap_or_default() - start))
}

/// Corners between kept features whose angle in the map is three quarters of a turn.
fn corners_of_three(mesh: &TriMesh, solution: &MapSolution) -> usize {
    let aligned = mesh.halfedges().map(|h| solution.features.contains(h)).collect();
    let (slit, _) = mesh.slit(&aligned);
    let angle = |h: Halfedge| {
        let [a, b, c] = [h, h.next(), h.prev()].map(|c| solution.map.corner_uvs()[c.at()]);
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]).to_degrees()
    };
    let is_three = |&s: &_| (slit.outgoing(s).map(angle).sum::<f64>() - 270.0).abs() < 1.0;
    slit.vertices().filter(|&s| slit.is_boundary(s)).filter(is_three).count()
}

/// Writes a map with texture coordinates per corner, and its kept features.
fn write(
    folder: &Path,
    path: &Path,
    mesh: &Mesh,
    solution: &MapSolution,
) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    let stem = path.file_stem().unwrap_or_default();
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        writeln!(text, "v {x:?} {y:?} {z:?}")?;
    }
    for [u, v] in solution.map.corner_uvs() {
        writeln!(text, "vt {u:?} {v:?}")?;
    }
    for f in mesh.connectivity.faces() {
        let corners = f.halfedges().map(|h| {
            let (v, t) = (mesh.connectivity.origin(h).0 + 1, h.0 + 1);
            format!("{v}/{t}")
        });
        writeln!(text, "f {}", corners.join(" "))?;
    }
    fs::write(folder.join(stem).with_extension("obj"), text)?;
    let pairs = solution.features.vertex_pairs(&mesh.connectivity);
    let lines: String = pairs.iter().map(|[a, b]| format!("{a} {b}\n")).collect();
    fs::write(folder.join(stem).with_extension("pairs"), lines)?;
    Ok(())
}
