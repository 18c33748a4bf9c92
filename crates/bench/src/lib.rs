//! Measurements of Seamstress: what the command `seamstress-bench` runs.

pub mod compare;
pub mod jobs;
pub mod maps;
pub mod markdown;
pub mod meshes;
pub mod output;
pub mod process;
pub mod program;
