//! Maps with how they were made.

use crate::features::ReleasedFeature;
use crate::layout::route::Route;
use crate::map::{Alignment, SeamlessMap};
use crate::mixed_integer::MixedIntegerStats;
use crate::progress::Stage;
use crate::quality::Distortion;
use seamstress_mesh::features::EdgeSet;

/// A certified map and how it was made.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct MapSolution {
    /// The map; UVs in mesh units.
    pub map: SeamlessMap,
    /// Its distortion.
    pub distortion: Distortion,
    /// The edges that run along the axes: every feature edge asked for that was not released.
    pub features: EdgeSet,
    /// The certificate of their alignment.
    pub alignment: Alignment,
    /// Feature edges that could not be aligned, component by component.
    pub released: Vec<ReleasedFeature>,
    /// One entry per connected component, in order of first faces.
    pub components: Vec<ComponentStats>,
}

/// How the map of one component was made.
#[derive(Debug, Clone, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ComponentStats {
    /// Faces.
    pub faces: usize,
    /// Genus.
    pub genus: i64,
    /// Boundary loops.
    pub boundary_loops: usize,
    /// Route of the final layout.
    pub route: Route,
    /// How much longer every edge was made to find the map, mean edge lengths: 0 unless triangles are degenerate.
    pub lengthening: f64,
    /// Rounds of the rounding loop.
    pub rounding_rounds: usize,
    /// Seams shifted to make indices possible or matchings consistent.
    pub repaired_seams: usize,
    /// How mixed-integer rounding went, where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixed_integer: Option<MixedIntegerStats>,
    /// Seconds and iterations by stage.
    pub stages: Vec<StageStats>,
}

/// Cost of one stage.
#[derive(Debug, Clone, Copy, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct StageStats {
    /// The stage.
    pub stage: Stage,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Layouts or Newton iterations.
    pub iterations: usize,
}
