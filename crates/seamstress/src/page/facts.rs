//! What a page says: in words for people who have not met a seamless map before, and in numbers.

use crate::features::FeatureReport;
use crate::finding::{Elements, Finding, Severity};
use crate::integer::{GridReport, IntegerMapReport};
use crate::map::MapReport;
use crate::parts::PartReport;
use crate::quad_report::QuadMeshReport;
use crate::report::{ConeReport, Distortion, SurfaceReport};
use crate::words::{counted, rounded};
use seamstress_parametrize::Alignment;
use seamstress_parametrize::map::{Certificate, IntegerCertificate};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a page says beside its drawing.
#[derive(Debug, Clone, Default, Serialize)]
pub(super) struct Facts {
    /// What was made or checked.
    pub(super) kind: &'static str,
    /// The file it was made of.
    pub(super) name: String,
    pub(super) version: &'static str,
    /// The result in one sentence.
    pub(super) headline: String,
    /// What was checked.
    pub(super) claims: Vec<Claim>,
    pub(super) metrics: Vec<Metric>,
    pub(super) notes: Vec<Note>,
    /// Vertices that are not regular: cones, or those of quads with another valence than four, with their indices.
    pub(super) cones: Vec<(u32, i32)>,
    /// Edges that are not followed, by their ends, with the reasons.
    pub(super) dropped: Vec<Dropped>,
    /// Whether UVs are in units of a grid whose lines are edges of quads.
    pub(super) has_grid: bool,
}

/// Something that was checked.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Claim {
    pub(super) passed: bool,
    pub(super) title: String,
    pub(super) text: String,
}

/// A number, with what it means.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Metric {
    pub(super) name: &'static str,
    pub(super) value: String,
    pub(super) meaning: &'static str,
}

/// Something to know, with the elements of the drawing that it is about.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Note {
    pub(super) severity: Option<Severity>,
    pub(super) text: String,
    pub(super) vertices: Vec<u32>,
    pub(super) faces: Vec<u32>,
}

/// A feature edge that is not followed.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Dropped {
    pub(super) vertices: [u32; 2],
    pub(super) reason: String,
}

/// Where elements of the input are in the drawing.
#[derive(Debug, Default)]
pub(super) struct Places {
    pub(super) vertices: BTreeMap<u32, u32>,
    pub(super) faces: BTreeMap<u32, u32>,
}

impl Places {
    fn vertices(&self, elements: &Elements) -> Vec<u32> {
        let of_edges = elements.edges.as_flattened();
        let all = elements.vertices.iter().chain(of_edges);
        all.filter_map(|vertex| self.vertices.get(vertex).copied()).collect()
    }

    fn faces(&self, elements: &Elements) -> Vec<u32> {
        elements.faces.iter().filter_map(|face| self.faces.get(face).copied()).collect()
    }
}

impl Facts {
    pub(super) fn claim(&mut self, passed: bool, title: &str, text: impl Into<String>) {
        self.claims.push(Claim { passed, title: title.into(), text: text.into() });
    }

    fn metric(&mut self, name: &'static str, value: impl ToString, meaning: &'static str) {
        self.metrics.push(Metric { name, value: value.to_string(), meaning });
    }

    fn note(&mut self, text: impl Into<String>) {
        self.notes.push(Note {
            severity: None,
            text: text.into(),
            vertices: vec![],
            faces: vec![],
        });
    }

    fn found(&mut self, severity: Severity, text: &str, elements: &Elements, places: &Places) {
        let (vertices, faces) = (places.vertices(elements), places.faces(elements));
        self.notes.push(Note { severity: Some(severity), text: text.into(), vertices, faces });
    }

    /// What was found, with links to the drawing.
    pub(super) fn findings(&mut self, findings: &[Finding], places: &Places) {
        for finding in findings {
            self.found(finding.severity, &finding.message, &finding.elements, places);
        }
    }

    /// The mesh, what was found and done on reading it.
    pub(super) fn surface(&mut self, report: &SurfaceReport, places: &Places) {
        self.metric("Vertices", report.vertices, "of the triangle mesh");
        self.metric("Triangles", report.faces, "of the triangle mesh");
        if report.components.len() > 1 {
            self.metric("Components", report.components.len(), "pieces that are not connected");
        }
        if let Some(genus) = report.genus {
            self.metric("Handles", genus, "tunnels through the surface (its genus)");
        }
        self.metric(
            "Boundary loops",
            report.boundary_loops,
            "rims of holes; 0 for a closed surface",
        );
        report.notes.iter().for_each(|note| self.note(note));
        report.repairs.iter().for_each(|repair| self.note(format!("Repaired: {repair}")));
        self.findings(&report.warnings, places);
    }

    /// What makes a map seamless.
    pub(super) fn certificate(&mut self, certificate: &Certificate) {
        let faces = counted(certificate.faces, "triangle");
        self.claim(
            true,
            "No triangle is flipped or collapsed",
            format!("{faces}, each with its right side up in the plane. The test is exact: rounding cannot fool it."),
        );
        let text = match certificate.seam_edges {
            0 => "There is no seam: the map is in one piece without a cut.".into(),
            n => format!(
                "The surface is cut along {} to lie flat. The two sides of every cut fit after a turn by a multiple of \
                 90 degrees and a shift, {}. A square grid runs on across every seam without a break.",
                counted(n, "edge"),
                within(certificate.seam_residual, "of the length of the edge")
            ),
        };
        self.claim(true, "Every seam fits", text);
        let text = match certificate.cones {
            0 => "The angles around all inner vertices add up to a full turn; there is no cone."
                .into(),
            n => format!(
                "At {}, called cones, other than four squares meet; around every other vertex the map makes a full \
                 turn. All angles are right, {}, and the cones balance as the topology demands.",
                counted(n, "point"),
                within(certificate.angle_error, "radians")
            ),
        };
        self.claim(true, "Angles are multiples of 90 degrees", text);
        if certificate.overwound_boundary_vertices > 0 {
            let vertices = counted(certificate.overwound_boundary_vertices, "boundary vertex");
            self.note(format!(
                "The map overlaps itself at {vertices}, where it makes more than a full turn."
            ));
        }
    }

    pub(super) fn integers(&mut self, certificate: &IntegerCertificate) {
        let edges = counted(certificate.edges, "edge");
        self.claim(
            true,
            "The unit grid closes up",
            format!(
                "Shifts across {edges} and the places of {} are whole numbers, {}. The unit squares of the plane \
                 are therefore quads of the surface.",
                counted(certificate.integral_cones, "cone"),
                within(certificate.integral_error, "units")
            ),
        );
    }

    pub(super) fn alignment(&mut self, alignment: &Alignment) {
        let edges = counted(alignment.edges, "feature edge");
        let text = match alignment.edges {
            0 => "There is no feature edge to follow.".into(),
            _ => format!(
                "{edges} run along the grid, {}, and the angles between them are multiples of 90 degrees.",
                within(alignment.axis_error, "degrees")
            ),
        };
        self.claim(true, "Features lie along the grid", text);
    }

    /// Features that are followed, and those that are not.
    pub(super) fn features(&mut self, features: &FeatureReport) {
        features.alignment.iter().for_each(|alignment| self.alignment(alignment));
        self.metric(
            "Feature edges",
            features.edges,
            "creases, rims and other edges asked to be followed",
        );
        let Some(dropped) = &features.dropped else { return };
        self.metric(
            "Dropped features",
            dropped.len(),
            "feature edges that are not followed, with reasons",
        );
        self.dropped.extend(dropped.iter().map(|feature| Dropped {
            vertices: feature.vertices,
            reason: feature.reason.to_string(),
        }));
    }

    pub(super) fn distortion(&mut self, distortion: &Distortion) {
        let d = distortion;
        self.metric(
            "Tau",
            rounded(d.tau),
            "largest over smallest stretch of the map, square root; 1 is no distortion",
        );
        self.metric("Tau, median", rounded(d.tau_t.p50), "half of the triangles are below");
        self.metric("Tau, 99%", rounded(d.tau_t.p99), "99 of 100 triangles are below");
        let meaning = "mean energy of the distortion; 4 is no distortion";
        self.metric("Symmetric Dirichlet", rounded(d.symmetric_dirichlet), meaning);
        self.metric("ARAP", rounded(d.arap), "mean distance to a rigid motion; 0 is no distortion");
        if d.flipped > 0 {
            self.metric(
                "Flipped triangles",
                d.flipped,
                "triangles that are turned over or collapsed",
            );
        }
    }

    pub(super) fn cones(&mut self, cones: &ConeReport) {
        self.metric("Cones", cones.count, "points at which other than four squares meet");
        self.cones = cones.list.iter().map(|cone| (cone.vertex, cone.index)).collect();
    }

    fn grid(&mut self, grid: &GridReport) {
        self.metric("Grid", grid, "cells of the grid on the surface");
        self.metric(
            "Cell size",
            rounded(grid.edge_length),
            "edge length of a cell, in units of the mesh",
        );
    }

    fn parts(&mut self, parts: &PartReport, places: &Places) {
        for part in &parts.failed {
            let text = format!("{part} is left out: {}", part.message);
            self.found(Severity::Warning, &text, &part.elements, places);
        }
    }

    fn lost(&mut self, components: &[u32]) {
        if !components.is_empty() {
            let n = counted(components.len(), "component");
            self.note(format!("{n} too small for a whole cell: no quads there"));
        }
    }
}

/// How well something fits.
fn within(error: f64, of: &str) -> String {
    match error {
        0.0 => "exactly".into(),
        error => format!("to within {error:.1e} {of}"),
    }
}

/// What a page says of a kind of map.
#[doc(hidden)]
pub trait Explained {
    /// Adds it.
    fn explain(&self, facts: &mut PageFacts);
}

/// The facts of a page and where elements of the input are in its drawing.
#[doc(hidden)]
#[derive(Debug)]
pub struct PageFacts {
    pub(super) facts: Facts,
    pub(super) places: Places,
}

impl Explained for MapReport {
    fn explain(&self, page: &mut PageFacts) {
        let PageFacts { facts, places } = page;
        facts.kind = "Seamless map";
        facts.headline = format!(
            "A certified seamless map: {}, largest distortion {} (1 is none).",
            counted(self.cones.count, "cone"),
            rounded(self.distortion.tau)
        );
        facts.certificate(&self.certificate);
        facts.distortion(&self.distortion);
        facts.cones(&self.cones);
        self.features.iter().for_each(|features| facts.features(features));
        facts.surface(&self.input, places);
    }
}

impl Explained for IntegerMapReport {
    fn explain(&self, page: &mut PageFacts) {
        let PageFacts { facts, places } = page;
        facts.kind = "Integer-grid map";
        facts.has_grid = true;
        facts.headline = format!(
            "A certified integer-grid map: {}, {}.",
            self.grid,
            counted(self.cones.count, "cone")
        );
        facts.certificate(&self.certificate);
        facts.integers(&self.integer_certificate);
        facts.grid(&self.grid);
        facts.distortion(&self.distortion);
        facts.cones(&self.cones);
        self.features.iter().for_each(|features| facts.features(features));
        facts.parts(&self.parts, places);
        facts.lost(&self.components_without_quads);
        facts.surface(&self.input, places);
    }
}

impl Explained for QuadMeshReport {
    fn explain(&self, page: &mut PageFacts) {
        let PageFacts { facts, places } = page;
        let quads = &self.quads;
        facts.kind = "Quad mesh";
        let irregular = quads.topology.as_ref().map(|topology| &topology.irregular);
        let count = counted(quads.count, "quad");
        facts.headline = match irregular {
            Some(irregular) => {
                format!("{count} with {}.", counted(irregular.count, "irregular vertex"))
            }
            None => format!("{count}, not a manifold."),
        };
        match &quads.faults {
            None => facts.claim(
                true,
                "Quads only, properly joined",
                format!(
                    "{count} on {}. Every edge has one or two quads, and those around a vertex form one fan: an \
                     oriented manifold.",
                    counted(quads.vertices, "vertex")
                ),
            ),
            Some(faults) => facts.claim(false, "The quads are no manifold", faults.to_string()),
        }
        self.integer_certificate.iter().for_each(|certificate| facts.integers(certificate));
        if let Some(orientation) = &self.orientation {
            let bad = orientation.inverted + orientation.crossed;
            let text = match bad {
                0 => "Seen from the surface, no quad is turned over and no two of its sides cross."
                    .into(),
                _ => format!("{} inverted, {} crossed", orientation.inverted, orientation.crossed),
            };
            facts.claim(bad == 0, "Quads face outwards", text);
        }
        facts.metric("Quads", quads.count, "of the result");
        self.grid.iter().for_each(|grid| facts.grid(grid));
        if let Some(irregular) = irregular {
            let by_valence = irregular.by_valence.iter();
            let list: Vec<String> =
                by_valence.map(|(v, n)| format!("{n} of valence {v}")).collect();
            let value = match list.len() {
                0 => "none".into(),
                _ => list.join(", "),
            };
            facts.metric("Irregular vertices", value, "inner vertices with other than four quads");
            facts.cones = irregular.list.iter().map(|v| (v.vertex, v.index)).collect();
        }
        self.distortion.iter().for_each(|distortion| facts.distortion(distortion));
        self.features.iter().for_each(|features| facts.features(features));
        if quads.trimmed > 0 {
            facts.note(format!("{} cut by the boundary left out", counted(quads.trimmed, "cell")));
        }
        self.parts.iter().for_each(|parts| facts.parts(parts, places));
        facts.lost(&quads.components_without_quads);
        facts.surface(&self.input, places);
    }
}
