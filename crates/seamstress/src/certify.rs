//! Certifying and measuring maps, whatever program made them.

use crate::error::{Error, Stage};
use crate::feature_sources::Features;
use crate::features::FeatureReport;
use crate::finding::Finding;
use crate::report::{ConeReport, Distortion, Measurement, SeamReport};
use crate::surface::Surface;
use seamstress_parametrize::map::{Certificate, IntegerCertificate, first_in_words};
use seamstress_parametrize::quality::{SingularValues, measure_all};
use seamstress_parametrize::{Alignment, SeamlessMap, Tolerance};
use serde::{Deserialize, Serialize};

/// Options of [`Surface::certify_with`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct CertifyOptions {
    /// Features that the map has to have on its axes
    #[cfg_attr(feature = "clap", arg(skip))]
    pub features: Features,

    /// Check an integer-grid map, in grid units: translations across seams and places of cones have to be
    /// integers, and features have to lie on lines of the grid, with their corners at grid points
    #[cfg_attr(feature = "clap", arg(long))]
    pub integer: bool,

    /// How far the sides of a seam may be apart, in lengths of the edge, at most 0.01; for maps written with
    /// few digits
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = crate::options::parse::not_negative,
        default_value_t = Self::default().tolerance))]
    pub tolerance: f64,

    /// How far the image of a feature may be off an axis, in degrees, at most 1; for maps written with few
    /// digits
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = crate::options::parse::not_negative,
        default_value_t = Self::default().alignment_tolerance))]
    pub alignment_tolerance: f64,

    /// How far translations, cones and features of an integer-grid map may be from integers, in grid units,
    /// at most 0.01; for maps written with few digits [default: exact]
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = crate::options::parse::not_negative,
        default_value_t = 0.0, hide_default_value = true))]
    pub integer_tolerance: f64,
}

impl Default for CertifyOptions {
    fn default() -> Self {
        Self {
            features: Features::none(),
            integer: false,
            tolerance: Tolerance::default().seams,
            alignment_tolerance: Tolerance::default().axes,
            integer_tolerance: Tolerance::default().integers,
        }
    }
}

impl CertifyOptions {
    /// Sets the features that have to be aligned.
    pub fn features(mut self, features: Features) -> Self {
        self.features = features;
        self
    }

    /// Asks for an integer-grid map.
    pub fn integer(mut self) -> Self {
        self.integer = true;
        self
    }

    /// Sets how far the sides of a seam may be apart, in lengths of the edge.
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// The tolerances, none of them so large that the check would mean nothing.
    pub(crate) fn allowed(&self) -> Result<Tolerance, Error> {
        let within = |name: &str, what: &str, given: f64, largest: f64| {
            if (0.0..=largest).contains(&given) {
                return Ok(given);
            }
            let text =
                format!("{name}: a tolerance of {given} {what}: it must be from 0 to {largest}");
            Err(Error::options(text))
        };
        let most = Tolerance::LARGEST;
        let (seams, axes) = ("edge lengths for seams", "degrees for aligned edges");
        Ok(Tolerance {
            seams: within("tolerance", seams, self.tolerance, most.seams)?,
            axes: within("alignment_tolerance", axes, self.alignment_tolerance, most.axes)?,
            integers: within(
                "integer_tolerance",
                "grid units for integers",
                self.integer_tolerance,
                most.integers,
            )?,
        })
    }
}

/// What was found of a map from anywhere.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Verdict {
    /// Whether it is a seamless map, without a flip.
    pub certified: bool,
    /// Why not.
    pub violations: Vec<Finding>,
    /// What was checked, if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// Its distortion.
    pub distortion: Distortion,
    /// Its cones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cones: Option<ConeReport>,
    /// Its seams.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seams: Option<SeamReport>,
    /// Whether the features asked for lie on its axes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aligned: Option<bool>,
    /// What was checked of them, if they do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alignment: Option<Alignment>,
    /// Why not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alignment_violations: Vec<Finding>,
    /// Whether it is an integer-grid map, if that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integral: Option<bool>,
    /// What was checked of its integers, if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integer_certificate: Option<IntegerCertificate>,
    /// Why not, if it is a seamless map.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub integer_violations: Vec<Finding>,
    /// The features asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub features: Option<FeatureReport>,
}

impl Verdict {
    /// Whether all that was asked for is certified.
    pub fn is_passed(&self) -> bool {
        self.certified && self.aligned != Some(false) && self.integral != Some(false)
    }
}

/// Every measure of distortion over a map, and whether it is seamless.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Measurements {
    /// Triangles flipped or collapsed.
    pub flipped: usize,
    /// Triangles without area on the surface.
    pub degenerate: usize,
    /// Whether it is a seamless map.
    pub certified: bool,
    /// Why not.
    pub fault: Option<String>,
    /// The measures.
    pub measures: Vec<Measurement>,
}

impl Surface {
    /// Certifies a map of this surface, by UVs and the three of each face: no triangle is flipped or collapsed, every
    /// seam fits, every cone angle is a multiple of a quarter turn.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`](crate::ErrorKind::NotAMap) with every violation.
    pub fn certify(&self, uvs: &[[f64; 2]], face_uvs: &[[u32; 3]]) -> Result<Certificate, Error> {
        let corner_uvs = self.corner_uvs(uvs, face_uvs)?;
        let certified = self.seamless_map(corner_uvs, &CertifyOptions::default())?;
        Ok(certified.certificate().clone())
    }

    /// Certifies a map as [`Surface::certify`] does, the alignment of features, and if asked for its integers;
    /// finds out all there is.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`](crate::ErrorKind::NotAMap) if the UVs are not of this surface's faces, and those of [`Surface::features`].
    pub fn certify_with(
        &self,
        uvs: &[[f64; 2]],
        face_uvs: &[[u32; 3]],
        options: &CertifyOptions,
    ) -> Result<Verdict, Error> {
        let tolerance = options.allowed()?;
        let corner_uvs = self.corner_uvs(uvs, face_uvs)?;
        let features = match options.features.is_none() {
            true => None,
            false => Some(self.features(&options.features)?),
        };
        let distortion = self.distortion(&corner_uvs);
        let mut verdict = Verdict {
            certified: false,
            violations: Vec::new(),
            certificate: None,
            distortion,
            cones: None,
            seams: None,
            aligned: None,
            alignment: None,
            alignment_violations: Vec::new(),
            integral: options.integer.then_some(false),
            integer_certificate: None,
            integer_violations: Vec::new(),
            features: features.as_ref().map(|features| features.report().clone()),
        };
        let map = match SeamlessMap::certify(self.mesh(), corner_uvs, &tolerance) {
            Ok(map) => map,
            Err(violations) => {
                verdict.violations = self.findings(&violations);
                return Ok(verdict);
            }
        };
        verdict.certified = true;
        verdict.certificate = Some(map.certificate().clone());
        verdict.cones = Some(ConeReport::new(map.cones()));
        verdict.seams = Some(SeamReport::new(map.seams()));
        let aligned = features.as_ref().map_or(Vec::new(), |features| features.edges().to_vec());
        if features.is_some() {
            match map.alignment(self.mesh(), &aligned, &tolerance) {
                Ok(alignment) => verdict.alignment = Some(alignment),
                Err(violations) => verdict.alignment_violations = self.findings(&violations),
            }
            verdict.aligned = Some(verdict.alignment.is_some());
        }
        if options.integer {
            match map.integers(self.mesh(), &aligned, &tolerance) {
                Ok(certificate) => verdict.integer_certificate = Some(certificate),
                Err(violations) => verdict.integer_violations = self.findings(&violations),
            }
            verdict.integral = Some(verdict.integer_certificate.is_some());
        }
        Ok(verdict)
    }

    /// Measures the distortion of any map of this surface; it may have flips and open seams.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`](crate::ErrorKind::NotAMap) if the UVs are not of this surface's faces.
    pub fn measure(
        &self,
        uvs: &[[f64; 2]],
        face_uvs: &[[u32; 3]],
        options: &CertifyOptions,
    ) -> Result<Measurements, Error> {
        let tolerance = options.allowed()?;
        let corner_uvs = self.corner_uvs(uvs, face_uvs)?;
        let singular = SingularValues::new(self.mesh(), self.metric(), &corner_uvs);
        let fault = SeamlessMap::certify(self.mesh(), corner_uvs, &tolerance)
            .err()
            .map(|violations| first_in_words(&violations.0));
        Ok(Measurements {
            flipped: singular.flipped(),
            degenerate: singular.degenerate(),
            certified: fault.is_none(),
            fault,
            measures: measure_all(&singular).into_iter().map(Measurement::from).collect(),
        })
    }

    /// A certified map of corner UVs.
    pub(crate) fn seamless_map(
        &self,
        corner_uvs: Vec<[f64; 2]>,
        options: &CertifyOptions,
    ) -> Result<SeamlessMap, Error> {
        SeamlessMap::certify(self.mesh(), corner_uvs, &options.allowed()?)
            .map_err(|violations| self.not_a_map(&violations).at_stage(Some(Stage::Certificate)))
    }
}
