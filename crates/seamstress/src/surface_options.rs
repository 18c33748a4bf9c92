//! How a surface is made of what is read.

use crate::mesh_format::MeshFormat;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// How a surface is made of what is read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct SurfaceOptions {
    /// Repair what can be repaired without moving a vertex, and go on with the repaired mesh
    ///
    /// Drops degenerate and repeated faces and unused vertices, leaves out repeated corners, collapses edges
    /// of length zero, turns faces over that disagree with their neighbours, cuts edges of three or more faces
    /// apart into sheets and pieces such as Moebius bands open, and splits vertices where surfaces only touch.
    /// Every repair is listed.
    #[cfg_attr(feature = "clap", arg(long))]
    pub repair: bool,

    /// Merge vertices within this distance of another, in mesh units
    ///
    /// Without a distance, or with `auto`: exact copies, and within the noise of the copies if there is one, far
    /// below the lengths of edges. `soups` does so where faces share next to no vertices, `off` never.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TOLERANCE", num_args = 0..=1,
        default_value = "soups", default_missing_value = "auto"))]
    pub weld: Weld,

    /// Format of the mesh, as of standard input, where neither name nor content says it [default: as they say]
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "FORMAT"))]
    pub format: Option<MeshFormat>,
}

/// Which vertices are merged on reading.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Weld {
    /// Copies of one vertex, where faces share next to no vertices.
    #[default]
    Soups,
    /// Copies of one vertex.
    Auto,
    /// None.
    Off,
    /// Those within this distance of another, mesh units; with 0 those in the same place.
    Within(f64),
}

impl FromStr for Weld {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "soups" => Ok(Self::Soups),
            "auto" => Ok(Self::Auto),
            "off" => Ok(Self::Off),
            _ => match text.parse::<f64>() {
                Ok(x) if x.is_finite() && x >= 0.0 => Ok(Self::Within(x)),
                _ => Err("expected a distance, 0 or larger, or `auto`, `soups` or `off`; \
                          files go before `--weld`"
                    .into()),
            },
        }
    }
}

impl SurfaceOptions {
    /// Whether to repair what can be repaired without moving a vertex.
    pub fn repair(mut self, repair: bool) -> Self {
        self.repair = repair;
        self
    }

    /// Sets which vertices are merged.
    pub fn weld(mut self, weld: Weld) -> Self {
        self.weld = weld;
        self
    }

    /// Sets the format of the file.
    pub fn format(mut self, format: MeshFormat) -> Self {
        self.format = Some(format);
        self
    }
}
