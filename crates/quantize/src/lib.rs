//! Integer maps: seamless maps whose unit grid closes up over the surface.
//!
//! [`to_integer_map`] rounds a certified seamless map, with these steps per component:
//!
//! 1. [`space`]: what must be integral, the translations of chains, the cones, and of aligned edges their
//!    corners and [`isolines`], as exact functions of free integer coordinates ([`lattice`]);
//! 2. [`reduced`]: the energy as a quadratic function of those coordinates alone;
//! 3. [`connections`], [`rays`], [`rounding`], [`search`]: the nearest integer point in that energy at
//!    which no straight line between cones or isolines collapses;
//! 4. [`barrier`]: the layout moves there without a flip; where it cannot, [`walls`] say what other integers
//!    have to satisfy, and the rounding is done again;
//! 5. [`snap`]: doubles that fit to the last bit;
//! 6. [`IntegerMap::certify`], the only door to an integer map.

mod area;
pub mod barrier;
mod certificate;
mod component;
pub mod conditional;
pub mod connections;
pub mod faces;
mod fixing;
pub mod gauss;
mod grids;
pub mod isolines;
pub mod lattice;
pub mod moves;
mod outcome;
pub mod rays;
pub mod reduced;
pub mod rounding;
pub mod scene;
pub mod search;
pub mod snap;
mod solve;
pub mod space;
mod walk;
pub mod walls;

use seamstress_parametrize::map::Tolerance;

pub use certificate::{IntegerCertificate, IntegerMap, IntegralTolerance};
pub use outcome::{IntegerFailure, IntegerStats};
pub use solve::{IntegerError, IntegerSolution, to_aligned_integer_map, to_integer_map};

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
pub enum IntegerRounding {
    /// The closest vector in the symmetric Dirichlet energy that keeps all connections of cones, and a
    /// way there without flips. A finer grid where there is none.
    #[default]
    Constrained,
    /// One coordinate after the other in the energy that preserves Jacobians (Levi 2021, supplement,
    /// section 8; Bommes et al. 2009). Often flips triangles; such a map is refused. For comparison.
    Greedy,
}

/// Settings of [`to_integer_map`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegerOptions {
    /// How fine the grid is to be.
    pub size: GridSize,
    /// How the integers are chosen.
    pub rounding: IntegerRounding,
    /// Tolerance of the certificate of the seamless map in it, and of the map it is made from; what is
    /// integral is so exactly.
    pub tolerance: Tolerance,
}

impl Default for IntegerOptions {
    fn default() -> Self {
        Self {
            size: GridSize::Quads(5000.0),
            rounding: IntegerRounding::default(),
            tolerance: Tolerance::default(),
        }
    }
}
