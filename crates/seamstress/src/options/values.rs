//! Values that options can have: checked, in JSON, and as arguments.

use crate::error::Error;
use std::time::Duration;

pub(crate) fn not_negative(name: &str, value: f64) -> Result<(), Error> {
    match value.is_finite() && value >= 0.0 {
        true => Ok(()),
        false => Err(Error::options(format!("{name}: {value} is no number of 0 or larger"))),
    }
}

/// A time of so many seconds. What is shorter than half a nanosecond is none.
fn duration(seconds: f64) -> Result<Duration, &'static str> {
    let time = Duration::try_from_secs_f64(seconds).ok().filter(|time| !time.is_zero());
    time.ok_or("expected a number of seconds larger than 0")
}

/// Durations in JSON: seconds.
pub(crate) mod seconds {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use std::time::Duration;

    pub(crate) fn serialize<S: Serializer>(
        time: &Option<Duration>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        time.map(|time| time.as_secs_f64()).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Duration>, D::Error> {
        let seconds = Option::<f64>::deserialize(deserializer)?;
        let time = |seconds: f64| super::duration(seconds).map_err(serde::de::Error::custom);
        seconds.map(time).transpose()
    }
}

/// Parsers of arguments.
#[cfg(feature = "clap")]
pub(crate) mod parse {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    use seamstress_parametrize::Objective;
    use std::time::Duration;

    pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
            _ => Err("expected a number, 0 or larger".into()),
        }
    }

    pub(crate) fn positive(text: &str) -> Result<f64, String> {
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
            _ => Err("expected a number larger than 0".into()),
        }
    }

    pub(crate) fn share(text: &str) -> Result<f64, String> {
        match text.parse::<f64>() {
            Ok(x) if (0.0..=1.0).contains(&x) => Ok(x),
            _ => Err("expected a number from 0 to 1".into()),
        }
    }

    pub(crate) fn angle(text: &str) -> Result<f64, String> {
        match text.parse::<f64>() {
            Ok(x) if x > 0.0 && x <= 180.0 => Ok(x),
            _ => Err("expected degrees, more than 0 and at most 180".into()),
        }
    }

    pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
        super::duration(text.parse().unwrap_or(f64::NAN)).map_err(str::to_owned)
    }

    /// Names of objectives.
    pub(crate) fn objective() -> impl TypedValueParser<Value = Objective> {
        PossibleValuesParser::new(Objective::ALL.map(Objective::name)).map(|name| {
            // The parser lets no other name pass.
            let named = Objective::ALL.into_iter().find(|objective| objective.name() == name);
            named.unwrap_or(Objective::SymmetricDirichlet)
        })
    }
}
