//! Quad meshes at several counts of quads, checked and measured.

mod check;

use crate::map_files::seamless;
use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::{Section, progress};
use crate::statistics::order;
use seamstress_mesh::features::EdgeSet;
use seamstress_parametrize::progress::go_on;
use seamstress_quads::quality::{
    Angles, EdgeLengths, Orientation, SurfaceDistance, split_polygons, surface_distance,
};
use seamstress_quads::{
    Constraints, QuadMesh, SmoothOptions, UntangleOptions, manifold_quads, smooth, untangle,
};
use seamstress_quantize::{GridSize, QuantizeOptions};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

/// Quad meshes: checked and measured
///
/// Of each mesh, the quads must be an oriented manifold. Those of a closed mesh must have its topology, be as many
/// as the area of the integer-grid map, and have the map's cones as irregular vertices; those of an open one are
/// trimmed, and have no other irregular vertices. No quad may be inverted, unless they are `--raw`. All this is checked without the code that
/// made the quads. Distances are to the source and from it, in per cent of the diagonal of its bounding box.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Quads asked for
    #[arg(long, value_delimiter = ',', default_values_t = [500.0, 2500.0])]
    quads: Vec<f64>,

    /// Leave the vertices where the map has them, with badly shaped quads as they are
    #[arg(long)]
    raw: bool,

    /// Smooth the quads along the surface this many times
    #[arg(long, value_name = "N", default_value_t = 0)]
    smooth: u32,

    /// Points sampled on each surface for the distances, about
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    samples: usize,

    /// Keep the seamless maps in this folder, and take those that are there
    #[arg(long, value_name = "DIR")]
    maps: Option<PathBuf>,
}

const TITLES: [&str; 13] = [
    "mesh",
    "triangles",
    "asked",
    "quads",
    "trimmed",
    "irregular",
    "angles",
    "mean off 90",
    "inverted corners; folded, self-intersecting, inverted quads",
    "edges +-%",
    "Hausdorff %",
    "mean %",
    "check",
];

/// Makes the quads; passes if every mesh gave quads that pass every check.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let mut table = Table::new(TITLES);
    let mut orders =
        Table::new(["mesh", "counts", "order of the Hausdorff distance", "of the mean"]);
    let mut failures = Vec::new();
    args.selection.survey(|subject| {
        let mut rows = Vec::new();
        for &asked in &args.quads {
            let place = format!("{} at {asked}", subject.name);
            match measure_mesh(&subject.name, &subject.mesh, asked, args) {
                Ok(row) => {
                    table.report(row.cells(&subject.name, &subject.mesh));
                    failures.extend(row.faults.iter().map(|fault| format!("{place}: {fault}")));
                    rows.push(row);
                }
                Err(error) => {
                    progress(&format!("{place}: {error}"));
                    failures.push(format!("{place}: {error}"));
                }
            }
        }
        orders.push(order_cells(&subject.name, &rows));
        Ok(())
    })?;
    let mut text = table.to_string();
    if args.quads.len() > 1 {
        text += &format!("\n{orders}");
    }
    if failures.is_empty() {
        text += "\nEvery check passed.\n";
    }
    Ok(Section::new(text, &failures))
}

/// The quads of one run, measured.
struct Row {
    asked: f64,
    quads: usize,
    trimmed: usize,
    irregular: usize,
    angles: Angles,
    orientation: Orientation,
    lengths: EdgeLengths,
    distance: SurfaceDistance,
    faults: Vec<String>,
}

fn measure_mesh(name: &str, mesh: &Mesh, asked: f64, args: &Args) -> Result<Row, Box<dyn Error>> {
    let (map, _) = seamless(name, mesh, asked, args.maps.as_deref())?;
    let (positions, faces) = (mesh.positions.as_slice(), mesh.faces());
    let source = (positions, faces.as_slice());
    let options = QuantizeOptions { size: GridSize::Quads(asked), ..Default::default() };
    let (connectivity, nothing) = (&mesh.connectivity, EdgeSet::new(&mesh.connectivity, []));
    let mut go_on = |_| ControlFlow::Continue(());
    let made = manifold_quads(
        connectivity,
        positions,
        &map,
        &nothing,
        &options,
        &mut |_| true,
        &mut go_on,
    )?;
    let (integer, extraction) = (made.quantization.map, made.extraction);

    let counts = check::count(extraction.mesh.quads())?;
    let (made, quads) = (extraction.mesh.positions(), extraction.mesh.quads());
    let mut faults = check::faults(mesh, integer.seamless(), made, quads, &counts);
    let constraints = extraction.constraints(&mesh.connectivity, positions.into(), &[]);
    let quads = match args.raw {
        true => extraction.mesh,
        false => untangled(&extraction.mesh, source, &constraints)?,
    };
    let quads = smoothed(quads, source, args.smooth, constraints)?;

    let polygons = || quads.quads().iter().map(<[u32; 4]>::as_slice);
    let orientation = Orientation::new(quads.positions(), polygons(), source)?;
    let inverted = orientation.inverted + orientation.crossed;
    if inverted > 0 && !args.raw {
        faults.push(format!("{inverted} quads are inverted"));
    }
    let triangles = split_polygons(quads.positions(), polygons())
        .map_err(|_| "the quads cannot be split into triangles")?;
    let halves = (quads.positions(), triangles.as_slice());
    Ok(Row {
        asked,
        quads: quads.quads().len(),
        trimmed: extraction.trimmed,
        irregular: counts.irregular.len(),
        angles: Angles::new(quads.positions(), polygons()),
        orientation,
        lengths: EdgeLengths::new(quads.positions(), polygons()),
        distance: surface_distance(halves, source, args.samples)?,
        faults,
    })
}

fn untangled(
    quads: &QuadMesh,
    source: (&[[f64; 3]], &[[u32; 3]]),
    constraints: &Constraints,
) -> Result<QuadMesh, Box<dyn Error>> {
    let start = Instant::now();
    let options =
        UntangleOptions { constraints: constraints.clone(), ..UntangleOptions::default() };
    let shaped = untangle(quads, source, &options, &mut go_on)?;
    let seconds = start.elapsed().as_secs_f64();
    progress(&format!("untangled in {seconds:.2} s: {} vertices moved", shaped.moved));
    Ok(shaped.mesh)
}

fn smoothed(
    quads: QuadMesh,
    source: (&[[f64; 3]], &[[u32; 3]]),
    rounds: u32,
    constraints: Constraints,
) -> Result<QuadMesh, Box<dyn Error>> {
    if rounds == 0 {
        return Ok(quads);
    }
    let start = Instant::now();
    let options = SmoothOptions { rounds, constraints };
    let smoothed = smooth(&quads, source, &options, &mut go_on)?.mesh;
    progress(&format!("smoothed in {:.2} s", start.elapsed().as_secs_f64()));
    Ok(smoothed)
}

impl Row {
    fn cells(&self, name: &str, mesh: &Mesh) -> Vec<String> {
        let share = |x: f64| 100.0 * x / self.distance.diagonal;
        let (to, from) = (self.distance.to_source, self.distance.from_source);
        let o = &self.orientation;
        vec![
            name.to_owned(),
            mesh.connectivity.n_faces().to_string(),
            format!("{:.0}", self.asked),
            self.quads.to_string(),
            self.trimmed.to_string(),
            self.irregular.to_string(),
            format!("{:.0}-{:.0}", self.angles.min, self.angles.max),
            format!("{:.1}", self.angles.mean_deviation),
            format!("{}, {}, {}, {}", o.turned_corners, o.bent, o.crossed, o.inverted),
            format!("{:.0}", 100.0 * self.lengths.variation),
            format!("{:.2}, {:.2}", share(to.max), share(from.max)),
            format!("{:.3}, {:.3}", share(to.mean), share(from.mean)),
            if self.faults.is_empty() { "ok".into() } else { "FAIL".into() },
        ]
    }
}

fn order_cells(name: &str, rows: &[Row]) -> Vec<String> {
    let exponent = |of: fn(&SurfaceDistance) -> f64| {
        let points: Vec<_> = rows.iter().map(|r| (r.lengths.mean, of(&r.distance))).collect();
        order(&points).map_or("-".into(), |exponent| format!("{exponent:.2}"))
    };
    let counts: Vec<String> = rows.iter().map(|row| row.quads.to_string()).collect();
    vec![name.to_owned(), counts.join(", "), exponent(|d| d.hausdorff), exponent(|d| d.mean)]
}
