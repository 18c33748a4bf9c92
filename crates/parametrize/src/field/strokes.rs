//! Directions of the faces near strokes.

use super::convert::dot;
use seamstress_mesh::{Face, FaceData, TriMesh};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A short segment on a surface.
#[derive(Debug, Clone, Copy)]
pub struct Stroke {
    /// A face that it lies on.
    pub face: Face,
    /// Its ends.
    pub ends: [[f64; 3]; 2],
}

/// The vector of the nearest stroke for each face whose middle is within a distance of one, or that one lies on; zero for all
/// others. Faces are reached over their sides: what is close in space alone is not.
pub fn along_strokes(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    strokes: &[Stroke],
    reach: f64,
) -> FaceData<[f64; 3]> {
    let middle = |f: Face| {
        let corners = mesh.face_vertices(f).map(|v| positions[v.at()]);
        [0, 1, 2].map(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0)
    };
    let mut nearest = FaceData::filled(mesh.n_faces(), f64::INFINITY);
    let mut directions = FaceData::filled(mesh.n_faces(), [0.0; 3]);
    // Distances are not negative, and so ordered as their bits.
    let mut queue = BinaryHeap::new();
    let way =
        |f: Face, k: u32| Reverse((distance(middle(f), strokes[k as usize].ends).to_bits(), k, f));
    queue.extend(strokes.iter().zip(0..).map(|(stroke, k)| way(stroke.face, k)));
    while let Some(Reverse((bits, k, f))) = queue.pop() {
        let distance = f64::from_bits(bits);
        let stroke = &strokes[k as usize];
        if distance >= nearest[f] || (distance > reach && f != stroke.face) {
            continue;
        }
        nearest[f] = distance;
        let [a, b] = stroke.ends;
        directions[f] = [0, 1, 2].map(|i| b[i] - a[i]);
        let beside = f.halfedges().into_iter().filter_map(|h| mesh.twin(h)).map(|t| t.face());
        queue.extend(beside.filter(|&g| nearest[g].is_infinite()).map(|g| way(g, k)));
    }
    directions
}

/// The distance of a point from a segment.
fn distance(p: [f64; 3], [a, b]: [[f64; 3]; 2]) -> f64 {
    let sub = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
    let (along, to) = (sub(b, a), sub(p, a));
    let square = dot(along, along);
    let part = if square > 0.0 { (dot(to, along) / square).clamp(0.0, 1.0) } else { 0.0 };
    let off = sub(to, along.map(|x| part * x));
    dot(off, off).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit as testkit;

    #[test]
    fn faces_near_a_stroke_have_its_direction_and_no_others() {
        // The sides of triangles are an eighth long; a stroke along the middle of a square from -1 to 1.
        let grid = testkit::disk_grid(16, 16);
        let mesh = TriMesh::from_faces(grid.positions.len(), &grid.faces).unwrap();
        let middle = |f: Face| {
            let corners = mesh.face_vertices(f).map(|v| grid.positions[v.at()]);
            [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0)
        };
        let ends = [[-0.5, 0.01, 0.0], [0.5, 0.01, 0.0]];
        let face = mesh.faces().find(|&f| {
            let [x, y] = middle(f);
            (0.0..0.1).contains(&x) && (0.0..0.1).contains(&y)
        });
        let stroke = Stroke { face: face.unwrap(), ends };
        let found = along_strokes(&mesh, &grid.positions, &[stroke], 0.25);
        for f in mesh.faces() {
            let [x, y] = middle(f);
            let off = (x.abs() - 0.5).max(0.0).hypot(y - 0.01);
            let expected = if off <= 0.25 { [1.0, 0.0, 0.0] } else { [0.0; 3] };
            assert_eq!(found[f], expected, "{x} {y}");
        }
    }
}
