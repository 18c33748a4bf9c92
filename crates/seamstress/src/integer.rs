//! Integer-grid maps.

use crate::certify::CertifyOptions;
use crate::context::Watcher;
use crate::error::{Error, ErrorKind, FailedPart, Stage};
use crate::feature_sources::Features;
use crate::features::{AlignedFeatures, FeatureCurves, FeatureReport, edges_of};
use crate::finding::Elements;
use crate::grid_size::GridSize;
use crate::gridded::Rounding;
use crate::map::{Described, SeamlessMap};
use crate::options::{GridRounding, IntegerMapOptions};
use crate::parts::{PartReport, Selection};
use crate::report::{ConeReport, Distortion, SeamReport, SurfaceReport, VERSION};
use crate::seamless_start::SeamlessStart;
use crate::sizes::SizeReport;
use crate::surface::Surface;
use crate::words::{counted, rounded};
use seamstress_parametrize::map::{Certificate, IntegerCertificate};
use seamstress_parametrize::{self as method, Tolerance};
use seamstress_quads::GoesOn;
use seamstress_quantize::{
    Decisions, Quantization, QuantizationFailure, QuantizationStats, QuantizeError,
    QuantizeOptions, quantize_deciding,
};
use serde::Serialize;

/// What may help where quads are no manifold.
pub(crate) const FEWER_CONES: &str = "try more quads, or fewer cones with a larger `cone_bias`";

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
    /// Its connected parts that are small, and those that failed.
    pub parts: PartReport,
    /// The grid asked for and the one made.
    pub grid: GridReport,
    /// How the map of each component that is not left out was made, in order of first faces.
    pub components: Vec<QuantizationStats>,
    /// Distortion of the seamless map it was made from.
    pub distortion_before: Distortion,
    /// Its own distortion.
    pub distortion: Distortion,
    /// The sizes of cells asked for, if any were.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sizes: Option<SizeReport>,
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

/// Decides for maps of any kind.
struct AnyMap<'a>(&'a mut GoesOn<'a>);

impl Decisions for AnyMap<'_> {
    fn goes_on(&mut self, failure: &QuantizationFailure) -> bool {
        (self.0)(failure)
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
        let made = self.context().run(self.expected_for_grid(options.size), |watcher| {
            let asked = self.features_for(&options.map.features, options.size)?;
            self.integer_parts(&asked, options, watcher, |selection, options, watcher| {
                let surface = &selection.surface;
                let round = |start: &SeamlessStart,
                             settings: &_,
                             goes_on: &mut GoesOn<'_>,
                             watcher: &mut _| {
                    Ok(surface.make_integer(start, settings, goes_on, watcher)?)
                };
                let rounding = Rounding { round, solution: |made: &Quantization| made };
                surface.make_gridded(&selection.curves, options, watcher, &rounding)
            })
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
        let made = self.context().run(self.expected_for_grid(options.size), |watcher| {
            // Of all components, also of those that are left out.
            self.seamless_map(corner_uvs.clone(), certify)?;
            let asked = self.features(&options.map.features)?;
            self.integer_parts(&asked, options, watcher, |selection, options, watcher| {
                let (surface, curves) = (&selection.surface, selection.curves.clone());
                let map = surface.seamless_map(selection.corner_uvs(&corner_uvs), certify)?;
                let is_asked = !options.map.features.is_none();
                let tolerance = certify.allowed()?;
                let followed = || surface.followed(&map, curves, &tolerance);
                let features = is_asked.then(followed).transpose()?;
                let start = SeamlessStart { map, features, tolerance };
                let made =
                    surface.make_integer(&start, &options.to_quantize(), &mut |_| true, watcher);
                let made = made.map_err(|cause| surface.no_integer_map(cause, options.rounding))?;
                Ok((start, made))
            })
        });
        made.map_err(|error| error.of(self.input()))
    }

    /// The integer-grid map of the parts of a surface, each from a seamless map.
    fn integer_parts(
        &self,
        asked: &FeatureCurves,
        options: &IntegerMapOptions,
        watcher: &mut Watcher,
        make: impl Fn(
            &Selection,
            &IntegerMapOptions,
            &mut Watcher,
        ) -> Result<(SeamlessStart, Quantization), Error>,
    ) -> Result<IntegerGridMap, Error> {
        let cell = options.size.to_quantize().cell(self.metric().side());
        let sized = self.sized(asked, &options.map, cell)?;
        let sized = sized.directed(&options.map.directions, cell)?;
        let made = sized.make_parts(asked, options.size, options.parts, |selection, size| {
            let options = IntegerMapOptions { size, ..options.clone() };
            let (start, solution) = make(selection, &options, watcher)?;
            let surface = &selection.surface;
            let features = start
                .features
                .map(|features| features.certified_in(surface.mesh(), solution.map.seamless()));
            let features = features.transpose().map_err(|v| surface.misaligned(&v))?;
            let before = surface.distortion(start.map.corner_uvs());
            let uvs = solution.map.seamless().corner_uvs();
            let kept = features.as_ref().map_or(&[][..], |features| &features.kept);
            let empty = surface.components_without_cells(uvs, &edges_of(surface.mesh(), kept));
            let empty = selection.components_in_whole(&empty);
            Ok((surface.clone(), (before, solution), features, empty))
        })?;
        let ((surface, made, features, empty), parts) = made;
        Ok(surface.integer_grid_map(made, features, (parts, empty), options))
    }

    /// What a map that is given follows of the features asked for.
    pub(crate) fn followed(
        &self,
        map: &method::SeamlessMap,
        asked: FeatureCurves,
        tolerance: &Tolerance,
    ) -> Result<AlignedFeatures, Error> {
        let tolerance = Tolerance::of_seams(tolerance.seams);
        let (_, dropped) = method::followed(self.mesh(), map, &asked.edges, &tolerance)
            .map_err(|violations| self.not_a_map(&violations))?;
        AlignedFeatures::certify(self.mesh(), asked, map, &dropped, &tolerance)
            .map_err(|violations| self.not_a_map(&violations))
    }

    /// The seamless map to start from, by the direct method, its cones those of a grid of this size.
    pub(crate) fn make_seamless(
        &self,
        asked: FeatureCurves,
        options: &IntegerMapOptions,
        watcher: &mut Watcher,
    ) -> Result<SeamlessStart, Error> {
        let mut settings = options.map.to_method();
        let edge_length = options.size.to_quantize().cell(self.cell_metric().side());
        settings.purpose = method::Purpose::Quads { edge_length };
        let made = self.make_map(asked, &options.map, settings, watcher)?;
        Ok(SeamlessStart {
            map: made.inner().clone(),
            features: made.features().cloned(),
            tolerance: Tolerance::default(),
        })
    }

    /// Rounds a seamless map, its aligned features to lines of the grid.
    pub(crate) fn make_integer(
        &self,
        start: &SeamlessStart,
        settings: &QuantizeOptions,
        goes_on: &mut GoesOn<'_>,
        watcher: &mut Watcher,
    ) -> Result<Quantization, QuantizeError> {
        let kept = start.kept(self.mesh());
        let mut observe = |progress| watcher.observe(progress);
        let settings = QuantizeOptions { given: start.tolerance, ..*settings };
        let mut decisions = AnyMap(goes_on);
        quantize_deciding(
            self.mesh(),
            self.geometry(),
            &start.map,
            &kept,
            &settings,
            &mut decisions,
            &mut observe,
        )
    }

    /// Why a map could not be rounded, with the elements that it names.
    pub(crate) fn no_integer_map(&self, cause: QuantizeError, rounding: GridRounding) -> Error {
        if matches!(cause, QuantizeError::Cancelled(_)) {
            return Error::cancelled();
        }
        let QuantizeError::Components(failed) = cause else {
            let text = format!("no certified integer-grid map could be made: {cause}");
            return Error::new(ErrorKind::NoIntegerMap, text)
                .with_hint(hint(rounding))
                .at_stage(Some(Stage::Quantization));
        };
        let failed: Vec<FailedPart> = failed
            .into_iter()
            .map(|part| {
                self.failed_part(part.component, &self.failed_rounding(part.cause, rounding))
            })
            .collect();
        self.no_parts(ErrorKind::NoIntegerMap, "no certified integer-grid map", failed)
    }

    /// Why a component could not be rounded, with the elements that this names.
    fn failed_rounding(&self, cause: QuantizationFailure, rounding: GridRounding) -> Error {
        let cause = cause.renamed(|v| self.vertex_named(v), |face| self.face_named(face));
        let mut elements = Elements::default();
        let (mut kind, mut hint) = (ErrorKind::NoIntegerMap, hint(rounding));
        match &cause {
            QuantizationFailure::TooCoarse { pairs, .. } => {
                elements.vertices = pairs.as_flattened().to_vec();
                elements.vertices.sort_unstable();
                elements.vertices.dedup();
            }
            QuantizationFailure::Blocked { face, .. } => elements.faces = vec![*face],
            QuantizationFailure::Refused(refusal) => {
                elements.faces.clone_from(&refusal.faces);
                kind = ErrorKind::NotAManifold;
                hint = FEWER_CONES;
            }
            _ => {}
        }
        Error::new(kind, cause.to_string())
            .at_stage(Some(Stage::Quantization))
            .with_elements(elements)
            .with_hint(hint)
    }

    fn integer_grid_map(
        &self,
        (before, solution): (Distortion, Quantization),
        features: Option<AlignedFeatures>,
        (parts, components_without_quads): (PartReport, Vec<u32>),
        options: &IntegerMapOptions,
    ) -> IntegerGridMap {
        let seamless = solution.map.seamless();
        let report = IntegerMapReport {
            seamstress: VERSION,
            options: options.clone(),
            input: self.report().clone(),
            parts,
            grid: GridReport::new(options.size, &solution),
            distortion_before: before,
            distortion: self.distortion(seamless.corner_uvs()),
            sizes: self.size_report(seamless.corner_uvs(), solution.cell),
            cones: ConeReport::new(seamless.cones()),
            seams: SeamReport::new(seamless.seams()),
            certificate: seamless.certificate().clone(),
            integer_certificate: solution.map.certificate().clone(),
            features: features.as_ref().map(|features| features.report.clone()),
            components: solution.components,
            components_without_quads,
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
