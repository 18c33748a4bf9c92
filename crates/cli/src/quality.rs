//! `seamstress quality`.

use crate::args::QualityArgs;
use crate::input::LoadedMesh;
use crate::outcome::{Failure, Status};
use crate::report::{self, VERSION};
use crate::summary;
use crate::text::{self, counted, figure, row};
use seamstress_io::{PolygonMesh, read_mesh};
use seamstress_quads::quality::{QuadQuality, SurfaceDistance, measure, surface_distance};
use seamstress_surface::soup;
use std::path::Path;

/// Runs the command.
pub(crate) fn run(args: &QualityArgs) -> Result<Status, Failure> {
    let read = read_mesh(&args.quads)?;
    if read.polygons.is_empty() {
        return Err(bad_mesh(&args.quads, "it has no faces"));
    }
    let quality = measure(&read.positions, read.polygons.iter());
    let distance = match &args.source {
        Some(source) => Some(distance(args, &read, source)?),
        None => None,
    };
    text::print(&match args.json {
        true => json_text(args, &quality, distance.as_ref()),
        false => table(args, &quality, distance.as_ref()),
    })?;
    Ok(Status::Done)
}

fn bad_mesh(file: &Path, text: &str) -> Failure {
    Failure::BadMesh { file: file.to_owned(), text: text.to_owned() }
}

fn distance(
    args: &QualityArgs,
    read: &PolygonMesh,
    source: &Path,
) -> Result<SurfaceDistance, Failure> {
    let triangles = soup::triangulate(&read.positions, read.polygons.iter()).map_err(|faults| {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        bad_mesh(&args.quads, &faults.join("; "))
    })?;
    let source = LoadedMesh::load(source, false)?;
    let surface = (read.positions.as_slice(), triangles.faces.as_slice());
    let reference = (source.soup.positions.as_slice(), source.soup.faces.as_slice());
    surface_distance(surface, reference, args.samples as usize)
        .map_err(|error| bad_mesh(&source.path, &error.to_string()))
}

fn json_text(
    args: &QualityArgs,
    quality: &QuadQuality,
    distance: Option<&SurfaceDistance>,
) -> String {
    let mut value = serde_json::to_value(quality).unwrap_or_default();
    if let Some(distortion) = &quality.distortion {
        value["distortion"] = report::distortion_json(distortion);
    }
    value["seamstress"] = VERSION.into();
    value["command"] = "quality".into();
    value["input"] = args.quads.to_string_lossy().into();
    if let (Some(distance), Some(source)) = (distance, &args.source) {
        value["source"] = source.to_string_lossy().into();
        value["distance"] = serde_json::to_value(distance).unwrap_or_default();
    }
    report::to_text(&value)
}

fn table(args: &QualityArgs, quality: &QuadQuality, distance: Option<&SurfaceDistance>) -> String {
    let mut rows = topology_rows(args, quality);
    rows.extend(shape_rows(quality));
    match (&quality.distortion, &quality.no_layout) {
        (Some(distortion), _) => rows.extend(summary::distortion_rows(distortion)),
        (None, Some(reason)) => rows.push(row("distortion", &format!("undefined: {reason}"))),
        (None, None) => {}
    }
    if let (Some(distance), Some(source)) = (distance, &args.source) {
        rows.extend(distance_rows(distance, source));
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
    vec![
        row("source", &source.display().to_string()),
        row("Hausdorff", &share(distance.hausdorff)),
        row("mean", &share(distance.mean)),
    ]
}
