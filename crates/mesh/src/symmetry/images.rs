//! Vertices and the vertices that are their images.

use super::Mirror;
use crate::vector::{norm, sub};
use rstar::RTree;
use rstar::primitives::GeomWithData;
use std::collections::{BTreeMap, HashMap, HashSet};

/// A mesh that is its own image.
#[derive(Debug, Clone, PartialEq)]
pub struct Images {
    /// For each vertex the first one at its image.
    pub of: Vec<u32>,
    /// The largest distance of a vertex from the image of its own, mesh units.
    pub error: f64,
}

/// The vertex nearest to the image of each vertex, if each of them is within a distance of it and every polygon has a
/// polygon as its image; `polygon` says of which one each triangle is. How polygons are split does not matter.
#[must_use]
pub fn images(
    positions: &[[f64; 3]],
    faces: &[[u32; 3]],
    polygon: &[u32],
    mirror: &Mirror,
    tolerance: f64,
) -> Option<Images> {
    let first = first_in_place(positions);
    let places = (0..positions.len() as u32).filter(|&v| first[v as usize] == v);
    let tree =
        RTree::bulk_load(places.map(|v| GeomWithData::new(positions[v as usize], v)).collect());
    let mut found = Images { of: Vec::with_capacity(positions.len()), error: 0.0 };
    for &p in positions {
        let image = mirror.image(p);
        let nearest = tree.nearest_neighbor(image)?;
        found.error = found.error.max(norm(sub(*nearest.geom(), image)));
        // NaN is beyond it, too.
        if found.error.partial_cmp(&tolerance).is_none_or(|order| order.is_gt()) {
            return None;
        }
        found.of.push(nearest.data);
    }
    let mut corners: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (face, polygon) in faces.iter().zip(polygon) {
        corners.entry(*polygon).or_default().extend(face.map(|v| first[v as usize]));
    }
    let polygons: HashSet<Vec<u32>> = corners.values().map(|of| set(of.iter().copied())).collect();
    let is_image =
        |of: &Vec<u32>| polygons.contains(&set(of.iter().map(|&v| found.of[v as usize])));
    corners.values().all(is_image).then_some(found)
}

/// The first vertex in the place of each vertex.
fn first_in_place(positions: &[[f64; 3]]) -> Vec<u32> {
    let mut first = HashMap::new();
    // Both zeros are one place.
    let place = |p: &[f64; 3]| p.map(|x| (x + 0.0).to_bits());
    positions.iter().zip(0u32..).map(|(p, v)| *first.entry(place(p)).or_insert(v)).collect()
}

fn set(vertices: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut set: Vec<u32> = vertices.collect();
    set.sort_unstable();
    set.dedup();
    set
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_roof_and_its_images() {
        // Over the plane where x is 0.1, with one vertex off by a little.
        let positions = [[0.1, 0.0, 1.0], [0.1, 3.0, 1.0], [1.1, 1.0, 0.0], [-0.9, 1.0, 0.01]];
        let mirror = Mirror::across(0, 0.1);
        let roof = [[0, 2, 1], [0, 1, 3]];
        let found = images(&positions, &roof, &[0, 1], &mirror, 0.02).unwrap();
        assert_eq!(found.of, [0, 1, 3, 2]);
        assert!((found.error - 0.01).abs() < 1e-12);
        assert_eq!(images(&positions, &roof, &[0, 1], &mirror, 0.005), None);
    }

    #[test]
    fn the_diagonals_of_polygons_do_not_matter() {
        let sheet = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];
        let (mirror, split) = (Mirror::across(0, 0.0), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(images(&sheet, &split, &[0, 1], &mirror, 0.1), None);
        assert_eq!(images(&sheet, &split, &[7, 7], &mirror, 0.1).unwrap().of, [3, 2, 1, 0]);
    }

    #[test]
    fn vertices_in_one_place_are_one() {
        // Two triangles that meet in an edge whose ends each has for itself.
        let positions = [
            [0.0; 3],
            [0.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [-0.0; 3],
            [0.0, 1.0, 0.0],
            [-1.0, 0.0, 0.0],
        ];
        let (faces, mirror) = ([[0, 2, 1], [3, 4, 5]], Mirror::across(0, 0.0));
        let found = images(&positions, &faces, &[0, 1], &mirror, 1e-9).unwrap();
        assert_eq!(found.of, [0, 1, 5, 0, 1, 2]);
    }
}
