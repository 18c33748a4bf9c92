//! The quality of quad meshes, whatever program made them.

use crate::error::{Error, ErrorKind};
#[cfg(feature = "render")]
use crate::pictures::{ViewOptions, draw_polygons};
use crate::polygons::Polygons;
use crate::report::{Distortion, Measurement, VERSION};
use seamstress_parametrize::quality::Measure;
#[cfg(feature = "render")]
use seamstress_quads::quality::angle_deviations;
use seamstress_quads::quality::{
    Angles, ComparisonError, EdgeLengths, Orientation, SurfaceDistance, Topology, compare, measure,
};
#[cfg(feature = "render")]
use seamstress_render::HeatMap;
use serde::Serialize;
#[cfg(feature = "io")]
use std::path::Path;

/// A mesh of polygons, mostly quads, as it was given. It need be no manifold.
#[derive(Debug, Clone)]
pub struct PolygonMesh {
    input: Option<String>,
    positions: Vec<[f64; 3]>,
    polygons: Polygons,
}

/// The quality of a quad mesh.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QualityReport {
    /// The version that measured it.
    pub seamstress: &'static str,
    /// The file.
    pub input: Option<String>,
    /// Polygons, irregular vertices, Euler characteristic.
    pub topology: Topology,
    /// Corner angles.
    pub angles: Angles,
    /// Edge lengths.
    pub edge_lengths: EdgeLengths,
    /// Distortion of the layout in which every quad is a unit square.
    pub distortion: Option<Distortion>,
    /// Every measure of it.
    pub measures: Vec<Measurement>,
    /// Why there is no layout.
    pub no_layout: Option<String>,
    /// How it lies to its source.
    #[serde(flatten)]
    pub compared: Option<SourceReport>,
}

/// How a quad mesh lies to the surface it was made from.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SourceReport {
    /// The file of the surface.
    pub source: Option<String>,
    /// Distances between the two.
    pub distance: SurfaceDistance,
    /// Inverted and crossed quads, seen from the surface.
    pub orientation: Orientation,
}

/// What a picture of a quad mesh shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum QuadMetric {
    /// The largest deviation of a corner from the regular polygon's.
    Angle,
    /// A measure of the distortion of the layout.
    Measure(Measure),
}

impl PolygonMesh {
    /// Reads a mesh: OBJ, OFF, PLY, STL or glTF.
    ///
    /// # Errors
    /// [`ErrorKind::Unreadable`], and [`ErrorKind::NotQuads`] if it has no faces.
    #[cfg(feature = "io")]
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let read = crate::files::read_mesh(path, None)?;
        let input = Some(path.display().to_string());
        Self::checked(Self {
            input,
            positions: read.positions,
            polygons: read.polygons.iter().collect(),
        })
    }

    /// Takes polygons as lists of vertices, counted from 0.
    ///
    /// # Errors
    /// [`ErrorKind::NotQuads`] if there are no faces, or one names a vertex that does not exist.
    pub fn new<P: AsRef<[u32]>>(
        positions: &[[f64; 3]],
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<Self, Error> {
        let polygons = polygons.into_iter().collect();
        Self::checked(Self { input: None, positions: positions.to_vec(), polygons })
    }

    fn checked(self) -> Result<Self, Error> {
        let n_vertices = self.positions.len();
        let bad = |polygon: &[u32]| polygon.iter().any(|&v| v as usize >= n_vertices);
        if self.polygons.len() == 0 {
            return Err(self.refused("it has no faces"));
        }
        let faulty = self.polygons.iter().position(bad);
        match faulty {
            Some(face) => {
                Err(self.refused(&format!("face {face} names a vertex that does not exist")))
            }
            None => Ok(self),
        }
    }

    /// The file it was read from.
    pub fn input(&self) -> Option<&str> {
        self.input.as_deref()
    }

    /// Positions of the vertices.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// The polygons.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = &[u32]> + Clone {
        self.polygons.iter()
    }

    fn refused(&self, text: &str) -> Error {
        Error::new(ErrorKind::NotQuads, text).of(self.input())
    }

    /// Measures it; with a source also the distances to that, from about so many sampled points each.
    ///
    /// # Errors
    /// [`ErrorKind::NotQuads`] and [`ErrorKind::NotASurface`] where distances are not defined.
    pub fn quality(
        &self,
        source: Option<(&crate::Inspection, u32)>,
    ) -> Result<QualityReport, Error> {
        let quality = measure(&self.positions, self.polygons.iter());
        let compared = source.map(|(source, samples)| self.compare(source, samples)).transpose()?;
        Ok(QualityReport {
            seamstress: VERSION,
            input: self.input.clone(),
            topology: quality.topology,
            angles: quality.angles,
            edge_lengths: quality.edge_lengths,
            distortion: quality.distortion.as_ref().map(Distortion::from),
            measures: quality.measures.into_iter().map(Measurement::from).collect(),
            no_layout: quality.no_layout,
            compared,
        })
    }

    fn compare(&self, source: &crate::Inspection, samples: u32) -> Result<SourceReport, Error> {
        let parts = &source.parts;
        // Repairs change polygons to triangles with other vertices.
        let reference: Vec<&[u32]> = match parts.vertex_origin {
            None => parts.polygons.iter().collect(),
            Some(_) => parts.soup.faces.iter().map(<[u32; 3]>::as_slice).collect(),
        };
        let mesh = (self.positions.as_slice(), self.polygons.iter());
        let reference = (parts.soup.positions.as_slice(), reference.into_iter());
        let compared = compare(mesh, reference, samples as usize).map_err(|cause| match cause {
            ComparisonError::BadMesh(_) => self.refused(&cause.to_string()),
            cause => {
                Error::new(ErrorKind::NotASurface, cause.to_string()).of(parts.input.as_deref())
            }
        })?;
        let (distance, orientation) = (compared.distance, compared.orientation);
        Ok(SourceReport { source: parts.input.clone(), distance, orientation })
    }

    /// Draws it from both sides in the colours of a metric, with irregular vertices and a legend, as a PNG file.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`], and [`ErrorKind::NotQuads`] where the metric is not defined.
    #[cfg(feature = "render")]
    pub fn picture(
        &self,
        quality: &QualityReport,
        of: QuadMetric,
        view: &ViewOptions,
    ) -> Result<Vec<u8>, Error> {
        let (values, heat) = match of {
            QuadMetric::Angle => self.angle_heat(),
            QuadMetric::Measure(wanted) => {
                let Some(measured) = quality.measures.iter().find(|m| m.measure == wanted) else {
                    let reason = quality.no_layout.as_deref().unwrap_or("there is no layout");
                    let text = format!("{} cannot be painted: {reason}", wanted.name());
                    return Err(self.refused(&text));
                };
                // The worse of a quad's two triangles.
                let worse = |pair: &[f64]| pair.iter().copied().fold(f64::NAN, f64::max);
                (measured.values.chunks(2).map(worse).collect(), measured.heat())
            }
        };
        let vertices = quality.topology.irregular_vertices.iter();
        let irregular: Vec<(u32, i32)> =
            vertices.map(|&(v, edges)| (v, 4 - edges as i32)).collect();
        let polygons = self.polygons.iter();
        draw_polygons(&self.positions, polygons, &irregular, (&heat, values.as_slice()), view)
    }

    #[cfg(feature = "render")]
    fn angle_heat(&self) -> (Vec<f64>, HeatMap) {
        let title = "deviation of angles, degrees".into();
        let values = angle_deviations(&self.positions, self.polygons.iter());
        (values, HeatMap { low: 0.0, high: BRIGHT_DEVIATION, title })
    }
}

/// Right angles are dark, and this many degrees off them bright.
#[cfg(feature = "render")]
const BRIGHT_DEVIATION: f64 = 45.0;
