//! A finer mesh of a surface to make its quads on.

use crate::error::{Error, ErrorKind, Stage};
use crate::features::{AlignedFeatures, FeatureCurves, FeatureReport, edges_of, ordered};
use crate::options::MapOptions;
use crate::surface::Surface;
use seamstress_mesh::refine::{Refinement, refine};
use seamstress_parametrize::ReleasedFeature;
use seamstress_quads::extract::SurfacePoint;
use seamstress_quads::{Extraction, locate};
use std::collections::{BTreeMap, HashMap};

/// Edges of the finer mesh, in cells: coarser than the quads, since a map bends little within a cell.
const EDGE: f64 = 2.0;
/// Edges of it on the side of a square with the area of the surface at most: more cost time and gain little.
const MOST_EDGES: f64 = 40.0;

/// The surface that quads are made on, and its features: the one that is given, or a finer mesh of it.
pub(crate) struct Workpiece {
    pub(crate) surface: Surface,
    pub(crate) curves: FeatureCurves,
    refined: Option<Refined>,
}

/// Where a finer mesh comes from.
struct Refined {
    surface: Surface,
    curves: FeatureCurves,
    /// The edge of the surface that a feature edge is a piece of; ends ascending.
    feature_origin: HashMap<[u32; 2], [u32; 2]>,
}

impl Workpiece {
    /// With room for features, and for quads of about an edge length.
    ///
    /// # Errors
    /// A fault of this program.
    pub(crate) fn new(
        surface: &Surface,
        curves: FeatureCurves,
        edge_length: f64,
        options: &MapOptions,
    ) -> Result<Self, Error> {
        let size = (EDGE * edge_length).max(surface.cell_metric().side() / MOST_EDGES);
        let (mesh, positions) = (surface.mesh(), surface.positions());
        let Some(refinement) = refine(mesh, positions, &curves.edges, size) else {
            return Ok(Self { surface: surface.clone(), curves, refined: None });
        };
        let Refinement { positions, faces, face_origin, features } = refinement;
        let finer = surface.refined(positions, faces, &face_origin)?;
        let pairs: Vec<[u32; 2]> = features.iter().map(|piece| piece.vertices).collect();
        let feature_origin =
            features.iter().map(|piece| (ordered(piece.vertices), piece.source)).collect();
        let refined = Refined { surface: surface.clone(), curves: curves.clone(), feature_origin };
        let edges = edges_of(finer.mesh(), &pairs);
        let curves = curves.on(&finer, edges);
        let surface = surface.sized_finer(finer, &curves, options, edge_length)?;
        Ok(Self { surface, curves, refined: Some(refined) })
    }

    /// Triangles of the finer mesh, if there is one.
    pub(crate) fn n_triangles(&self) -> Option<usize> {
        self.refined.as_ref().map(|_| self.surface.faces().len())
    }

    /// The report on features as one on those of the surface that was given: an edge is kept if all its pieces are.
    pub(crate) fn feature_report(&self, aligned: &AlignedFeatures) -> FeatureReport {
        let Some(refined) = &self.refined else { return aligned.report.clone() };
        let mut dropped = BTreeMap::new();
        for piece in &aligned.dropped {
            if let Some(&edge) = refined.feature_origin.get(&ordered(piece.vertices)) {
                dropped
                    .entry(ordered(edge))
                    .or_insert_with(|| ReleasedFeature::new(edge, piece.reason));
            }
        }
        let mut report = refined.curves.report().clone();
        report.kept = Some(report.edges - dropped.len());
        report.dropped = Some(dropped.into_values().collect());
        report.alignment.clone_from(&aligned.report.alignment);
        report
    }

    /// Makes places on the finer mesh places on the surface that was given.
    ///
    /// # Errors
    /// Where the surface cannot be searched.
    pub(crate) fn bring_back(&self, extraction: &mut Extraction) -> Result<(), Error> {
        let Some(Refined { surface, .. }) = &self.refined else { return Ok(()) };
        let (positions, faces) = (self.surface.positions(), self.surface.faces());
        let points = extraction.sources.iter().map(|place| place.position(positions, faces));
        extraction.sources = surface.places_of(points)?;
        let n_vertices = surface.positions().len() as u32;
        for cone in &mut extraction.cones {
            cone.source = cone.source.filter(|&vertex| vertex < n_vertices);
        }
        Ok(())
    }
}

impl Surface {
    /// The places on the surface nearest to points where quads have come from.
    ///
    /// # Errors
    /// Where the surface cannot be searched.
    pub(crate) fn places_of(
        &self,
        points: impl IntoIterator<Item = [f64; 3]>,
    ) -> Result<Vec<SurfacePoint>, Error> {
        locate(self.positions(), self.faces(), points.into_iter()).map_err(|cause| {
            Error::new(ErrorKind::NoQuads, format!("no quads were extracted: {cause}"))
                .at_stage(Some(Stage::Extraction))
        })
    }
}
