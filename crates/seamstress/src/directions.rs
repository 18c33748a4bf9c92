//! Directions that lines are to follow, on the triangles of a surface.

use crate::direction_sources::DirectionSource;
use crate::error::Error;
#[cfg(feature = "io")]
use crate::error::ErrorKind;
use crate::feature_edges::Namer;
use crate::grid_size::GridSize;
use crate::surface::Surface;
use seamstress_mesh::Halfedge;
use seamstress_parametrize::field::{Stroke, along_strokes};
#[cfg(feature = "io")]
use seamstress_quads::locate;
use std::sync::Arc;

/// Points of a stroke that is drawn, along a cell.
#[cfg(feature = "io")]
const POINTS: f64 = 4.0;

impl Surface {
    /// The same surface with the directions of some sources, for cells of a length.
    ///
    /// # Errors
    /// `Unreadable`, `BadFeatures`, and `BadStart` where a field does not fit.
    pub(crate) fn directed(&self, sources: &[DirectionSource], cell: f64) -> Result<Self, Error> {
        if sources.is_empty() {
            return Ok(self.clone());
        }
        let (mesh, positions) = (self.mesh(), self.positions());
        let mut strokes = Vec::new();
        let mut directions = vec![[0.0; 3]; self.faces().len()];
        for source in sources {
            match source {
                DirectionSource::Edges(source) => {
                    let edges = Namer::new(self, GridSize::EdgeLength(cell)).edges_of(source)?;
                    let sides = edges.edges().iter().flat_map(|&h| [Some(h), mesh.twin(h)]);
                    strokes.extend(sides.flatten().map(|h| self.stroke_along(h)));
                }
                #[cfg(feature = "io")]
                DirectionSource::Strokes(file) => {
                    strokes.extend(self.drawn(&seamstress_io::read_segments(file)?, cell)?);
                }
                #[cfg(feature = "io")]
                DirectionSource::Field(file) => {
                    let field = seamstress_io::read_field(file, directions.len())?;
                    directions = field.into_iter().map(|cross| cross[0]).collect();
                }
                #[cfg(not(feature = "io"))]
                _ => {
                    return Err(Error::options("directions: files are read with the feature `io`"));
                }
            }
        }
        let along = along_strokes(mesh, positions, &strokes, 0.5 * cell);
        for (direction, along) in directions.iter_mut().zip(along.iter()) {
            if *along != [0.0; 3] {
                *direction = *along;
            }
        }
        let mut directed = self.clone();
        directed.directions = Some(Arc::new(directions));
        Ok(directed)
    }

    /// Another mesh with the directions of the faces that its faces lie on.
    pub(crate) fn directed_part(&self, mut part: Self, faces: &[u32]) -> Self {
        part.directions = self.directions.as_ref().map(|directions| {
            Arc::new(faces.iter().map(|&face| directions[face as usize]).collect())
        });
        part
    }

    /// An edge as a stroke on the face beside it.
    fn stroke_along(&self, h: Halfedge) -> Stroke {
        let (mesh, positions) = (self.mesh(), self.positions());
        let [a, b] = [mesh.origin(h), mesh.tip(h)].map(|v| positions[v.at()]);
        Stroke { face: h.face(), ends: [a, b] }
    }

    /// Segments near the surface in short pieces, each at the face that its middle is nearest to.
    #[cfg(feature = "io")]
    fn drawn(&self, segments: &[[[f64; 3]; 2]], cell: f64) -> Result<Vec<Stroke>, Error> {
        let pieces: Vec<[[f64; 3]; 2]> =
            segments.iter().flat_map(|&ends| pieces(ends, cell / POINTS)).collect();
        let middles = pieces.iter().map(|[a, b]| [0, 1, 2].map(|k| 0.5 * (a[k] + b[k])));
        let places = locate(self.positions(), self.faces(), middles)
            .map_err(|cause| Error::new(ErrorKind::Internal, cause))?;
        let stroke = |(&ends, at): (&[[f64; 3]; 2], &crate::SurfacePoint)| Stroke {
            face: seamstress_mesh::Face(at.face),
            ends,
        };
        Ok(pieces.iter().zip(&places).map(stroke).collect())
    }
}

/// The most pieces of a segment: of one that is much longer than a surface is wide.
#[cfg(feature = "io")]
const MOST_PIECES: f64 = 1e4;

/// A segment in equal pieces of at most a length.
#[cfg(feature = "io")]
fn pieces([a, b]: [[f64; 3]; 2], length: f64) -> Vec<[[f64; 3]; 2]> {
    let long = (0..3).map(|k| (b[k] - a[k]).powi(2)).sum::<f64>().sqrt();
    let n = (long / length).ceil().clamp(1.0, MOST_PIECES);
    let at = |k: f64| [0, 1, 2].map(|axis| a[axis] + k / n * (b[axis] - a[axis]));
    (0..n as u32).map(|k| [at(f64::from(k)), at(f64::from(k) + 1.0)]).collect()
}
