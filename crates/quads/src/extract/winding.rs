//! How many times a patch covers its cell, where the map folds.

use super::patches::Patches;
use super::pieces::Pieces;
use super::snap::GridMap;
use seamstress_mesh::{Face, TriMesh};
use seamstress_parallel::prelude::*;

/// The degree of every patch: sheets that keep the orientation, less those that turn it over.
///
/// The signed areas of the pieces of a whole patch sum to its degree, an integer: rounding it in
/// floating point loses nothing.
pub(super) fn degrees(
    mesh: &TriMesh,
    map: &GridMap,
    pieces: &Pieces,
    patches: &Patches,
) -> Vec<i32> {
    let faces: Vec<Face> = mesh.faces().collect();
    let areas: Vec<Vec<(u32, f64)>> = faces
        .par_iter()
        .map(|&face| {
            let triangle = map.triangle(face).map(|p| map.unit.to_f64(p));
            let pieces = pieces.of_face(face);
            pieces.map(|(piece, cell)| (piece, area_in_cell(&triangle, cell))).collect()
        })
        .collect();
    let mut sums = vec![0.0; patches.count()];
    for (piece, area) in areas.into_iter().flatten() {
        sums[patches.of_piece[piece as usize] as usize] += area;
    }
    sums.into_iter().map(|sum| sum.round() as i32).collect()
}

/// The signed area of a triangle within a cell.
fn area_in_cell(triangle: &[[f64; 2]; 3], cell: [i64; 2]) -> f64 {
    let mut polygon: Vec<[f64; 2]> =
        triangle.iter().map(|p| [p[0] - cell[0] as f64, p[1] - cell[1] as f64]).collect();
    for axis in 0..2 {
        polygon = clip(&polygon, |p| p[axis]);
        polygon = clip(&polygon, |p| 1.0 - p[axis]);
    }
    let n = polygon.len();
    let twice = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % n]);
        a[0] * b[1] - a[1] * b[0]
    };
    0.5 * (0..n).map(twice).sum::<f64>()
}

/// The part of a convex polygon where an affine function is not negative.
fn clip(polygon: &[[f64; 2]], height: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (above, below) = (height(a), height(b));
        if above >= 0.0 {
            kept.push(a);
        }
        if (above > 0.0 && below < 0.0) || (above < 0.0 && below > 0.0) {
            let t = above / (above - below);
            kept.push([0, 1].map(|k| a[k] + t * (b[k] - a[k])));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_by_hand() {
        let triangle = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
        let area = |cell| area_in_cell(&triangle, cell);
        assert_eq!([area([0, 0]), area([1, 0]), area([0, 1]), area([1, 1])], [1.0, 0.5, 0.5, 0.0]);
        let turned_over = [triangle[1], triangle[0], triangle[2]];
        assert_eq!(area_in_cell(&turned_over, [1, 0]), -0.5);
        assert_eq!(area_in_cell(&[[0.5, 0.5], [1.5, 0.5], [2.5, 0.5]], [0, 0]), 0.0);
    }
}
