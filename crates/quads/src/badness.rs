//! How bad the shape of a quad is.

use crate::vector::{Point, add, cross, dot, norm, sub, unit, vector_area};

/// From 0 for a right angle to 1 for a corner of 0 or 180 degrees, and above for reflex corners, told by the
/// vector area of the quad.
pub(crate) fn of_corners(quad: [Point; 4]) -> [f64; 4] {
    let normal = vector_area(&quad);
    [0, 1, 2, 3].map(|k| {
        let (a, b) = (sub(quad[(k + 1) % 4], quad[k]), sub(quad[(k + 3) % 4], quad[k]));
        let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
        match dot(cross(a, b), normal) > 0.0 {
            _ if cosine.is_nan() => DEGENERATE,
            true => cosine.abs(),
            false => 2.0 - cosine.abs(),
        }
    })
}

/// The worst corner.
#[cfg(test)]
pub(crate) fn of_quad(quad: [Point; 4]) -> f64 {
    of_corners(quad).into_iter().fold(0.0, f64::max)
}

/// A corner with an edge of no length.
const DEGENERATE: f64 = 2.0;

/// What is added for a quad that faces away from the surface: more than any corner can do.
const INVERTED: f64 = 2.0;

/// The corners against a surface, whose normals at the corners are given: as [`of_corners`], or worse where a
/// corner is reflex seen along the mean normal, and much worse for a quad that faces the other way.
pub(crate) fn on_surface(quad: [Point; 4], normals: [Point; 4]) -> [f64; 4] {
    let normal = unit(normals.into_iter().fold([0.0; 3], add)).unwrap_or_default();
    let area = vector_area(&quad);
    let along = dot(area, normal);
    let side = if along > 0.0 { 0.0 } else { INVERTED - along / norm(area).max(f64::MIN_POSITIVE) };
    let mut bad = of_corners(quad);
    for (k, bad) in bad.iter_mut().enumerate() {
        let (a, b) = (sub(quad[(k + 1) % 4], quad[k]), sub(quad[(k + 3) % 4], quad[k]));
        let turn = dot(cross(a, b), normal) / (norm(a) * norm(b));
        let reflex = if turn < 0.0 { 1.0 - turn } else { 0.0 };
        *bad = side + bad.max(reflex);
    }
    bad
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn badness_by_hand() {
        assert_eq!(of_quad(SQUARE), 0.0);
        let mut dart = SQUARE;
        dart[2] = [0.25, 0.25, 0.0];
        assert!(of_quad(dart) > 1.0);
        let mut kite = SQUARE;
        kite[2] = [0.5, 0.5, 0.0];
        assert!((of_quad(kite) - 1.0).abs() < 1e-12);
        let mut collapsed = SQUARE;
        collapsed[1] = collapsed[0];
        assert_eq!(of_quad(collapsed), 2.0);
    }

    #[test]
    fn the_side_is_told_by_the_normals() {
        assert_eq!(on_surface(SQUARE, [[0.0, 0.0, 1.0]; 4]), [0.0; 4]);
        assert_eq!(on_surface(SQUARE, [[0.0, 0.0, -1.0]; 4]), [5.0; 4]);
        assert_eq!(on_surface(SQUARE, [[1.0, 0.0, 0.0]; 4]), [2.0; 4]);
        // Bent up at one corner: seen from the side, the opposite one is reflex.
        let mut bent = SQUARE;
        bent[2] = [0.5, 0.5, 1.0];
        let [opposite, _, corner, _] = on_surface(bent, [[-1.0, -1.0, -0.1]; 4]);
        assert!(opposite > 1.0 && corner < 1.0);
    }
}
