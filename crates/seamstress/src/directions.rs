//! Directions that lines are to follow, on the triangles of a surface.

use crate::direction_sources::DirectionSource;
use crate::error::{Error, ErrorKind};
use crate::feature_edges::Namer;
use crate::grid_size::GridSize;
use crate::surface::Surface;
use seamstress_mesh::Halfedge;
use seamstress_mesh::symmetry::{Mirror, images_of};
use seamstress_parametrize::field::{Stroke, along_strokes};
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

    /// A side of planes of symmetry of this surface with the directions of the faces that its faces lie on, or of the images
    /// of these where they have none.
    ///
    /// # Errors
    /// Where the surface cannot be searched.
    pub(crate) fn directed_side(
        &self,
        side: Self,
        faces: &[u32],
        mirrors: &[Mirror],
    ) -> Result<Self, Error> {
        let mut side = self.directed_part(side, faces);
        let (Some(of_whole), Some(of_side)) = (&self.directions, &side.directions) else {
            return Ok(side);
        };
        let middle = |face: &[u32; 3]| {
            let corners = face.map(|v| side.positions()[v as usize]);
            [0, 1, 2].map(|k| corners.iter().map(|p| p[k] / 3.0).sum())
        };
        let points = side.faces().iter().flat_map(|face| images_of(middle(face), mirrors));
        let places = locate(self.positions(), self.faces(), points)
            .map_err(|cause| Error::new(ErrorKind::Internal, cause))?;
        // Of a vector, the difference of the images of its ends.
        let reflected = |[x, y, z]: [f64; 3]| {
            let ends = images_of([x, y, z], mirrors).zip(images_of([0.0; 3], mirrors));
            ends.map(|(tip, origin)| [0, 1, 2].map(|k| tip[k] - origin[k]))
        };
        let of_images = places.chunks(1 << mirrors.len()).map(|places| {
            let mut found = places.iter().enumerate().filter_map(|(k, place)| {
                reflected(of_whole[place.face as usize]).nth(k).filter(|d| *d != [0.0; 3])
            });
            found.next().unwrap_or_default()
        });
        let own = of_side.iter().copied();
        let either = own.zip(of_images).map(|(own, image)| match own == [0.0; 3] {
            true => image,
            false => own,
        });
        side.directions = Some(Arc::new(either.collect()));
        Ok(side)
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

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_mesh::soup::TriangleSoup;
    use seamstress_testkit::disk_grid;

    #[test]
    fn a_side_has_directions_of_its_own_and_of_images() {
        // A square, and the half of it where x is positive.
        let TriangleSoup { positions, faces } = disk_grid(8, 8);
        let mut whole = Surface::from_triangles(&positions, &faces).unwrap();
        let middle = |face: &[u32; 3]| {
            let corners = face.map(|v| positions[v as usize]);
            [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0)
        };
        // Of the four quarters one has its own direction, one that of its image, one has both.
        let given = |face: &[u32; 3]| match middle(face).map(|x| x > 0.0) {
            [true, true] => [1.0, 2.0, 0.0],
            [false, true] => [3.0, 1.0, 0.0],
            [false, false] => [5.0, 1.0, 0.0],
            [true, false] => [0.0; 3],
        };
        whole.directions = Some(Arc::new(faces.iter().map(given).collect()));
        let of_side = (0u32..).zip(&faces).filter(|(_, face)| middle(face)[0] > 0.0);
        let of_side: Vec<u32> = of_side.map(|(f, _)| f).collect();
        let chosen = of_side.iter().map(|&f| faces[f as usize]).collect::<Vec<_>>();
        let mut vertices = chosen.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let side = whole.restricted(&vertices, &of_side).unwrap();
        let side = whole.directed_side(side, &of_side, &[Mirror::across(0, 0.0)]).unwrap();
        for (face, direction) in chosen.iter().zip(side.directions.unwrap().iter()) {
            let expected = match middle(face)[1] > 0.0 {
                true => [1.0, 2.0, 0.0],
                false => [-5.0, 1.0, 0.0],
            };
            assert_eq!(*direction, expected, "{:?}", middle(face));
        }
    }
}
