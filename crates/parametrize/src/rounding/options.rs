//! Settings of the rounding loop.

use crate::mixed_integer::MixedIntegerOptions;

/// How the size of a rounding is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RoundingStrategy {
    /// By the angle it turns the seam.
    #[default]
    ConeBias,
    /// By the change of energy it makes on a small patch around the seam: the local estimation of Levi 2021.
    LocalEstimation,
    /// By programs in which matchings are integer variables, see [`crate::mixed_integer`]. Components with
    /// aligned edges are rounded by [`Self::ConeBias`].
    MixedInteger,
}

/// Settings of the rounding loop.
#[derive(Debug, Clone, Copy)]
pub struct RoundingOptions {
    /// How the size of a rounding is judged.
    pub strategy: RoundingStrategy,
    /// How much a rounding that makes cones costs, against one that only turns: 0 gives the lowest
    /// distortion and two to five times the cones, one half the cones for about 0.02 of energy. At one
    /// half, cancelling a pair of unit cones by a whole turn costs as little as not turning at all (the
    /// smaller turn wins); beyond it cones are cancelled where they belong.
    pub cone_bias: f64,
    /// The same at corners: sectors between two aligned edges. Larger values make corners keep to the
    /// whole number of quarters nearest to their angle, at a price in distortion.
    pub corner_weight: f64,
    /// Rounds over which the threshold on the cost grows to its last value.
    pub rounds: usize,
    /// Layout iterations per round.
    pub layout_iterations: usize,
    /// Settings of [`RoundingStrategy::MixedInteger`].
    pub mixed_integer: MixedIntegerOptions,
}

impl Default for RoundingOptions {
    fn default() -> Self {
        Self {
            strategy: RoundingStrategy::default(),
            cone_bias: 0.5,
            corner_weight: 1.0,
            rounds: 60,
            layout_iterations: 4,
            mixed_integer: MixedIntegerOptions::default(),
        }
    }
}
