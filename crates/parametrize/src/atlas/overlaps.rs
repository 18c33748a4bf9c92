//! Triangles that lie over each other in the plane.

use super::charts::Charts;
use super::{bounds, triangle};
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};
use seamstress_mesh::{Face, FaceData};

/// The faces of its chart that each face lies over.
pub(super) fn overlaps(charts: &Charts, corner_uvs: &[[f64; 2]]) -> FaceData<Vec<Face>> {
    let mut over = FaceData::filled(charts.of_face.len(), Vec::new());
    let rectangle = |f: Face| {
        let [low, high] = bounds(triangle(corner_uvs, f).into_iter());
        Rectangle::from_corners(low, high)
    };
    for faces in &charts.faces {
        let entries = faces.iter().map(|&f| GeomWithData::new(rectangle(f), f));
        let tree = RTree::bulk_load(entries.collect());
        for (a, b) in tree.intersection_candidates_with_other_tree(&tree) {
            let (f, g) = (a.data, b.data);
            if f < g && is_over(triangle(corner_uvs, f), triangle(corner_uvs, g)) {
                over[f].push(g);
                over[g].push(f);
            }
        }
    }
    over
}

/// Whether the interiors of two triangles without flips meet, decided exactly: unless a side of one has all of the other
/// behind it.
fn is_over(a: [[f64; 2]; 3], b: [[f64; 2]; 3]) -> bool {
    let coord = |[x, y]: [f64; 2]| robust::Coord { x, y };
    let is_behind = |a: [[f64; 2]; 3], b: [[f64; 2]; 3]| {
        (0..3).any(|k| {
            let [from, to] = [a[k], a[(k + 1) % 3]].map(coord);
            b.iter().all(|&p| robust::orient2d(from, to, coord(p)) <= 0.0)
        })
    };
    !is_behind(a, b) && !is_behind(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_touch_are_not_over_each_other() {
        let t = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
        let moved = |[x, y]: [f64; 2]| t.map(|p| [p[0] + x, p[1] + y]);
        assert!(is_over(t, t) && is_over(t, moved([0.5, 0.5])) && is_over(t, moved([1.5, 0.0])));
        // A corner at a corner, a corner in a side, beside it.
        for off in [[2.0, 0.0], [1.0, 1.0], [3.0, 0.0]] {
            assert!(!is_over(t, moved(off)) && !is_over(moved(off), t), "{off:?}");
        }
        // One within the other.
        assert!(is_over(t, [[0.5, 0.5], [0.75, 0.5], [0.5, 0.75]]));
        // Across a common side.
        assert!(!is_over(t, [[2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]));
    }
}
