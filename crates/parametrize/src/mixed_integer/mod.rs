//! Mixed-integer rounding: matchings as integer variables of the bounded-distortion program (Levi 2021, suppl. sec. 10).
//!
//! The program is (9) with the frames of the last layout, over all layouts whose rounded seams close; seams
//! that are not rounded yet are free. Batches of matchings are chosen by branch and bound (`search`)
//! over the interior point of [`crate::layout::conic`] (`program`).

mod batches;
mod program;
mod search;

pub use batches::round_mixed_integer;

use std::time::Duration;

/// Settings of [`round_mixed_integer`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixedIntegerOptions {
    /// Maximum number of matchings that are integer variables at a time; b in Levi 2021.
    pub batch: usize,
    /// Most programs solved for a batch, and some more as long as no integers were found. The first integers
    /// are mostly found with fewer; more prove them, or find better ones.
    pub nodes: usize,
    /// Time for all batches of a component together. The result depends on the machine where it runs out;
    /// what is open then is rounded to the nearest integers.
    pub time_limit: Option<Duration>,
    /// Gap to which programs are solved, as a part of their objective. Integers that promise less than
    /// this are not looked for.
    pub tolerance: f64,
}

impl Default for MixedIntegerOptions {
    fn default() -> Self {
        Self { batch: 800, nodes: 60, time_limit: None, tolerance: 1e-4 }
    }
}

/// How the matchings of a component were chosen.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MixedIntegerStats {
    /// Batch after batch.
    pub batches: Vec<BatchStats>,
    /// Matchings rounded to the nearest integer in the end, since no batch found integers for them.
    pub left_to_nearest: usize,
}

impl MixedIntegerStats {
    /// Programs solved in all.
    pub fn nodes(&self) -> usize {
        self.batches.iter().map(|batch| batch.nodes).sum()
    }
}

/// How the matchings of one batch were chosen.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BatchStats {
    /// Matchings that were integer variables.
    pub integers: usize,
    /// Programs solved.
    pub nodes: usize,
    /// tau of the program at the best integers found, the incumbent; none if none were found.
    pub tau: Option<f64>,
    /// Bound from below on tau over all choices of the two integers next to each matching; 4 where no choice
    /// has a layout of smaller tau.
    pub bound: f64,
    /// Whether the incumbent is the best choice, to the tolerance.
    pub proven: bool,
    /// Wall-clock seconds.
    pub seconds: f64,
}
