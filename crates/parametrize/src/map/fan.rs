//! How far a map turns around a vertex of the boundary.

use super::exact::{Arrow, Point};
use seamstress_mesh::{Halfedge, TriMesh, Vertex};
use std::cmp::Ordering;

/// Whether the images of the triangles around a boundary vertex, laid side by side, turn by more than a full
/// turn.
///
/// `across` is the number of quarter turns from the face of a half-edge to that of its twin. The edges of the
/// fan are turned into the chart of its first face, exactly, and followed from the first to the last: half
/// turns are counted where one passes the line of the first. A sum of angles could not tell a full turn from
/// a little more, and boundaries that are aligned do have full turns.
pub(super) fn is_overwound(
    mesh: &TriMesh,
    uvs: &[Point],
    across: impl Fn(Halfedge) -> i32,
    vertex: Vertex,
) -> bool {
    let arrow = |from: Halfedge, to: Halfedge| Arrow { from: uvs[from.at()], to: uvs[to.at()] };
    let Some(start) = mesh.outgoing(vertex).next() else { return false };
    let first = arrow(start, start.next());
    // Half turns from the first edge to the last one seen, rounded down, and quarters to its chart.
    let (mut half_turns, mut quarters) = (0i32, 0i32);
    let mut last = first;
    for corner in mesh.outgoing(vertex) {
        let next = arrow(corner, corner.prev()).turned(-quarters);
        if half_of(&first, &next) != half_turns.rem_euclid(2) {
            // Images of a short edge that differ by rounding may even lead a little backwards.
            let is_back = last.side_of(&next) == Ordering::Less;
            half_turns += if is_back { -1 } else { 1 };
        }
        quarters += across(corner.prev());
        last = next;
    }
    half_turns > 2 || (half_turns == 2 && first.side_of(&last) == Ordering::Greater)
}

/// Whether a vector is less than a half turn counter-clockwise from another (0), or not (1).
fn half_of(first: &Arrow, arrow: &Arrow) -> i32 {
    match first.side_of(arrow) {
        Ordering::Greater => 0,
        Ordering::Less => 1,
        Ordering::Equal => i32::from(!first.agrees_with(arrow)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An open fan around vertex 0, laid with the given ends of its edges, its middle at zero, without seams.
    fn is_overwound_at(ends: &[Point]) -> bool {
        let n = ends.len() as u32;
        let faces: Vec<_> = (1..n).map(|k| [0, k, k + 1]).collect();
        let mesh = TriMesh::from_faces(n as usize + 1, &faces).unwrap();
        let uvs: Vec<Point> = ends.windows(2).flat_map(|e| [[0.0; 2], e[0], e[1]]).collect();
        is_overwound(&mesh, &uvs, |_| 0, Vertex(0))
    }

    fn at(degrees: f64) -> Point {
        [degrees.to_radians().cos(), degrees.to_radians().sin()]
    }

    #[test]
    fn fans_of_all_angles() {
        for step in [50.0, 90.0, 119.0, 170.0] {
            for n in 1..=12 {
                let (angle, ends) = (step * f64::from(n), 0..=n);
                let ends: Vec<_> = ends.map(|k| at(17.0 + step * f64::from(k))).collect();
                if angle != 360.0 {
                    assert_eq!(is_overwound_at(&ends), angle > 360.0, "{n} of {step} degrees");
                }
            }
        }
    }

    #[test]
    fn a_full_turn_is_told_from_a_little_more() {
        let with_last =
            |last| is_overwound_at(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], last]);
        assert!(!with_last([2.0, 0.0]));
        assert!(!with_last([2.0, -1e-300]));
        assert!(with_last([2.0, 1e-300]));
    }

    #[test]
    fn charts_are_turned_into_one() {
        // Quarters, each in a chart that is turned by one more than the last: all look alike.
        let fan = |n: u32| {
            let faces: Vec<_> = (1..=n).map(|k| [0, k, k + 1]).collect();
            let mesh = TriMesh::from_faces(n as usize + 2, &faces).unwrap();
            let uvs: Vec<Point> = (0..n).flat_map(|_| [[0.3; 2], [1.3, 0.3], [0.3, 1.3]]).collect();
            // Along the left side of one the next has its right side.
            is_overwound(&mesh, &uvs, |_| -1, Vertex(0))
        };
        assert_eq!([1, 2, 3, 4, 5, 6, 9].map(fan), [false, false, false, false, true, true, true]);
    }
}
