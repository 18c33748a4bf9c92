//! What `map` has made: a certified map, or a layout that is none and says so.

use crate::faults::{listing, violation_json};
use crate::report;
use crate::summary;
use crate::text::{counted, row};
use crate::writers::Written;
use seamstress_parametrize::map::Cone;
use seamstress_parametrize::quality::Distortion;
use seamstress_parametrize::{
    ComponentStats, FieldMap, MapSolution, SeamlessMap, UncertifiedMap, Violation, Violations,
};
use serde_json::{Value, json};

/// Violations of each kind that are named.
const SHOWN: usize = 5;

/// A map or layout of a mesh.
pub(crate) struct Made {
    map: Result<SeamlessMap, UncertifiedMap>,
    /// Of the field, where there is no map.
    field_cones: Vec<Cone>,
    pub(crate) distortion: Distortion,
    pub(crate) components: Vec<ComponentStats>,
}

impl From<MapSolution> for Made {
    fn from(solution: MapSolution) -> Self {
        Self {
            map: Ok(solution.map),
            field_cones: Vec::new(),
            distortion: solution.distortion,
            components: solution.components,
        }
    }
}

impl From<FieldMap> for Made {
    fn from(made: FieldMap) -> Self {
        Self {
            map: made.map,
            field_cones: made.field_cones,
            distortion: made.distortion,
            components: made.components,
        }
    }
}

impl Made {
    pub(crate) fn certified(&self) -> Option<&SeamlessMap> {
        self.map.as_ref().ok()
    }

    pub(crate) fn violations(&self) -> Option<&Violations> {
        self.map.as_ref().err().map(|layout| &layout.violations)
    }

    pub(crate) fn cones(&self) -> &[Cone] {
        match &self.map {
            Ok(map) => map.cones(),
            Err(_) => &self.field_cones,
        }
    }

    /// The map as it is written.
    pub(crate) fn written(&self) -> Written<'_> {
        match &self.map {
            Ok(map) => Written::certified(map, &self.distortion),
            Err(layout) => Written {
                title: "Uncertified layout of a cross field (triangles are flipped)",
                corner_uvs: &layout.corner_uvs,
                cones: &self.field_cones,
                distortion: &self.distortion,
            },
        }
    }

    /// The map's part of the report.
    pub(crate) fn json(&self) -> Value {
        match &self.map {
            Ok(map) => report::map_json(map, &self.distortion),
            Err(UncertifiedMap { violations: Violations(violations), .. }) => json!({
                "distortion": report::distortion_json(&self.distortion),
                "cones": {
                    "count": self.field_cones.len(),
                    "by_index": report::cones_by_index(&self.field_cones),
                    "list": self.field_cones,
                },
                "certificate": Value::Null,
                "violations": violations.iter().map(violation_json).collect::<Vec<_>>(),
            }),
        }
    }

    /// The map's part of the summary.
    pub(crate) fn rows(&self) -> Vec<String> {
        match &self.map {
            Ok(map) => summary::map_rows(map, &self.distortion),
            Err(layout) => {
                let mut rows = summary::distortion_rows(&self.distortion);
                rows.push(row("cones", &counted(self.field_cones.len(), "cone")));
                rows.push(row("certificate", &format!("none: {}", named(&layout.violations))));
                rows
            }
        }
    }
}

/// Counts violations and names some of each kind.
pub(crate) fn named(Violations(violations): &Violations) -> String {
    let is_flip = |v: &&Violation| {
        matches!(v, Violation::FlippedTriangle { .. } | Violation::CollapsedTriangle { .. })
    };
    let flips = violations.iter().filter(is_flip).count();
    let counts = format!(
        "{} flipped or collapsed and {} (elements counted from 0)",
        counted(flips, "triangle"),
        counted(violations.len() - flips, "other violation")
    );
    std::iter::once(counts).chain(listing(violations, SHOWN)).collect::<Vec<_>>().join("\n  ")
}
