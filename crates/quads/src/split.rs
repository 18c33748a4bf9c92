//! Polygons split into triangles, the same way whichever corner they are listed from.

use crate::QuadMesh;
use crate::vector::{Point, norm, sub};
use seamstress_mesh::soup::{self, Fault, polygon_faults};
use std::collections::HashSet;

/// Splits polygons into triangles on the same vertices: quads along their shorter diagonal, ties going to the one
/// with the smallest vertex, unless there is an edge or a diagonal with these ends already; larger polygons as
/// [`soup::triangulate`] does from their smallest vertex on. Which corner a polygon is listed from does not matter.
///
/// # Errors
/// As [`soup::triangulate`]; the `face` of a fault is the polygon.
pub fn split_polygons<'a>(
    positions: &[Point],
    polygons: impl Iterator<Item = &'a [u32]>,
) -> Result<Vec<[u32; 3]>, Vec<Fault>> {
    let polygons: Vec<&[u32]> = polygons.collect();
    let faults = polygon_faults(positions.len(), &polygons);
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut diagonals = Diagonals::new(positions, polygons.iter().copied());
    let mut parts: Vec<Vec<u32>> = Vec::with_capacity(2 * polygons.len());
    for polygon in polygons {
        match <[u32; 4]>::try_from(polygon) {
            Ok(quad) => parts.extend(diagonals.split(quad).map(|t| t.to_vec())),
            Err(_) => parts.push(listed_from_smallest(polygon)),
        }
    }
    Ok(soup::triangulate(positions, parts.iter().map(Vec::as_slice))?.faces)
}

/// The two triangles of every quad. Their corners are the first three, and the first, third and fourth of the
/// quad, counted from the smaller end of its diagonal.
pub(crate) fn split_quads(mesh: &QuadMesh) -> Vec<[u32; 3]> {
    let sides = mesh.quads().iter().map(<[u32; 4]>::as_slice);
    let mut diagonals = Diagonals::new(mesh.positions(), sides);
    mesh.quads().iter().flat_map(|&quad| diagonals.split(quad)).collect()
}

/// The corners of a polygon from the smallest on, the way round that it is listed.
pub(crate) fn listed_from_smallest(polygon: &[u32]) -> Vec<u32> {
    let mut best = polygon.to_vec();
    let mut turned = polygon.to_vec();
    // A polygon may have its smallest corner more than once: those that follow decide.
    for _ in 1..polygon.len() {
        turned.rotate_left(1);
        if turned < best {
            best.copy_from_slice(&turned);
        }
    }
    best
}

/// Positions of the corners of a polygon, from the smallest on: what is summed over them does not depend on the
/// corner it is listed from.
pub(crate) fn corner_positions(positions: &[Point], polygon: &[u32]) -> Vec<Point> {
    listed_from_smallest(polygon).iter().map(|&v| positions[v as usize]).collect()
}

/// Diagonals chosen one after the other.
struct Diagonals<'p> {
    positions: &'p [Point],
    /// Ends of the sides of all polygons and of the diagonals chosen.
    taken: HashSet<[u32; 2]>,
}

impl<'p> Diagonals<'p> {
    fn new<'a>(positions: &'p [Point], polygons: impl Iterator<Item = &'a [u32]>) -> Self {
        let sides = polygons.flat_map(|polygon| {
            let next = polygon.iter().cycle().skip(1);
            polygon.iter().zip(next).map(|(&a, &b)| ends(a, b))
        });
        Self { positions, taken: sides.collect() }
    }

    fn split(&mut self, mut corners: [u32; 4]) -> [[u32; 3]; 2] {
        let listed = listed_from_smallest(&corners);
        corners.copy_from_slice(&listed);
        let [a, b, c, d] = corners;
        let is_free = |p, q| !self.taken.contains(&ends(p, q));
        let length =
            |p: u32, q: u32| norm(sub(self.positions[p as usize], self.positions[q as usize]));
        let takes_second = match (is_free(a, c), is_free(b, d)) {
            (false, true) => true,
            (true, false) => false,
            _ => length(b, d) < length(a, c),
        };
        let [a, b, c, d] = match takes_second {
            true if b < d => [b, c, d, a],
            true => [d, a, b, c],
            false => [a, b, c, d],
        };
        self.taken.insert(ends(a, c));
        [[a, b, c], [a, c, d]]
    }
}

fn ends(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLANTED: [Point; 4] =
        [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

    #[test]
    fn diagonals_are_short_and_no_two_have_the_same_ends() {
        for turn in 0..4 {
            let (mut above, mut below) = ([0, 1, 2, 3], [3, 2, 1, 0]);
            above.rotate_left(turn);
            let one = QuadMesh::new(SLANTED.to_vec(), vec![above]).unwrap();
            assert_eq!(split_quads(&one), [[1, 2, 3], [1, 3, 0]]);
            // A pillow: the second quad cannot have the diagonal of the first.
            below.rotate_left(turn);
            let two = QuadMesh::new(SLANTED.to_vec(), vec![above, below]).unwrap();
            assert_eq!(split_quads(&two)[2..], [[0, 3, 2], [0, 2, 1]]);
        }
    }

    #[test]
    fn of_equal_diagonals_the_one_with_the_smallest_vertex_is_taken() {
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        for quad in [[0, 1, 2, 3], [1, 2, 3, 0], [2, 3, 0, 1], [3, 0, 1, 2]] {
            let faces = split_polygons(&square, [&quad[..]].into_iter()).unwrap();
            assert_eq!(faces, [[0, 1, 2], [0, 2, 3]]);
        }
    }

    #[test]
    fn other_polygons_keep_their_places() {
        let mut positions = SLANTED.to_vec();
        positions.push([-1.0, 0.5, 0.0]);
        let polygons: [&[u32]; 2] = [&[3, 4, 0], &[2, 3, 0, 1]];
        let faces = split_polygons(&positions, polygons.into_iter()).unwrap();
        assert_eq!(faces, [[0, 3, 4], [1, 2, 3], [1, 3, 0]]);
        let pentagon: [&[u32]; 2] = [&[2, 3, 4, 0, 1], &[4, 0, 1, 2, 3]];
        let [first, second] = pentagon.map(|p| split_polygons(&positions, [p].into_iter()));
        assert_eq!((first.as_ref().unwrap().len(), &first), (3, &second));
    }

    #[test]
    fn faults_name_the_polygon() {
        let polygons: [&[u32]; 2] = [&[0, 1, 2, 3], &[0, 1, 0, 2]];
        let faults = split_polygons(&SLANTED, polygons.into_iter()).unwrap_err();
        assert_eq!(faults, [Fault::RepeatedVertex { face: 1, vertex: 0 }]);
    }
}
