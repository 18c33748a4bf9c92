//! `seamstress quality`.

use crate::args::{QuadFigure, QualityArgs};
use crate::measure::{TITLES, line, summary_line};
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, VERSION};
use crate::shape::orientation_row;
use crate::summary;
use crate::text::{self, counted, figure, row};
use seamstress_io::{PolygonMesh, read_mesh};
use seamstress_quads::quality::{
    self, Comparison, ComparisonError, Distance, QuadQuality, SurfaceDistance, angle_deviations,
    measure,
};
use seamstress_render::HeatMap;
use std::io::Write;
use std::path::Path;

/// Runs the command.
pub(crate) fn run(args: &QualityArgs) -> Result<Status, Failure> {
    let mut inputs: Vec<&Path> = vec![&args.quads];
    inputs.extend(args.source.as_deref());
    let targets = args.picture.iter().map(|path| Target::new(Kind::Picture, path)).collect();
    let plan = Plan::new(&inputs, None, targets)?;
    let read = read_mesh(&args.quads)?;
    if read.polygons.is_empty() {
        return Err(bad_mesh(&args.quads, "it has no faces"));
    }
    let quality = measure(&read.positions, read.polygons.iter());
    let compared = match &args.source {
        Some(source) => Some(compare(args, &read, source)?),
        None => None,
    };
    let mut batch = plan.begin()?;
    for target in &plan.targets {
        let picture = draw(args, &read, &quality)?;
        batch.write(&target.path, |file| file.write_all(&picture))?;
    }
    batch.commit()?;
    text::print(&match args.json {
        true => json_text(args, &quality, compared.as_ref()),
        false => table(args, &quality, compared.as_ref()),
    })?;
    Ok(Status::Done)
}

fn bad_mesh(file: &Path, text: &str) -> Failure {
    Failure::BadMesh { file: file.to_owned(), text: text.to_owned() }
}

fn compare(args: &QualityArgs, read: &PolygonMesh, source: &Path) -> Result<Comparison, Failure> {
    let reference = read_mesh(source)?;
    let mesh = (read.positions.as_slice(), read.polygons.iter());
    let reference = (reference.positions.as_slice(), reference.polygons.iter());
    quality::compare(mesh, reference, args.samples as usize).map_err(|error| {
        let file = if matches!(error, ComparisonError::BadMesh(_)) { &args.quads } else { source };
        bad_mesh(file, &error.to_string())
    })
}

/// The polygons in the colours of the figure asked for, one value each.
fn draw(args: &QualityArgs, read: &PolygonMesh, quality: &QuadQuality) -> Result<Vec<u8>, Failure> {
    let (values, heat) = match args.of {
        QuadFigure::Angle => angle_heat(read),
        QuadFigure::Measure(wanted) => {
            let Some(measured) = quality.measures.iter().find(|m| m.measure == wanted) else {
                let reason = quality.no_layout.as_deref().unwrap_or("there is no layout");
                let text = format!("{} cannot be painted: {reason}", wanted.name());
                return Err(bad_mesh(&args.quads, &text));
            };
            // The worse of a quad's two triangles.
            let values = measured.values.0.chunks(2);
            let values = values.map(|pair| pair.iter().copied().fold(f64::NAN, f64::max)).collect();
            (values, pictures::heat_of(measured))
        }
    };
    let vertices = quality.topology.irregular_vertices.iter();
    let irregular: Vec<(u32, i32)> = vertices.map(|&(v, edges)| (v, 4 - edges as i32)).collect();
    pictures::draw_polygons(
        &read.positions,
        read.polygons.iter(),
        &irregular,
        (&heat, values.as_slice()),
    )
    .map_err(|cause| Failure::NoPicture { file: args.quads.clone(), cause })
}

/// Right angles are dark, and this many degrees off them bright.
const BRIGHT_DEVIATION: f64 = 45.0;

fn angle_heat(read: &PolygonMesh) -> (Vec<f64>, HeatMap) {
    let title = "deviation of angles, degrees".into();
    let values = angle_deviations(&read.positions, read.polygons.iter());
    (values, HeatMap { low: 0.0, high: BRIGHT_DEVIATION, title })
}

fn json_text(args: &QualityArgs, quality: &QuadQuality, compared: Option<&Comparison>) -> String {
    let mut value = serde_json::to_value(quality).unwrap_or_default();
    if let Some(distortion) = &quality.distortion {
        value["distortion"] = report::distortion_json(distortion);
    }
    value["measures"] = quality.measures.iter().map(report::measure_json).collect();
    value["seamstress"] = VERSION.into();
    value["command"] = "quality".into();
    value["input"] = args.quads.to_string_lossy().into();
    if let (Some(compared), Some(source)) = (compared, &args.source) {
        value["source"] = source.to_string_lossy().into();
        value["distance"] = serde_json::to_value(compared.distance).unwrap_or_default();
        value["orientation"] = serde_json::to_value(compared.orientation).unwrap_or_default();
    }
    report::to_text(&value)
}

fn table(args: &QualityArgs, quality: &QuadQuality, compared: Option<&Comparison>) -> String {
    let mut rows = topology_rows(args, quality);
    rows.extend(shape_rows(quality));
    match (&quality.distortion, &quality.no_layout) {
        (Some(distortion), _) => rows.extend(summary::distortion_rows(distortion)),
        (None, Some(reason)) => rows.push(row("distortion", &format!("undefined: {reason}"))),
        (None, None) => {}
    }
    if let (Some(compared), Some(source)) = (compared, &args.source) {
        rows.extend(distance_rows(&compared.distance, source));
        rows.push(orientation_row(&compared.orientation));
    }
    if let Some(path) = &args.picture {
        rows.push(row("written", &path.display().to_string()));
    }
    if !quality.measures.is_empty() {
        rows.push(String::new());
        rows.push(line(TITLES));
        rows.extend(quality.measures.iter().map(|measured| summary_line(measured, |_, _| false)));
    }
    rows.join("\n")
}

fn topology_rows(args: &QualityArgs, quality: &QuadQuality) -> Vec<String> {
    let topology = &quality.topology;
    let polygons: Vec<String> = topology
        .polygons
        .iter()
        .map(|(&corners, &count)| match corners {
            3 => counted(count, "triangle"),
            4 => counted(count, "quad"),
            n => format!("{count} of {n} corners"),
        })
        .collect();
    let irregular = match topology.n_irregular() {
        0 => "none".into(),
        n => {
            let valences = topology.irregular.iter();
            let parts = valences.map(|(valence, count)| format!("{count} of valence {valence}"));
            format!("{n} ({})", parts.collect::<Vec<_>>().join(", "))
        }
    };
    let mut surface = format!("Euler characteristic {}", topology.euler_characteristic);
    match topology.boundary_edges {
        0 => surface += ", closed",
        n => surface += &format!(", {} on the boundary", counted(n, "edge")),
    }
    if topology.bad_edges > 0 {
        surface += &format!(", {} with faces that do not fit", counted(topology.bad_edges, "edge"));
    }
    let mut rows = vec![
        row("quad mesh", &args.quads.display().to_string()),
        row("size", &format!("{}, {}", counted(topology.vertices, "vertex"), polygons.join(", "))),
        row("topology", &surface),
        row("irregular", &irregular),
    ];
    let on_boundary: usize = topology.boundary_vertices.values().sum();
    if on_boundary > 0 {
        let vertices = topology.boundary_vertices.iter();
        let parts =
            vertices.map(|(&faces, count)| format!("{count} in {}", counted(faces, "face")));
        let parts = parts.collect::<Vec<_>>().join(", ");
        rows.push(row("boundary", &format!("{}: {parts}", counted(on_boundary, "vertex"))));
    }
    rows
}

fn shape_rows(quality: &QuadQuality) -> Vec<String> {
    let (angles, lengths) = (&quality.angles, &quality.edge_lengths);
    let mut text = format!(
        "{:.1} to {:.1} degrees, {:.1} from 90 in the mean",
        angles.min, angles.max, angles.mean_deviation
    );
    if angles.not_convex > 0 {
        text += &format!("; {} not convex", counted(angles.not_convex, "face"));
    }
    if angles.degenerate > 0 {
        text += &format!("; {} with an edge of no length", counted(angles.degenerate, "face"));
    }
    let edges = format!(
        "{} to {}, mean {}, deviating by {:.1} % of it",
        figure(lengths.min),
        figure(lengths.max),
        figure(lengths.mean),
        100.0 * lengths.variation
    );
    vec![row("angles", &text), row("edges", &edges)]
}

fn distance_rows(distance: &SurfaceDistance, source: &Path) -> Vec<String> {
    let share =
        |x: f64| format!("{} ({:.3} % of the diagonal)", figure(x), 100.0 * x / distance.diagonal);
    let both = |d: &Distance| format!("largest {}, mean {}", figure(d.max), figure(d.mean));
    vec![
        row("source", &source.display().to_string()),
        row("Hausdorff", &share(distance.hausdorff)),
        row("mean", &share(distance.mean)),
        row("to source", &both(&distance.to_source)),
        row("from source", &both(&distance.from_source)),
    ]
}
