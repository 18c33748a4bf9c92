//! Distortion, cones, seams and certificates of maps.

use crate::text::{counted, rounded, row};
use seamstress::{
    Certificate, ComponentStats, ConeReport, Distortion, IntegerCertificate, MapReport,
    MixedIntegerStats, PackingReport, SizeReport,
};

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
