//! The isometric layout: triangles unfolded one by one along a dual tree.

use super::{Cut, DualTree};
use crate::quarter::rotation;
use num_complex::Complex64;
use seamstress_mesh::{Face, FaceData, Halfedge, HalfedgeData, Metric, TriMesh};
use std::f64::consts::{FRAC_PI_2, PI};

/// Direction of each face's first half-edge in the unfolded plane, radians, summed up along the tree
/// without taking any remainder. Faces that hang on the ground have that edge on the u axis.
///
/// It is a linear function of the corner angles, which makes seam rotations comparable between metrics
/// and liftable: two layouts that differ by full turns get different numbers.
pub(crate) fn headings(
    mesh: &TriMesh,
    angle: &HalfedgeData<f64>,
    tree: &DualTree,
) -> FaceData<f64> {
    let mut heading = FaceData::filled(mesh.n_faces(), 0.0);
    for &f in &tree.order {
        if let Some(h) = tree.ground[f] {
            heading[f] = -turning(angle, h);
        }
        let Some(h) = tree.parent[f] else { continue };
        let Some(t) = mesh.twin(h) else { continue };
        heading[f] = heading[h.face()] + turning(angle, h) - turning(angle, t) - PI;
    }
    heading
}

/// Direction of a half-edge against the first one of its face, radians.
pub(crate) fn turning(angle: &HalfedgeData<f64>, h: Halfedge) -> f64 {
    let [_, second, third] = h.face().halfedges();
    match h.side() {
        0 => 0.0,
        1 => PI - angle[second],
        _ => 2.0 * PI - angle[second] - angle[third],
    }
}

/// Frames of the faces as given corner angles turn them along the tree: each triangle keeps its shape
/// and is turned so that its sides point on average where those angles say.
pub fn frames_of_angles(
    mesh: &TriMesh,
    metric: &Metric,
    angle: &HalfedgeData<f64>,
    tree: &DualTree,
) -> Vec<Complex64> {
    let heading = headings(mesh, angle, tree);
    let frame = |f: Face| {
        let off = f.halfedges().map(|h| turning(angle, h) - turning(&metric.angle, h));
        rotation((heading[f] + off.iter().sum::<f64>() / 3.0) / FRAC_PI_2)
    };
    mesh.faces().map(frame).collect()
}

/// Positions of the wedges after unfolding the faces along the tree; every triangle keeps its shape.
pub fn unfold(mesh: &TriMesh, metric: &Metric, tree: &DualTree, cut: &Cut) -> Vec<Complex64> {
    let heading = headings(mesh, &metric.angle, tree);
    let mut z = vec![Complex64::ZERO; cut.n_wedges];
    for &f in &tree.order {
        let turn = rotation(heading[f] / FRAC_PI_2);
        let flat = metric.flat[f];
        let place = |z: &mut Vec<Complex64>, f: Face, from: usize, to: usize| {
            let (from_wedge, to_wedge) =
                (cut.wedge[f.halfedge(from)] as usize, cut.wedge[f.halfedge(to)] as usize);
            z[to_wedge] = z[from_wedge] + turn * (flat[to] - flat[from]);
        };
        match tree.parent[f].and_then(|h| mesh.twin(h)) {
            // The two corners on the shared edge stand; hang the third on the nearer one.
            Some(t) => {
                let (near, far, apex) = (t.side(), (t.side() + 1) % 3, (t.side() + 2) % 3);
                let nearer =
                    if metric.length[t.prev()] <= metric.length[t.next()] { near } else { far };
                place(&mut z, f, nearer, apex);
            }
            None => {
                place(&mut z, f, 0, 1);
                place(&mut z, f, 0, 2);
            }
        }
    }
    z
}

/// Lifted rotation of each half-edge in the layout with these corner angles, in quarter turns: the angle from the left
/// to the right image of its edge, which for edges without a twin is on the ground, along the u axis.
pub fn rotations(
    mesh: &TriMesh,
    angle: &HalfedgeData<f64>,
    tree: &DualTree,
    halfedges: &[Halfedge],
) -> Vec<f64> {
    let heading = headings(mesh, angle, tree);
    halfedges
        .iter()
        .map(|&h| {
            let left = heading[h.face()] + turning(angle, h);
            let right = match mesh.twin(h) {
                Some(t) => heading[t.face()] + turning(angle, t) + PI,
                None => 0.0,
            };
            (right - left) / FRAC_PI_2
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quarter::direction;
    use seamstress_testkit as testkit;

    #[test]
    fn unfolding_keeps_lengths_and_rotations_agree_with_positions() {
        let soup = testkit::bumpy(&testkit::icosphere(2), 0.05, 3);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let tree = DualTree::lightest(&mesh, |h| metric.length[h]);
        let cut = Cut::new(&mesh, |h| tree.crossed[h]);
        let z = unfold(&mesh, &metric, &tree, &cut);
        for h in mesh.halfedges() {
            let [a, b] = cut.ends(h);
            let length = (z[b as usize] - z[a as usize]).norm();
            assert!((length - metric.length[h]).abs() < 1e-10);
        }
        let rotations = rotations(&mesh, &metric.angle, &tree, &cut.seams);
        for (&h, r) in cut.seams.iter().zip(rotations) {
            let [a, b, c, d] = cut.seam_wedges(&mesh, h).map(|w| z[w as usize]);
            let turned = direction(b - a) * rotation(r);
            assert!((turned - direction(d - c)).norm() < 1e-9);
        }
    }
}
