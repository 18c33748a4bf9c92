//! Options of quads.

use super::MapOptions;
use crate::error::Error;
use crate::feature_sources::Features;
use crate::grid_size::GridSize;
use crate::parts::PartOptions;
use serde::{Deserialize, Serialize};

/// What is done to the vertices of extracted quads, and said of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct ShapeOptions {
    /// Leave every vertex where the map has it, and badly shaped quads as they are
    #[cfg_attr(feature = "clap", arg(long))]
    pub raw: bool,

    /// Move the vertices along the surface this many times, to even out angles and lengths
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value_t = 0,
        value_parser = clap::value_parser!(u32).range(0..=1000)))]
    pub smooth: u32,

    /// Write the point of the input that the map has each vertex at, as properties of vertices in PLY: `source_face`,
    /// `source_vertex_0` to `_2`, corners of that face, counted from 0, and `source_weight_0` to `_2`, their weights
    #[cfg_attr(feature = "clap", arg(long))]
    pub source_points: bool,
}

/// Options of [`Surface::quad_mesh`](crate::Surface::quad_mesh).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct QuadOptions {
    /// How fine the grid is to be
    #[cfg_attr(feature = "clap", arg(skip))]
    pub size: GridSize,

    /// What is done to the vertices
    #[cfg_attr(feature = "clap", command(flatten))]
    pub shape: ShapeOptions,

    /// What becomes of connected parts that fail, or are small
    #[cfg_attr(feature = "clap", command(flatten))]
    pub parts: PartOptions,

    /// The seamless map that is made first
    #[cfg_attr(feature = "clap", command(flatten))]
    pub map: MapOptions,
}

impl QuadOptions {
    /// About so many quads in all.
    pub fn count(quads: u32) -> Self {
        Self { size: GridSize::Quads(f64::from(quads)), ..Self::default() }
    }

    /// Quads of this edge length, mesh units.
    pub fn edge_length(length: f64) -> Self {
        Self { size: GridSize::EdgeLength(length), ..Self::default() }
    }

    /// Sets the features, which chains of edges of quads follow.
    pub fn features(mut self, features: Features) -> Self {
        self.map.features = features;
        self
    }

    /// Sets the options of the seamless map.
    pub fn map(mut self, map: MapOptions) -> Self {
        self.map = map;
        self
    }

    /// Whether to leave every vertex where the map has it.
    pub fn raw(mut self, raw: bool) -> Self {
        self.shape.raw = raw;
        self
    }

    /// Sets how often the vertices are smoothed along the surface.
    pub fn smooth(mut self, rounds: u32) -> Self {
        self.shape.smooth = rounds;
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
}
