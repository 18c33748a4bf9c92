//! Charts of a map in the unit square.

use crate::error::Error;
use crate::options::MapOptions;
use seamstress_parametrize::atlas::{Atlas, AtlasError};
use serde::Serialize;

/// How the charts of a map were packed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PackingReport {
    /// Texels on a side of the texture.
    pub texels: u32,
    /// Texels between charts, at least.
    pub margin: u32,
    /// Charts of the map.
    pub islands: usize,
    /// Charts after those that lay over themselves were cut.
    pub charts: usize,
    /// Triangles that lay over others of their chart, ascending.
    pub overlapping: Vec<u32>,
    /// Texels per unit of length of the mesh.
    pub density: f64,
    /// The share of the texture that charts cover.
    pub covered: f64,
}

impl PackingReport {
    pub(crate) fn new(atlas: &Atlas, options: &MapOptions) -> Self {
        let doubled: f64 = atlas
            .corner_uvs
            .as_chunks::<3>()
            .0
            .iter()
            .map(|&[a, b, c]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            .sum();
        Self {
            texels: options.pack.unwrap_or_default(),
            margin: options.pack_margin,
            islands: atlas.n_islands,
            charts: atlas.n_charts,
            overlapping: atlas.overlapping.iter().map(|f| f.0).collect(),
            density: atlas.density,
            covered: 0.5 * doubled,
        }
    }

    pub(crate) fn refusal(cause: &AtlasError) -> Error {
        Error::options(format!("pack: {cause}"))
            .with_hint("pack for a larger texture, or with smaller margins")
    }
}
