//! Distance between surfaces, sampled.

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh as Bvh;
use seamstress_parallel::prelude::*;

/// Distances from points of one surface to another surface.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Distance {
    /// The largest, mesh units.
    pub max: f64,
    /// The mean over the area, mesh units.
    pub mean: f64,
    /// Points sampled.
    pub samples: usize,
}

/// Distances both ways between a mesh and its source.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SurfaceDistance {
    /// From the mesh to the source.
    pub to_source: Distance,
    /// From the source to the mesh.
    pub from_source: Distance,
    /// The larger maximum of both ways.
    pub hausdorff: f64,
    /// The mean of both ways.
    pub mean: f64,
    /// Diagonal of the source's bounding box, to compare with.
    pub diagonal: f64,
}

/// Why there is no distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DistanceError {
    /// One of the surfaces has no face.
    #[error("a surface without faces has no distance")]
    Empty,
}

/// Distances between two triangulated surfaces, both ways.
///
/// Sampled are all vertices and about `samples` centres of small triangles, evenly over the area; a
/// sampled maximum is a lower bound of the true one. Means weigh by area and leave the vertices out.
///
/// # Errors
/// [`DistanceError::Empty`].
pub fn surface_distance(
    mesh: (&[[f64; 3]], &[[u32; 3]]),
    source: (&[[f64; 3]], &[[u32; 3]]),
    samples: usize,
) -> Result<SurfaceDistance, DistanceError> {
    if mesh.1.is_empty() || source.1.is_empty() {
        return Err(DistanceError::Empty);
    }
    let frame = Frame::around(source);
    let (mesh, source) = (frame.surface(mesh)?, frame.surface(source)?);
    let to_source = mesh.distance_to(&source, samples).scaled(frame.diagonal);
    let from_source = source.distance_to(&mesh, samples).scaled(frame.diagonal);
    Ok(SurfaceDistance {
        to_source,
        from_source,
        hausdorff: to_source.max.max(from_source.max),
        mean: 0.5 * (to_source.mean + from_source.mean),
        diagonal: frame.diagonal,
    })
}

/// A corner and the diagonal of a bounding box: coordinates are taken relative to them, so that no
/// square overflows or vanishes.
struct Frame {
    corner: [f64; 3],
    diagonal: f64,
}

impl Frame {
    fn around((positions, faces): (&[[f64; 3]], &[[u32; 3]])) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &v in faces.as_flattened() {
            for k in 0..3 {
                low[k] = low[k].min(positions[v as usize][k]);
                high[k] = high[k].max(positions[v as usize][k]);
            }
        }
        let diagonal = (high[0] - low[0]).hypot(high[1] - low[1]).hypot(high[2] - low[2]);
        let is_usable = diagonal.is_normal();
        Self { corner: low, diagonal: if is_usable { diagonal } else { 1.0 } }
    }

    fn surface(
        &self,
        (positions, faces): (&[[f64; 3]], &[[u32; 3]]),
    ) -> Result<Surface, DistanceError> {
        let point = |p: &[f64; 3]| {
            let [x, y, z] = [0, 1, 2].map(|k| (p[k] - self.corner[k]) / self.diagonal);
            Vector::new(x, y, z)
        };
        let points = positions.iter().map(point).collect();
        let bvh = Bvh::new(points, faces.to_vec()).map_err(|_| DistanceError::Empty)?;
        Ok(Surface { bvh })
    }
}

struct Surface {
    bvh: Bvh,
}

impl Surface {
    fn corners(&self, face: &[u32; 3]) -> [Vector; 3] {
        face.map(|v| self.bvh.vertices()[v as usize])
    }

    fn distance_to(&self, other: &Self, samples: usize) -> Distance {
        let faces = self.bvh.indices();
        let area = |face: &[u32; 3]| {
            let [a, b, c] = self.corners(face);
            0.5 * (b - a).cross(c - a).length()
        };
        let total: f64 = faces.iter().map(area).sum();
        let far = |p: Vector| other.bvh.distance_to_local_point(p, false);
        let of_face = |face: &[u32; 3]| {
            let corners = self.corners(face);
            let share = if total > 0.0 { area(face) / total } else { 1.0 / faces.len() as f64 };
            let k = ((share * samples as f64).sqrt().ceil() as usize).max(1);
            let mut largest = corners.iter().map(|&p| far(p)).fold(0.0, f64::max);
            let mut sum = 0.0;
            for_each_centre(k, |x, y| {
                let d =
                    far(corners[0] + (corners[1] - corners[0]) * x + (corners[2] - corners[0]) * y);
                largest = largest.max(d);
                sum += d;
            });
            (largest, share * sum / (k * k) as f64, k * k + 3)
        };
        let parts: Vec<(f64, f64, usize)> =
            faces.par_iter().with_min_len(64).map(of_face).collect();
        parts.iter().fold(Distance { max: 0.0, mean: 0.0, samples: 0 }, |d, part| Distance {
            max: d.max.max(part.0),
            mean: d.mean + part.1,
            samples: d.samples + part.2,
        })
    }
}

impl Distance {
    fn scaled(self, factor: f64) -> Self {
        Self { max: self.max * factor, mean: self.mean * factor, ..self }
    }
}

/// Centres of the `k * k` equal triangles a triangle falls into, as coordinates along two of its sides.
fn for_each_centre(k: usize, mut visit: impl FnMut(f64, f64)) {
    let step = 1.0 / k as f64;
    for i in 0..k {
        for j in 0..k - i {
            let (x, y) = (i as f64, j as f64);
            visit((x + 1.0 / 3.0) * step, (y + 1.0 / 3.0) * step);
            if i + j + 2 <= k {
                visit((x + 2.0 / 3.0) * step, (y + 2.0 / 3.0) * step);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn square(z: f64) -> Vec<[f64; 3]> {
        vec![[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]]
    }

    #[test]
    fn centres_are_inside_and_their_mean_is_the_centroid() {
        for k in 1..6 {
            let (mut n, mut sum) = (0, [0.0; 2]);
            for_each_centre(k, |x, y| {
                assert!(x > 0.0 && y > 0.0 && x + y < 1.0);
                n += 1;
                sum = [sum[0] + x, sum[1] + y];
            });
            assert_eq!(n, k * k);
            assert!(sum.iter().all(|s| (s / n as f64 - 1.0 / 3.0).abs() < 1e-12));
        }
    }

    #[test]
    fn parallel_squares_are_as_far_apart_as_they_are() {
        for scale in [1e-150, 1.0, 1e150] {
            let at = |z| square(z).iter().map(|p| p.map(|x| x * scale)).collect::<Vec<_>>();
            let (lower, upper) = (at(0.0), at(0.25));
            let d = surface_distance((&lower, &SQUARE), (&upper, &SQUARE), 100).unwrap();
            assert!((d.hausdorff / scale - 0.25).abs() < 1e-12);
            assert!((d.mean / scale - 0.25).abs() < 1e-12);
        }
    }

    #[test]
    fn the_two_ways_differ() {
        // half of the square: from it nothing is far, to it the other corner is
        let positions = square(0.0);
        let half = &SQUARE[..1];
        let d = surface_distance((&positions, half), (&positions, &SQUARE), 1000).unwrap();
        assert!(d.to_source.max < 1e-12);
        assert!((d.from_source.max - 0.5f64.sqrt()).abs() < 1e-12);
        // over the missing half the distance to the diagonal has the mean sqrt(1/2) / 3
        assert!((d.from_source.mean - 0.5f64.sqrt() / 6.0).abs() < 1e-3);
    }

    #[test]
    fn nothing_has_no_distance() {
        let positions = square(0.0);
        let d = surface_distance((&positions, &[]), (&positions, &SQUARE), 10);
        assert_eq!(d, Err(DistanceError::Empty));
    }
}
