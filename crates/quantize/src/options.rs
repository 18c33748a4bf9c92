//! What is asked for.

use seamstress_parametrize::map::Tolerance;

/// How fine the grid is to be.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum GridSize {
    /// About so many quads in all.
    Quads(f64),
    /// Mesh units per grid unit: the mean edge length of the quads.
    EdgeLength(f64),
    /// Grid units per mesh unit.
    Scale(f64),
}

impl GridSize {
    /// The number.
    pub fn value(self) -> f64 {
        match self {
            Self::Quads(x) | Self::EdgeLength(x) | Self::Scale(x) => x,
        }
    }

    /// Edge length of a cell on a surface with the area of a square of this side, both in mesh units.
    pub fn cell(self, side: f64) -> f64 {
        match self {
            Self::Quads(quads) => side / quads.sqrt(),
            Self::EdgeLength(length) => length,
            Self::Scale(scale) => 1.0 / scale,
        }
    }
}

/// How the integers are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RoundingMethod {
    /// The closest vector in the symmetric Dirichlet energy that keeps all connections of cones, and a
    /// path there without flips. A finer grid where there is none.
    #[default]
    Constrained,
    /// One coordinate after the other in the energy that preserves Jacobians (Levi 2021, suppl. sec. 8; Bommes et al.
    /// 2009). Often flips triangles; such a map is refused. For comparison.
    Greedy,
}

/// Settings of [`crate::quantize`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantizeOptions {
    /// How fine the grid is to be.
    pub size: GridSize,
    /// How the integers are chosen.
    pub rounding: RoundingMethod,
    /// How much the directions of the map count against its lengths, from 0 to 1: what [`MapOptions::alignment`] was.
    ///
    /// [`MapOptions::alignment`]: seamstress_parametrize::MapOptions::alignment
    pub alignment: f64,
    /// Tolerance of the certificate of the seamless map in it; what is integral is so exactly.
    pub tolerance: Tolerance,
    /// Tolerance of the map it is made from, and of the alignment there.
    pub given: Tolerance,
    /// Work that a component is worth on all grids, in passes of roundings of usual size; what moves along paths take counts
    /// as so many of these. When it is spent, the best map so far is the result.
    pub effort: usize,
}

/// Work that a component is worth: several times what the hardest meshes measured took to a first map.
const EFFORT: usize = 250;

impl Default for QuantizeOptions {
    fn default() -> Self {
        Self {
            size: GridSize::Quads(5000.0),
            rounding: RoundingMethod::default(),
            alignment: 0.0,
            tolerance: Tolerance::default(),
            given: Tolerance::default(),
            effort: EFFORT,
        }
    }
}
