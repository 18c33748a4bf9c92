//! Limits on how sizes change over a surface.

use seamstress_mesh::{Face, Metric, TriMesh, Vertex, edge_scale};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

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

/// What is left of a triangle's slack, the part of its longest side by which the others together are longer, at least, and
/// what a triangle gets that has less.
const SLACK: [f64; 2] = [0.5, 0.75];
/// Steps for each face, at most; few faces need one but where triangles are needles.
const MOST_STEPS: usize = 1000;

/// The sizes with which triangles close: where the sides of one, counted in sizes, are much nearer to a line than they are, the
/// size at the corner over the longest becomes smaller, and so the others longer. No size becomes less than both beside it,
/// so that it comes to an end.
pub(super) fn closing(mesh: &TriMesh, metric: &Metric, mut sizes: Vec<f64>) -> Vec<f64> {
    let slack = |sides: [f64; 3]| {
        let longest = sides.into_iter().fold(0.0, f64::max);
        sides.iter().sum::<f64>() / longest - 2.0
    };
    let mut queue: VecDeque<Face> = mesh.faces().collect();
    let mut is_queued = vec![true; mesh.n_faces()];
    for _ in 0..MOST_STEPS * mesh.n_faces() {
        let Some(f) = queue.pop_front() else { break };
        is_queued[f.at()] = false;
        let halfedges = f.halfedges();
        let sides = halfedges.map(|h| metric.length[h]);
        let scaled = halfedges.map(|h| metric.length[h] * edge_scale(mesh, &sizes, h));
        let whole = slack(sides);
        if slack(scaled) >= SLACK[0] * whole {
            continue;
        }
        let longest = (0..3).max_by(|&a, &b| scaled[a].total_cmp(&scaled[b])).unwrap_or_default();
        let [cb, ba] = [1, 2].map(|k| sides[(longest + k) % 3]);
        let apex = mesh.origin(halfedges[(longest + 2) % 3]);
        let [a, c] = [mesh.origin(halfedges[longest]), mesh.tip(halfedges[longest])];
        let [at_a, at_c] = [a, c].map(|v| 1.0 / sizes[v.at()]);
        let others = 2.0 * scaled[longest] * (1.0 + SLACK[1] * whole);
        let wanted = (others - ba * at_a - cb * at_c) / (ba + cb);
        let size = 1.0 / wanted.min(at_a.max(at_c));
        if size >= sizes[apex.at()] {
            continue;
        }
        sizes[apex.at()] = size;
        for h in mesh.outgoing(apex) {
            let face = h.face();
            if !std::mem::replace(&mut is_queued[face.at()], true) {
                queue.push_back(face);
            }
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

    #[test]
    fn fans_of_needles_close() {
        // From a tip to many points close together on a line, which would have sizes of 3 to 1, or of 1 to 3.
        let n = 200u32;
        let tip = [0.0, 0.0, 0.0];
        let base = (0..=n).map(|i| [10.0, 1e-4 * f64::from(i), 0.0]);
        let positions: Vec<[f64; 3]> = std::iter::once(tip).chain(base).collect();
        let faces: Vec<[u32; 3]> = (1..=n).map(|i| [0, i, i + 1]).collect();
        let mesh = TriMesh::from_faces(positions.len(), &faces).unwrap();
        let metric = Metric::from_positions(&mesh, &positions);
        let slack = |f: Face, sizes: &[f64]| {
            let sides = f.halfedges().map(|h| metric.length[h] * edge_scale(&mesh, sizes, h));
            sides.iter().sum::<f64>() / sides.into_iter().fold(0.0, f64::max) - 2.0
        };
        for turned in [false, true] {
            let wish =
                |i: u32| 1.0 + 2.0 * f64::from(if turned { n - i } else { i }) / f64::from(n);
            let wanted: Vec<f64> = std::iter::once(2.0).chain((0..=n).map(wish)).collect();
            let sizes = closing(&mesh, &metric, wanted.clone());
            let alike = vec![1.0; wanted.len()];
            assert!(mesh.faces().any(|f| slack(f, &wanted) < 0.0));
            assert!(mesh.faces().all(|f| slack(f, &sizes) > 0.49 * slack(f, &alike)));
            let is_between = |(size, wanted): (&f64, &f64)| (1.0..=*wanted).contains(size);
            assert!(sizes.iter().zip(&wanted).all(is_between));
        }
    }
}
