//! Reports: what is known of an input and of what was made of it, as JSON for programs.
//!
//! Numbers that JSON does not have are spelled out as `"inf"`, `"-inf"` and `"nan"`.

use seamstress_mesh::soup::{ComponentFacts, Facts};
use seamstress_parametrize::map::{Cone, SeamEdge};
use seamstress_parametrize::quality::{self, Measure};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

use crate::finding::Finding;

/// The version that made a report.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// An input, and what was found and done on reading it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SurfaceReport {
    /// The file, if it was read from one.
    pub file: Option<String>,
    /// Its format.
    pub format: Option<String>,
    /// Vertices of the input.
    pub vertices_read: usize,
    /// Polygons of the input.
    pub polygons_read: usize,
    /// Vertices, after repairs.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Triangles.
    pub faces: usize,
    /// Handles of all components; none if one is no orientable manifold.
    pub genus: Option<usize>,
    /// Boundary loops of all components.
    pub boundary_loops: usize,
    /// Vertices less edges plus faces.
    pub euler_characteristic: i64,
    /// The pieces connected across edges, in order of their first faces.
    pub components: Vec<ComponentFactsReport>,
    /// Vertices in the place of another one, not counting the copies that repairs have made.
    pub coincident_vertices: usize,
    /// Smallest and largest coordinates.
    pub bounding_box: Option<[[f64; 3]; 2]>,
    /// Length of the shortest edge.
    #[serde(serialize_with = "some_number")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Number>"))]
    pub min_edge_length: Option<f64>,
    /// Length of the longest edge.
    #[serde(serialize_with = "some_number")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Number>"))]
    pub max_edge_length: Option<f64>,
    /// Smallest corner angle, radians.
    #[serde(serialize_with = "some_number")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Number>"))]
    pub min_angle: Option<f64>,
    /// Vertices that were merged into another on reading.
    pub welded_vertices: usize,
    /// The distance within which they were, mesh units, if any were looked for.
    pub weld_tolerance: Option<f64>,
    /// Edges of more than two faces that were cut apart, by vertices of the input.
    pub junction_edges: Vec<[u32; 2]>,
    /// What was changed or left out on reading.
    pub notes: Vec<String>,
    /// What is wrong but does not keep it from being a surface.
    pub warnings: Vec<Finding>,
    /// What was repaired.
    pub repairs: Vec<String>,
}

impl SurfaceReport {
    pub(crate) fn new(facts: &Facts) -> Self {
        Self {
            file: None,
            format: None,
            vertices_read: facts.n_vertices,
            polygons_read: facts.n_faces,
            vertices: facts.n_vertices,
            edges: facts.n_edges,
            faces: facts.n_faces,
            genus: facts.genus(),
            boundary_loops: facts.boundary_loops(),
            euler_characteristic: facts.euler_characteristic(),
            components: facts.components.iter().map(ComponentFactsReport::new).collect(),
            coincident_vertices: facts.n_coincident_vertices,
            bounding_box: facts.bounding_box,
            min_edge_length: facts.min_edge_length,
            max_edge_length: facts.max_edge_length,
            min_angle: facts.min_angle,
            welded_vertices: 0,
            weld_tolerance: None,
            junction_edges: Vec::new(),
            notes: Vec::new(),
            warnings: Vec::new(),
            repairs: Vec::new(),
        }
    }
}

/// A piece of an input that is connected across edges.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ComponentFactsReport {
    /// Its first face.
    pub first_face: u32,
    /// Vertices.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Triangles.
    pub faces: usize,
    /// Handles, if it is an orientable manifold.
    pub genus: Option<usize>,
    /// Boundary loops.
    pub boundary_loops: usize,
    /// Vertices less edges plus faces.
    pub euler_characteristic: i64,
}

impl ComponentFactsReport {
    fn new(facts: &ComponentFacts) -> Self {
        Self {
            first_face: facts.first_face,
            vertices: facts.n_vertices,
            edges: facts.n_edges,
            faces: facts.n_faces,
            genus: facts.genus,
            boundary_loops: facts.boundary_loops,
            euler_characteristic: facts.euler_characteristic(),
        }
    }
}

/// The distortion of a map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Distortion {
    /// Largest over smallest stretch, square root; 1 for an isometry. Infinite with flips, undefined
    /// over no area.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub tau: f64,
    /// Percentiles of a triangle's tau.
    pub tau_t: Percentiles,
    /// Largest singular value of a triangle.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub sigma_1_max: f64,
    /// Smallest singular value of a triangle.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub sigma_2_min: f64,
    /// Mean symmetric Dirichlet energy over the surface at its best scale; 4 for an isometry.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub symmetric_dirichlet: f64,
    /// Mean squared distance to rotations over the surface at its best scale; 0 for an isometry.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub arap: f64,
    /// Triangles of positive orientation, over which the means are taken.
    pub measured: usize,
    /// Triangles flipped or collapsed by the map.
    pub flipped: usize,
    /// Triangles without area on the surface, left out.
    pub degenerate: usize,
}

impl From<&quality::Distortion> for Distortion {
    fn from(d: &quality::Distortion) -> Self {
        Self {
            tau: if (d.measured, d.flipped) == (0, 0) { f64::NAN } else { d.tau },
            tau_t: (&d.tau_t).into(),
            sigma_1_max: d.sigma_1_max,
            sigma_2_min: d.sigma_2_min,
            symmetric_dirichlet: d.symmetric_dirichlet,
            arap: d.arap,
            measured: d.measured,
            flipped: d.flipped,
            degenerate: d.degenerate,
        }
    }
}

/// Median, 95th and 99th percentile over the triangles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Percentiles {
    /// Half of the triangles are below.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub p50: f64,
    /// 95 of 100 are below.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub p95: f64,
    /// 99 of 100 are below.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub p99: f64,
}

impl From<&quality::Percentiles> for Percentiles {
    fn from(p: &quality::Percentiles) -> Self {
        Self { p50: p.p50, p95: p.p95, p99: p.p99 }
    }
}

/// One measure of distortion over a map.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Measurement {
    /// The measure.
    pub measure: Measure,
    /// Its value for a triangle without distortion.
    pub ideal: f64,
    /// The factor on the UVs at which all of this was taken.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub scale: f64,
    /// Mean over the surface.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub mean: f64,
    /// The largest value.
    #[serde(serialize_with = "number")]
    #[cfg_attr(feature = "schema", schemars(with = "Number"))]
    pub max: f64,
    /// The triangle that has it.
    pub worst: Option<u32>,
    /// Percentiles over the triangles.
    pub percentiles: Percentiles,
    /// Triangles whose value is infinite.
    pub infinite: usize,
    /// The value of every triangle; not a number where the surface has no area.
    #[serde(skip)]
    pub values: Vec<f64>,
}

impl From<quality::Summary> for Measurement {
    fn from(summary: quality::Summary) -> Self {
        Self {
            measure: summary.measure,
            ideal: summary.measure.ideal(),
            scale: summary.scale,
            mean: summary.mean,
            max: summary.max,
            worst: summary.worst.map(|face| face.0),
            percentiles: (&summary.percentiles).into(),
            infinite: summary.infinite,
            values: summary.values.0,
        }
    }
}

/// Interior vertices at which the angle of a map is not a full turn.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConeReport {
    /// How many.
    pub count: usize,
    /// How many of each index, in quarters of a turn.
    pub by_index: BTreeMap<i32, usize>,
    /// Each with its index.
    pub list: Vec<Cone>,
}

impl ConeReport {
    pub(crate) fn new(cones: &[Cone]) -> Self {
        let by_index = counts(cones.iter().map(|cone| cone.index));
        Self { count: cones.len(), by_index, list: cones.to_vec() }
    }
}

/// Edges across which the UVs of a map jump.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SeamReport {
    /// How many.
    pub edges: usize,
    /// How many of each matching, quarter turns from left to right.
    pub by_matching: BTreeMap<i32, usize>,
}

impl SeamReport {
    pub(crate) fn new(seams: &[SeamEdge]) -> Self {
        Self { edges: seams.len(), by_matching: counts(seams.iter().map(|seam| seam.matching)) }
    }
}

pub(crate) fn counts(keys: impl Iterator<Item = i32>) -> BTreeMap<i32, usize> {
    let mut counts = BTreeMap::new();
    for key in keys {
        *counts.entry(key).or_default() += 1;
    }
    counts
}

/// A number as reports have it: `"inf"`, `"-inf"` and `"nan"` where JSON has none.
#[cfg(feature = "schema")]
#[derive(schemars::JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "only its schema is used")]
pub(crate) enum Number {
    Finite(f64),
    Name(NumberName),
}

/// What JSON has no number for.
#[cfg(feature = "schema")]
#[derive(schemars::JsonSchema)]
#[schemars(rename_all = "lowercase")]
#[expect(dead_code, reason = "only its schema is used")]
pub(crate) enum NumberName {
    Inf,
    #[schemars(rename = "-inf")]
    MinusInf,
    Nan,
}

/// A number, or its name where JSON has none.
pub(crate) fn number<S: Serializer>(x: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match x.is_finite() {
        true => serializer.serialize_f64(*x),
        false => serializer.serialize_str(&x.to_string().to_lowercase()),
    }
}

fn some_number<S: Serializer>(x: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match x {
        Some(x) => number(x, serializer),
        None => serializer.serialize_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_without_a_json_form_are_spelled_out() {
        let text = |x| {
            let percentiles = Percentiles { p50: x, p95: x, p99: x };
            serde_json::to_value(percentiles).unwrap()["p50"].to_string()
        };
        assert_eq!(text(1.5), "1.5");
        assert_eq!(text(f64::INFINITY), "\"inf\"");
        assert_eq!(text(f64::NEG_INFINITY), "\"-inf\"");
        assert_eq!(text(f64::NAN), "\"nan\"");
    }
}
