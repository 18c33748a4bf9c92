//! Quad meshes of any program laid out in the plane.

use crate::certify::CertifyOptions;
use crate::error::{Error, ErrorKind};
use crate::inspection::Inspection;
use crate::map::Described;
use crate::quality::PolygonMesh;
use crate::report::{ConeReport, Distortion, SeamReport, VERSION};
use crate::surface::Surface;
use crate::{CrossField, SeamlessMap, SurfaceOptions};
use seamstress_parametrize::map::Certificate;
use seamstress_quads::QuadMesh;
use seamstress_quads::layout::{self, lay_out_conformal, lay_out_squares};
use serde::{Deserialize, Serialize};

/// How the coordinates of quads are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum QuadLayoutMethod {
    /// One square after the other, breadth first: exact
    #[default]
    Squares,
    /// Least squares conformal map: one linear system, exact up to rounding
    Conformal,
}

/// How far seams of the conformal layout may be open, in quad edges: its linear system is badly
/// conditioned on large meshes, which is what it is there to show.
const CONFORMAL_TOLERANCE: f64 = 1e-5;

/// Polygons that are no quads, named at most.
const LISTED: usize = 5;

/// The seamless map in which every quad is a unit square.
pub type QuadLayout = SeamlessMap<QuadLayoutReport>;

/// How quads were laid out.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuadLayoutReport {
    /// The version that made it.
    pub seamstress: &'static str,
    /// The quad mesh.
    pub input: QuadInput,
    /// Its distortion.
    pub distortion: Distortion,
    /// Its cones: the irregular vertices.
    pub cones: ConeReport,
    /// Its seams.
    pub seams: SeamReport,
    /// What was checked of it.
    pub certificate: Certificate,
    /// Largest distance of a coordinate from an integer.
    pub integer_error: f64,
}

/// A quad mesh that was laid out.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuadInput {
    /// The file.
    pub file: Option<String>,
    /// Vertices.
    pub vertices: usize,
    /// Quads.
    pub quads: usize,
}

impl Described for QuadLayoutReport {
    const TITLE: &'static str = "Layout of a quad mesh";

    fn lines(&self) -> Vec<String> {
        vec!["Every two triangles are a unit square".into()]
    }
}

impl PolygonMesh {
    fn quads(&self) -> Result<QuadMesh, Error> {
        let refused = |text: String| Error::new(ErrorKind::NotQuads, text).of(self.input());
        let sizes = self.polygons().map(<[u32]>::len).enumerate();
        let others: Vec<(usize, usize)> = sizes.filter(|&(_, corners)| corners != 4).collect();
        if !others.is_empty() {
            let name =
                |(face, corners): &(usize, usize)| format!("face {face} with {corners} corners");
            let shown: Vec<String> = others.iter().take(LISTED).map(name).collect();
            let more = if others.len() > LISTED { ", ..." } else { "" };
            return Err(refused(format!(
                "not a quad mesh: {} of its {} faces have another number of corners than four: {}{more}",
                others.len(),
                self.polygons().len(),
                shown.join(", ")
            )));
        }
        let corners = self.polygons().filter_map(|polygon| <[u32; 4]>::try_from(polygon).ok());
        QuadMesh::new(self.positions().to_vec(), corners.collect())
            .map_err(|cause| refused(cause.to_string()))
    }

    /// Lays the quads out: every one a unit square, irregular vertices the cones.
    ///
    /// # Errors
    /// [`ErrorKind::NotQuads`] if they are no oriented manifold of quads.
    ///
    /// # Source
    /// Levi 2021, suppl. sec. 7.
    pub fn lay_out(&self, method: QuadLayoutMethod) -> Result<QuadLayout, Error> {
        let quads = self.quads()?;
        let layout = self.squares(&quads, method)?;
        let surface = Surface::from_triangles(quads.positions(), &layout.faces)
            .map_err(|error| error.of(self.input()))?
            .named(self.input());
        let error = |x: &f64| (x - x.round()).abs();
        let integer_error = layout.corner_uvs.iter().flatten().map(error).fold(0.0, f64::max);
        let mut certify = CertifyOptions::default();
        if method == QuadLayoutMethod::Conformal {
            certify.tolerance = CONFORMAL_TOLERANCE;
        }
        let map = surface.seamless_map(layout.corner_uvs, &certify).map_err(|error| {
            let text = format!("the layout failed its certificate: {}", error.message());
            Error::new(ErrorKind::Internal, text).of(self.input())
        })?;
        let report = QuadLayoutReport {
            seamstress: VERSION,
            input: QuadInput {
                file: self.input().map(str::to_owned),
                vertices: quads.positions().len(),
                quads: quads.quads().len(),
            },
            distortion: surface.distortion(map.corner_uvs()),
            cones: ConeReport::new(map.cones()),
            seams: SeamReport::new(map.seams()),
            certificate: map.certificate().clone(),
            integer_error,
        };
        Ok(SeamlessMap::reported(&surface, map, None, report))
    }

    fn squares(
        &self,
        quads: &QuadMesh,
        method: QuadLayoutMethod,
    ) -> Result<layout::QuadLayout, Error> {
        let layout = match method {
            QuadLayoutMethod::Squares => lay_out_squares(quads),
            QuadLayoutMethod::Conformal => lay_out_conformal(quads),
        };
        layout.map_err(|cause| Error::new(ErrorKind::NotQuads, cause.to_string()).of(self.input()))
    }

    /// The cross field of the quads: on each of the two triangles of a quad the directions of its sides.
    ///
    /// # Errors
    /// [`ErrorKind::NotQuads`] and [`ErrorKind::NotASurface`].
    pub fn field(&self) -> Result<CrossField, Error> {
        let quads = self.quads()?;
        let layout = self.squares(&quads, QuadLayoutMethod::Squares)?;
        // The surface splits each quad along either diagonal.
        let inspection =
            Inspection::of_polygons(self.positions(), self.polygons(), &SurfaceOptions::default());
        let surface =
            inspection.surface().map_err(|error| error.of(self.input()))?.named(self.input());
        let halves =
            layout.faces.as_flattened().chunks_exact(6).zip(layout.corner_uvs.chunks_exact(6));
        let uvs = halves.zip(surface.faces().as_flattened().chunks_exact(6)).flat_map(
            |((vertices, uvs), here)| {
                here.iter().filter_map(|v| Some(uvs[vertices.iter().position(|w| w == v)?]))
            },
        );
        let map = surface.seamless_map(uvs.collect(), &CertifyOptions::default())?;
        surface.field_of(&map)
    }
}
