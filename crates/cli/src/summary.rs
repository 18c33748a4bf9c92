//! Summaries for people.

use crate::features::{AlignedFeatures, Features};
use crate::input::LoadedMesh;
use crate::report::{Cost, cones_by_index, tau};
use crate::text::{counted, figure, row};
use seamstress_mesh::features::NodeKind;
use seamstress_parametrize::mixed_integer::MixedIntegerStats;
use seamstress_parametrize::quality::Distortion;
use seamstress_parametrize::{Alignment, ComponentStats, SeamlessMap};

/// Released features that are listed; the report has them all.
const SHOWN_RELEASED: usize = 10;

/// Name, size and topology of a mesh.
pub(crate) fn mesh_rows(mesh: &LoadedMesh) -> Vec<String> {
    let facts = &mesh.facts;
    let counts = [
        counted(facts.n_vertices, "vertex"),
        counted(facts.n_edges, "edge"),
        counted(facts.n_faces, "triangle"),
    ];
    let genus = facts.genus().map_or("genus undefined".into(), |g| format!("genus {g}"));
    let boundary = match facts.boundary_loops() {
        0 => "closed".into(),
        n => counted(n, "boundary loop"),
    };
    let components = counted(facts.components.len(), "component");
    let characteristic = facts.euler_characteristic();
    let repaired = match mesh.repairs.len() {
        0 => String::new(),
        n => format!(", after {}", counted(n, "repair")),
    };
    let name = mesh.path.display();
    vec![
        row("mesh", &format!("{name} ({}){repaired}", mesh.format)),
        row("size", &counts.join(", ")),
        row(
            "topology",
            &format!("{components}, {genus}, {boundary}, Euler characteristic {characteristic}"),
        ),
    ]
}

/// The curves and corners of features, and where they come from.
pub(crate) fn feature_rows(features: &Features) -> Vec<String> {
    let graph = &features.graph;
    let loops = graph.n_loops();
    let mut text = format!(
        "{}: {}, {}",
        counted(features.edges.len(), "edge"),
        counted(graph.curves.len() - loops, "curve"),
        counted(loops, "loop"),
    );
    for (kind, noun) in [
        (NodeKind::Junction, "junction"),
        (NodeKind::Turn, "turn"),
        (NodeKind::OpenEnd, "open end"),
        (NodeKind::BoundaryEnd, "end on the boundary"),
    ] {
        match graph.count(kind) {
            0 => {}
            n if kind == NodeKind::BoundaryEnd && n > 1 => {
                text += &format!(", {n} ends on the boundary");
            }
            n => text += &format!(", {}", counted(n, noun)),
        }
    }
    let mut sources: Vec<String> = features
        .sources
        .iter()
        .map(|(source, edges)| format!("{source} {}", counted(*edges, "edge")))
        .collect();
    if features.align_boundary {
        let edges = counted(features.boundary_edges(), "edge");
        sources.push(format!("boundary {edges}"));
    }
    vec![row("features", &text), row("", &format!("from {}", sources.join(", ")))]
}

/// What the certificate of alignment says.
pub(crate) fn alignment_row(alignment: &Alignment) -> String {
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
pub(crate) fn aligned_rows(features: &AlignedFeatures) -> Vec<String> {
    let mut rows = vec![alignment_row(&features.alignment)];
    let released = &features.released;
    if released.is_empty() {
        return rows;
    }
    let asked = counted(features.asked.edges.len(), "edge");
    rows.push(row("released", &format!("{} of {asked} not aligned", released.len())));
    rows.extend(released.iter().take(SHOWN_RELEASED).map(|feature| {
        let [a, b] = feature.vertices;
        row("", &format!("edge {a}-{b}: {}", feature.reason))
    }));
    if released.len() > SHOWN_RELEASED {
        let more = released.len() - SHOWN_RELEASED;
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
pub(crate) fn map_rows(map: &SeamlessMap, distortion: &Distortion) -> Vec<String> {
    let certificate = map.certificate();
    let cones = cones_by_index(map.cones());
    let by_index: Vec<String> =
        cones.iter().map(|(index, count)| format!("{count} of index {index:+}")).collect();
    let cones = match map.cones().len() {
        0 => "none".into(),
        n => format!("{n}: {}", by_index.join(", ")),
    };
    let mut rows = distortion_rows(distortion);
    rows.extend([
        row("cones", &cones),
        row("seams", &counted(certificate.seam_edges, "edge")),
        row(
            "certificate",
            &format!(
                "passed: no flips, seams fit to {:.1e} mean edge lengths, angles to {:.1e} rad",
                certificate.seam_residual, certificate.angle_error
            ),
        ),
    ]);
    rows
}

/// The distortion, in two rows.
pub(crate) fn distortion_rows(distortion: &Distortion) -> Vec<String> {
    let d = distortion;
    if tau(d).is_nan() {
        return vec![row("distortion", "undefined: no triangle has an area")];
    }
    let mut rows = vec![
        row(
            "distortion",
            &format!(
                "tau {}; per triangle: median {}, 95% {}, 99% {} (1 = isometry)",
                figure(tau(d)),
                figure(d.tau_t.p50),
                figure(d.tau_t.p95),
                figure(d.tau_t.p99)
            ),
        ),
        row(
            "energy",
            &format!(
                "symmetric Dirichlet {} (4 = isometry), ARAP {}",
                figure(d.symmetric_dirichlet),
                figure(d.arap)
            ),
        ),
    ];
    if d.degenerate > 0 {
        let text =
            format!("{} without area left out of these figures", counted(d.degenerate, "triangle"));
        rows.push(row("", &text));
    }
    rows
}

/// Names and seconds of all stages.
pub(crate) fn stages(components: &[ComponentStats]) -> impl Iterator<Item = (&'static str, f64)> {
    components.iter().flat_map(|c| &c.stages).map(|lap| (lap.stage.name(), lap.seconds))
}

/// Time and memory, and what the named parts took in all.
pub(crate) fn cost_row(cost: &Cost, parts: impl Iterator<Item = (&'static str, f64)>) -> String {
    let mut stages: Vec<(&'static str, f64)> = Vec::new();
    for (name, lap) in parts {
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
