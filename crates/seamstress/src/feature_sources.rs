//! Features as asked for: sources of edges.

use crate::as_text::as_text;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Where feature edges come from.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum FeatureSource {
    /// The boundary, creases found by the shape of the surface, and curves along which repairs have cut sheets apart:
    /// `auto`.
    Auto,
    /// Edges at which the surface bends by this many degrees or more: `angle:40`.
    Angle(f64),
    /// The boundary: `boundary`.
    Boundary,
    /// The `l` elements of the OBJ file of the surface: `lines`.
    Lines,
    /// Edges between faces of different materials in the OBJ file of the surface: `material`.
    Material,
    /// Edges between faces of different groups or objects: `group`.
    Group,
    /// Edges between faces of different smoothing groups: `smoothing`.
    Smoothing,
    /// Edges at which the texture coordinates of the OBJ file of the surface differ on both sides: `uv-seams`.
    UvSeams,
    /// Edges by their ends, vertices of the input counted from 0: `edges:0-1,1-5`.
    Edges(Vec<[u32; 2]>),
    /// A file of two vertices a line: `pairs:FILE`.
    Pairs(PathBuf),
    /// A `.sharp` file of QuadWild: `sharp:FILE`.
    Sharp(PathBuf),
}

impl FeatureSource {
    /// The file it is read from, other than that of the surface.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Pairs(file) | Self::Sharp(file) => Some(file),
            _ => None,
        }
    }
}

impl FromStr for FeatureSource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        match (kind, rest) {
            ("auto", "") => Ok(Self::Auto),
            ("lines", "") => Ok(Self::Lines),
            ("boundary", "") => Ok(Self::Boundary),
            ("material", "") => Ok(Self::Material),
            ("group", "") => Ok(Self::Group),
            ("smoothing", "") => Ok(Self::Smoothing),
            ("uv-seams", "") => Ok(Self::UvSeams),
            ("angle", degrees) => match degrees.parse::<f64>() {
                Ok(degrees) if degrees > 0.0 && degrees <= 180.0 => Ok(Self::Angle(degrees)),
                _ => Err("expected degrees, more than 0 and at most 180, after `angle:`".into()),
            },
            ("edges", edges) => {
                edges.split(',').map(edge).collect::<Result<_, _>>().map(Self::Edges)
            }
            ("pairs", file) if !file.is_empty() => Ok(Self::Pairs(file.into())),
            ("sharp", file) if !file.is_empty() => Ok(Self::Sharp(file.into())),
            _ => {
                Err("expected auto, angle:DEGREES, boundary, lines, material, group, smoothing, uv-seams, edges:A-B, pairs:FILE or sharp:FILE"
                    .into())
            }
        }
    }
}

fn edge(text: &str) -> Result<[u32; 2], String> {
    let ends = text.split_once('-');
    let parsed = ends.and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    parsed.ok_or_else(|| "expected edges such as 0-1,1-5 after `edges:`".into())
}

impl fmt::Display for FeatureSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Angle(degrees) => write!(f, "angle:{degrees}"),
            Self::Boundary => f.write_str("boundary"),
            Self::Lines => f.write_str("lines"),
            Self::Material => f.write_str("material"),
            Self::Group => f.write_str("group"),
            Self::Smoothing => f.write_str("smoothing"),
            Self::UvSeams => f.write_str("uv-seams"),
            Self::Edges(edges) => {
                let edges: Vec<String> = edges.iter().map(|[a, b]| format!("{a}-{b}")).collect();
                write!(f, "edges:{}", edges.join(","))
            }
            Self::Pairs(file) => write!(f, "pairs:{}", file.display()),
            Self::Sharp(file) => write!(f, "sharp:{}", file.display()),
        }
    }
}

as_text!(
    FeatureSource,
    "auto, angle:DEGREES, boundary, lines, material, group, smoothing, uv-seams, edges:A-B,C-D, pairs:FILE or sharp:FILE"
);

/// Edges that a map, and quads, should follow: those of all sources.
///
/// The default leaves the choice to what is made: quad meshes and integer-grid maps of a mesh follow those of
/// [`FeatureSource::Auto`], all else none.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct Features {
    sources: Option<Vec<FeatureSource>>,
}

impl Features {
    /// No features, not even by default.
    pub fn none() -> Self {
        Self { sources: Some(Vec::new()) }
    }

    /// The boundary, and creases found by the shape of the surface.
    pub fn auto() -> Self {
        Self::none().and(FeatureSource::Auto)
    }

    /// Edges at which the surface bends by this many degrees or more.
    pub fn angle(degrees: f64) -> Self {
        Self::none().and(FeatureSource::Angle(degrees))
    }

    /// Edges by their ends, vertices of the input counted from 0.
    pub fn edges(edges: impl Into<Vec<[u32; 2]>>) -> Self {
        Self::none().and(FeatureSource::Edges(edges.into()))
    }

    /// The boundary as well.
    pub fn with_boundary(self) -> Self {
        self.and(FeatureSource::Boundary)
    }

    /// Those of another source as well.
    pub fn and(mut self, source: FeatureSource) -> Self {
        let sources = self.sources.get_or_insert_default();
        if !sources.contains(&source) {
            sources.push(source);
        }
        self
    }

    /// The sources.
    pub fn sources(&self) -> &[FeatureSource] {
        self.sources.as_deref().unwrap_or_default()
    }

    /// Whether none is asked for.
    pub fn is_none(&self) -> bool {
        self.sources().is_empty()
    }

    /// These, or others where the choice was left open.
    pub(crate) fn or(&self, default: Self) -> Self {
        if self.sources.is_some() { self.clone() } else { default }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_read_and_written_alike() {
        let good = [
            "auto",
            "angle:40",
            "angle:0.5",
            "boundary",
            "lines",
            "material",
            "group",
            "smoothing",
            "uv-seams",
            "edges:0-1,4-2",
            "pairs:a b.txt",
            "sharp:C:\\x.sharp",
        ];
        for text in good {
            let source: FeatureSource = text.parse().unwrap();
            assert_eq!(source.to_string(), text);
        }
        let bad = [
            "",
            "auto:1",
            "angle",
            "angle:0",
            "angle:181",
            "angle:nan",
            "lines:3",
            "pairs",
            "pairs:",
            "edges:x",
            "edges:1",
            "edges:1-2-3",
            "boundary:1",
        ];
        for text in bad {
            assert!(text.parse::<FeatureSource>().is_err(), "{text}");
        }
    }

    #[test]
    fn features_are_a_list_of_sources_in_json() {
        let features = Features::angle(40.0).with_boundary();
        let text = serde_json::to_string(&features).unwrap();
        assert_eq!(text, r#"["angle:40","boundary"]"#);
        assert_eq!(serde_json::from_str::<Features>(&text).unwrap(), features);
        assert!(serde_json::from_str::<Features>(r#"["angle:0"]"#).is_err());
    }
}
