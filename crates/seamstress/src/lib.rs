//! Seamless parametrizations of triangle meshes, and what people make from them: integer-grid maps, quad meshes,
//! cross fields, metrics and pictures.
//!
//! Everything starts from a [`Surface`]:
//!
//! | you want | call |
//! |---|---|
//! | a surface | [`Surface::read`], [`Surface::from_triangles`], [`Surface::from_polygons`]; [`Inspection`] for what need not be one |
//! | a seamless map | [`Surface::parametrize`] |
//! | an integer-grid map | [`Surface::integer_map`], [`Surface::integer_map_of`] |
//! | a quad mesh | [`Surface::quad_mesh`], [`Surface::extract_quads`] |
//! | UVs, materials, colours and other attributes of the mesh on the quads | [`QuadMesh::transfer`] |
//! | to know whether a map is seamless | [`Surface::certify`], [`Surface::certify_with`] |
//! | its distortion | [`Surface::measure`] |
//! | another distortion minimised | [`Surface::optimize`], [`Surface::flatten_disk`] |
//! | its cross field | [`Surface::field`] |
//! | creases, rims and other features | [`Surface::features`] |
//! | the quality of a quad mesh | [`PolygonMesh::quality`] |
//!
//! ```
//! use seamstress::{MapOptions, Surface};
//!
//! // A tetrahedron.
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
//! let surface = Surface::from_triangles(&positions, &faces)?;
//! let map = surface.parametrize(&MapOptions::default())?;
//! assert_eq!(map.face_uvs().len(), 4);
//! // The indices of the cones of a sphere add up to 8 quarters.
//! assert_eq!(map.cones().iter().map(|cone| cone.index).sum::<i32>(), 8);
//! # Ok::<(), seamstress::Error>(())
//! ```
//!
//! Whatever takes long runs under the [`Context`] that was attached to the surface: progress, cancellation, a time
//! limit, threads. Options have defaults and go through JSON, reports come as JSON with published schemas. The
//! one [`Error`] has a stable code, a stage, elements in the ids of the input, and a hint. The same input gives the same
//! output on any number of threads.
//!
//! # Features
//!
//! | feature | default | for |
//! |---|---|---|
//! | `io` | yes | reading and writing files |
//! | `render` | yes | pictures, drawn in software |
//! | `page` | yes | results as pages to look at in a browser |
//! | `parallel` | yes | threads |
//! | `metis` | yes | nested dissection by METIS, in C; else the minimum-degree ordering of faer |
//! | `clarabel` | yes | a second solver of conic programs, where ours fails |
//! | `lab` | | research options and baselines, for experiments and comparisons |
//! | `schema` | | JSON schemas |
//! | `clap` | | options as command-line arguments |

mod as_text;
mod attributes;
mod certify;
mod checked;
#[doc(hidden)]
pub mod command_reports;
mod context;
mod direction_sources;
mod directions;
mod error;
mod expected;
mod feature_edges;
mod feature_sources;
mod features;
mod field;
#[cfg(feature = "io")]
mod files;
mod finding;
mod forecast;
#[cfg(feature = "io")]
mod given;
mod grid_size;
mod gridded;
mod inspection;
mod integer;
#[cfg(feature = "lab")]
pub mod lab;
mod map;
mod memory;
mod mesh_format;
mod mirrored;
mod named;
mod no_map;
mod no_quads;
mod optimize;
mod options;
mod packing;
#[cfg(feature = "page")]
mod page;
mod parts;
#[cfg(feature = "render")]
mod pictures;
mod polygons;
mod quad_report;
mod quads;
mod quality;
mod refined;
mod report;
#[cfg(feature = "schema")]
mod schema;
mod seamless_start;
mod size_sources;
mod sizes;
mod surface;
mod surface_options;
mod symmetric;
mod symmetry;
#[doc(hidden)]
pub mod words;

pub use certify::{CertifyOptions, Measurements, Verdict};
pub use context::{CancelToken, Context, Progress};
pub use direction_sources::DirectionSource;
pub use error::{Error, ErrorCategory, ErrorKind, FailedPart, Stage};
pub use feature_sources::{FeatureSource, Features};
pub use features::{FeatureCurve, FeatureCurves, FeatureNode, FeatureReport, FeatureSourceReport};
pub use field::{CrossField, EdgeMatching, FieldLoop, FieldReport, FullTurns};
#[cfg(feature = "io")]
pub use field::{write_cones, write_matchings};
#[cfg(feature = "io")]
#[doc(hidden)]
pub use files::Output;
#[doc(hidden)]
pub use finding::listing;
pub use finding::{Elements, Finding, Severity};
#[cfg(feature = "io")]
pub use given::MapFile;
pub use grid_size::GridSize;
pub use inspection::Inspection;
pub use integer::{GridReport, IntegerGridMap, IntegerMapReport};
#[doc(hidden)]
pub use map::Described;
pub use map::{MapReport, SeamlessMap, UvSet};
pub use mesh_format::MeshFormat;
pub use optimize::{ConicSolver, OptimizeOptions, OptimizeReport};
pub use options::{GridRounding, IntegerMapOptions, MapOptions, QuadOptions, ShapeOptions};
pub use packing::PackingReport;
#[cfg(feature = "page")]
pub use page::Page;
#[cfg(all(feature = "page", feature = "io"))]
#[doc(hidden)]
pub use page::{Done, Task, refusal};
#[cfg(feature = "page")]
#[doc(hidden)]
pub use page::{Explained, PageFacts};
pub use parts::{PartOptions, PartReport, SmallParts};
#[cfg(feature = "render")]
pub use pictures::{MapPictures, TextureOptions, UpAxis, ViewOptions, ViewSide};
pub use quad_report::{
    ExtractedMap, IrregularReport, QuadMeshReport, QuadReport, QuadTopology, Untangled,
};
pub use quads::{ExtractionOptions, QuadMesh};
pub use quality::{PolygonMesh, QuadMetric, QualityReport, SourceReport};
pub use report::{
    ComponentFactsReport, ConeReport, Distortion, Measurement, Percentiles, SeamReport,
    SurfaceReport, VERSION,
};
#[cfg(feature = "schema")]
pub use schema::schemas;
pub use size_sources::SizeSource;
pub use sizes::SizeReport;
pub use surface::Surface;
pub use surface_options::{SurfaceOptions, Weld};
pub use symmetry::{Symmetry, SymmetryPlane, SymmetryReport};

#[cfg(feature = "io")]
#[doc(hidden)]
pub use seamstress_io::AtomicFile;
pub use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind, Attributes};
pub use seamstress_parametrize::MixedIntegerStats;
pub use seamstress_parametrize::map::{Certificate, Cone, IntegerCertificate, SeamEdge};
pub use seamstress_parametrize::quality::Measure;
pub use seamstress_parametrize::{
    Alignment, ComponentStats, ConicStats, Objective, RelayoutStats, ReleasedFeature, Stretch,
};
pub use seamstress_quads::extract::SurfacePoint;
pub use seamstress_quads::{IrregularVertex, quality::Orientation};
pub use seamstress_quantize::QuantizationStats;
