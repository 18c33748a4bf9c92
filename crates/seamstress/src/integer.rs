//! Integer-grid maps.

use crate::certify::CertifyOptions;
use crate::context::Watcher;
use crate::error::{Error, ErrorKind, Stage};
use crate::features::{AlignedFeatures, FeatureCurves, FeatureReport, Features, edges_of};
use crate::finding::Elements;
use crate::grid_size::GridSize;
use crate::map::{Described, SeamlessMap};
use crate::options::{GridRounding, IntegerMapOptions};
use crate::report::{ConeReport, Distortion, SeamReport, SurfaceReport, VERSION};
use crate::surface::Surface;
use crate::words::{counted, rounded};
use seamstress_mesh::TriMesh;
use seamstress_mesh::features::EdgeSet;
use seamstress_parametrize::map::Certificate;
use seamstress_parametrize::{self as method};
use seamstress_quantize::{
    IntegerCertificate, Quantization, QuantizationFailure, QuantizationStats, QuantizeError,
    quantize,
};
use serde::Serialize;

/// A certified seamless map whose unit grid closes up over the surface: translations and cones are whole numbers, and
/// UVs are in grid units.
pub type IntegerGridMap = SeamlessMap<IntegerMapReport>;

/// How an integer-grid map was made, and how good it is.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IntegerMapReport {
    /// The version that made it.
    pub seamstress: &'static str,
    /// The options it was made with.
    pub options: IntegerMapOptions,
    /// The surface.
    pub input: SurfaceReport,
    /// The grid asked for and the one made.
    pub grid: GridReport,
    /// How the map of each component was made, in order of first faces.
    pub components: Vec<QuantizationStats>,
    /// Distortion of the seamless map it was made from.
    pub distortion_before: Distortion,
    /// Its own distortion.
    pub distortion: Distortion,
    /// Its cones.
    pub cones: ConeReport,
    /// Its seams.
    pub seams: SeamReport,
    /// What was checked of it as a seamless map.
    pub certificate: Certificate,
    /// What was checked of the whole numbers.
    pub integer_certificate: IntegerCertificate,
    /// The features asked for and what became of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub features: Option<FeatureReport>,
    /// Components of the surface, counted from 0, in which no cell fits whole, so that they will have no quads.
    pub components_without_quads: Vec<u32>,
}

/// A grid asked for and the one made.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct GridReport {
    /// As asked for.
    pub requested: GridSize,
    /// Area of the map in grid units: the number of quads, a whole number unless a boundary cuts cells.
    #[serde(serialize_with = "whole_without_point")]
    #[cfg_attr(feature = "schema", schemars(with = "f64"))]
    pub quads: f64,
    /// Edge length of a cell, mesh units, before any component needed a finer one.
    pub edge_length: f64,
    /// Cells per mesh unit.
    pub scale: f64,
    /// Finer grids that were needed, over all components.
    pub refinements: usize,
    /// Cell sizes tried to meet a number of quads.
    pub sizes_tried: usize,
}

impl GridReport {
    pub(crate) fn new(requested: GridSize, solution: &Quantization) -> Self {
        Self {
            requested,
            quads: solution.quads(),
            edge_length: solution.cell,
            scale: 1.0 / solution.cell,
            refinements: solution.refinements(),
            sizes_tried: solution.sizes_tried,
        }
    }

    fn line(&self) -> String {
        let asked = match self.requested {
            GridSize::Quads(quads) => format!("{quads} quads"),
            GridSize::EdgeLength(length) => format!("edge length {}", rounded(length)),
            GridSize::Scale(scale) => format!("scale {}", rounded(scale)),
        };
        let quads = match self.quads {
            whole if whole.fract() == 0.0 => whole.to_string(),
            cut => format!("{cut:.1}"),
        };
        let mut text = format!("{quads} quads, asked for {asked}");
        if self.refinements > 0 {
            let times = counted(self.refinements, "time");
            text += &format!("; {times} finer where cones are close");
        }
        text
    }
}

fn whole_without_point<S: serde::Serializer>(x: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match *x {
        whole if whole.fract() == 0.0 && (0.0..u32::MAX.into()).contains(&whole) => {
            serializer.serialize_u32(whole as u32)
        }
        other => serializer.serialize_f64(other),
    }
}

impl std::fmt::Display for GridReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.line())
    }
}

impl Described for IntegerMapReport {
    const TITLE: &'static str = "Integer-grid map";
    // One check a cell.
    const CHECK: Option<f64> = Some(1.0);

    fn lines(&self) -> Vec<String> {
        vec!["One quad per unit square".into(), self.grid.to_string()]
    }
}

/// What an integer-grid map is made from.
pub(crate) struct SeamlessStart {
    pub(crate) map: method::SeamlessMap,
    pub(crate) features: Option<AlignedFeatures>,
}

impl SeamlessStart {
    /// The features that it follows.
    pub(crate) fn kept(&self, mesh: &TriMesh) -> EdgeSet {
        let kept = self.features.as_ref().map_or(&[][..], |features| &features.kept);
        edges_of(mesh, kept)
    }
}

impl Surface {
    /// Makes a seamless map whose cones suit the grid, and rounds it to an integer-grid map.
    ///
    /// # Errors
    /// [`ErrorKind::NoIntegerMap`], and those of [`Surface::parametrize`].
    pub fn integer_map(&self, options: &IntegerMapOptions) -> Result<IntegerGridMap, Error> {
        options.validate()?;
        options.size.check_count(self.metric().side())?;
        let options = &options.clone().map(options.map.or_features(Features::auto()));
        let made = self.context().run(|watcher| {
            let asked = self.features_for(&options.map.features, options.size)?;
            let start = self.make_seamless(asked, options, watcher)?;
            let solution = self.make_integer(&start, options, watcher)?;
            Ok(self.integer_grid_map(solution, start.features, options))
        });
        made.map_err(|error| error.of(self.input()))
    }

    /// Rounds a seamless map of this surface, from anywhere, to an integer-grid map. Features that it has on its
    /// axes come to lie on lines of the grid; the others are dropped.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`] if it is no seamless map to the tolerance of `certify`, and those of
    /// [`Surface::integer_map`].
    pub fn integer_map_of(
        &self,
        uvs: &[[f64; 2]],
        face_uvs: &[[u32; 3]],
        certify: &CertifyOptions,
        options: &IntegerMapOptions,
    ) -> Result<IntegerGridMap, Error> {
        options.validate()?;
        options.size.check_count(self.metric().side())?;
        let options = &options.clone().map(options.map.or_features(Features::none()));
        let corner_uvs = self.corner_uvs(uvs, face_uvs)?;
        let made = self.context().run(|watcher| {
            let map = self.seamless_map(corner_uvs, certify)?;
            let features = self.followed(&map, &options.map.features)?;
            let start = SeamlessStart { map, features };
            let solution = self.make_integer(&start, options, watcher)?;
            Ok(self.integer_grid_map(solution, start.features, options))
        });
        made.map_err(|error| error.of(self.input()))
    }

    /// What a map that is given follows of the features asked for.
    pub(crate) fn followed(
        &self,
        map: &method::SeamlessMap,
        features: &Features,
    ) -> Result<Option<AlignedFeatures>, Error> {
        if features.is_none() {
            return Ok(None);
        }
        let asked = self.features(features)?;
        let (_, dropped) = method::followed(self.mesh(), map, &asked.edges)
            .map_err(|violations| self.not_a_map(&violations))?;
        let aligned = AlignedFeatures::certify(self.mesh(), asked, map, &dropped);
        aligned.map(Some).map_err(|violations| self.not_a_map(&violations))
    }

    /// The seamless map to start from, by the direct method, its cones those of a grid of this size.
    pub(crate) fn make_seamless(
        &self,
        asked: FeatureCurves,
        options: &IntegerMapOptions,
        watcher: &mut Watcher,
    ) -> Result<SeamlessStart, Error> {
        let mut settings = options.map.to_method();
        let edge_length = options.size.to_quantize().cell(self.metric().side());
        settings.purpose = method::Purpose::Quads { edge_length };
        let made = self.make_map(asked, &options.map, settings, watcher)?;
        Ok(SeamlessStart { map: made.inner().clone(), features: made.features().cloned() })
    }

    /// Rounds a seamless map, its aligned features to lines of the grid.
    pub(crate) fn make_integer(
        &self,
        start: &SeamlessStart,
        options: &IntegerMapOptions,
        watcher: &mut Watcher,
    ) -> Result<Quantization, Error> {
        let kept = start.kept(self.mesh());
        let mut observe = |progress| watcher.observe(progress);
        let (map, settings) = (&start.map, options.to_quantize());
        quantize(self.mesh(), self.positions(), map, &kept, &settings, &mut observe)
            .map_err(|cause| self.no_integer_map(&cause, options.rounding))
    }

    /// Why a map could not be rounded, with the elements that it names.
    pub(crate) fn no_integer_map(&self, cause: &QuantizeError, rounding: GridRounding) -> Error {
        if matches!(cause, QuantizeError::Cancelled(_)) {
            return Error::cancelled();
        }
        let text = format!("no certified integer-grid map could be made: {cause}");
        let error = Error::new(ErrorKind::NoIntegerMap, text).with_hint(hint(rounding));
        let mut elements = Elements::default();
        if let QuantizeError::Component { cause, .. } = cause {
            match cause {
                QuantizationFailure::TooCoarse { pairs, .. } => {
                    elements.vertices = pairs.as_flattened().to_vec();
                    elements.vertices.sort_unstable();
                    elements.vertices.dedup();
                }
                QuantizationFailure::Blocked { face, .. } => elements.faces = vec![*face],
                _ => {}
            }
        }
        error.at_stage(Some(Stage::Quantization)).with_elements(self.in_input(&elements))
    }

    fn integer_grid_map(
        &self,
        solution: Quantization,
        features: Option<AlignedFeatures>,
        options: &IntegerMapOptions,
    ) -> IntegerGridMap {
        let seamless = solution.map.seamless();
        let report = IntegerMapReport {
            seamstress: VERSION,
            options: options.clone(),
            input: self.report().clone(),
            grid: GridReport::new(options.size, &solution),
            distortion_before: Distortion::from(&solution.before),
            distortion: Distortion::from(&solution.distortion),
            cones: ConeReport::new(seamless.cones()),
            seams: SeamReport::new(seamless.seams()),
            certificate: seamless.certificate().clone(),
            integer_certificate: solution.map.certificate().clone(),
            features: features.as_ref().map(|features| features.report.clone()),
            components: solution.components,
            components_without_quads: self.components_without_cells(seamless.corner_uvs()),
        };
        SeamlessMap::reported(self, seamless.clone(), features, report)
    }
}

fn hint(rounding: GridRounding) -> &'static str {
    match rounding {
        GridRounding::Constrained => "try a finer grid, or fewer cones with a larger `cone_bias`",
        GridRounding::Greedy => {
            "greedy `rounding` is for comparison; leave it out, or try a finer grid"
        }
    }
}
