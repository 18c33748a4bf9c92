//! Normals for shading: smooth over gentle edges, broken at creases.

use crate::topology::{edges, matched_corners, sorted_sides};
use crate::vec3::{Vec3, add, area_normal, dot, unit};

/// Edges whose faces turn by more than this stay sharp, in degrees.
const CREASE_ANGLE: f64 = 40.0;

/// Normals of a surface for shading.
#[derive(Debug)]
pub(crate) struct Normals {
    /// Unit normals of the three corners of every face: the area-weighted mean over the faces that are reached around
    /// the vertex without crossing a crease.
    pub(crate) at_corners: Vec<[[f32; 3]; 3]>,
    /// Edges between two faces over which light and all else go on smoothly.
    pub(crate) smooth: Vec<SmoothEdge>,
    /// The ends of all others.
    pub(crate) sharp: Vec<[u32; 2]>,
}

/// An edge and its two faces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SmoothEdge {
    pub(crate) ends: [u32; 2],
    pub(crate) faces: [u32; 2],
}

impl Normals {
    /// `goes_on` tells of pairs of corners that meet across an edge whether all else is smooth there.
    pub(crate) fn new(
        positions: &[Vec3],
        faces: &[[u32; 3]],
        goes_on: impl Fn([u32; 2]) -> bool,
    ) -> Self {
        let weighted: Vec<Vec3> =
            faces.iter().map(|f| area_normal(f.map(|v| positions[v as usize]))).collect();
        let flat: Vec<Option<Vec3>> = weighted.iter().map(|&n| unit(n)).collect();
        let smooth_cos = CREASE_ANGLE.to_radians().cos();

        let mut smooth = Vec::with_capacity(faces.len() * 3 / 2);
        let mut sharp = Vec::new();
        let mut groups = Groups::new(3 * faces.len());
        for edge in edges(&sorted_sides(faces)) {
            if let &[a, b] = edge
                && let sides = [a, b].map(|side| side.corner / 3)
                && let [Some(n), Some(m)] = sides.map(|face| flat[face as usize])
                && dot(n, m) >= smooth_cos
            {
                let meeting = matched_corners(faces, a, b);
                meeting.iter().for_each(|&[c, d]| groups.join(c, d));
                if meeting.into_iter().all(&goes_on) {
                    smooth.push(SmoothEdge { ends: a.vertices, faces: sides });
                    continue;
                }
            }
            sharp.push(edge[0].vertices);
        }

        let mut sums = vec![[0.0; 3]; 3 * faces.len()];
        for corner in 0..3 * faces.len() {
            let root = groups.root(corner as u32) as usize;
            sums[root] = add(sums[root], weighted[corner / 3]);
        }
        let at_corner = |face: usize, root: u32| {
            let normal = unit(sums[root as usize]).or(flat[face]).unwrap_or([0.0, 0.0, 1.0]);
            normal.map(|x| x as f32)
        };
        let corners = |face: usize| [0, 1, 2].map(|k| (3 * face + k) as u32);
        let at_corners = (0..faces.len())
            .map(|face| corners(face).map(|corner| at_corner(face, groups.root(corner))))
            .collect();
        Self { at_corners, smooth, sharp }
    }
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
    fn hinge(degrees: f64) -> Normals {
        let (s, c) = degrees.to_radians().sin_cos();
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, -1.0, 0.0], [0.5, c, s]];
        Normals::new(&positions, &[[0, 2, 1], [0, 1, 3]], |_| true)
    }

    #[test]
    fn gentle_edges_share_a_normal_and_creases_do_not() {
        let Normals { at_corners: gentle, smooth, sharp } = hinge(20.0);
        assert_eq!((smooth[0].ends, smooth[0].faces, sharp.len()), ([0, 1], [0, 1], 4));
        assert_eq!(gentle[0][0], gentle[1][0]);
        assert_eq!(gentle[0][2], gentle[1][1]);
        assert_ne!(gentle[0][1], gentle[1][2]);
        let expected = 10.0_f32.to_radians();
        assert!((gentle[0][0][2] - expected.cos()).abs() < 1e-6);
        assert!((gentle[0][0][1] + expected.sin()).abs() < 1e-6);

        let Normals { at_corners: crease, smooth, sharp } = hinge(60.0);
        assert_eq!((smooth.len(), sharp.len()), (0, 5));
        assert_eq!(crease[0], [[0.0, 0.0, 1.0]; 3]);
        assert!((crease[1][0][2] - 0.5).abs() < 1e-6);
    }
}
