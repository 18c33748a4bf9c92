//! Options: what a user has a reason to change. One text each, for documentation, command line and JSON.

use crate::direction_sources::DirectionSource;
use crate::error::Error;
use crate::feature_sources::{FeatureSource, Features};
use crate::grid_size::GridSize;
use crate::parts::PartOptions;
use crate::size_sources::SizeSource;
use crate::symmetry::Symmetry;
use seamstress_parametrize::RoundingOptions;
use seamstress_parametrize::{self as method, Objective, PolishOptions};
use seamstress_quantize as quantize;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::time::Duration;

/// Texels on a side of the largest texture that charts are packed for.
const LARGEST_TEXTURE: u32 = 32_768;

/// Options of [`Surface::parametrize`](crate::Surface::parametrize).
///
/// In JSON an object with any of the fields; times are in seconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct MapOptions {
    /// Edges that the map should have on its axes; the default is none for a map, and those of `auto` for an
    /// integer-grid map or quads of a mesh
    #[cfg_attr(feature = "clap", arg(skip))]
    pub features: Features,

    /// Fail if a feature cannot be aligned, instead of dropping and reporting it
    #[cfg_attr(feature = "clap", arg(long))]
    pub features_strict: bool,

    /// Give a curve of features a corner where it turns by so many degrees or more; for quads a turn counts only if it
    /// lasts for a cell on both sides, so that curves that zigzag along the edges of the mesh are followed smoothly
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", value_parser = parse::angle,
        default_value_t = Self::default().corner_angle))]
    pub corner_angle: f64,

    /// How much to follow the directions of principal curvature: 0 not at all, 1 as far as they are certain, so that
    /// lines run around and along limbs and tubes [default: 0; for quads of a mesh 1, but 0 where cells have different sizes]
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::share))]
    pub align: Option<f64>,

    /// Directions to follow besides, wherever they can be, from one of these sources; may be given several times
    ///
    ///   strokes:FILE  polylines near the surface, the `l` elements of an OBJ file
    ///   field:FILE    a .rawfield, or a .rosy with a vector per face
    ///   SOURCE        edges as by `--features`, which need not be on lines
    #[cfg_attr(feature = "clap", arg(long, value_name = "SOURCE", verbatim_doc_comment))]
    pub directions: Vec<DirectionSource>,

    /// How much smaller cells are to be where the surface bends: 0 not at all, 1 so that all leave it equally far; there are
    /// as many as without
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::share,
        default_value_t = Self::default().adaptive))]
    pub adaptive: f64,

    /// Relative sizes of cells, from one of these sources; those of several are multiplied, and there are as many cells as
    /// without
    ///
    ///   color:CHANNEL   of the vertices, red, green, blue or alpha: 0 stands for twice
    ///                   the edge length, 1 for half of it
    ///   property:NAME   of the vertices in PLY, in proportion to the edge length
    ///   csv:FILE        such a number for every vertex, one a line
    ///   features:X      edges X times as long at features, X at most 1
    ///   boundary:X      the same at the boundary
    #[cfg_attr(feature = "clap", arg(long, value_name = "SOURCE", verbatim_doc_comment))]
    pub sizes: Vec<SizeSource>,

    /// The least edge length where sizes vary, in mesh units [default: a hundredth of the mean]
    #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = parse::positive))]
    pub min_edge: Option<f64>,

    /// The largest edge length where sizes vary, in mesh units [default: a hundred times the mean]
    #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = parse::positive))]
    pub max_edge: Option<f64>,

    /// How much edge lengths may grow from a cell to the next, as a share
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::positive,
        default_value_t = Self::default().size_growth))]
    pub size_growth: f64,

    /// Planes at which the map or the quads are exactly symmetric: axes such as `x` or `xz`, for the planes across them
    /// through the origin or the middle of the mesh; `auto`, those across axes at which the mesh is symmetric; or
    /// `plane:NX,NY,NZ,D`. One side is made, and mirrored; a mesh that is not symmetric there is refused; for a map its
    /// triangles must be, too
    #[cfg_attr(feature = "clap", arg(long, value_name = "PLANES", default_value_t))]
    pub symmetry: Symmetry,

    /// Move the charts of the map into the unit square, side by side without overlap, for a texture of so many texels on a
    /// side, 2048 if no number is given. All have one scale and are turned by quarters only, so that the map stays
    /// seamless; a chart that lies over itself is cut
    #[cfg_attr(feature = "clap", arg(long, value_name = "TEXELS", num_args = 0..=1, require_equals = true,
        default_missing_value = "2048", value_parser = clap::value_parser!(u32).range(1..=i64::from(LARGEST_TEXTURE))))]
    pub pack: Option<u32>,

    /// Texels between charts that are packed, and at the sides of the square
    #[cfg_attr(feature = "clap", arg(long, value_name = "TEXELS", default_value_t = Self::default().pack_margin))]
    pub pack_margin: u32,

    /// How much to avoid cones: 0 gives the lowest distortion, larger values fewer cones
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::not_negative,
        default_value_t = Self::default().cone_bias))]
    pub cone_bias: f64,

    /// How much the mean symmetric Dirichlet energy (4 is no distortion) may rise for each cone removed in clean-up;
    /// 0 turns clean-up off [default: 0.0005; for quads the area of four of them as a share of the surface, at least
    /// 0.0015]
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::not_negative))]
    pub cone_price: Option<f64>,

    /// How much corners between features keep to their own angle: larger values give fewer false
    /// corners and more distortion
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::not_negative,
        default_value_t = Self::default().corner_weight))]
    pub corner_weight: f64,

    /// Take about half of the time, as for a preview: cones are looked for on a coarser mesh still, the mean distortion
    /// stays a little above the least, and the largest (tau) is not polished
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["polish_time", "max_energy_rise"]))]
    pub fast: bool,

    /// Leave out the polish that lowers the largest distortion (tau)
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["polish_time", "max_energy_rise"]))]
    pub no_tau_polish: bool,

    /// Stop the tau polish after this many seconds; the map then depends on the machine [default: no
    /// limit]
    #[serde(with = "seconds")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<f64>"))]
    #[cfg_attr(feature = "clap", arg(long, value_name = "SECONDS", value_parser = parse::seconds))]
    pub polish_time: Option<Duration>,

    /// Maximum relative increase of the mean symmetric Dirichlet energy allowed to the tau polish
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::not_negative,
        default_value_t = Self::default().max_energy_rise))]
    pub max_energy_rise: f64,

    /// Minimise this in the end, instead of the compromise of mean and worst distortion
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME", value_parser = parse::objective()))]
    pub objective: Option<Objective>,
}

impl Default for MapOptions {
    fn default() -> Self {
        let rounding = RoundingOptions::default();
        Self {
            features: Features::default(),
            features_strict: false,
            corner_angle: method::MapOptions::default().corner_angle,
            align: None,
            directions: Vec::new(),
            adaptive: 0.0,
            sizes: Vec::new(),
            min_edge: None,
            max_edge: None,
            size_growth: 0.25,
            symmetry: Symmetry::None,
            pack: None,
            pack_margin: 4,
            cone_bias: rounding.cone_bias,
            cone_price: None,
            corner_weight: rounding.corner_weight,
            fast: false,
            no_tau_polish: false,
            polish_time: None,
            max_energy_rise: PolishOptions::default().max_energy_rise,
            objective: None,
        }
    }
}

impl MapOptions {
    /// Sets the features.
    pub fn features(mut self, features: Features) -> Self {
        self.features = features;
        self
    }

    /// Sets the planes of symmetry.
    pub fn symmetry(mut self, symmetry: Symmetry) -> Self {
        self.symmetry = symmetry;
        self
    }

    /// Sets how much to avoid cones, 0 or more.
    pub fn cone_bias(mut self, cone_bias: f64) -> Self {
        self.cone_bias = cone_bias;
        self
    }

    /// Sets the price of a cone, 0 or more.
    pub fn cone_price(mut self, cone_price: f64) -> Self {
        self.cone_price = Some(cone_price);
        self
    }

    /// Sets what to minimise in the end.
    pub fn objective(mut self, objective: Objective) -> Self {
        self.objective = Some(objective);
        self
    }

    /// Checks that every option has a value it can have. Everything that takes options does this first.
    ///
    /// # Errors
    /// [`ErrorKind::Options`](crate::ErrorKind::Options), naming the option.
    pub fn validate(&self) -> Result<(), Error> {
        self.features.validate()?;
        if !(self.corner_angle > 0.0 && self.corner_angle <= 180.0) {
            let text =
                format!("corner_angle: {} is no angle above 0 and up to 180", self.corner_angle);
            return Err(Error::options(text));
        }
        if let Some(align) = self.align.filter(|align| !(0.0..=1.0).contains(align)) {
            return Err(Error::options(format!("align: {align} is not between 0 and 1")));
        }
        if !(0.0..=1.0).contains(&self.adaptive) {
            let text = format!("adaptive: {} is not between 0 and 1", self.adaptive);
            return Err(Error::options(text));
        }
        let edges = [("min_edge", self.min_edge), ("max_edge", self.max_edge)];
        let lengths = edges.into_iter().filter_map(|(name, edge)| Some((name, edge?)));
        for (name, value) in lengths.chain([("size_growth", self.size_growth)]) {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::options(format!("{name}: {value} is no number larger than 0")));
            }
        }
        if let (Some(least), Some(largest)) = (self.min_edge, self.max_edge)
            && least > largest
        {
            return Err(Error::options(format!("min_edge: {least} is more than {largest}")));
        }
        if let Some(texels) = self.pack.filter(|texels| !(1..=LARGEST_TEXTURE).contains(texels)) {
            let text = format!("pack: {texels} is not between 1 and {LARGEST_TEXTURE}");
            return Err(Error::options(text));
        }
        not_negative("cone_bias", self.cone_bias)?;
        not_negative("corner_weight", self.corner_weight)?;
        not_negative("max_energy_rise", self.max_energy_rise)?;
        self.cone_price.map_or(Ok(()), |price| not_negative("cone_price", price))
    }

    /// Refuses to pack what is no map.
    fn refuse_packing(&self) -> Result<(), Error> {
        match self.pack {
            None => Ok(()),
            Some(_) => Err(Error::options("pack: only charts of seamless maps are packed")),
        }
    }

    /// The same with features chosen where that was left open.
    pub(crate) fn or_features(&self, default: Features) -> Self {
        self.clone().features(self.features.or(default))
    }

    /// The files that are read, other than that of the surface.
    #[doc(hidden)]
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let features = self.features.sources().iter().filter_map(FeatureSource::file);
        let directions = self.directions.iter().filter_map(DirectionSource::file);
        features.chain(directions).chain(self.sizes.iter().filter_map(SizeSource::file))
    }

    /// Whether cells are to have different sizes.
    pub(crate) fn has_sizes(&self) -> bool {
        self.adaptive > 0.0 || !self.sizes.is_empty()
    }

    /// The same with the strength of alignment chosen where that was left open.
    pub(crate) fn or_align(self, default: f64) -> Self {
        Self { align: self.align.or(Some(default)), ..self }
    }

    pub(crate) fn to_method(&self) -> method::MapOptions {
        let mut options = method::MapOptions::default();
        options.rounding.cone_bias = self.cone_bias;
        options.rounding.corner_weight = self.corner_weight;
        options.cone_price = self.cone_price;
        options.alignment = self.align.unwrap_or(0.0);
        options.strict_features = self.features_strict;
        options.corner_angle = self.corner_angle;
        options.fast = self.fast;
        options.polish = (!self.no_tau_polish && !self.fast).then_some(PolishOptions {
            max_energy_rise: self.max_energy_rise,
            time_limit: self.polish_time,
        });
        options.objective = self.objective;
        options
    }
}

/// How whole numbers are chosen for an integer-grid map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum GridRounding {
    /// The integers that raise the symmetric Dirichlet energy least while keeping cones apart
    #[default]
    Constrained,
    /// One number after the other in the energy that preserves Jacobians; often fails
    Greedy,
}

/// Options of [`Surface::integer_map`](crate::Surface::integer_map).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct IntegerMapOptions {
    /// How fine the grid is to be
    #[cfg_attr(feature = "clap", arg(skip))]
    pub size: GridSize,

    /// How the whole numbers are chosen
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "HOW",
        default_value_t = GridRounding::Constrained))]
    pub rounding: GridRounding,

    /// What becomes of connected parts that fail, or are small
    #[cfg_attr(feature = "clap", command(flatten))]
    pub parts: PartOptions,

    /// The seamless map that is made first
    #[cfg_attr(feature = "clap", command(flatten))]
    pub map: MapOptions,
}

impl IntegerMapOptions {
    /// A grid of about so many cells in all.
    pub fn count(quads: u32) -> Self {
        Self { size: GridSize::Quads(f64::from(quads)), ..Self::default() }
    }

    /// A grid with cells of this edge length, mesh units.
    pub fn edge_length(length: f64) -> Self {
        Self { size: GridSize::EdgeLength(length), ..Self::default() }
    }

    /// Sets the options of the seamless map.
    pub fn map(mut self, map: MapOptions) -> Self {
        self.map = map;
        self
    }

    /// Sets the features, which come to lie on lines of the grid.
    pub fn features(mut self, features: Features) -> Self {
        self.map.features = features;
        self
    }

    /// Checks every option, as [`MapOptions::validate`] does.
    ///
    /// # Errors
    /// [`ErrorKind::Options`](crate::ErrorKind::Options), naming the option.
    pub fn validate(&self) -> Result<(), Error> {
        self.size.validate()?;
        self.map.refuse_packing()?;
        self.map.validate()
    }

    pub(crate) fn to_quantize(&self) -> quantize::QuantizeOptions {
        let rounding = match self.rounding {
            GridRounding::Constrained => quantize::RoundingMethod::Constrained,
            GridRounding::Greedy => quantize::RoundingMethod::Greedy,
        };
        // Directions that are given count fully.
        let alignment = match self.map.directions.is_empty() {
            true => self.map.align.unwrap_or(0.0),
            false => 1.0,
        };
        let size = self.size.to_quantize();
        quantize::QuantizeOptions { size, rounding, alignment, ..Default::default() }
    }
}

/// What is done to the vertices of extracted quads, and said of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct ShapeOptions {
    /// Leave every vertex where the map has it, and badly shaped quads as they are
    #[cfg_attr(feature = "clap", arg(long))]
    pub raw: bool,

    /// Move the vertices along the surface this many times, to even out angles and lengths
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value_t = 0,
        value_parser = clap::value_parser!(u32).range(0..=1000)))]
    pub smooth: u32,

    /// Write the point of the input that the map has each vertex at, as properties of vertices in PLY: `source_face`,
    /// `source_vertex_0` to `_2`, corners of that face, counted from 0, and `source_weight_0` to `_2`, their weights
    #[cfg_attr(feature = "clap", arg(long))]
    pub source_points: bool,
}

/// Options of [`Surface::quad_mesh`](crate::Surface::quad_mesh).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct QuadOptions {
    /// How fine the grid is to be
    #[cfg_attr(feature = "clap", arg(skip))]
    pub size: GridSize,

    /// What is done to the vertices
    #[cfg_attr(feature = "clap", command(flatten))]
    pub shape: ShapeOptions,

    /// What becomes of connected parts that fail, or are small
    #[cfg_attr(feature = "clap", command(flatten))]
    pub parts: PartOptions,

    /// The seamless map that is made first
    #[cfg_attr(feature = "clap", command(flatten))]
    pub map: MapOptions,
}

impl QuadOptions {
    /// About so many quads in all.
    pub fn count(quads: u32) -> Self {
        Self { size: GridSize::Quads(f64::from(quads)), ..Self::default() }
    }

    /// Quads of this edge length, mesh units.
    pub fn edge_length(length: f64) -> Self {
        Self { size: GridSize::EdgeLength(length), ..Self::default() }
    }

    /// Sets the features, which chains of edges of quads follow.
    pub fn features(mut self, features: Features) -> Self {
        self.map.features = features;
        self
    }

    /// Sets the options of the seamless map.
    pub fn map(mut self, map: MapOptions) -> Self {
        self.map = map;
        self
    }

    /// Whether to leave every vertex where the map has it.
    pub fn raw(mut self, raw: bool) -> Self {
        self.shape.raw = raw;
        self
    }

    /// Sets how often the vertices are smoothed along the surface.
    pub fn smooth(mut self, rounds: u32) -> Self {
        self.shape.smooth = rounds;
        self
    }

    /// Checks every option, as [`MapOptions::validate`] does.
    ///
    /// # Errors
    /// [`ErrorKind::Options`](crate::ErrorKind::Options), naming the option.
    pub fn validate(&self) -> Result<(), Error> {
        self.size.validate()?;
        self.map.refuse_packing()?;
        self.map.validate()
    }
}

impl Features {
    fn validate(&self) -> Result<(), Error> {
        for source in self.sources() {
            if let FeatureSource::Angle(degrees) = source
                && !(*degrees > 0.0 && *degrees <= 180.0)
            {
                let text = format!("features: {degrees} is no angle above 0 and up to 180 degrees");
                return Err(Error::options(text));
            }
        }
        Ok(())
    }
}

pub(crate) fn not_negative(name: &str, value: f64) -> Result<(), Error> {
    match value.is_finite() && value >= 0.0 {
        true => Ok(()),
        false => Err(Error::options(format!("{name}: {value} is no number of 0 or larger"))),
    }
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
        let time = |seconds: f64| {
            let time = Some(seconds).filter(|x| *x > 0.0);
            let time = time.and_then(|x| Duration::try_from_secs_f64(x).ok());
            time.ok_or_else(|| {
                serde::de::Error::custom("expected a number of seconds larger than 0")
            })
        };
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
        let positive = text.parse().ok().filter(|&x: &f64| x > 0.0);
        positive
            .and_then(|x| Duration::try_from_secs_f64(x).ok())
            .ok_or_else(|| "expected a number of seconds larger than 0".into())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_survive_json() {
        let mut options = QuadOptions::count(1500).features(Features::angle(40.0)).smooth(3);
        options.map.polish_time = Some(Duration::from_millis(2500));
        options.map.objective = Some(Objective::SymmetricDirichlet);
        let text = serde_json::to_string(&options).unwrap();
        assert_eq!(serde_json::from_str::<QuadOptions>(&text).unwrap(), options);
        assert_eq!(serde_json::from_str::<QuadOptions>("{}").unwrap(), QuadOptions::default());
    }

    #[test]
    fn unknown_and_impossible_options_are_named() {
        let unknown = serde_json::from_str::<MapOptions>(r#"{"cone_bais": 1}"#).unwrap_err();
        assert!(unknown.to_string().contains("cone_bais"), "{unknown}");
        let cases: [(MapOptions, &str); 6] = [
            (MapOptions { corner_angle: 0.0, ..Default::default() }, "corner_angle"),
            (MapOptions::default().cone_bias(-1.0), "cone_bias"),
            (MapOptions { align: Some(1.5), ..Default::default() }, "align"),
            (MapOptions::default().cone_price(f64::NAN), "cone_price"),
            (MapOptions::default().features(Features::angle(0.0)), "features"),
            (
                MapOptions { max_energy_rise: f64::INFINITY, ..Default::default() },
                "max_energy_rise",
            ),
        ];
        for (options, name) in cases {
            let error = options.validate().unwrap_err();
            assert_eq!(error.code(), "options");
            assert!(error.to_string().starts_with(name), "{error}");
        }
        let error = QuadOptions::edge_length(0.0).validate().unwrap_err();
        assert!(error.to_string().starts_with("edge_length"), "{error}");
    }
}
