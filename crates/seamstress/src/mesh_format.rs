//! Formats of mesh files.

use serde::{Deserialize, Serialize};

/// A format of mesh files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[allow(missing_docs)]
pub enum MeshFormat {
    Obj,
    Off,
    Ply,
    Stl,
    Gltf,
}

#[cfg(feature = "io")]
impl From<MeshFormat> for seamstress_io::Format {
    fn from(format: MeshFormat) -> Self {
        match format {
            MeshFormat::Obj => Self::Obj,
            MeshFormat::Off => Self::Off,
            MeshFormat::Ply => Self::Ply,
            MeshFormat::Stl => Self::Stl,
            MeshFormat::Gltf => Self::Gltf,
        }
    }
}
