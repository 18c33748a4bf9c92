//! Reports as JSON.

use crate::args::FeatureArgs;
use crate::faults::fault_json;
use crate::input::LoadedMesh;
use crate::output::Target;
use seamstress_mesh::soup::ComponentFacts;
use seamstress_parametrize::map::{Certificate, Cone};
use seamstress_parametrize::quality::{Distortion, Summary};
use seamstress_parametrize::{Alignment, ComponentStats, SeamlessMap};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Everything about a run of `map`.
#[derive(Debug, Serialize)]
pub(crate) struct MapReport<'a> {
    pub(crate) seamstress: &'static str,
    pub(crate) command: &'static str,
    pub(crate) options: Value,
    pub(crate) input: Value,
    /// How the map of each component was made, in order of first faces.
    pub(crate) components: &'a [ComponentStats],
    #[serde(flatten)]
    pub(crate) map: Value,
    /// The features asked for and what became of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) features: Option<Value>,
    pub(crate) files: &'a [Target],
    pub(crate) cost: Cost,
}

/// What a run has cost.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Cost {
    pub(crate) wall_seconds: f64,
    /// All threads together; where the system tells.
    pub(crate) cpu_seconds: Option<f64>,
    /// Where the system tells.
    pub(crate) peak_memory_bytes: Option<u64>,
    pub(crate) threads: usize,
}

/// The input and what was found and done on reading it.
pub(crate) fn input_json(mesh: &LoadedMesh) -> Value {
    let facts = &mesh.facts;
    json!({
        "file": mesh.path.to_string_lossy(),
        "format": mesh.format.to_string(),
        "vertices_read": mesh.n_read[0],
        "polygons_read": mesh.n_read[1],
        "vertices": facts.n_vertices,
        "edges": facts.n_edges,
        "faces": facts.n_faces,
        "genus": facts.genus(),
        "boundary_loops": facts.boundary_loops(),
        "euler_characteristic": facts.euler_characteristic(),
        "components": facts.components.iter().map(component_json).collect::<Vec<_>>(),
        "coincident_vertices": facts.n_coincident_vertices,
        "bounding_box": facts.bounding_box,
        "min_edge_length": facts.min_edge_length.map(number),
        "max_edge_length": facts.max_edge_length.map(number),
        "min_angle": facts.min_angle.map(number),
        "notes": mesh.notes,
        "warnings": mesh.warnings().map(fault_json).collect::<Vec<_>>(),
        "repairs": mesh.repairs,
    })
}

fn component_json(component: &ComponentFacts) -> Value {
    json!({
        "first_face": component.first_face,
        "vertices": component.n_vertices,
        "edges": component.n_edges,
        "faces": component.n_faces,
        "genus": component.genus,
        "boundary_loops": component.boundary_loops,
        "euler_characteristic": component.euler_characteristic(),
    })
}

/// A certified map in figures.
pub(crate) fn map_json(map: &SeamlessMap, distortion: &Distortion) -> Value {
    let seams = map.seams();
    let by_matching = count(seams.iter().map(|seam| seam.matching));
    json!({
        "distortion": distortion_json(distortion),
        "cones": {
            "count": map.cones().len(),
            "by_index": cones_by_index(map.cones()),
            "list": map.cones(),
        },
        "seams": { "edges": seams.len(), "by_matching": by_matching },
        "certificate": certificate_json(map.certificate()),
    })
}

/// How many cones there are of each index.
pub(crate) fn cones_by_index(cones: &[Cone]) -> BTreeMap<i32, usize> {
    count(cones.iter().map(|cone| cone.index))
}

fn count(keys: impl Iterator<Item = i32>) -> BTreeMap<i32, usize> {
    let mut counts = BTreeMap::new();
    for key in keys {
        *counts.entry(key).or_default() += 1;
    }
    counts
}

/// What was found of features that have to be aligned.
pub(crate) fn alignment_json(alignment: &Alignment) -> Value {
    serde_json::to_value(alignment).unwrap_or_default()
}

/// The sources of features as they were given.
pub(crate) fn sources_json(args: &FeatureArgs) -> Vec<String> {
    args.features.iter().map(ToString::to_string).collect()
}

fn certificate_json(certificate: &Certificate) -> Value {
    serde_json::to_value(certificate).unwrap_or_default()
}

/// All figures of the distortion; JSON has no infinity, so that is spelled out.
pub(crate) fn distortion_json(distortion: &Distortion) -> Value {
    let mut value = serde_json::to_value(distortion).unwrap_or_default();
    // Means and percentiles over no triangle at all are undefined.
    let missing = if distortion.measured == 0 { "nan" } else { "inf" };
    spell_out(&mut value, missing);
    if let Value::Object(fields) = &mut value {
        fields.insert("tau".into(), number(tau(distortion)));
    }
    value
}

/// A measure over a map.
pub(crate) fn measure_json(summary: &Summary) -> Value {
    let mut value = serde_json::to_value(summary).unwrap_or_default();
    let missing = if summary.worst.is_none() { "nan" } else { "inf" };
    spell_out(&mut value, missing);
    value["worst"] = summary.worst.map(|face| face.0).into();
    value["ideal"] = summary.measure.ideal().into();
    value
}

/// The name that something without fields has in reports.
pub(crate) fn name_of(value: &impl Serialize) -> String {
    let value = serde_json::to_value(value).unwrap_or_default();
    value.as_str().unwrap_or_default().to_owned()
}

/// Adds the fields of an object to another.
pub(crate) fn merge(target: &mut Value, fields: Value) {
    if let (Value::Object(target), Value::Object(fields)) = (target, fields) {
        target.extend(fields);
    }
}

/// The distortion, undefined if nothing has an area.
pub(crate) fn tau(distortion: &Distortion) -> f64 {
    match (distortion.measured, distortion.flipped) {
        (0, 0) => f64::NAN,
        _ => distortion.tau,
    }
}

fn spell_out(value: &mut Value, missing: &str) {
    match value {
        Value::Null => *value = missing.into(),
        Value::Object(fields) => fields.values_mut().for_each(|v| spell_out(v, missing)),
        Value::Array(items) => items.iter_mut().for_each(|v| spell_out(v, missing)),
        _ => {}
    }
}

/// A number, or "inf", "-inf", "nan".
fn number(x: f64) -> Value {
    serde_json::Number::from_f64(x)
        .map_or_else(|| Value::from(x.to_string().to_lowercase()), Value::Number)
}

/// JSON for people and programs.
pub(crate) fn to_text(report: &impl Serialize) -> String {
    serde_json::to_string_pretty(report).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_without_a_json_form_are_spelled_out() {
        assert_eq!(number(1.5), json!(1.5));
        assert_eq!(number(f64::INFINITY), json!("inf"));
        assert_eq!(number(f64::NEG_INFINITY), json!("-inf"));
        assert_eq!(number(f64::NAN), json!("nan"));
    }
}
