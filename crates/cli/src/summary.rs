//! Summaries for people: rows of a label and a text.

use crate::job::Cost;
use crate::text::{as_options, counted, listing, rounded, row};
use seamstress::{
    Alignment, Certificate, ComponentStats, ConeReport, Distortion, FailedPart, FeatureReport,
    IntegerCertificate, MapReport, Measure, Measurement, MixedIntegerStats, Orientation,
    PackingReport, PartReport, QuadMeshReport, QualityReport, SizeReport, SurfaceReport,
    SymmetryReport,
};

/// Dropped features that are listed; the report has them all.
const SHOWN_DROPPED: usize = 10;
/// Components without quads that are named; the report has them all.
const SHOWN_LOST: usize = 5;
/// Corners turned against the source that are named; the report has them all.
const SHOWN_TURNED: usize = 3;
/// Faults of quads that are listed.
const SHOWN_FAULTS: usize = 5;

/// Name, size and topology of a mesh.
pub(crate) fn surface_rows(report: &SurfaceReport) -> Vec<String> {
    let counts = [
        counted(report.vertices, "vertex"),
        counted(report.edges, "edge"),
        counted(report.faces, "triangle"),
    ];
    let genus = report.genus.map_or("genus undefined".into(), |g| format!("genus {g}"));
    let boundary = boundary_text(report.boundary_loops);
    let components = counted(report.components.len(), "component");
    let repaired = match report.repairs.len() {
        0 => String::new(),
        n => format!(", after {}", counted(n, "repair")),
    };
    let name = report.file.as_deref().unwrap_or_default();
    let format = report.format.iter().map(|format| format!(" ({format})")).collect::<String>();
    let euler = format!("Euler characteristic {}", report.euler_characteristic);
    vec![
        row("mesh", &format!("{name}{format}{repaired}")),
        row("size", &counts.join(", ")),
        row("topology", &[components, genus, boundary, euler].join(", ")),
    ]
}

fn boundary_text(loops: usize) -> String {
    match loops {
        0 => "closed".into(),
        n => counted(n, "boundary loop"),
    }
}

/// Edge lengths and angles of a mesh.
pub(crate) fn size_rows(report: &SurfaceReport) -> Option<String> {
    let (shortest, longest) = (report.min_edge_length?, report.max_edge_length?);
    let mut text = format!("edges of {} to {}", rounded(shortest), rounded(longest));
    if let Some(angle) = report.min_angle {
        text += &format!(", smallest angle {} degrees", rounded(angle.to_degrees()));
    }
    Some(row("shape", &text))
}

/// The charts in the unit square.
pub(crate) fn packing_rows(report: &PackingReport) -> Vec<String> {
    let cut = match report.overlapping.len() {
        0 => String::new(),
        n => format!(", cut from {} since {} overlap", report.islands, counted(n, "triangle")),
    };
    let charts = counted(report.charts, "chart");
    let texture = format!("{0} by {0} texels, {1} between charts", report.texels, report.margin);
    let density = rounded(report.density);
    let covered = 100.0 * report.covered;
    vec![
        row("charts", &format!("{charts}{cut}")),
        row(
            "texture",
            &format!("{texture}; {density} texels a unit of length, {covered:.0} % covered"),
        ),
    ]
}

/// The planes of symmetry.
pub(crate) fn symmetry_rows(report: &SymmetryReport) -> Vec<String> {
    let planes = report.planes.iter().map(|plane| {
        let what = if plane.of_polygons { "polygons" } else { "shape" };
        format!("{what} to {} at {plane}", rounded(plane.error))
    });
    let split = counted(report.split_triangles, "triangle");
    let made =
        format!("made on {}, with {split} split", counted(report.side_triangles, "triangle"));
    let texts: Vec<String> = planes.chain([made]).collect();
    let labels = ["symmetry"].into_iter().chain(std::iter::repeat(""));
    labels.zip(&texts).map(|(label, text)| row(label, text)).collect()
}

/// The curves and corners of features, and where they come from.
pub(crate) fn feature_rows(report: &FeatureReport) -> Vec<String> {
    let mut text = format!(
        "{}: {}, {}",
        counted(report.edges, "edge"),
        counted(report.curves.len() - report.loops, "curve"),
        counted(report.loops, "loop"),
    );
    let nodes = [
        (report.junctions, "junction", "junctions"),
        (report.turns, "turn", "turns"),
        (report.open_ends, "open end", "open ends"),
        (report.boundary_ends, "end on the boundary", "ends on the boundary"),
    ];
    for (count, one, many) in nodes {
        match count {
            0 => {}
            1 => text += &format!(", 1 {one}"),
            n => text += &format!(", {n} {many}"),
        }
    }
    let mut sources: Vec<String> = report
        .sources
        .iter()
        .map(|source| format!("{} {}", source.source, counted(source.edges, "edge")))
        .collect();
    if report.align_boundary {
        sources.push(format!("boundary {}", counted(report.boundary_edges, "edge")));
    }
    vec![row("features", &text), row("", &format!("from {}", sources.join(", ")))]
}

/// What the certificate of alignment says.
pub(crate) fn alignment_row(alignment: &Alignment) -> String {
    if alignment.edges == 0 {
        return row("alignment", "no edge is aligned");
    }
    let text = format!(
        "passed: {} within {:.1e} degrees of an axis ({} of {} sides exact), {} of whole quarter \
         turns to {:.1e} rad",
        counted(alignment.edges, "edge"),
        alignment.axis_error,
        alignment.exact_sides,
        alignment.sides,
        counted(alignment.sectors, "sector"),
        alignment.sector_error
    );
    row("alignment", &text)
}

/// The certificate of alignment, and the features that are not aligned.
pub(crate) fn aligned_rows(features: &FeatureReport) -> Vec<String> {
    let mut rows: Vec<String> = features.alignment.iter().map(alignment_row).collect();
    let dropped = features.dropped.as_deref().unwrap_or_default();
    if dropped.is_empty() {
        return rows;
    }
    let asked = counted(features.edges, "edge");
    rows.push(row("dropped", &format!("{} of {asked} not aligned", dropped.len())));
    rows.extend(dropped.iter().take(SHOWN_DROPPED).map(|feature| {
        let [a, b] = feature.vertices;
        row("", &format!("edge {a}-{b}: {}", feature.reason))
    }));
    if dropped.len() > SHOWN_DROPPED {
        let more = dropped.len() - SHOWN_DROPPED;
        rows.push(row("", &format!("and {more} more; the report has them all")));
    }
    rows
}

/// How mixed-integer rounding went, if there was any.
pub(crate) fn mixed_integer_rows(components: &[ComponentStats]) -> Vec<String> {
    let stats: Vec<&MixedIntegerStats> =
        components.iter().filter_map(|c| c.mixed_integer.as_ref()).collect();
    let batches: Vec<_> = stats.iter().flat_map(|stats| &stats.batches).collect();
    if batches.is_empty() {
        return Vec::new();
    }
    let integers: usize = batches.iter().map(|batch| batch.integers).sum();
    let proven = batches.iter().filter(|batch| batch.proven).count();
    let mut text = format!(
        "{} in {}, {proven} of them proven, {} solved",
        counted(integers, "variable"),
        counted(batches.len(), "group"),
        counted(stats.iter().map(|stats| stats.nodes()).sum(), "program"),
    );
    let worst = batches.iter().filter_map(|batch| Some((batch.tau?, batch.bound)));
    if let Some((tau, bound)) = worst.max_by(|a, b| a.0.total_cmp(&b.0)) {
        text += &format!("; worst tau {tau:.4}, its bound {bound:.4}");
    }
    let left: usize = stats.iter().map(|stats| stats.left_to_nearest).sum();
    if left > 0 {
        text += &format!("; {} rounded to the nearest", counted(left, "matching"));
    }
    vec![row("integers", &text)]
}

/// Distortion, cones, seams and certificate of a map.
pub(crate) fn map_rows(map: &MapReport) -> Vec<String> {
    let mut rows = distortion_rows(&map.distortion);
    rows.extend(map.sizes.iter().flat_map(cell_size_rows));
    rows.extend(certificate_rows(&map.cones, &map.certificate));
    rows
}

/// Cones, seams and certificate of a map.
pub(crate) fn certificate_rows(cones: &ConeReport, certificate: &Certificate) -> Vec<String> {
    let by_index: Vec<String> =
        cones.by_index.iter().map(|(index, count)| format!("{count} of index {index:+}")).collect();
    let cones = match cones.count {
        0 => "none".into(),
        n => format!("{n}: {}", by_index.join(", ")),
    };
    let mut rows = vec![
        row("cones", &cones),
        row("seams", &counted(certificate.seam_edges, "edge")),
        row(
            "certificate",
            &format!(
                "passed: no flips, seams fit to {:.1e} edge lengths, angles to {:.1e} rad",
                certificate.seam_residual, certificate.angle_error
            ),
        ),
    ];
    if certificate.overwound_boundary_vertices > 0 {
        let vertices = counted(certificate.overwound_boundary_vertices, "boundary vertex");
        let text = "where the map turns by more than a full turn, and overlaps itself";
        rows.push(row("", &format!("{vertices} {text}")));
    }
    rows
}

/// The distortion, in two rows.
pub(crate) fn distortion_rows(d: &Distortion) -> Vec<String> {
    if d.tau.is_nan() {
        return vec![row("distortion", "undefined: no triangle has an area")];
    }
    let mut rows = vec![
        row(
            "distortion",
            &format!(
                "tau {}; per triangle: median {}, 95% {}, 99% {} (1 = isometry)",
                rounded(d.tau),
                rounded(d.tau_t.p50),
                rounded(d.tau_t.p95),
                rounded(d.tau_t.p99)
            ),
        ),
        row(
            "energy",
            &format!(
                "symmetric Dirichlet {} (4 = isometry), ARAP {}",
                rounded(d.symmetric_dirichlet),
                rounded(d.arap)
            ),
        ),
    ];
    if d.degenerate > 0 {
        let triangles = counted(d.degenerate, "triangle");
        rows.push(row("", &format!("{triangles} without area left out of these metrics")));
    }
    rows
}

/// The sizes of cells asked for and made.
pub(crate) fn cell_size_rows(sizes: &SizeReport) -> Vec<String> {
    let d = &sizes.distortion;
    let text = format!(
        "counted in these sizes tau {}, symmetric Dirichlet {}",
        rounded(d.tau),
        rounded(d.symmetric_dirichlet)
    );
    vec![row("sizes", &sizes.to_string()), row("", &text)]
}

/// What is integral.
pub(crate) fn integers_row(certificate: &IntegerCertificate) -> String {
    let how = match certificate.integral_error {
        0.0 => "exact".into(),
        error => format!("to within {error:.1e} grid units"),
    };
    let mut text = format!(
        "{how} across {}, at {}",
        counted(certificate.edges, "edge"),
        counted(certificate.integral_cones, "cone")
    );
    if certificate.isoline_edges > 0 {
        text += &format!(
            ", {} and {}",
            counted(certificate.integral_corners, "corner"),
            counted(certificate.isoline_edges, "aligned edge")
        );
    }
    row("integers", &text)
}

/// Quads, their topology, what was left out, and how they lie to their source.
pub(crate) fn quad_rows(report: &QuadMeshReport) -> Vec<String> {
    let (map, quads) = (&report.map, &report.quads);
    let text = format!(
        "{:.4} grid cells, {}; made exact by moving UVs by up to {:.1e} grid units",
        map.uv_area,
        counted(map.cones.len(), "cone"),
        map.snapping.largest_change
    );
    let mut rows = Vec::new();
    if let Some(triangles) = report.finer_triangles {
        let text = format!(
            "made on {triangles} triangles of the same surface, where features lacked room"
        );
        rows.push(row("refined", &text));
    }
    rows.extend([row("map", &text), row("quads", &quads.count.to_string())]);
    if let Some(topology) = &quads.topology {
        let text = format!(
            "{}, {}, {}, Euler characteristic {}",
            counted(quads.vertices, "vertex"),
            counted(topology.components, "component"),
            boundary_text(topology.boundary_loops),
            topology.euler_characteristic
        );
        let irregular = &topology.irregular;
        let by_valence = irregular.by_valence.iter();
        let by_valence: Vec<String> =
            by_valence.map(|(valence, count)| format!("{count} of valence {valence}")).collect();
        let irregular = match irregular.count {
            0 => "none".into(),
            n => format!("{n}: {}", by_valence.join(", ")),
        };
        rows.extend([row("manifold", &text), row("irregular", &irregular)]);
    }
    if let Some(faults) = &quads.faults {
        let faults: Vec<String> = faults.0.iter().map(ToString::to_string).collect();
        rows.extend(listing(&faults, SHOWN_FAULTS).iter().map(|fault| row("fault", fault)));
    }
    if quads.trimmed > 0 {
        rows.push(row(
            "left out",
            &format!("{} cut by the boundary", counted(quads.trimmed, "cell")),
        ));
    }
    rows.extend(folds_text(report).map(|text| row("folds", &text)));
    let moved = report.mended.filter(|untangled| untangled.moved > 0);
    rows.extend(moved.map(|untangled| {
        let vertices = counted(untangled.moved, "vertex");
        row("untangled", &format!("{vertices} of badly shaped quads moved along the surface"))
    }));
    rows.extend(report.orientation.iter().map(orientation_row));
    rows
}

fn folds_text(report: &QuadMeshReport) -> Option<String> {
    let folds = report.map.folds.as_ref()?;
    Some(format!(
        "the map folds: {} and {} collapsed; {} lost, {} merged",
        counted(folds.flipped.len(), "flipped face"),
        folds.collapsed.len(),
        counted(folds.lost, "cell"),
        counted(folds.merged, "grid point"),
    ))
}

/// What quads lack, and what is wrong with them, as notes and warnings.
pub(crate) fn quad_warnings(report: &QuadMeshReport) -> Vec<String> {
    let quads = &report.quads;
    let mut lines = Vec::new();
    if quads.trimmed > 0 {
        lines
            .push(format!("note: {} cut by the boundary left out", counted(quads.trimmed, "cell")));
    }
    if quads.split_vertices > 0 {
        let vertices = counted(quads.split_vertices, "vertex");
        lines.push(format!("note: {vertices} added where quads met in a point only"));
    }
    lines.extend(report.parts.iter().flat_map(failed_warnings));
    lines.extend(lost_warning(&report.input, &report.quads.components_without_quads));
    lines.extend(folds_text(report).map(|text| format!("warning: {text}")));
    lines.extend(report.orientation.as_ref().and_then(orientation_warning));
    lines
}

/// Parts that failed, each with the reason and what may help.
pub(crate) fn failed_warnings(parts: &PartReport) -> Vec<String> {
    let warning = |part: &FailedPart| {
        let mut text = format!("warning: {part} is left out: {}", as_options(&part.message));
        if let Some(hint) = &part.hint {
            text += &format!("\nhint: {}", as_options(hint));
        }
        text
    };
    parts.failed.iter().map(warning).collect()
}

/// Small parts and parts that failed.
pub(crate) fn part_rows(parts: &PartReport) -> Vec<String> {
    let mut rows = Vec::new();
    if parts.small > 0 {
        let faces = counted(parts.small_faces, "face");
        let what = match parts.small_left_out {
            true => "left out",
            false => "each with a few cells of its own size",
        };
        let text = format!("{} smaller than a cell, of {faces}: {what}", parts.small);
        rows.push(row("small parts", &text));
    }
    let names: Vec<String> = parts.failed.iter().map(ToString::to_string).collect();
    let names = listing(&names, SHOWN_LOST);
    if !names.is_empty() {
        rows.push(row("failed", &format!("{}; left out", names.join(", "))));
    }
    rows
}

/// Components without quads, and what may give them some.
pub(crate) fn lost_warning(input: &SurfaceReport, lost: &[u32]) -> Option<String> {
    let all = &input.components;
    if lost.is_empty() {
        return None;
    }
    let components: Vec<_> = lost.iter().filter_map(|&c| Some((c, all.get(c as usize)?))).collect();
    let faces: usize = components.iter().map(|(_, component)| component.faces).sum();
    let mut named: Vec<String> = components
        .iter()
        .take(SHOWN_LOST)
        .map(|(c, component)| format!("{c} (from triangle {})", component.first_face))
        .collect();
    if components.len() > SHOWN_LOST {
        named.push("...".into());
    }
    let weld = match input.coincident_vertices {
        0 => "",
        _ => ", or `--weld` if pieces should be joined",
    };
    Some(format!(
        "warning: {} of {} have no quads, since no cell fits into them whole: {}; they have {} of {}\n\
         hint: try more quads or `--align-boundary`{weld}",
        lost.len(),
        counted(all.len(), "component"),
        named.join(", "),
        faces,
        counted(input.faces, "triangle"),
    ))
}

fn orientation_warning(orientation: &Orientation) -> Option<String> {
    let &Orientation { inverted, crossed, .. } = orientation;
    (inverted + crossed > 0).then(|| {
        let faces = counted(inverted, "face");
        format!("warning: {faces} inverted, {crossed} crossed, seen from the surface; more quads may help")
    })
}

/// How quads lie to their source.
pub(crate) fn orientation_row(orientation: &Orientation) -> String {
    let corners = counted(orientation.turned_corners, "corner");
    let named = orientation.turned.iter().map(|[face, v]| format!("vertex {v} in face {face}"));
    let named = listing(&named.collect::<Vec<_>>(), SHOWN_TURNED).join(", ");
    let named = if named.is_empty() { named } else { format!(" ({named})") };
    let bent = match orientation.bent {
        0 => String::new(),
        n => format!("; {} bent over a thin sheet or sharp edge", counted(n, "face")),
    };
    let text = match orientation.inverted + orientation.crossed {
        0 => format!("no face is inverted; {corners} turned against the source{named}{bent}"),
        _ => format!(
            "{} inverted, {} crossed; {corners} turned against the source{named}{bent}",
            counted(orientation.inverted, "face"),
            orientation.crossed
        ),
    };
    row("orientation", &text)
}

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

/// Names and seconds of all stages.
pub(crate) fn stages(components: &[ComponentStats]) -> Vec<(&'static str, f64)> {
    let laps = components.iter().flat_map(|c| &c.stages);
    laps.map(|lap| (lap.stage.name(), lap.seconds)).collect()
}

/// Time and memory, and what the named parts took in all.
pub(crate) fn cost_row(cost: &Cost, parts: &[(&'static str, f64)]) -> String {
    let mut stages: Vec<(&'static str, f64)> = Vec::new();
    for &(name, lap) in parts {
        match stages.iter_mut().find(|(known, _)| *known == name) {
            Some((_, seconds)) => *seconds += lap,
            None => stages.push((name, lap)),
        }
    }
    let stages: Vec<String> =
        stages.iter().map(|(name, seconds)| format!("{name} {seconds:.2}")).collect();
    let mut text = format!("{:.2} s", cost.wall_seconds);
    if !stages.is_empty() {
        text += &format!(" ({})", stages.join(", "));
    }
    text += &format!(", {}", counted(cost.threads, "thread"));
    if let Some(cpu) = cost.cpu_seconds {
        text += &format!(", {cpu:.2} s of CPU");
    }
    if let Some(bytes) = cost.peak_memory_bytes {
        text += &format!(", {} MB", bytes.div_ceil(1_000_000));
    }
    row("time", &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faulty_quads_are_reported() {
        let mut orientation = Orientation::default();
        (orientation.bent, orientation.turned_corners) = (1, 4);
        orientation.turned = vec![[7, 2], [7, 3], [9, 0], [11, 1]];
        assert_eq!(orientation_warning(&orientation), None);
        let text = orientation_row(&orientation);
        assert!(text.ends_with(
            "no face is inverted; 4 corners turned against the source (vertex 2 in face 7, vertex 3 in face 7, vertex 0 in face 9, and 1 more); \
             1 face bent over a thin sheet or sharp edge"
        ));
        (orientation.inverted, orientation.crossed) = (2, 1);
        let warning = orientation_warning(&orientation);
        assert!(warning.is_some_and(|text| text.contains("2 faces inverted, 1 crossed")));
        assert!(orientation_row(&orientation).contains("2 faces inverted, 1 crossed"));
    }
}
