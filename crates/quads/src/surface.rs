//! A triangulated surface to project to.

use crate::surface_point::SurfacePoint;
use crate::vector::{Point, add, angle, cross, scale, sub, unit, vector};
use parry3d_f64::query::{PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::{TriMesh as Bvh, Triangle, TrianglePointLocation};
use std::collections::HashMap;

/// Triangles with normals on faces, edges and vertices.
pub(crate) struct Surface {
    bvh: Bvh,
    /// Unit normals; zero for a face without area.
    of_face: Vec<Point>,
    /// Sums of unit normals over the faces of each edge, its vertices ascending.
    of_edge: HashMap<[u32; 2], Point>,
    /// Sums of unit normals around each vertex, weighted by angles.
    of_vertex: Vec<Point>,
}

/// A point this close to a side of its face is on it, as a part of the distance to the opposite corner.
const ON_SIDE: f64 = 1e-6;

impl Surface {
    /// Prepares triangles; the error says why they cannot be used.
    pub(crate) fn new(positions: &[Point], faces: &[[u32; 3]]) -> Result<Self, String> {
        let vertices = positions.iter().map(|&p| vector(p)).collect();
        let bvh = Bvh::new(vertices, faces.to_vec()).map_err(|error| error.to_string())?;
        let mut surface = Self {
            bvh,
            of_face: Vec::with_capacity(faces.len()),
            of_edge: HashMap::new(),
            of_vertex: vec![[0.0; 3]; positions.len()],
        };
        faces.iter().for_each(|face| surface.add_normals(face, positions));
        Ok(surface)
    }

    fn add_normals(&mut self, face: &[u32; 3], positions: &[Point]) {
        let corners = face.map(|v| positions[v as usize]);
        let sides = [0, 1, 2].map(|k| sub(corners[(k + 1) % 3], corners[k]));
        let normal = unit(cross(sides[0], sides[1])).unwrap_or_default();
        self.of_face.push(normal);
        for k in 0..3 {
            let edge = self.of_edge.entry(edge(face[k], face[(k + 1) % 3])).or_default();
            *edge = add(*edge, normal);
            let weight = angle(sides[k], scale(sides[(k + 2) % 3], -1.0));
            let vertex = &mut self.of_vertex[face[k] as usize];
            *vertex = add(*vertex, scale(normal, weight));
        }
    }

    /// The nearest point, and the unit normal there: of its face, or the mean over the faces of its edge or around
    /// its vertex; zero where there is none.
    pub(crate) fn nearest(&self, at: Point) -> (Point, Point) {
        let (found, (face, location)) =
            self.bvh.project_local_point_and_get_location(vector(at), false);
        ([found.point.x, found.point.y, found.point.z], self.normal_at(face, location))
    }

    /// The unit normal at the nearest point.
    pub(crate) fn normal(&self, at: Point) -> Point {
        self.nearest(at).1
    }

    fn normal_at(&self, face: u32, location: TrianglePointLocation) -> Point {
        let Some(&[a, b, c]) = self.bvh.indices().get(face as usize) else { return [0.0; 3] };
        let sum = match corner_weights(location).map(|w| w > ON_SIDE) {
            [true, true, true] => self.of_face[face as usize],
            [true, true, false] => self.of_edge[&edge(a, b)],
            [false, true, true] => self.of_edge[&edge(b, c)],
            [true, false, true] => self.of_edge[&edge(c, a)],
            [_, true, _] => self.of_vertex[b as usize],
            [_, _, true] => self.of_vertex[c as usize],
            _ => self.of_vertex[a as usize],
        };
        unit(sum).unwrap_or_default()
    }
}

fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The places on a surface nearest to points; the error says why it cannot be searched.
///
/// # Errors
/// Where there is no face.
pub fn locate(
    positions: &[[f64; 3]],
    faces: &[[u32; 3]],
    points: impl Iterator<Item = [f64; 3]>,
) -> Result<Vec<SurfacePoint>, String> {
    let surface = Surface::new(positions, faces)?;
    let place = |at: Point| {
        let (_, (face, location)) =
            surface.bvh.project_local_point_and_get_location(vector(at), false);
        SurfacePoint { face, barycentric: corner_weights(location) }
    };
    Ok(points.map(place).collect())
}

/// The point of a triangle nearest to a point, and the weights of its corners there.
pub(crate) fn nearest_in_triangle(at: Point, corners: [Point; 3]) -> (Point, [f64; 3]) {
    let [a, b, c] = corners.map(vector);
    let (found, location) =
        Triangle::new(a, b, c).project_local_point_and_get_location(vector(at), false);
    ([found.point.x, found.point.y, found.point.z], corner_weights(location))
}

/// The weights of the corners of a triangle at a point of it.
fn corner_weights(location: TrianglePointLocation) -> [f64; 3] {
    match location {
        TrianglePointLocation::OnVertex(k) => [0, 1, 2].map(|i| f64::from(i == k)),
        other => other.barycentric_coordinates().unwrap_or([1.0 / 3.0; 3]),
    }
}

/// Distance of a point from a triangle.
pub(crate) fn distance_to_triangle(at: Point, corners: [Point; 3]) -> f64 {
    let [a, b, c] = corners.map(vector);
    Triangle::new(a, b, c).distance_to_local_point(vector(at), false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_a_roof_by_hand() {
        // Two faces at right angles over the edge from 0 to 1.
        let positions = [[0.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 2.0, 0.0], [0.0, 2.0, -4.0]];
        let roof = Surface::new(&positions, &[[0, 2, 1], [0, 1, 3]]).unwrap();
        let half = 0.5f64.sqrt();
        for (at, expected) in [
            ([1.0, 2.0, 3.0], [0.0, 0.0, 1.0]),
            ([-3.0, 2.0, -1.0], [-1.0, 0.0, 0.0]),
            ([-1.0, 2.0, 1.0], [-half, 0.0, half]),
            ([-1.0, -2.0, 1.0], [-half, 0.0, half]),
            ([9.0, 2.0, 1.0], [0.0, 0.0, 1.0]),
        ] {
            let normal = roof.normal(at);
            let gap = sub(normal, expected).map(f64::abs);
            assert!(gap.iter().all(|&x| x < 1e-12), "{at:?}: {normal:?}");
        }
        assert_eq!(roof.nearest([1.0, 2.0, 3.0]).0, [1.0, 2.0, 0.0]);
        assert!(Surface::new(&positions, &[]).is_err());
    }
}
