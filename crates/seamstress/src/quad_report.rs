//! What is reported of quad meshes.

use crate::features::FeatureReport;
use crate::integer::GridReport;
use crate::options::QuadOptions;
use crate::parts::PartReport;
use crate::report::{Distortion, SurfaceReport};
use crate::sizes::SizeReport;
use crate::symmetry::SymmetryReport;
use seamstress_parametrize::map::IntegerCertificate;
use seamstress_quads::extract::{Folds, QuadCone, Snapping};
use seamstress_quads::quality::Orientation;
use seamstress_quads::{Extraction, IrregularVertex, QuadConnectivity, QuadFaults};
use seamstress_quantize::QuantizationStats;
use serde::Serialize;
use std::collections::BTreeMap;

/// How quads were made, and what they are.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuadMeshReport {
    /// The version that made them.
    pub seamstress: &'static str,
    /// The options they were made with; none for those of a map that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub options: Option<QuadOptions>,
    /// The surface.
    pub input: SurfaceReport,
    /// Its connected parts that are small, and those that failed; none for a map that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parts: Option<PartReport>,
    /// What made them symmetric, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<SymmetryReport>,
    /// Triangles of the finer mesh of the same surface that quads were made on, where features lacked room or triangles
    /// area.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finer_triangles: Option<usize>,
    /// The grid asked for and the one made.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<GridReport>,
    /// Distortion of the integer-grid map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distortion: Option<Distortion>,
    /// The sizes of cells asked for, and made, if any were.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sizes: Option<SizeReport>,
    /// What was checked of its whole numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integer_certificate: Option<IntegerCertificate>,
    /// How it was made, component by component.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub components: Option<Vec<QuantizationStats>>,
    /// The map that the quads were extracted from.
    pub map: ExtractedMap,
    /// The features asked for and what became of them.
    pub features: Option<FeatureReport>,
    /// The quads.
    pub quads: QuadReport,
    /// What untangling moved.
    pub mended: Option<Untangled>,
    /// How the quads lie to the surface.
    pub orientation: Option<Orientation>,
}

/// The map that quads were extracted from.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ExtractedMap {
    /// Its area in grid units.
    pub uv_area: f64,
    /// How far it was from exactness.
    pub snapping: Snapping,
    /// Its cones that are vertices of the quads.
    pub cones: Vec<QuadCone>,
    /// What was done where it folds.
    pub folds: Option<Folds>,
}

/// Quads in numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuadReport {
    /// Quads.
    pub count: usize,
    /// Vertices.
    pub vertices: usize,
    /// Cells that the boundary cuts, left out.
    pub trimmed: usize,
    /// Components of the surface, counted from 0 in the order of its report, in which no cell fits whole.
    pub components_without_quads: Vec<u32>,
    /// Copies made of vertices at which quads met in a point only.
    pub split_vertices: usize,
    /// Whether they are an oriented manifold.
    pub is_manifold: bool,
    /// Numbers of a manifold.
    #[serde(flatten)]
    pub topology: Option<QuadTopology>,
    /// Why they are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faults: Option<QuadFaults>,
}

/// The topology of a manifold of quads.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuadTopology {
    /// Edges.
    pub edges: usize,
    /// Vertices less edges plus quads.
    pub euler_characteristic: i64,
    /// Boundary loops.
    pub boundary_loops: usize,
    /// Connected pieces.
    pub components: usize,
    /// Interior vertices with another number of quads than four.
    pub irregular: IrregularReport,
}

/// Irregular vertices.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IrregularReport {
    /// How many.
    pub count: usize,
    /// How many of each valence.
    pub by_valence: BTreeMap<i32, usize>,
    /// Each with its index, 4 less its valence.
    pub list: Vec<IrregularVertex>,
}

/// What untangling moved.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Untangled {
    /// Vertices moved.
    pub moved: usize,
    /// The farthest move, mesh units.
    pub largest_move: f64,
}

impl QuadReport {
    pub(crate) fn new(
        components_without_quads: Vec<u32>,
        extraction: &Extraction,
        connectivity: Result<&QuadConnectivity, &QuadFaults>,
    ) -> Self {
        Self {
            components_without_quads,
            count: extraction.mesh.quads().len(),
            vertices: extraction.mesh.positions().len(),
            trimmed: extraction.trimmed,
            split_vertices: extraction.split_vertices,
            is_manifold: connectivity.is_ok(),
            topology: connectivity.ok().map(|c| QuadTopology {
                edges: c.n_edges(),
                euler_characteristic: c.euler_characteristic(),
                boundary_loops: c.n_boundary_loops(),
                components: c.connected_quads().1,
                irregular: IrregularReport::new(c.irregular_vertices()),
            }),
            faults: connectivity.err().cloned(),
        }
    }
}

impl IrregularReport {
    fn new(list: Vec<IrregularVertex>) -> Self {
        let by_valence = crate::report::counts(list.iter().map(|vertex| 4 - vertex.index));
        Self { count: list.len(), by_valence, list }
    }
}

impl ExtractedMap {
    pub(crate) fn new(extraction: &Extraction) -> Self {
        Self {
            uv_area: extraction.uv_area,
            snapping: extraction.snapping,
            cones: extraction.cones.clone(),
            folds: extraction.folds.clone(),
        }
    }
}
