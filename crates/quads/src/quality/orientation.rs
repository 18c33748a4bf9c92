//! Which way polygons face.

use crate::split::listed_from_smallest;
use crate::surface::Surface;
use crate::vector::{Point, add, cross, dot, sub, unit, vector_area};
use seamstress_parallel::prelude::*;

/// How polygons lie to the surface they stand for.
///
/// The normal at a corner is that of the surface at the nearest point: of its face, or the mean over the faces of
/// its edge or, weighted by their angles, around its vertex.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Orientation {
    /// Polygons whose vector area points against the sum of the normals at their corners.
    pub inverted: usize,
    /// Quads two of whose opposite sides cross, seen along that sum.
    pub crossed: usize,
    /// Polygons that would be one or the other, but whose corners see no common side of the surface: bent over
    /// a thin sheet or a sharp edge. There is no direction to judge them from.
    pub bent: usize,
    /// Corners that turn against the surface's normal there.
    pub turned_corners: usize,
    /// Each of them: the polygon, and the vertex of its corner, both counted from 0.
    pub turned: Vec<[u32; 2]>,
}

/// Why nothing was measured.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the surface cannot be used: {0}")]
pub struct BadSurface(String);

impl Orientation {
    /// Compares polygons with the triangles of a surface; corners must be below the number of positions.
    ///
    /// # Errors
    /// If the surface has no triangles.
    pub fn new<'a>(
        positions: &[Point],
        polygons: impl Iterator<Item = &'a [u32]>,
        surface: (&[Point], &[[u32; 3]]),
    ) -> Result<Self, BadSurface> {
        let surface = Surface::new(surface.0, surface.1).map_err(BadSurface)?;
        let normals: Vec<Point> = positions.par_iter().map(|&p| surface.normal(p)).collect();
        let mut found = Self::default();
        for (polygon, number) in polygons.zip(0u32..) {
            let polygon = listed_from_smallest(polygon);
            let at = |of: &[Point]| polygon.iter().map(|&v| of[v as usize]).collect::<Vec<_>>();
            let one = Self::of_polygon(&at(positions), &at(&normals));
            found.inverted += one.inverted;
            found.crossed += one.crossed;
            found.bent += one.bent;
            found.turned_corners += one.turned_corners;
            found.turned.extend(one.turned.iter().map(|&[_, k]| [number, polygon[k as usize]]));
        }
        Ok(found)
    }

    /// Of a single polygon, with the normals of the surface at its corners, which are named by their places.
    pub(crate) fn of_polygon(points: &[Point], normals: &[Point]) -> Self {
        let mean = normals.iter().copied().fold([0.0; 3], add);
        let n = points.len();
        let turns = |k: usize| {
            let [out, back] = [(k + 1) % n, (k + n - 1) % n].map(|j| sub(points[j], points[k]));
            dot(cross(out, back), normals[k]) <= 0.0
        };
        let is_inverted = dot(vector_area(points), mean) <= 0.0;
        let is_crossed = n == 4 && is_crossed(points, mean);
        let turned: Vec<[u32; 2]> = (0..n).filter(|&k| turns(k)).map(|k| [0, k as u32]).collect();
        let has_side = normals.iter().all(|&normal| dot(normal, mean) > 0.0);
        Self {
            inverted: usize::from(is_inverted && has_side),
            crossed: usize::from(is_crossed && has_side),
            bent: usize::from((is_inverted || is_crossed) && !has_side),
            turned_corners: turned.len(),
            turned,
        }
    }

    /// Polygons that are inverted or crossed, or would be; one that is both counts twice.
    pub(crate) fn faults(&self) -> usize {
        self.inverted + self.crossed + self.bent
    }
}

/// Whether opposite sides of a quad cross, seen along a direction.
fn is_crossed(points: &[Point], along: Point) -> bool {
    let Some(along) = unit(along) else { return false };
    let turn = |a: usize, b: usize, c: usize| {
        dot(cross(sub(points[b], points[a]), sub(points[c], points[a])), along)
    };
    let cross = |[a, b]: [usize; 2], [c, d]: [usize; 2]| {
        turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
    };
    cross([0, 1], [2, 3]) || cross([1, 2], [3, 0])
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUND: [Point; 3] = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];

    fn orientation(points: &[[f64; 2]]) -> Orientation {
        let positions: Vec<Point> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        let quad: Vec<u32> = (0..points.len() as u32).collect();
        let polygons = [quad.as_slice()].into_iter();
        Orientation::new(&positions, polygons, (&GROUND, &[[0, 1, 2]])).unwrap()
    }

    #[test]
    fn quads_in_the_plane_by_hand() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(orientation(&square), Orientation::default());
        let mut reversed = square;
        reversed.reverse();
        let all = vec![[0, 0], [0, 1], [0, 2], [0, 3]];
        let expected =
            Orientation { inverted: 1, turned_corners: 4, turned: all, ..Default::default() };
        assert_eq!(orientation(&reversed), expected);
        let dart = [[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]];
        let turned = vec![[0, 2]];
        let expected = Orientation { turned_corners: 1, turned, ..Default::default() };
        assert_eq!(orientation(&dart), expected);
        // More of it the right way round than not.
        let bow = [[0.0, 0.0], [2.0, 0.0], [0.9, 1.0], [1.0, 0.9]];
        assert_eq!(orientation(&bow).crossed, 0);
        let bow = [[0.0, 0.0], [3.0, 0.0], [0.5, 1.0], [2.0, 1.0]];
        let turned = vec![[0, 2], [0, 3]];
        let expected = Orientation { crossed: 1, turned_corners: 2, turned, ..Default::default() };
        assert_eq!(orientation(&bow), expected);
    }

    #[test]
    fn turned_corners_are_named_by_polygon_and_vertex() {
        // The reflex corner is vertex 2.
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 0.2, 0.0], [0.0, 1.0, 0.0]];
        let polygons: [&[u32]; 2] = [&[0, 1, 3], &[3, 0, 1, 2]];
        let found = Orientation::new(&positions, polygons.into_iter(), (&GROUND, &[[0, 1, 2]]));
        assert_eq!(found.unwrap().turned, [[1, 2]]);
    }

    #[test]
    fn a_quad_over_a_thin_sheet_has_no_side() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
        let of = |normals: [Point; 4]| Orientation::of_polygon(&square, &normals);
        assert_eq!(of([up, up, up, down]).turned, [[0, 3]]);
        let bent = of([down, down, down, up]);
        assert_eq!((bent.inverted, bent.crossed, bent.bent), (0, 0, 1));
        assert_eq!(bent.faults(), 1);
    }

    #[test]
    fn no_surface_is_an_error() {
        let none = Orientation::new(&GROUND, std::iter::empty(), (&GROUND, &[]));
        assert!(none.is_err());
    }
}
