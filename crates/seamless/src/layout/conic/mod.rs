//! Layouts of least maximal distortion, by second-order cone programs.

mod cells;
mod cone;
mod element;
pub mod interior_point;
mod passes;
pub mod program;
pub mod reference;
mod rows;
pub mod solver;
mod start;

pub use program::{Matrix2, Program, ProgramKind};
pub use solver::{ConicSolution, Outcome, Solver, SolverOptions, solve};
