//! Sizes of cells as asked for: sources of relative edge lengths.

use crate::as_text::as_text;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Where the relative sizes of cells come from; those of several sources are multiplied.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SizeSource {
    /// A channel of the colours of the vertices, counted from red: `color:green`. 0 stands for twice the edge length, 1 for
    /// half of it.
    Color(usize),
    /// A property of the vertices, larger than 0, in proportion to the edge length: `property:NAME`.
    Property(String),
    /// A file with such a number for every vertex of the input, one a line: `csv:FILE`.
    Csv(PathBuf),
    /// Edges at features are so many times as long as elsewhere, and grow from there; at most 1: `features:0.5`.
    Features(f64),
    /// The same at the boundary: `boundary:0.5`.
    Boundary(f64),
}

/// The channels of colours.
const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];
/// What a source may be.
const FORMS: &str = "color:CHANNEL, property:NAME, csv:FILE, features:X or boundary:X";

impl SizeSource {
    /// The file it is read from, other than that of the surface.
    pub(crate) fn file(&self) -> Option<&Path> {
        match self {
            Self::Csv(file) => Some(file),
            _ => None,
        }
    }
}

impl FromStr for SizeSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        let part = || match rest.parse::<f64>() {
            Ok(x) if x > 0.0 && x <= 1.0 => Ok(x),
            _ => Err(format!("expected a number above 0 and at most 1 after `{kind}:`")),
        };
        match kind {
            "color" => match CHANNELS.iter().position(|&channel| channel == rest) {
                Some(channel) => Ok(Self::Color(channel)),
                None => Err("expected red, green, blue or alpha after `color:`".into()),
            },
            "property" if !rest.is_empty() => Ok(Self::Property(rest.into())),
            "csv" if !rest.is_empty() => Ok(Self::Csv(rest.into())),
            "features" => part().map(Self::Features),
            "boundary" => part().map(Self::Boundary),
            _ => Err(format!("expected {FORMS}")),
        }
    }
}

impl fmt::Display for SizeSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Color(channel) => {
                write!(f, "color:{}", CHANNELS.get(*channel).copied().unwrap_or_default())
            }
            Self::Property(name) => write!(f, "property:{name}"),
            Self::Csv(file) => write!(f, "csv:{}", file.display()),
            Self::Features(part) => write!(f, "features:{part}"),
            Self::Boundary(part) => write!(f, "boundary:{part}"),
        }
    }
}

as_text!(SizeSource, FORMS);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_read_and_written_alike() {
        let good = ["color:red", "color:alpha", "property:size", "csv:a b.csv", "features:0.25"];
        for text in good.into_iter().chain(["boundary:1"]) {
            assert_eq!(text.parse::<SizeSource>().unwrap().to_string(), text);
        }
        let bad = ["", "color", "color:grey", "property:", "csv", "features:0", "features:1.5"];
        for text in bad.into_iter().chain(["boundary:nan", "size:3"]) {
            assert!(text.parse::<SizeSource>().is_err(), "{text}");
        }
    }
}
