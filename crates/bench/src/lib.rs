//! What the measuring programs of Seamstress share.

pub mod maps;
pub mod markdown;
pub mod meshes;
pub mod process;
