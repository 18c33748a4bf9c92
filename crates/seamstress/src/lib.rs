//! Seamless parametrizations of triangle meshes, and what people make from them: integer-grid maps and quad meshes.

mod certify;
mod context;
mod error;
mod features;
#[cfg(feature = "io")]
mod files;
mod finding;
mod inspection;
mod integer;
mod map;
mod options;
mod polygons;
mod quads;
mod report;
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
#[doc(hidden)]
pub use finding::listing;
pub use finding::{Elements, Finding, Severity};
pub use inspection::{Inspection, SurfaceOptions};
pub use integer::{GridReport, IntegerGridMap, IntegerMapReport};
pub use map::{MapReport, SeamlessMap};
pub use options::{
    GridRounding, GridSize, IntegerMapOptions, MapOptions, QuadOptions, ShapeOptions,
};
pub use quads::{
    ExtractedMap, ExtractionOptions, IrregularReport, QuadMesh, QuadMeshReport, QuadReport,
    QuadTopology, Untangled,
};
pub use report::{
    ComponentFactsReport, ConeReport, Distortion, Measurement, Percentiles, SeamReport,
    SurfaceReport, VERSION,
};
pub use surface::Surface;
