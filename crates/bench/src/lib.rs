//! Measurements of Seamstress: what the command `seamstress-bench` runs.

mod compare;
pub mod family;
mod jobs;
mod machine;
mod map_files;
mod markdown;
pub mod measurements;
mod meshes;
pub mod output;
pub mod process;
mod program;
pub mod results;
mod statistics;
mod verify;
mod yardstick;
