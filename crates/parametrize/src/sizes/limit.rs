//! Limits on how sizes change over a surface.

use seamstress_mesh::{Metric, TriMesh, Vertex, edge_scale};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The largest sizes below those given that grow along no edge by more than `growth` times its length (the gradation of mesh
/// generators).
pub(super) fn growing(
    mesh: &TriMesh,
    metric: &Metric,
    mut sizes: Vec<f64>,
    growth: f64,
) -> Vec<f64> {
    // Positive numbers are ordered as their bits.
    let mut queue: BinaryHeap<Reverse<(u64, u32)>> =
        sizes.iter().zip(0..).map(|(size, v)| Reverse((size.to_bits(), v))).collect();
    while let Some(Reverse((bits, v))) = queue.pop() {
        let size = f64::from_bits(bits);
        if size > sizes[v as usize] {
            continue;
        }
        let around = mesh.outgoing(Vertex(v)).flat_map(|h| [h, h.prev()]);
        for h in around {
            let [a, b] = [mesh.origin(h).0, mesh.tip(h).0];
            let w = if a == v { b } else { a };
            let most = size + growth * metric.length[h];
            if most < sizes[w as usize] {
                sizes[w as usize] = most;
                queue.push(Reverse((most.to_bits(), w)));
            }
        }
    }
    sizes
}

/// What is left of a triangle's slack, the part of its longest side by which the others together are longer.
const SLACK: f64 = 0.5;
/// Each takes the sizes in triangles that do not close halfway to each other; few are needed but where triangles are needles.
const SWEEPS: usize = 50;

/// Sizes with which triangles close: where the sides of one, counted in sizes, are much nearer to a line than they are, the
/// sizes at its corners become alike.
pub(super) fn closing(mesh: &TriMesh, metric: &Metric, mut sizes: Vec<f64>) -> Vec<f64> {
    let slack = |sides: [f64; 3]| {
        let longest = sides.into_iter().fold(0.0, f64::max);
        sides.iter().sum::<f64>() / longest - 2.0
    };
    for _ in 0..SWEEPS {
        let mut is_closed = true;
        for f in mesh.faces() {
            let sides = f.halfedges().map(|h| metric.length[h]);
            let scaled = f.halfedges().map(|h| metric.length[h] * edge_scale(mesh, &sizes, h));
            if slack(scaled) >= SLACK * slack(sides) {
                continue;
            }
            is_closed = false;
            let corners = mesh.face_vertices(f).map(|v| v.at());
            let mean = 3.0 / corners.iter().map(|&v| 1.0 / sizes[v]).sum::<f64>();
            corners.iter().for_each(|&v| sizes[v] = 2.0 / (1.0 / sizes[v] + 1.0 / mean));
        }
        if is_closed {
            break;
        }
    }
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_grow_from_the_least() {
        // Three vertices in a row on one side of a strip: at 0, 1 and 3.
        let positions =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.5, 9.0, 0.0], [2.0, 9.0, 0.0]];
        let faces = [[0, 1, 3], [1, 4, 3], [1, 2, 4]];
        let mesh = TriMesh::from_faces(5, &faces).unwrap();
        let metric = Metric::from_positions(&mesh, &positions);
        let sizes = growing(&mesh, &metric, vec![1.0, 9.0, 9.0, 0.5, 9.0], 0.5 * metric.unit);
        assert!((sizes[1] - 1.5).abs() < 1e-12 && (sizes[2] - 2.5).abs() < 1e-12, "{sizes:?}");
        // From the other side, 1.5 away.
        assert!(sizes[3] == 0.5 && (sizes[4] - 1.25).abs() < 1e-12, "{sizes:?}");
    }

    #[test]
    fn sides_of_triangles_close() {
        // A low triangle: the sides at its apex become much shorter than the third, which its own ends keep.
        let positions = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 0.2, 0.0]];
        let mesh = TriMesh::from_faces(3, &[[0, 1, 2]]).unwrap();
        let metric = Metric::from_positions(&mesh, &positions);
        let slack = |sizes: &[f64]| {
            let scaled = [0, 1, 2].map(|h| {
                let h = seamstress_mesh::Halfedge(h);
                metric.length[h] * edge_scale(&mesh, sizes, h)
            });
            scaled[1] + scaled[2] - scaled[0]
        };
        let wanted = vec![1.0, 1.0, 3.0];
        assert!(slack(&wanted) < 0.0);
        let sizes = closing(&mesh, &metric, wanted);
        assert!(slack(&sizes) > 0.0 && sizes[2] > sizes[0], "{sizes:?}");
        let fair = vec![1.0, 1.0, 0.5];
        assert_eq!(closing(&mesh, &metric, fair.clone()), fair);
    }
}
