//! The JSON schemas of options and reports.

use crate::command_reports::{CheckReport, ExtractReport, FoundFeaturesReport, MeasureReport};
use crate::{
    CertifyOptions, FeatureReport, FieldReport, IntegerMapOptions, IntegerMapReport, MapOptions,
    MapReport, Measurements, OptimizeOptions, OptimizeReport, QuadMeshReport, QuadOptions,
    QualityReport, SurfaceOptions, SurfaceReport, Verdict,
};
use schemars::{JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings};

/// The schemas of everything that goes through JSON, by name. Those published are in `docs/schema`.
///
/// Options are described as they are read, reports as they are written. The command line adds its name, files and cost
/// to a report.
pub fn schemas() -> Vec<(&'static str, Schema)> {
    vec![
        ("map-options", of::<MapOptions>(options())),
        ("integer-options", of::<IntegerMapOptions>(options())),
        ("quad-options", of::<QuadOptions>(options())),
        ("optimize-options", of::<OptimizeOptions>(options())),
        ("certify-options", of::<CertifyOptions>(options())),
        ("surface-options", of::<SurfaceOptions>(options())),
        ("surface", of::<SurfaceReport>(reports())),
        ("features", of::<FeatureReport>(reports())),
        ("map", of::<MapReport>(reports())),
        ("integer", of::<IntegerMapReport>(reports())),
        ("quad", of::<QuadMeshReport>(reports())),
        ("optimize", of::<OptimizeReport>(reports())),
        ("verdict", of::<Verdict>(reports())),
        ("measurements", of::<Measurements>(reports())),
        ("field", of::<FieldReport>(reports())),
        ("quality", of::<QualityReport>(reports())),
        ("check-report", of::<CheckReport>(reports())),
        ("features-report", of::<FoundFeaturesReport>(reports())),
        ("measure-report", of::<MeasureReport>(reports())),
        ("extract-report", of::<ExtractReport>(reports())),
    ]
}

fn options() -> SchemaSettings {
    SchemaSettings::draft2020_12().for_deserialize()
}

fn reports() -> SchemaSettings {
    SchemaSettings::draft2020_12().for_serialize()
}

fn of<T: JsonSchema>(settings: SchemaSettings) -> Schema {
    SchemaGenerator::new(settings).into_root_schema_for::<T>()
}
