//! Pages of what was found of a mesh, or of a map that some program made.

use super::facts::{Facts, Places};
use super::scene::Drawing;
use super::{Page, name_of};
use crate::certify::Verdict;
use crate::features::FeatureCurves;
use crate::finding::{Finding, Severity};
use crate::inspection::Inspection;
use crate::report::VERSION;
use crate::surface::Surface;
use crate::words::counted;

impl Page {
    /// What was found of a mesh.
    #[doc(hidden)]
    pub fn of_mesh(inspection: &Inspection, features: Option<&FeatureCurves>) -> Self {
        let parts = &inspection.parts;
        let mut facts = Facts {
            kind: "Mesh",
            name: name_of(parts.input.as_deref()),
            version: VERSION,
            ..Facts::default()
        };
        let errors = inspection.findings().iter().filter(|f| f.severity == Severity::Error);
        let errors: Vec<Finding> = errors.cloned().collect();
        let places = places_of(inspection);
        facts.headline = match errors.len() {
            0 => "A mesh that can be mapped.".into(),
            n if inspection.is_repairable() => {
                format!(
                    "Not a mesh that can be mapped: {}, which can be repaired.",
                    counted(n, "fault")
                )
            }
            n => format!("Not a mesh that can be mapped: {}.", counted(n, "fault")),
        };
        let text = match errors.len() {
            0 => {
                "Its triangles form an oriented manifold: every edge has one or two, all with the same side up."
            }
            _ => {
                "Every edge should have one or two triangles, all with the same side up. Here it is not so; the notes say where."
            }
        };
        facts.claim(errors.is_empty(), "A surface", text);
        features.iter().for_each(|features| facts.features(features.report()));
        facts.findings(&errors, &places);
        facts.surface(inspection.report(), &places);
        let drawing = Drawing {
            positions: &parts.soup.positions,
            corners: parts.soup.faces.as_flattened(),
            sides: 3,
            features: features.map_or(&[], FeatureCurves::edges),
            ..Drawing::default()
        };
        Self::new(facts, inspection.report(), &drawing)
    }

    /// What was found of a map, by its UVs and the three of each face, which are those of the surface if there is a
    /// verdict.
    #[doc(hidden)]
    pub fn of_map(
        surface: &Surface,
        (uvs, face_uvs): (&[[f64; 2]], &[[u32; 3]]),
        (differences, verdict): (&[Finding], Option<&Verdict>),
        features: Option<&FeatureCurves>,
    ) -> Self {
        let places = surface.places();
        let mut facts = Facts {
            kind: "Checked map",
            name: name_of(surface.input()),
            version: VERSION,
            ..Facts::default()
        };
        let is_passed = differences.is_empty() && verdict.is_some_and(Verdict::is_passed);
        facts.headline = match is_passed {
            true => "The map passes the check.".into(),
            false => "The map fails the check.".into(),
        };
        if !differences.is_empty() {
            facts.claim(
                false,
                "A map of this mesh",
                "Its vertices or faces are not those of the mesh.",
            );
            facts.findings(differences, &places);
        }
        if let Some(verdict) = verdict {
            facts.verdict(verdict, &places);
            facts.has_grid = verdict.integral.is_some();
        }
        facts.surface(surface.report(), &places);
        let corner_uvs = verdict.and_then(|_| surface.corner_uvs(uvs, face_uvs).ok());
        let values = corner_uvs.as_ref().map(|uvs| surface.tau(uvs)).unwrap_or_default();
        let drawing = Drawing {
            positions: surface.positions(),
            corners: surface.faces().as_flattened(),
            sides: 3,
            corner_uvs: corner_uvs.as_deref(),
            values: &values,
            features: features.map_or(&[], FeatureCurves::edges),
        };
        Self::new(facts, &verdict, &drawing)
    }
}

impl Facts {
    fn verdict(&mut self, verdict: &Verdict, places: &Places) {
        match &verdict.certificate {
            Some(certificate) => self.certificate(certificate),
            None => {
                let n = counted(verdict.violations.len(), "violation");
                self.claim(false, "A seamless map", format!("{n}; the notes say where."));
                self.findings(&verdict.violations, places);
            }
        }
        verdict.alignment.iter().for_each(|alignment| self.alignment(alignment));
        if verdict.aligned == Some(false) {
            let n = counted(verdict.alignment_violations.len(), "violation");
            self.claim(false, "Features lie along the grid", format!("{n}; the notes say where."));
            self.findings(&verdict.alignment_violations, places);
        }
        verdict.integer_certificate.iter().for_each(|certificate| self.integers(certificate));
        if verdict.integral == Some(false) && verdict.certified {
            let n = counted(verdict.integer_violations.len(), "violation");
            self.claim(false, "The unit grid closes up", format!("{n}; the notes say where."));
            self.findings(&verdict.integer_violations, places);
        }
        self.distortion(&verdict.distortion);
        verdict.cones.iter().for_each(|cones| self.cones(cones));
    }
}

/// Where elements of the input are among the triangles.
fn places_of(inspection: &Inspection) -> Places {
    let parts = &inspection.parts;
    let mut places = Places::default();
    for vertex in 0..parts.soup.positions.len() as u32 {
        let origin = parts.vertex_origin.as_ref();
        let given = origin.map_or(Some(vertex), |origin| origin.get(vertex as usize).copied());
        places.vertices.extend(given.map(|given| (given, vertex)));
    }
    for (face, &given) in (0..parts.soup.faces.len() as u32).zip(&parts.face_origin) {
        places.faces.entry(given).or_insert(face);
    }
    places
}
