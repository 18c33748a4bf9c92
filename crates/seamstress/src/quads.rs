//! Quad meshes.

use crate::context::Watcher;
use crate::error::{Error, ErrorKind, Stage};
use crate::feature_sources::Features;
use crate::features::FeatureReport;
use crate::grid_size::GridSize;
use crate::gridded::Rounding;
use crate::integer::GridReport;
use crate::options::{IntegerMapOptions, QuadOptions, ShapeOptions};
use crate::parts::Selection;
use crate::quad_report::{ExtractedMap, QuadMeshReport, QuadReport, Untangled};
use crate::refined::Workpiece;
use crate::report::{Distortion, VERSION};
use crate::seamless_start::SeamlessStart;
use crate::sizes::SizeReport;
use crate::surface::Surface;
use crate::symmetric::Side;
use crate::symmetry::Symmetry;
#[cfg(feature = "io")]
use crate::words::counted;
use seamstress_certify::Quads;
use seamstress_mesh::components::{Component, components};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Face, Halfedge};
use seamstress_parametrize::map::first_in_words;
use seamstress_parametrize::progress::go_on;
use seamstress_quads::extract::SurfacePoint;
use seamstress_quads::quality::Orientation;
use seamstress_quads::{
    self as quads, ExtractError, ExtractOptions, Extraction, GoesOn, IrregularVertex,
    ManifoldQuads, QuadConnectivity, SmoothError, SmoothOptions, UntangleOptions, manifold_quads,
};
use seamstress_quantize::{IntegerGridMap, Quantization};
use serde::Serialize;
#[cfg(feature = "io")]
use std::{io, path::Path};

/// A mesh of quads extracted from an integer-grid map, and where it comes from.
#[derive(Debug, Clone)]
pub struct QuadMesh {
    surface: Surface,
    extraction: Extraction,
    irregular: Vec<IrregularVertex>,
    report: QuadMeshReport,
    writes_sources: bool,
}

/// How quads are extracted from an integer-grid map that is given.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct ExtractionOptions {
    /// What is done to the vertices
    #[cfg_attr(feature = "clap", command(flatten))]
    pub shape: ShapeOptions,

    /// How far translations, cones and seams may be from exact, in grid units
    #[cfg_attr(feature = "clap", arg(long, value_name = "X", value_parser = crate::options::parse::not_negative,
        default_value_t = Self::default().tolerance))]
    pub tolerance: f64,

    /// Extract what can be extracted from a map that folds, and write it even if it is no manifold
    #[cfg_attr(feature = "clap", arg(long))]
    pub best_effort: bool,
}

impl Default for ExtractionOptions {
    fn default() -> Self {
        let ExtractOptions { tolerance, best_effort, .. } = ExtractOptions::default();
        Self { shape: ShapeOptions::default(), tolerance, best_effort }
    }
}

impl QuadMesh {
    /// The surface that it was made of.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Positions of the vertices, mesh units.
    pub fn positions(&self) -> &[[f64; 3]] {
        self.extraction.mesh.positions()
    }

    /// Vertices of the quads, counter-clockwise as the faces of the surface.
    pub fn quads(&self) -> &[[u32; 4]] {
        self.extraction.mesh.quads()
    }

    pub(crate) fn mesh(&self) -> &quads::QuadMesh {
        &self.extraction.mesh
    }

    /// The point of the surface at which the map has each vertex: a face and barycentric coordinates.
    pub fn sources(&self) -> &[SurfacePoint] {
        &self.extraction.sources
    }

    /// Interior vertices with another number of quads than four, each with its index: 4 less that number.
    pub fn irregular(&self) -> &[IrregularVertex] {
        &self.irregular
    }

    /// How it was made, and what it is.
    pub fn report(&self) -> &QuadMeshReport {
        &self.report
    }

    /// Whether files say where vertices come from, as far as they can.
    pub(crate) fn writes_sources(&self) -> bool {
        self.writes_sources
    }

    /// Writes it as OBJ, OFF, PLY, or STL or GLB (two triangles a quad), by the ending of the name, with what the surface
    /// carries and the format holds; the file appears when it is complete.
    ///
    /// # Errors
    /// [`ErrorKind::Unwritable`].
    #[cfg(feature = "io")]
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let output = match self.writes_sources {
            true => crate::files::Output::SourcePoints,
            false => crate::files::Output::Quads,
        };
        output.write(path, |file| self.write_as(path, file))
    }

    /// Writes it in the format that a file of this name has: OBJ, OFF, PLY, STL or GLB. If it says none, OBJ, or PLY with
    /// [`source_points`](ShapeOptions::source_points).
    ///
    /// # Errors
    /// Those of the writer.
    #[cfg(feature = "io")]
    pub fn write_as(&self, name: impl AsRef<Path>, writer: &mut impl io::Write) -> io::Result<()> {
        let mut comments = vec![format!("Quad mesh by Seamstress {VERSION}")];
        comments.extend(crate::map::source_line(&self.surface));
        comments.push(counted(self.quads().len(), "quad"));
        let attributes = &self.attributes().map_err(io::Error::other)?;
        let (positions, polygons, comments) = (self.positions(), self.quads(), &comments[..]);
        let mesh = seamstress_io::Polymesh { positions, polygons, attributes, comments };
        let otherwise = match self.writes_sources {
            true => seamstress_io::Format::Ply,
            false => seamstress_io::Format::Obj,
        };
        let format = seamstress_io::Format::from_path(name.as_ref());
        mesh.write(writer, format.unwrap_or(otherwise))
    }
}

/// The quads of some parts of a surface, placed on the whole.
pub(crate) struct PartQuads {
    pub(crate) solution: Quantization,
    pub(crate) extraction: Extraction,
    pub(crate) connectivity: QuadConnectivity,
    pub(crate) features: Option<FeatureReport>,
    pub(crate) shaped: (Untangled, Orientation),
    /// Triangles of the finer mesh, if there is one.
    pub(crate) finer: Option<usize>,
    /// Components without quads.
    pub(crate) empty: Vec<u32>,
    /// Of the map, on the surface.
    pub(crate) distortion: Distortion,
    pub(crate) sizes: Option<SizeReport>,
}

impl Selection {
    /// The quads of a selection of parts, of about a size.
    pub(crate) fn quads(
        &self,
        size: GridSize,
        options: &QuadOptions,
        watcher: &mut Watcher,
    ) -> Result<PartQuads, Error> {
        // Images are made of the whole.
        let map = options.map.clone().symmetry(Symmetry::None);
        let integer = IntegerMapOptions { size, map, ..IntegerMapOptions::default() };
        let edge_length = size.to_quantize().cell(self.surface.cell_metric().side());
        let work = Workpiece::new(&self.surface, self.curves.clone(), edge_length, &options.map)?;
        let surface = &work.surface;
        let (mesh, geometry) = (surface.mesh(), surface.geometry());
        let round = |start: &SeamlessStart,
                     settings: &_,
                     goes_on: &mut GoesOn<'_>,
                     watcher: &mut Watcher| {
            let (map, kept) = (&start.map, start.kept(mesh));
            let mut observe = |progress| watcher.observe(progress);
            manifold_quads(mesh, geometry, map, &kept, settings, goes_on, &mut observe)
        };
        let rounding = Rounding { round, solution: |made: &ManifoldQuads| &made.quantization };
        let (start, made) = surface.make_gridded(&work.curves, &integer, watcher, &rounding)?;
        let ManifoldQuads { quantization: solution, mut extraction, connectivity, .. } = made;
        let features = start.features.map(|f| f.certified_in(mesh, solution.map.seamless()));
        let features = features.transpose().map_err(|v| surface.misaligned(&v))?;
        let kept = features.as_ref().map_or(&[][..], |features| &features.kept);
        let shaped = surface.shape(&mut extraction, &options.shape, kept, watcher)?;
        surface.certify_quads(&extraction, Some(&solution.map))?;
        let uvs = solution.map.seamless().corner_uvs();
        let sizes = surface.quad_size_report(uvs, &extraction, solution.cell);
        let distortion = surface.distortion(uvs);
        work.bring_back(&mut extraction)?;
        let empty = self.components_in_whole(&self.surface.components_without(&extraction.sources));
        self.bring_back(&mut extraction);
        let features = features.map(|f| self.report_in_whole(work.feature_report(&f)));
        let finer = work.n_triangles();
        Ok(PartQuads {
            solution,
            extraction,
            connectivity,
            features,
            shaped,
            finer,
            empty,
            distortion,
            sizes,
        })
    }
}

/// How much quads follow principal directions, unless it is said.
const ALIGN: f64 = 1.0;

impl Surface {
    /// Makes a mesh of quads: a seamless map, rounded to an integer-grid map whose cells are extracted.
    ///
    /// The quads are an oriented manifold; their irregular vertices are the cones of the map. Cells that a boundary
    /// cuts which is not among the features are left out, and counted.
    ///
    /// # Errors
    /// [`ErrorKind::NoQuads`], [`ErrorKind::NotAManifold`], and those of [`Surface::integer_map`].
    pub fn quad_mesh(&self, options: &QuadOptions) -> Result<QuadMesh, Error> {
        options.validate()?;
        options.size.check_count(self.metric().side())?;
        // Cells that have sizes of their own keep these rather than directions.
        let align = if options.map.has_sizes() { 0.0 } else { ALIGN };
        let options =
            &options.clone().map(options.map.or_features(Features::auto()).or_align(align));
        let made = self.context().run(self.expected_for_grid(options.size), |watcher| {
            let asked = self.features_for(&options.map.features, options.size)?;
            let cell = options.size.to_quantize().cell(self.metric().side());
            let sized = self.sized(&asked, &options.map, cell)?;
            let sized = sized.directed(&options.map.directions, cell)?;
            let side = Side::new(&sized, &asked, &options.map, cell)?;
            let (made, parts) = match &side {
                None => {
                    let make =
                        |selection: &Selection, size| selection.quads(size, options, watcher);
                    sized.make_parts(&asked, options.size, options.parts, make)?
                }
                Some(side) => sized.symmetric_quads(side, options, watcher)?,
            };
            let PartQuads { solution, extraction, connectivity, features, shaped, .. } = made;
            let report = QuadMeshReport {
                seamstress: VERSION,
                options: Some(options.clone()),
                input: self.report().clone(),
                parts: Some(parts),
                symmetry: side.as_ref().map(Side::report),
                finer_triangles: made.finer,
                grid: Some(GridReport {
                    quads: extraction.uv_area,
                    ..GridReport::new(options.size, &solution)
                }),
                distortion: Some(made.distortion),
                sizes: made.sizes,
                integer_certificate: Some(solution.map.certificate().clone()),
                components: Some(solution.components),
                map: ExtractedMap::new(&extraction),
                features,
                quads: QuadReport::new(made.empty, &extraction, Ok(&connectivity)),
                mended: Some(shaped.0),
                orientation: Some(shaped.1),
            };
            let irregular = connectivity.irregular_vertices();
            let (surface, writes_sources) = (self.clone(), options.shape.source_points);
            Ok(QuadMesh { surface, extraction, irregular, report, writes_sources })
        });
        made.map_err(|error| error.of(self.input()))
    }

    /// Extracts the quads of an integer-grid map of this surface, made by any program, in grid units. Vertices on
    /// features stay on them when quads are untangled and smoothed; features that the quads do not follow are dropped.
    ///
    /// # Errors
    /// [`ErrorKind::NoQuads`] where it is no integer-grid map, and [`ErrorKind::NotAManifold`].
    pub fn extract_quads(
        &self,
        uvs: &[[f64; 2]],
        face_uvs: &[[u32; 3]],
        features: &Features,
        options: &ExtractionOptions,
    ) -> Result<QuadMesh, Error> {
        let corner_uvs = self.corner_uvs(uvs, face_uvs)?;
        let made = self.context().run(self.expected_for_cells(&corner_uvs), |watcher| {
            let asked = self.features(features)?;
            let settings =
                ExtractOptions { tolerance: options.tolerance, best_effort: options.best_effort };
            let mut observe = |progress| watcher.observe(progress);
            let (mesh, positions) = (self.mesh(), self.positions());
            let extracted = quads::extract(mesh, positions, &corner_uvs, &settings, &mut observe);
            let mut extraction =
                extracted.map_err(|cause| self.no_quads(&cause, &corner_uvs, options.tolerance))?;
            let connectivity = extraction.mesh.connectivity();
            if let (Err(faults), false) = (&connectivity, options.best_effort) {
                return Err(
                    Error::no_manifold(faults).with_hint("`best_effort` writes them all the same")
                );
            }
            let map = ExtractedMap::new(&extraction);
            let (kept, feature_report) = asked.followed_by(&extraction);
            // What folds have left holes in is no surface to shape.
            let shaped = match connectivity.is_ok() && extraction.folds.is_none() {
                true => {
                    let shaped = self.shape(&mut extraction, &options.shape, &kept, watcher)?;
                    self.certify_quads(&extraction, None)?;
                    Some(shaped)
                }
                false => None,
            };
            let empty = self.components_without(&extraction.sources);
            let quads = QuadReport::new(empty, &extraction, connectivity.as_ref());
            let irregular = connectivity.as_ref().map(QuadConnectivity::irregular_vertices);
            let (mended, orientation) = shaped.unzip();
            let report = QuadMeshReport {
                seamstress: VERSION,
                options: None,
                input: self.report().clone(),
                parts: None,
                symmetry: None,
                finer_triangles: None,
                grid: None,
                distortion: None,
                sizes: None,
                integer_certificate: None,
                components: None,
                map,
                features: (!features.is_none()).then_some(feature_report),
                quads,
                mended,
                orientation,
            };
            let irregular = irregular.unwrap_or_default();
            let (surface, writes_sources) = (self.clone(), options.shape.source_points);
            Ok(QuadMesh { surface, extraction, irregular, report, writes_sources })
        });
        made.map_err(|error| error.of(self.input()))
    }

    /// The components in which no cell of an integer-grid map fits whole. Only a boundary cuts cells that does not lie
    /// on lines of the grid, as aligned edges do.
    pub(crate) fn components_without_cells(
        &self,
        corner_uvs: &[[f64; 2]],
        aligned: &EdgeSet,
    ) -> Vec<u32> {
        let settings = ExtractOptions::default();
        let is_empty = |piece: &Component| {
            let is_cut = |h: Halfedge| {
                let whole = piece.faces[h.face().at()].halfedge(h.side());
                piece.mesh.twin(h).is_none() && !aligned.contains(whole)
            };
            if !piece.mesh.halfedges().any(is_cut) {
                return false;
            }
            let (positions, uvs) =
                (piece.positions(self.positions()), piece.corner_uvs(corner_uvs));
            let quads = quads::extract(&piece.mesh, &positions, &uvs, &settings, &mut go_on);
            matches!(quads, Err(ExtractError::NoQuads { .. }))
        };
        let pieces = components(self.mesh()).unwrap_or_default();
        pieces.iter().zip(0..).filter(|(piece, _)| is_empty(piece)).map(|(_, k)| k).collect()
    }

    /// The components that none of some points lies on.
    pub(crate) fn components_without(&self, points: &[SurfacePoint]) -> Vec<u32> {
        // Each of them has been a mesh as part of the whole.
        let components = components(self.mesh()).unwrap_or_default();
        let mut has_points = vec![false; self.faces().len()];
        for point in points {
            has_points[point.face as usize] = true;
        }
        let is_empty = |faces: &[Face]| !faces.iter().any(|face| has_points[face.at()]);
        let empty = components.iter().zip(0u32..).filter(|(c, _)| is_empty(&c.faces));
        empty.map(|(_, number)| number).collect()
    }

    /// Untangles and smooths quads, which must be a manifold; says what moved, and how they lie to the surface.
    fn shape(
        &self,
        extraction: &mut Extraction,
        options: &ShapeOptions,
        features: &[[u32; 2]],
        watcher: &mut Watcher,
    ) -> Result<(Untangled, Orientation), Error> {
        watcher.enter(Stage::Shaping)?;
        let constraints = extraction.constraints(self.mesh(), self.geometry(), features);
        let surface = (self.positions(), self.faces());
        let failure = |cause: &dyn std::fmt::Display| {
            Error::new(ErrorKind::NoQuads, format!("no quads were extracted: {cause}"))
                .at_stage(Some(Stage::Shaping))
        };
        let not_shaped = |cause: SmoothError| match cause {
            SmoothError::Cancelled(_) => Error::cancelled(),
            cause => failure(&cause),
        };
        let mut observe = |progress| watcher.observe(progress);
        let mut untangled = Untangled { moved: 0, largest_move: 0.0 };
        if !options.raw {
            let settings =
                UntangleOptions { constraints: constraints.clone(), ..UntangleOptions::default() };
            let shaped = quads::untangle(&extraction.mesh, surface, &settings, &mut observe)
                .map_err(not_shaped)?;
            untangled = Untangled { moved: shaped.moved, largest_move: shaped.largest_move };
            extraction.mesh = shaped.mesh;
        }
        if options.smooth > 0 {
            let settings = SmoothOptions { rounds: options.smooth, constraints };
            let smoothed = quads::smooth(&extraction.mesh, surface, &settings, &mut observe);
            extraction.mesh = smoothed.map_err(not_shaped)?.mesh;
        }
        let polygons = extraction.mesh.quads().iter().map(<[u32; 4]>::as_slice);
        let orientation = Orientation::new(extraction.mesh.positions(), polygons, surface)
            .map_err(|cause| failure(&cause))?;
        Ok((untangled, orientation))
    }

    /// Certifies quads of this surface, and of an integer-grid map of it, by the checker alone.
    fn certify_quads(
        &self,
        extraction: &Extraction,
        map: Option<&IntegerGridMap>,
    ) -> Result<(), Error> {
        let sources: Vec<u32> = extraction.sources.iter().map(|point| point.face).collect();
        let quads = Quads {
            quads: extraction.mesh.quads(),
            sources: &sources,
            n_vertices: self.positions().len(),
            faces: self.faces(),
            is_trimmed: extraction.trimmed > 0,
        };
        let agrees = |map: &IntegerGridMap| {
            let cones: Vec<i32> = map.seamless().cones().iter().map(|cone| cone.index).collect();
            quads.agree_with(&cones, map.certificate().area)
        };
        let certified = quads.check().and_then(|_| match map.filter(|_| !quads.is_trimmed) {
            Some(map) => agrees(map),
            None => Ok(()),
        });
        certified.map_err(|violations| {
            let first = first_in_words(&violations.0);
            let text = format!("quads were made, but they are not those of the surface: {first}");
            Error::new(ErrorKind::Internal, text).with_hint("please report this with the mesh")
        })
    }
}
