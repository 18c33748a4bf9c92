//! Reports of commands that put several reports together.

use crate::certify::{CertifyOptions, Measurements, Verdict};
use crate::feature_sources::FeatureSource;
use crate::features::FeatureReport;
use crate::finding::Finding;
use crate::inspection::Inspection;
use crate::quad_report::QuadMeshReport;
use crate::quads::ExtractionOptions;
use crate::report::{ConeReport, Distortion, Measurement, SeamReport, SurfaceReport, VERSION};
use crate::surface_options::{SurfaceOptions, Weld};
use seamstress_parametrize::Alignment;
use seamstress_parametrize::map::{Certificate, IntegerCertificate};
use serde::Serialize;

/// What `check` reports.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CheckReport {
    /// The version that checked it.
    seamstress: &'static str,
    /// What was asked for.
    options: CheckOptions,
    /// The mesh.
    input: SurfaceReport,
    /// Its features, if any were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    features: Option<FeatureReport>,
    /// What was found.
    #[serde(flatten)]
    found: CheckedReport,
}

/// The options of `check`.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct CheckOptions {
    /// Whether to repair the mesh.
    repair: bool,
    /// Which of its vertices were merged.
    weld: Weld,
    #[serde(flatten)]
    certify: CertifyOptions,
}

/// What `check` has found of a mesh, or of a map of it.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum CheckedReport {
    Map {
        /// The map.
        map: Box<CheckedMapReport>,
    },
    Mesh {
        /// All that is wrong with the mesh.
        faults: Vec<Finding>,
        /// Whether it can be mapped.
        is_mesh: bool,
        /// Whether repairs would make it so.
        is_repairable: bool,
    },
}

/// What `check` has found of a map.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CheckedMapReport {
    /// Its file.
    file: String,
    /// Whether it is a seamless map of the mesh.
    certified: bool,
    /// Why not.
    violations: Vec<Finding>,
    /// Its distortion, if it has the faces of the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    distortion: Option<Distortion>,
    /// What was checked of it as a seamless map.
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<Certificate>,
    /// Its cones.
    #[serde(skip_serializing_if = "Option::is_none")]
    cones: Option<ConeReport>,
    /// Its seams.
    #[serde(skip_serializing_if = "Option::is_none")]
    seams: Option<SeamReport>,
    /// Whether it has the features on its axes.
    #[serde(skip_serializing_if = "Option::is_none")]
    aligned: Option<bool>,
    /// What was checked of them, or why not.
    #[serde(skip_serializing_if = "Option::is_none")]
    alignment: Option<Found<Alignment>>,
    /// Whether it is an integer-grid map.
    #[serde(skip_serializing_if = "Option::is_none")]
    integral: Option<bool>,
    /// What was checked of its whole numbers, or why not.
    #[serde(skip_serializing_if = "Option::is_none")]
    integer_certificate: Option<Found<IntegerCertificate>>,
}

/// A certificate, or why there is none.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum Found<T> {
    Certificate(T),
    Violations {
        /// Why there is none.
        violations: Vec<Finding>,
    },
}

impl CheckReport {
    /// Of a mesh with its features, and if a map of it was checked, of that.
    pub fn new(
        inspection: &Inspection,
        features: Option<&FeatureReport>,
        map: Option<CheckedMapReport>,
        (surface, certify): (SurfaceOptions, CertifyOptions),
    ) -> Self {
        let found = match map {
            Some(map) => CheckedReport::Map { map: Box::new(map) },
            None => CheckedReport::Mesh {
                faults: inspection.findings().to_vec(),
                is_mesh: inspection.is_surface(),
                is_repairable: inspection.is_repairable(),
            },
        };
        let options = CheckOptions { repair: surface.repair, weld: surface.weld, certify };
        Self {
            seamstress: VERSION,
            options,
            input: inspection.report().clone(),
            features: features.cloned(),
            found,
        }
    }
}

impl CheckedMapReport {
    /// Of a map in a file, that differs from the mesh, or of which something was found.
    pub fn new(file: String, differences: &[Finding], verdict: Option<&Verdict>) -> Self {
        let of_verdict = verdict.iter().flat_map(|verdict| &verdict.violations);
        let violations: Vec<Finding> = differences.iter().chain(of_verdict).cloned().collect();
        let certified = verdict.filter(|verdict| differences.is_empty() && verdict.certified);
        fn found<T>(
            passed: Option<bool>,
            certificate: Option<T>,
            violations: &[Finding],
        ) -> Option<Found<T>> {
            match passed? {
                true => certificate.map(Found::Certificate),
                false => Some(Found::Violations { violations: violations.to_vec() }),
            }
        }
        let alignment =
            certified.and_then(|v| found(v.aligned, v.alignment.clone(), &v.alignment_violations));
        let integers = certified
            .and_then(|v| found(v.integral, v.integer_certificate.clone(), &v.integer_violations));
        Self {
            file,
            certified: certified.is_some(),
            violations,
            distortion: verdict.map(|verdict| verdict.distortion),
            certificate: certified.and_then(|verdict| verdict.certificate.clone()),
            cones: certified.and_then(|verdict| verdict.cones.clone()),
            seams: certified.and_then(|verdict| verdict.seams.clone()),
            aligned: certified.and_then(|verdict| verdict.aligned),
            alignment,
            integral: verdict.and_then(|verdict| verdict.integral),
            integer_certificate: integers,
        }
    }
}

/// What `features` reports.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FoundFeaturesReport {
    /// The version that found them.
    seamstress: &'static str,
    /// The mesh.
    input: SurfaceReport,
    /// Its features.
    features: FeatureReport,
}

impl FoundFeaturesReport {
    /// Of features of a surface.
    pub fn new(input: &SurfaceReport, features: &FeatureReport) -> Self {
        Self { seamstress: VERSION, input: input.clone(), features: features.clone() }
    }
}

/// What `measure` reports.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeasureReport {
    /// The version that measured it.
    seamstress: &'static str,
    /// What was asked for.
    options: MeasureOptions,
    /// The mesh.
    input: SurfaceReport,
    /// The map.
    map: MeasuredMap,
    /// The measures.
    measures: Vec<Measurement>,
}

/// The options of `measure`.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct MeasureOptions {
    /// Whether to repair the mesh.
    repair: bool,
    /// How far the sides of a seam may be apart, in lengths of the edge.
    tolerance: f64,
}

/// A map whose distortion was measured.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct MeasuredMap {
    /// Its file.
    file: String,
    /// Triangles flipped or collapsed.
    flipped: usize,
    /// Triangles without area on the surface.
    degenerate: usize,
    /// Whether it is a seamless map.
    certified: bool,
    /// Why not.
    fault: Option<String>,
}

impl MeasureReport {
    /// Of a map in a file, of a surface.
    pub fn new(
        input: &SurfaceReport,
        file: String,
        measured: &Measurements,
        (surface, certify): (SurfaceOptions, &CertifyOptions),
    ) -> Self {
        let map = MeasuredMap {
            file,
            flipped: measured.flipped,
            degenerate: measured.degenerate,
            certified: measured.certified,
            fault: measured.fault.clone(),
        };
        Self {
            seamstress: VERSION,
            options: MeasureOptions { repair: surface.repair, tolerance: certify.tolerance },
            input: input.clone(),
            map,
            measures: measured.measures.clone(),
        }
    }
}

/// What `extract` reports.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ExtractReport {
    /// The quads.
    #[serde(flatten)]
    quads: QuadMeshReport,
    /// What was asked for.
    #[serde(rename = "options")]
    options: ExtractOptions,
}

/// The options of `extract`.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct ExtractOptions {
    #[serde(flatten)]
    extraction: ExtractionOptions,
    /// Sources of the features that vertices are kept on.
    features: Vec<FeatureSource>,
}

impl ExtractReport {
    /// Of quads of a map that was given.
    pub fn new(
        quads: &QuadMeshReport,
        extraction: ExtractionOptions,
        features: &[FeatureSource],
    ) -> Self {
        let options = ExtractOptions { extraction, features: features.to_vec() };
        Self { quads: quads.clone(), options }
    }
}
