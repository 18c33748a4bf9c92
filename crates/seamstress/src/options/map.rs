//! Options of maps.

#[cfg(feature = "clap")]
use super::parse;
use super::{not_negative, seconds};
use crate::direction_sources::DirectionSource;
use crate::error::Error;
use crate::feature_sources::{FeatureSource, Features};
use crate::size_sources::SizeSource;
use crate::symmetry::Symmetry;
use seamstress_parametrize::RoundingOptions;
use seamstress_parametrize::{self as method, Objective, PolishOptions};
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
    /// 0.0015; twice that along directions, at least 0.01]
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::not_negative))]
    pub cone_price: Option<f64>,

    /// How much corners between features keep to their own angle: larger values give fewer false
    /// corners and more distortion
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = parse::not_negative,
        default_value_t = Self::default().corner_weight))]
    pub corner_weight: f64,

    /// Take less than half of the time, as for a preview: cones are looked for on a coarser mesh still, the mean distortion
    /// stays a little above the least, and the largest (tau) is not polished
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["polish_time", "max_energy_rise"]))]
    pub fast: bool,

    /// Leave out the polish that lowers the largest distortion (tau); quads along directions have none
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
    pub(super) fn refuse_packing(&self) -> Result<(), Error> {
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
