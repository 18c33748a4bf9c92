//! The distortion measures of Levi 2021, suppl. sec. 3 and 5.

use super::scale;
use super::singular::SingularValues;
use crate::energy::{Arap, Energy, SymmetricDirichlet};

/// A measure of distortion: a function of the signed singular values of each triangle, a rule for the global
/// scale at which they are taken, and the mean or the maximum as the figure of the whole map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Measure {
    /// `max(sigma_1, 1 / sigma_2)`, eq. (1), of the map as it is scaled.
    TauTilde,
    /// The same at the scale that makes its maximum least, eq. (2); the maximum is tau, eq. (3).
    Tau,
    /// `sigma_1^2 + 1 / sigma_1^2 + sigma_2^2 + 1 / sigma_2^2`, eq. (5) with its squares.
    SymmetricDirichlet,
    /// `(sigma_1 - 1)^2 + (sigma_2 - 1)^2`, eq. (4), at the scale of its least mean.
    Arap,
    /// The same at the scale of its least maximum, the measure of eq. (8).
    ArapMax,
    /// `(sigma_1 - s)^2 + (sigma_2 - s)^2` at its best `s = (sigma_1 + sigma_2) / 2`, eq. (10), at the global
    /// scale where `(sigma_1^2 + sigma_2^2) / 2` has mean 1.
    Asap,
    /// `(sigma_1 / s - 1)^2 + (sigma_2 / s - 1)^2` at its best `s`, eq. (11):
    /// `(sigma_1 - sigma_2)^2 / (sigma_1^2 + sigma_2^2)`; independent of scale.
    AsapMax,
    /// The large dilatation `K = sigma_1 / sigma_2` of section 5; independent of scale.
    Dilatation,
}

/// How the values of the triangles become one figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Aggregate {
    /// The mean over the source's area.
    Mean,
    /// The maximum.
    Max,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::TauTilde,
        Self::Tau,
        Self::SymmetricDirichlet,
        Self::Arap,
        Self::ArapMax,
        Self::Asap,
        Self::AsapMax,
        Self::Dilatation,
    ];

    /// Name for commands and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::TauTilde => "tau-tilde",
            Self::Tau => "tau",
            Self::SymmetricDirichlet => "symmetric-dirichlet",
            Self::Arap => "arap",
            Self::ArapMax => "arap-max",
            Self::Asap => "asap",
            Self::AsapMax => "asap-max",
            Self::Dilatation => "dilatation",
        }
    }

    /// The value of a triangle without distortion, the least there is.
    pub fn ideal(self) -> f64 {
        match self {
            Self::TauTilde | Self::Tau | Self::Dilatation => 1.0,
            Self::SymmetricDirichlet => 4.0,
            Self::Arap | Self::ArapMax | Self::Asap | Self::AsapMax => 0.0,
        }
    }

    /// What is minimised when a map is to be good by this measure.
    pub fn aggregate(self) -> Aggregate {
        match self {
            Self::SymmetricDirichlet | Self::Arap | Self::Asap => Aggregate::Mean,
            Self::TauTilde | Self::Tau | Self::ArapMax | Self::AsapMax | Self::Dilatation => {
                Aggregate::Max
            }
        }
    }

    /// Whether maps are compared by its mean, not by its maximum.
    pub fn is_mean(self) -> bool {
        self.aggregate() == Aggregate::Mean
    }

    /// Whether its values are taken at a global scale of its own, not of the map as it is.
    pub fn has_scale(self) -> bool {
        !matches!(self, Self::TauTilde | Self::AsapMax | Self::Dilatation)
    }

    /// The value of a triangle with signed singular values `s1 >= |s2|`.
    ///
    /// A flipped or collapsed triangle (`s2 <= 0`) is infinitely distorted for tau, the symmetric Dirichlet
    /// energy and the dilatation; the distances to rotations and similarities stay finite.
    pub fn value(self, s1: f64, s2: f64) -> f64 {
        let is_positive = s2 > 0.0;
        match self {
            Self::TauTilde | Self::Tau if is_positive => s1.max(1.0 / s2),
            Self::SymmetricDirichlet if is_positive => SymmetricDirichlet.value(s1, s2),
            Self::Dilatation if is_positive => s1 / s2,
            Self::Arap | Self::ArapMax => Arap.value(s1, s2),
            Self::Asap => 0.5 * (s1 - s2).powi(2),
            // The limit: nothing of a rotation is left.
            Self::AsapMax if s1 == 0.0 => 2.0,
            // Divided first, so that squares neither overflow nor vanish.
            Self::AsapMax => (1.0 - s2 / s1).powi(2) / (1.0 + (s2 / s1).powi(2)),
            Self::TauTilde | Self::Tau | Self::SymmetricDirichlet | Self::Dilatation => {
                f64::INFINITY
            }
        }
    }

    /// The global scale at which the values are taken; 1 for the measures without one ([`Measure::has_scale`]). Where flipped triangles have no finite value, the
    /// others decide.
    pub fn scale(self, singular: &SingularValues) -> f64 {
        match self {
            Self::TauTilde | Self::AsapMax | Self::Dilatation => 1.0,
            Self::Tau => scale::of_tau(singular),
            Self::SymmetricDirichlet => scale::of_symmetric_dirichlet(singular),
            Self::Arap => scale::of_arap(singular),
            Self::ArapMax => scale::of_arap_max(singular),
            Self::Asap => scale::of_asap(singular),
        }
    }
}

impl std::fmt::Display for Measure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
