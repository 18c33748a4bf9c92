//! Options of integer-grid maps.

use super::MapOptions;
use crate::error::Error;
use crate::feature_sources::Features;
use crate::grid_size::GridSize;
use crate::parts::PartOptions;
use seamstress_quantize as quantize;
use serde::{Deserialize, Serialize};

/// How whole numbers are chosen for an integer-grid map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum GridRounding {
    /// The integers that raise the symmetric Dirichlet energy least while keeping cones apart
    #[default]
    Constrained,
    /// One number after the other in the energy that preserves Jacobians; often fails
    Greedy,
}

/// Options of [`Surface::integer_map`](crate::Surface::integer_map).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct IntegerMapOptions {
    /// How fine the grid is to be
    #[cfg_attr(feature = "clap", arg(skip))]
    pub size: GridSize,

    /// How the whole numbers are chosen
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "HOW",
        default_value_t = GridRounding::Constrained))]
    pub rounding: GridRounding,

    /// What becomes of connected parts that fail, or are small
    #[cfg_attr(feature = "clap", command(flatten))]
    pub parts: PartOptions,

    /// The seamless map that is made first
    #[cfg_attr(feature = "clap", command(flatten))]
    pub map: MapOptions,
}

impl IntegerMapOptions {
    /// A grid of about so many cells in all.
    pub fn count(quads: u32) -> Self {
        Self { size: GridSize::Quads(f64::from(quads)), ..Self::default() }
    }

    /// A grid with cells of this edge length, mesh units.
    pub fn edge_length(length: f64) -> Self {
        Self { size: GridSize::EdgeLength(length), ..Self::default() }
    }

    /// Sets the options of the seamless map.
    pub fn map(mut self, map: MapOptions) -> Self {
        self.map = map;
        self
    }

    /// Sets the features, which come to lie on lines of the grid.
    pub fn features(mut self, features: Features) -> Self {
        self.map.features = features;
        self
    }

    /// Checks every option, as [`MapOptions::validate`] does.
    ///
    /// # Errors
    /// [`ErrorKind::Options`](crate::ErrorKind::Options), naming the option.
    pub fn validate(&self) -> Result<(), Error> {
        self.size.validate()?;
        self.map.refuse_packing()?;
        self.map.validate()
    }

    pub(crate) fn to_quantize(&self) -> quantize::QuantizeOptions {
        let rounding = match self.rounding {
            GridRounding::Constrained => quantize::RoundingMethod::Constrained,
            GridRounding::Greedy => quantize::RoundingMethod::Greedy,
        };
        // Directions that are given count fully.
        let alignment = match self.map.directions.is_empty() {
            true => self.map.align.unwrap_or(0.0),
            false => 1.0,
        };
        let size = self.size.to_quantize();
        quantize::QuantizeOptions { size, rounding, alignment, ..Default::default() }
    }
}
