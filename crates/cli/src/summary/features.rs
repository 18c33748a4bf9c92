//! Features, and whether they are aligned.

use crate::text::{counted, row};
use seamstress::{Alignment, FeatureReport};

/// Dropped features that are listed; the report has them all.
const SHOWN_DROPPED: usize = 10;

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
