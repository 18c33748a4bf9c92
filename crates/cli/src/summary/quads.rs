//! Quads that were made, and what is wrong with them.

use super::surface::{boundary_text, failed_warnings, lost_warning};
use crate::text::{counted, listing, row};
use seamstress::{Orientation, QuadMeshReport};

/// Corners turned against the source that are named; the report has them all.
const SHOWN_TURNED: usize = 3;
/// Faults of quads that are listed.
const SHOWN_FAULTS: usize = 5;

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

fn orientation_warning(orientation: &Orientation) -> Option<String> {
    let &Orientation { inverted, crossed, .. } = orientation;
    (inverted + crossed > 0).then(|| {
        let faces = counted(inverted, "face");
        format!("warning: {faces} inverted, {crossed} crossed, seen from the surface; more quads may help")
    })
}

/// How quads lie to their source.
pub(super) fn orientation_row(orientation: &Orientation) -> String {
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
