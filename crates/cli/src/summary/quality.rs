//! Quads and maps that were measured.

use super::map::distortion_rows;
use super::quads::orientation_row;
use crate::text::{counted, rounded, row};
use seamstress::{Measure, Measurement, QualityReport};

/// Topology, shape, distortion and distances of a quad mesh.
pub(crate) fn quality_rows(report: &QualityReport) -> Vec<String> {
    let mut rows = quality_topology_rows(report);
    rows.extend(quality_shape_rows(report));
    match (&report.distortion, &report.no_layout) {
        (Some(distortion), _) => rows.extend(distortion_rows(distortion)),
        (None, Some(reason)) => rows.push(row("distortion", &format!("undefined: {reason}"))),
        (None, None) => {}
    }
    if let Some(compared) = &report.compared {
        let distance = &compared.distance;
        let share = |x: f64| {
            format!("{} ({:.3} % of the diagonal)", rounded(x), 100.0 * x / distance.diagonal)
        };
        let both = |max, mean| format!("largest {}, mean {}", rounded(max), rounded(mean));
        let (to, from) = (&distance.to_source, &distance.from_source);
        rows.extend([
            row("source", compared.source.as_deref().unwrap_or_default()),
            row("Hausdorff", &share(distance.hausdorff)),
            row("mean", &share(distance.mean)),
            row("to source", &both(to.max, to.mean)),
            row("from source", &both(from.max, from.mean)),
            orientation_row(&compared.orientation),
        ]);
    }
    rows
}

fn quality_topology_rows(report: &QualityReport) -> Vec<String> {
    let topology = &report.topology;
    let polygons = topology.polygons.iter().map(|(&corners, &count)| match corners {
        3 => counted(count, "triangle"),
        4 => counted(count, "quad"),
        n => format!("{count} of {n} corners"),
    });
    let polygons: Vec<String> = polygons.collect();
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
    let size = format!("{}, {}", counted(topology.vertices, "vertex"), polygons.join(", "));
    let mut rows = vec![
        row("quad mesh", report.input.as_deref().unwrap_or_default()),
        row("size", &size),
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

fn quality_shape_rows(report: &QualityReport) -> [String; 2] {
    let (angles, lengths) = (&report.angles, &report.edge_lengths);
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
        rounded(lengths.min),
        rounded(lengths.max),
        rounded(lengths.mean),
        100.0 * lengths.variation
    );
    [row("angles", &text), row("edges", &edges)]
}

/// A table of measures; those that `has_star` get one at the number they are compared by.
pub(crate) fn measure_table(
    measures: &[Measurement],
    has_star: impl Fn(Measure) -> bool,
) -> Vec<String> {
    let titles =
        ["measure", "ideal", "scale", "mean", "maximum", "median", "95%", "99%"].map(str::to_owned);
    let rows = measures.iter().map(|measured| {
        let (measure, percentiles) = (measured.measure, &measured.percentiles);
        let mark = |is_compared: bool, x: f64| {
            format!("{}{}", rounded(x), if is_compared && has_star(measure) { "*" } else { " " })
        };
        table_row([
            measure.name().to_owned(),
            rounded(measured.ideal),
            if measure.has_scale() { rounded(measured.scale) } else { "-".into() },
            mark(measure.is_mean(), measured.mean),
            mark(!measure.is_mean(), measured.max),
            rounded(percentiles.p50),
            rounded(percentiles.p95),
            rounded(percentiles.p99),
        ])
    });
    std::iter::once(table_row(titles)).chain(rows).collect()
}

fn table_row([name, numbers @ ..]: [String; 8]) -> String {
    let cells: Vec<String> = numbers.iter().map(|cell| format!("{cell:>10}")).collect();
    format!("{name:<20}{}", cells.join(" "))
}
