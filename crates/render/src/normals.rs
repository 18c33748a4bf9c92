//! Normals for shading: smooth over gentle edges, broken at creases.

use crate::topology::{edges, matched_corners, sorted_sides};
use crate::vec3::{Vec3, add, area_normal, dot, unit};

/// Edges whose faces turn by more than this stay sharp, in degrees.
const CREASE_ANGLE: f64 = 40.0;

/// Unit normals of the three corners of every face: the area-weighted mean over the faces that
/// are reached around the vertex without crossing a crease.
pub(crate) fn corner_normals(positions: &[Vec3], faces: &[[u32; 3]]) -> Vec<[[f32; 3]; 3]> {
    let weighted: Vec<Vec3> =
        faces.iter().map(|f| area_normal(f.map(|v| positions[v as usize]))).collect();
    let flat: Vec<Option<Vec3>> = weighted.iter().map(|&n| unit(n)).collect();
    let smooth_cos = CREASE_ANGLE.to_radians().cos();

    let mut groups = Groups::new(3 * faces.len());
    for edge in edges(&sorted_sides(faces)) {
        let &[a, b] = edge else { continue };
        let faces_of = [a, b].map(|side| flat[side.corner as usize / 3]);
        if let [Some(n), Some(m)] = faces_of
            && dot(n, m) >= smooth_cos
        {
            for [c, d] in matched_corners(faces, a, b) {
                groups.join(c, d);
            }
        }
    }

    let mut sums = vec![[0.0; 3]; 3 * faces.len()];
    for corner in 0..3 * faces.len() {
        let root = groups.root(corner as u32) as usize;
        sums[root] = add(sums[root], weighted[corner / 3]);
    }
    (0..faces.len())
        .map(|face| {
            std::array::from_fn(|k| {
                let root = groups.root((3 * face + k) as u32) as usize;
                let normal = unit(sums[root]).or(flat[face]).unwrap_or([0.0, 0.0, 1.0]);
                normal.map(|x| x as f32)
            })
        })
        .collect()
}

/// Disjoint sets of corners.
struct Groups {
    parent: Vec<u32>,
}

impl Groups {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    fn root(&mut self, mut corner: u32) -> u32 {
        while self.parent[corner as usize] != corner {
            let up = self.parent[self.parent[corner as usize] as usize];
            self.parent[corner as usize] = up;
            corner = up;
        }
        corner
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles on the x axis; the second rises from the plane by the given angle.
    fn hinge(degrees: f64) -> Vec<[[f32; 3]; 3]> {
        let (s, c) = degrees.to_radians().sin_cos();
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, -1.0, 0.0], [0.5, c, s]];
        corner_normals(&positions, &[[0, 2, 1], [0, 1, 3]])
    }

    #[test]
    fn gentle_edges_share_a_normal_and_creases_do_not() {
        let gentle = hinge(20.0);
        assert_eq!(gentle[0][0], gentle[1][0]);
        assert_eq!(gentle[0][2], gentle[1][1]);
        assert_ne!(gentle[0][1], gentle[1][2]);
        let expected = 10.0_f32.to_radians();
        assert!((gentle[0][0][2] - expected.cos()).abs() < 1e-6);
        assert!((gentle[0][0][1] + expected.sin()).abs() < 1e-6);

        let crease = hinge(60.0);
        assert_eq!(crease[0], [[0.0, 0.0, 1.0]; 3]);
        assert!((crease[1][0][2] - 0.5).abs() < 1e-6);
    }
}
