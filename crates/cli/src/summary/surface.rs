//! What a mesh is, and what became of its parts.

use crate::text::{as_options, counted, listing, rounded, row};
use seamstress::{FailedPart, PartReport, SurfaceReport, SymmetryReport};

/// Components without quads that are named; the report has them all.
const SHOWN_LOST: usize = 5;

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

pub(super) fn boundary_text(loops: usize) -> String {
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
