//! Seamless parametrizations of triangle meshes, and what people make from them: integer-grid maps and quad meshes.

mod certify;
mod context;
mod error;
mod features;
mod field;
#[cfg(feature = "io")]
mod files;
mod finding;
#[cfg(feature = "io")]
mod given;
mod inspection;
mod integer;
#[cfg(all(feature = "lab", feature = "io"))]
pub mod lab;
mod map;
mod optimize;
mod options;
#[cfg(feature = "render")]
mod pictures;
mod polygons;
mod quads;
mod quality;
mod report;
#[cfg(feature = "schema")]
mod schema;
mod surface;
#[doc(hidden)]
pub mod words;

pub use certify::{CertifyOptions, Measurements, Verdict};
pub use context::{CancelToken, Context, Progress};
pub use error::{Error, ErrorCategory, ErrorKind, Stage};
pub use features::{
    FeatureCurve, FeatureCurves, FeatureNode, FeatureReport, FeatureSource, FeatureSourceReport,
    Features,
};
pub use field::{CrossField, EdgeMatching, FieldReport};
#[cfg(feature = "io")]
pub use field::{write_cones, write_matchings};
#[doc(hidden)]
pub use finding::listing;
pub use finding::{Elements, Finding, Severity};
#[cfg(feature = "io")]
pub use given::MapFile;
pub use inspection::{Inspection, SurfaceOptions};
pub use integer::{GridReport, IntegerGridMap, IntegerMapReport};
pub use map::{MapReport, SeamlessMap};
pub use optimize::{ConicSolver, OptimizeOptions, OptimizeReport};
pub use options::{
    GridRounding, GridSize, IntegerMapOptions, MapOptions, QuadOptions, ShapeOptions,
};
#[cfg(feature = "render")]
pub use pictures::{MapPictures, TextureOptions};
pub use quads::{
    ExtractedMap, ExtractionOptions, IrregularReport, QuadMesh, QuadMeshReport, QuadReport,
    QuadTopology, Untangled,
};
pub use quality::{PolygonMesh, QuadMetric, QualityReport, SourceReport};
pub use report::{
    ComponentFactsReport, ConeReport, Distortion, Measurement, Percentiles, SeamReport,
    SurfaceReport, VERSION,
};
#[cfg(feature = "schema")]
pub use schema::schemas;
pub use surface::Surface;

#[cfg(feature = "io")]
pub use seamstress_io::{AtomicFile, Format};
pub use seamstress_parametrize::map::{Certificate, Cone, SeamEdge};
pub use seamstress_parametrize::mixed_integer::MixedIntegerStats;
pub use seamstress_parametrize::quality::Measure;
pub use seamstress_parametrize::{
    Alignment, ComponentStats, ConicStats, Objective, RelayoutStats, ReleasedFeature, Stretch,
};
pub use seamstress_quads::extract::SurfacePoint;
pub use seamstress_quads::{IrregularVertex, quality::Orientation};
pub use seamstress_quantize::{IntegerCertificate, IntegerStats};
