//! Certifying a map from a file, whatever program made it.

use crate::faults::{listing, violation_json};
use crate::features::Features;
use crate::map_file::MapFile;
use crate::report;
use crate::summary;
use crate::text::{counted, row};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::map::compare_source;
use seamstress_parametrize::quality::{Distortion, distortion};
use seamstress_parametrize::{
    Alignment, AlignmentTolerance, SeamlessMap, Tolerance, Violation, Violations,
};
use serde_json::{Value, json};
use std::path::Path;

/// Violations of each kind that are printed.
const SHOWN: usize = 20;
/// An angle to an axis, in degrees, that numbers of few digits may explain.
const FEW_DIGITS: f64 = 0.01;

/// What is to say about a map.
pub(crate) struct Verdict {
    certified: Result<SeamlessMap, Violations>,
    /// Of maps whose faces are those of the mesh.
    distortion: Option<Distortion>,
    /// Of the features asked for, if the map is certified.
    alignment: Option<Result<Alignment, Violations>>,
}

/// Certifies a map of a mesh.
pub(crate) fn judge(
    mesh: &TriangleSoup,
    connectivity: &TriMesh,
    map: MapFile,
    tolerance: &Tolerance,
) -> Verdict {
    let mut violations =
        compare_source((&mesh.positions, &mesh.faces), (&map.soup.positions, &map.soup.faces));
    if mesh.faces != map.soup.faces {
        return Verdict {
            certified: Err(Violations(violations)),
            distortion: None,
            alignment: None,
        };
    }
    let metric = Metric::from_positions(connectivity, &mesh.positions);
    let distortion = Some(distortion(connectivity, &metric, &map.corner_uvs));
    let certified = match SeamlessMap::certify(connectivity, map.corner_uvs, tolerance) {
        Ok(map) if violations.is_empty() => Ok(map),
        Ok(_) => Err(Violations(violations)),
        Err(Violations(more)) => {
            violations.extend(more);
            Err(Violations(violations))
        }
    };
    Verdict { certified, distortion, alignment: None }
}

impl Verdict {
    /// Certifies the alignment of features as well, if the map is certified.
    pub(crate) fn with_features(
        mut self,
        connectivity: &TriMesh,
        features: &Features,
        tolerance: &AlignmentTolerance,
    ) -> Self {
        let certify = |map| Alignment::certify(connectivity, map, &features.pairs, tolerance);
        self.alignment = self.certified.as_ref().ok().map(certify);
        self
    }

    /// Whether all that was asked for is certified.
    pub(crate) fn is_passed(&self) -> bool {
        self.certified.is_ok() && !matches!(self.alignment, Some(Err(_)))
    }

    pub(crate) fn json(&self, path: &Path) -> Value {
        let mut value = match (&self.certified, &self.distortion) {
            (Ok(map), Some(distortion)) => report::map_json(map, distortion),
            (_, Some(distortion)) => json!({ "distortion": report::distortion_json(distortion) }),
            (_, None) => json!({}),
        };
        let violations: &[Violation] = match &self.certified {
            Ok(_) => &[],
            Err(Violations(violations)) => violations,
        };
        value["file"] = path.to_string_lossy().into();
        value["certified"] = self.certified.is_ok().into();
        value["violations"] = violations.iter().map(violation_json).collect();
        match &self.alignment {
            Some(Ok(alignment)) => {
                value["alignment"] = report::alignment_json(alignment);
                value["aligned"] = true.into();
            }
            Some(Err(Violations(violations))) => {
                let violations: Vec<Value> = violations.iter().map(violation_json).collect();
                value["alignment"] = json!({ "violations": violations });
                value["aligned"] = false.into();
            }
            None => {}
        }
        value
    }

    pub(crate) fn rows(&self) -> Vec<String> {
        let mut rows = self.map_rows();
        match &self.alignment {
            Some(Ok(alignment)) => rows.push(summary::alignment_row(alignment)),
            Some(Err(Violations(violations))) => {
                let lines = listing(violations, SHOWN);
                rows.extend(lines.iter().map(|line| row("violation", line)));
                rows.extend(off_axis_row(violations));
                let count = counted(violations.len(), "violation");
                rows.push(row("alignment", &format!("failed: {count}")));
            }
            None => {}
        }
        rows
    }

    fn map_rows(&self) -> Vec<String> {
        match (&self.certified, &self.distortion) {
            (Ok(map), Some(distortion)) => summary::map_rows(map, distortion),
            (Ok(_), None) => Vec::new(),
            (Err(Violations(violations)), distortion) => {
                let mut rows = Vec::new();
                rows.extend(distortion.iter().flat_map(summary::distortion_rows));
                let lines = listing(violations, SHOWN);
                rows.extend(lines.iter().map(|line| row("violation", line)));
                rows.extend(tolerance_row(violations));
                let count = counted(violations.len(), "violation");
                let text = format!("failed: {count} (elements counted from 0)");
                rows.push(row("certificate", &text));
                rows
            }
        }
    }
}

/// How far the worst seam is open, and what that may come from.
fn tolerance_row(violations: &[Violation]) -> Option<String> {
    let residuals = violations.iter().filter_map(|violation| match violation {
        Violation::OpenSeam { residual, .. } => Some(*residual),
        _ => None,
    });
    let worst = residuals.max_by(f64::total_cmp)?;
    let text = format!(
        "open by up to {worst:.1e} mean edge lengths; maps written with few digits need `--tolerance`"
    );
    Some(row("seams", &text))
}

/// How far the worst feature is off, and what that may come from.
fn off_axis_row(violations: &[Violation]) -> Option<String> {
    let angles = violations.iter().filter_map(|violation| match violation {
        Violation::OffAxis { degrees, .. } => Some(*degrees),
        _ => None,
    });
    let worst = angles.max_by(f64::total_cmp)?;
    let mut text = format!("off the axes by up to {worst:.1e} degrees");
    if worst < FEW_DIGITS {
        text += "; maps written with few digits need `--alignment-tolerance`";
    }
    Some(row("features", &text))
}
