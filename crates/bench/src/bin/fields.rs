//! Round trips from maps to cross fields and back, on every mesh of a folder.

use clap::Parser;
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{Mesh, list, load, name};
use seamstress_bench::process::cpu_seconds;
use seamstress_mesh::{HalfedgeData, Metric};
use seamstress_parametrize::field::{CrossField, Homology, extract, lift, map_indices};
use seamstress_parametrize::{MapOptions, Start, make_map, make_map_from};
use std::error::Error;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

/// Maps each mesh, reads the cross field off the map, maps the field, and compares
///
/// Columns: cones and loops of the first map; whether the second has the same cones, the same loop
/// indices; its tau against that of the first; milliseconds for the basis of the homology and for the
/// elimination of eq. (13), with all matchings shaken by full turns first.
#[derive(Debug, Parser)]
struct Args {
    /// Folder with meshes
    folder: PathBuf,

    /// Only meshes whose name contains this
    #[arg(long)]
    only: Option<String>,

    /// Only meshes of at most this many triangles
    #[arg(long, default_value_t = usize::MAX)]
    largest: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let mut table = Table::new([
        "mesh",
        "triangles",
        "cones",
        "loops",
        "same cones",
        "same loops",
        "tau",
        "tau again",
        "basis ms",
        "(13) ms",
        "CPU s",
    ]);
    for path in list(&args.folder, args.only.as_deref())? {
        let mesh = match load(&path) {
            Ok(mesh) if mesh.connectivity.n_faces() > args.largest => continue,
            Ok(mesh) => mesh,
            Err(error) => {
                writeln!(std::io::stderr(), "left out: {error}")?;
                continue;
            }
        };
        let mut cells = vec![name(&path), mesh.connectivity.n_faces().to_string()];
        match round_trip(&mesh) {
            Ok(more) => cells.extend(more),
            Err(error) => {
                writeln!(std::io::stderr(), "{}: {error}", name(&path))?;
                cells.extend(["failed"; 9].map(String::from));
            }
        }
        writeln!(std::io::stderr(), "| {} |", cells.join(" | "))?;
        table.push(cells);
    }
    write!(std::io::stdout(), "{table}")?;
    Ok(())
}

fn round_trip(mesh: &Mesh) -> Result<Vec<String>, Box<dyn Error>> {
    let before = cpu_seconds();
    let (connectivity, positions) = (&mesh.connectivity, &mesh.positions);
    let options = MapOptions::default();
    let mut go_on = |_| ControlFlow::Continue(());
    let first = make_map(connectivity, positions, &options, &mut go_on)?;
    let metric = Metric::from_positions(connectivity, positions);
    let begun = Instant::now();
    let homology = Homology::new(connectivity);
    let basis = begun.elapsed().as_secs_f64() * 1e3;
    let field = extract(connectivity, &metric, &homology, &first.map)?;
    let elimination = time_of_elimination(mesh, &homology, &field, first.map.corner_uvs())?;
    let start = Start::Field(field.clone());
    let second = make_map_from(connectivity, positions, &start, &options, &mut go_on)?;
    let again = extract(connectivity, &metric, &homology, &second.map)?;
    let loops = |field: &CrossField| -> Vec<i32> {
        homology.loops().iter().map(|l| field.loop_index(connectivity, l)).collect()
    };
    let yes = |same: bool| if same { "yes" } else { "NO" }.to_owned();
    let cpu = before.zip(cpu_seconds()).map_or("-".into(), |(a, b)| format!("{:.2}", b - a));
    Ok(vec![
        first.map.cones().len().to_string(),
        homology.loops().len().to_string(),
        yes(first.map.cones() == second.map.cones()),
        yes(loops(&field) == loops(&again)),
        format!("{:.3}", first.distortion.tau),
        format!("{:.3}", second.distortion.tau),
        format!("{basis:.1}"),
        format!("{elimination:.1}"),
        cpu,
    ])
}

/// Milliseconds to find the full turns again after all matchings were shaken by some.
fn time_of_elimination(
    mesh: &Mesh,
    homology: &Homology,
    field: &CrossField,
    corner_uvs: &[[f64; 2]],
) -> Result<f64, Box<dyn Error>> {
    let connectivity = &mesh.connectivity;
    let mut shaken: HalfedgeData<i32> = field.matching().clone();
    for h in connectivity.interior_edges() {
        let turns = 4 * ((h.0 % 3) as i32 - 1);
        shaken[h] += turns;
        if let Some(t) = connectivity.twin(h) {
            shaken[t] -= turns;
        }
    }
    let found = CrossField::new(connectivity, field.frames().clone(), shaken.clone())?
        .node_indices(connectivity, homology);
    let (nodes, loops) = map_indices(connectivity, homology, corner_uvs);
    let begun = Instant::now();
    let turns = lift(connectivity, homology, &shaken, &found, &nodes, &loops)?;
    let elapsed = begun.elapsed().as_secs_f64() * 1e3;
    let full = shaken.iter().zip(turns.iter()).map(|(r, k)| r + 4 * k).collect();
    let lifted = CrossField::new(connectivity, field.frames().clone(), full)?;
    if lifted.node_indices(connectivity, homology) != nodes {
        return Err("the elimination missed the indices".into());
    }
    Ok(elapsed)
}
