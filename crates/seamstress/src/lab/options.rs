//! The options of the method with every choice open.

use super::start::StartOptions;
use crate::error::Error;
use crate::options::{MapOptions, seconds};
use seamstress_parametrize as parametrize;
use seamstress_parametrize::MixedIntegerOptions;
use seamstress_parametrize::RoundingStrategy;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// How the rounding of a seam is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Rounding {
    /// Angle and cones
    #[default]
    ConeBias,
    /// Effect on a small patch, and cones
    LocalEstimation,
    /// Matchings as integer variables of the program of minimum tau, solved by branch and bound; slow
    MixedInteger,
}

/// How matchings are rounded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct RoundingOptions {
    /// How the rounding of a seam is judged: by its angle and the cones it makes, or by its effect
    /// estimated on a small patch as well
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "HOW", default_value_t = Rounding::ConeBias))]
    pub rounding: Rounding,

    /// Matchings that are integer variables at a time, with `--rounding mixed-integer`
    #[cfg_attr(feature = "clap", arg(long, value_name = "B", value_parser = clap::value_parser!(u32).range(1..),
        default_value_t = Self::default().batch))]
    pub batch: u32,

    /// Programs solved for a batch at most, with `--rounding mixed-integer`
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..),
        default_value_t = Self::default().nodes))]
    pub nodes: u32,

    /// Stop `--rounding mixed-integer` after this many seconds and round what is left to the nearest
    /// integers; the map then depends on the machine [default: no limit]
    #[serde(with = "seconds")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    #[cfg_attr(feature = "clap", arg(long, value_name = "SECONDS", value_parser = crate::options::parse::seconds))]
    pub rounding_time: Option<Duration>,
}

impl Default for RoundingOptions {
    fn default() -> Self {
        let mixed_integer = MixedIntegerOptions::default();
        Self {
            rounding: Rounding::ConeBias,
            batch: mixed_integer.batch as u32,
            nodes: mixed_integer.nodes as u32,
            rounding_time: None,
        }
    }
}

/// The method with every choice open.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct MethodOptions {
    /// The options of every map
    #[cfg_attr(feature = "clap", command(flatten))]
    pub map: MapOptions,

    /// How matchings are rounded
    #[cfg_attr(feature = "clap", command(flatten))]
    pub rounding: RoundingOptions,

    /// What the map starts from
    #[cfg_attr(feature = "clap", command(flatten))]
    pub start: StartOptions,
}

impl MethodOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// [`ErrorKind::Options`](crate::ErrorKind::Options), naming the option.
    pub fn validate(&self) -> Result<(), Error> {
        self.map.validate()?;
        self.start.validate()?;
        let has_features = !self.map.features.is_none();
        if has_features && self.start.is_baseline() {
            let text = "features are aligned by the direct method; leave out the method `field`";
            return Err(Error::options(text));
        }
        if has_features && self.rounding.rounding == Rounding::MixedInteger {
            let text = "features are aligned by the other ways of rounding; leave out the rounding \
                        `mixed-integer`";
            return Err(Error::options(text));
        }
        Ok(())
    }

    pub(super) fn to_method(&self) -> parametrize::MapOptions {
        let mut options = self.map.to_method();
        options.rounding.strategy = match self.rounding.rounding {
            Rounding::ConeBias => RoundingStrategy::ConeBias,
            Rounding::LocalEstimation => RoundingStrategy::LocalEstimation,
            Rounding::MixedInteger => RoundingStrategy::MixedInteger,
        };
        options.rounding.mixed_integer = MixedIntegerOptions {
            batch: self.rounding.batch as usize,
            nodes: self.rounding.nodes as usize,
            time_limit: self.rounding.rounding_time,
            ..MixedIntegerOptions::default()
        };
        options
    }
}
