//! Consistent matchings: matchings, indices and angles that triangles can have, near given ones.
//!
//! Problem (14) of Levi 2021 (suppl. sec. 9). Matchings carry no cost; they only move
//! index from vertex to vertex. What is left is a convex cost of integer indices (`descent`, and exactly `branch`)
//! and, for fixed indices, a convex program in the angles (`program`).

mod bound;
mod branch;
mod candidates;
mod descent;
mod error;
mod flow;
mod from_map;
mod groups;
mod input;
mod landscape;
mod piece;
mod problem;
mod program;
mod refine;
mod resistance;
mod solve;
mod system;

pub use error::ConsistencyError;
pub use from_map::{consistent_cut, lifted_angles, matched_by_angles, transitions};
pub use input::{
    AngleNorm, ConsistencyInput, ConsistencyOptions, ConsistencyStats, Consistent, MatchingSet,
    SeamMatching,
};
pub use solve::make_consistent;
