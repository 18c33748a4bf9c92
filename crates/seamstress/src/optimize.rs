//! Laying a map out anew for another objective.

use crate::certify::CertifyOptions;
use crate::error::{Error, ErrorKind};
use crate::feature_sources::Features;
use crate::features::FeatureReport;
use crate::map::{Described, SeamlessMap};
use crate::report::{ConeReport, Distortion, SeamReport, SurfaceReport, VERSION};
use crate::surface::Surface;
use seamstress_parametrize::map::Certificate;
use seamstress_parametrize::{
    Anisotropy, Objective, RelayoutOptions, RelayoutStats, Solver, Stretch, lay_out_disk, relayout,
};
use serde::{Deserialize, Serialize};

/// Options of [`Surface::optimize`] and [`Surface::flatten_disk`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct OptimizeOptions {
    /// What to minimise
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME", value_parser = crate::options::parse::objective()))]
    pub objective: Objective,

    /// With an objective of the dilatation: keep it at most K, 1 or more, and minimise the mean symmetric
    /// Dirichlet energy under that bound; it fails if no such map is found
    #[cfg_attr(feature = "clap", arg(long, value_name = "K"))]
    pub bound: Option<f64>,

    /// Solver of the conic programs of `arap-max`, `tau`, `asap-max` and `dilatation`; where our own
    /// fails, Clarabel takes over
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "NAME", default_value_t = ConicSolver::Own))]
    pub solver: ConicSolver,

    /// Features that the map follows and is to keep
    #[cfg_attr(feature = "clap", arg(skip))]
    pub features: Features,

    /// Fail if the map does not follow a feature, instead of reporting it
    #[cfg_attr(feature = "clap", arg(long))]
    pub features_strict: bool,

    /// How far the sides of a seam of the map may be apart, in lengths of the edge, at most 0.01 [default: 1e-9]
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = crate::options::parse::not_negative,
        requires = "map"))]
    pub tolerance: Option<f64>,

    /// Stretches that count as no distortion, one a face; none for an isometry
    #[serde(skip)]
    #[cfg_attr(feature = "clap", arg(skip))]
    pub stretches: Option<Vec<Stretch>>,
}

/// Names of the conic solvers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum ConicSolver {
    /// Our own
    #[default]
    Own,
    /// Clarabel
    Clarabel,
}

impl Default for OptimizeOptions {
    fn default() -> Self {
        Self {
            objective: Objective::SymmetricDirichlet,
            bound: None,
            solver: ConicSolver::Own,
            features: Features::none(),
            features_strict: false,
            tolerance: None,
            stretches: None,
        }
    }
}

impl OptimizeOptions {
    /// Sets what to minimise.
    pub fn objective(mut self, objective: Objective) -> Self {
        self.objective = objective;
        self
    }

    /// Sets a bound on the dilatation, which has to be the objective.
    pub fn bound(mut self, bound: f64) -> Self {
        self.bound = Some(bound);
        self
    }

    /// Sets the features to keep.
    pub fn features(mut self, features: Features) -> Self {
        self.features = features;
        self
    }

    fn certify(&self) -> CertifyOptions {
        let mut options = CertifyOptions::default();
        options.tolerance = self.tolerance.unwrap_or(options.tolerance);
        options
    }

    fn validate_bound(&self) -> Result<(), Error> {
        match self.bound {
            Some(bound) if !(bound >= 1.0 && bound.is_finite()) => {
                let text = format!("bound is {bound}; no map has a dilatation below 1");
                Err(Error::options(text).with_hint("give a finite number, 1 or larger"))
            }
            Some(_) if !self.objective.is_of_dilatation() => {
                let text = format!("bound is one on the dilatation, not on {}", self.objective);
                let hint = "minimise `dilatation`, `dilatation-alternating` or \
                            `dilatation-bisection` with it";
                Err(Error::options(text).with_hint(hint))
            }
            _ => Ok(()),
        }
    }

    fn to_method(&self, surface: &Surface) -> Result<RelayoutOptions, Error> {
        self.validate_bound()?;
        let mut options = RelayoutOptions::new(self.objective);
        options.tolerance = self.certify().allowed()?;
        options.settings.dilatation_bound = self.bound;
        options.strict_features = self.features_strict;
        options.settings.conic.solver = match self.solver {
            ConicSolver::Own => Solver::Own,
            ConicSolver::Clarabel => Solver::Clarabel,
        };
        if let Some(stretches) = &self.stretches {
            let anisotropy = Anisotropy::new(surface.mesh(), surface.positions(), stretches)
                .map_err(|cause| Error::new(ErrorKind::BadStart, cause.to_string()))?;
            options.anisotropy = Some(anisotropy);
        }
        Ok(options)
    }
}

/// UVs, and the three of each face.
type FaceUvs<'a> = (&'a [[f64; 2]], &'a [[u32; 3]]);

/// How a map was optimised.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OptimizeReport {
    /// The version that made it.
    pub seamstress: &'static str,
    /// The options it was made with.
    pub options: OptimizeOptions,
    /// The surface.
    pub input: SurfaceReport,
    /// How each component was optimised, in order of first faces.
    pub components: Vec<RelayoutStats>,
    /// Its distortion.
    pub distortion: Distortion,
    /// Its cones.
    pub cones: ConeReport,
    /// Its seams.
    pub seams: SeamReport,
    /// What was checked of it.
    pub certificate: Certificate,
    /// The features asked for and what became of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub features: Option<FeatureReport>,
}

impl Described for OptimizeReport {
    const TITLE: &'static str = "Seamless map";

    fn lines(&self) -> Vec<String> {
        vec![self.distortion.line(self.cones.count)]
    }
}

impl Surface {
    /// Minimises an objective over all maps with the matchings and cones of a seamless map; its seams may come to lie
    /// elsewhere. The result is certified and never worse than the start, unless that does not keep the bound asked for.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`] if it is no seamless map to start from, [`ErrorKind::NoMap`] if none is found that keeps
    /// the bound, and those of [`Surface::parametrize`].
    pub fn optimize(
        &self,
        uvs: &[[f64; 2]],
        face_uvs: &[[u32; 3]],
        options: &OptimizeOptions,
    ) -> Result<SeamlessMap<OptimizeReport>, Error> {
        self.optimized(Some((uvs, face_uvs)), options)
    }

    /// Lays out a surface that is a disk, with a free boundary and no seam.
    ///
    /// # Errors
    /// [`ErrorKind::Options`] if it is no disk, and those of [`Surface::parametrize`].
    pub fn flatten_disk(
        &self,
        options: &OptimizeOptions,
    ) -> Result<SeamlessMap<OptimizeReport>, Error> {
        if !options.features.is_none() {
            return Err(Error::options("features need a map that follows them").of(self.input()));
        }
        self.optimized(None, options)
    }

    fn optimized(
        &self,
        start: Option<FaceUvs<'_>>,
        options: &OptimizeOptions,
    ) -> Result<SeamlessMap<OptimizeReport>, Error> {
        let mut settings = options.to_method(self)?;
        let corner_uvs = start.map(|(uvs, face_uvs)| self.corner_uvs(uvs, face_uvs)).transpose()?;
        let made = self.context().run(self.expected_for_map(), |watcher| {
            let start = corner_uvs.map(|uvs| self.seamless_map(uvs, &options.certify()));
            let start = start.transpose()?;
            let asked = self.features(&options.features)?;
            let is_asked = !options.features.is_none();
            settings.features = is_asked.then(|| asked.edges.clone());
            let mut observe = |progress| watcher.observe(progress);
            let (mesh, positions) = (self.mesh(), self.positions());
            let made = match &start {
                Some(map) => relayout(mesh, positions, map, &settings, &mut observe),
                None => lay_out_disk(mesh, positions, &settings, &mut observe),
            };
            let solution = made.map_err(|cause| match cause {
                cause if cause.is_not_a_disk() => Error::options(cause.to_string())
                    .with_hint("give a seamless map to start from, as made by `parametrize`"),
                cause if cause.is_infeasible() => Error::new(ErrorKind::NoMap, cause.to_string())
                    .with_hint("allow a larger `bound`, or start from another map"),
                cause => self.no_map(cause),
            })?;
            let certify = || self.aligned(asked, &solution.map, &solution.released);
            let features = is_asked.then(certify).transpose()?;
            let report = OptimizeReport {
                seamstress: VERSION,
                options: options.clone(),
                input: self.report().clone(),
                components: solution.components,
                distortion: Distortion::from(&solution.distortion),
                cones: ConeReport::new(solution.map.cones()),
                seams: SeamReport::new(solution.map.seams()),
                certificate: solution.map.certificate().clone(),
                features: features.as_ref().map(|features| features.report.clone()),
            };
            Ok(SeamlessMap::reported(self, solution.map, features, report))
        });
        made.map_err(|error| error.of(self.input()))
    }
}
