//! Cutting a soup apart into sheets in which every edge has at most two faces, and which can be
//! oriented.

use super::TriangleSoup;
use super::connectivity::{Connectivity, Side};
use super::geometry::Local;
use super::sets::SignedSets;
use crate::vector::{cross, dot, norm, sub};
use std::collections::{BTreeMap, VecDeque};
use std::f64::consts::PI;

/// Turns that differ by less, in radians, are alike.
const ALIKE: f64 = 1e-6;

/// Where a soup is cut.
#[derive(Debug)]
pub(super) struct Cuts {
    /// For each corner the lowest corner of its fan, when faces are joined in sheets only.
    pub(super) fans: Vec<u32>,
    /// Edges of more than two faces, with their faces and how many sheets run along them.
    pub(super) junctions: Vec<Junction>,
    /// By their lowest faces, the patches that no orientation fits, and the edges that they are cut
    /// open along.
    pub(super) opened: BTreeMap<u32, Vec<[u32; 2]>>,
}

/// An edge of more than two faces.
#[derive(Debug)]
pub(super) struct Junction {
    pub(super) edge: [u32; 2],
    pub(super) faces: Vec<u32>,
    pub(super) sheets: usize,
}

/// Finds the cuts, if there are any to make.
///
/// Faces go on across edges of two faces, except where a walk over them breadth-first finds that no
/// orientation fits. At an edge of more faces those go on into each other that turn the least, of
/// equal turns the convex one; a pair that agrees in orientation comes before one that does not, and
/// none is made that no orientation of the sheet would fit.
pub(super) fn cuts(soup: &TriangleSoup) -> Option<Cuts> {
    let faces = &soup.faces;
    let connectivity = Connectivity::new(faces, &vec![true; faces.len()]);
    let crowded: Vec<&[Side]> = connectivity.edges().filter(|sides| sides.len() > 2).collect();
    let mut joints = Joints::new(&connectivity, faces.len());
    let opened = joints.open();
    if crowded.is_empty() && opened.is_empty() {
        return None;
    }
    for sides in &crowded {
        joints.pair(soup, sides);
    }
    let ends = |fans: &[u32], sides: &[Side]| {
        let ends = |side: &Side| connectivity.corners_at_ends(*side).map(|c| fans[c as usize]);
        let mut ends: Vec<[u32; 2]> = sides.iter().map(ends).collect();
        ends.sort_unstable();
        ends
    };
    // A sheet may come back to an edge with both of its ends. There nothing goes on.
    let fans = joints.fans(&connectivity);
    for sides in &crowded {
        if ends(&fans, sides).chunk_by(|a, b| a == b).any(|same| same.len() > 2) {
            joints.part(sides);
        }
    }
    let fans = joints.fans(&connectivity);
    let junctions = crowded.iter().map(|sides| Junction {
        edge: sides[0].edge,
        faces: sides.iter().map(|side| side.face()).collect(),
        sheets: ends(&fans, sides).chunk_by(|a, b| a == b).count(),
    });
    Some(Cuts { junctions: junctions.collect(), fans, opened })
}

/// Which sides are joined, and how that orients faces against each other.
struct Joints {
    /// For each side, by the corner that it starts from, the one that it is joined to, and whether
    /// they run the same way.
    across: Vec<Option<(Side, bool)>>,
    /// Faces joined so far, signed by orientation.
    sets: SignedSets,
}

impl Joints {
    fn new(connectivity: &Connectivity, n_faces: usize) -> Self {
        let mut across = vec![None; 3 * n_faces];
        for (a, b, same_way) in connectivity.edges().filter_map(|sides| connectivity.pair(sides)) {
            across[a.corner as usize] = Some((b, same_way));
            across[b.corner as usize] = Some((a, same_way));
        }
        Self { across, sets: SignedSets::new(n_faces) }
    }

    /// Orients patches from their lowest faces, and parts the sides at which that fails.
    fn open(&mut self) -> BTreeMap<u32, Vec<[u32; 2]>> {
        let n_faces = self.across.len() as u32 / 3;
        let mut opened = BTreeMap::<u32, Vec<[u32; 2]>>::new();
        let mut seen = vec![false; n_faces as usize];
        let mut queue = VecDeque::new();
        for lowest in 0..n_faces {
            if !seen[lowest as usize] {
                seen[lowest as usize] = true;
                queue.push_back(lowest);
            }
            while let Some(face) = queue.pop_front() {
                for corner in 3 * face..3 * face + 3 {
                    let Some((other, same_way)) = self.across[corner as usize] else { continue };
                    if !self.sets.join(face, other.face(), same_way) {
                        self.across[corner as usize] = None;
                        self.across[other.corner as usize] = None;
                        opened.entry(lowest).or_default().push(other.edge);
                    } else if !seen[other.face() as usize] {
                        seen[other.face() as usize] = true;
                        queue.push_back(other.face());
                    }
                }
            }
        }
        opened
    }

    /// Joins the sides of an edge in pairs, the best first.
    fn pair(&mut self, soup: &TriangleSoup, sides: &[Side]) {
        let hinge = Hinge::new(soup, sides);
        let pairs = (0..sides.len()).flat_map(|i| (i + 1..sides.len()).map(move |j| [i, j]));
        let mut pairs: Vec<([i64; 3], [usize; 2])> =
            pairs.map(|pair| (hinge.rank(pair), pair)).collect();
        pairs.sort_unstable();
        for ([disagree, ..], pair) in pairs {
            let [a, b] = pair.map(|i| sides[i]);
            let is_free = [a, b].iter().all(|side| self.across[side.corner as usize].is_none());
            let same_way = disagree > 0;
            if is_free && self.sets.join(a.face(), b.face(), same_way) {
                self.across[a.corner as usize] = Some((b, same_way));
                self.across[b.corner as usize] = Some((a, same_way));
            }
        }
    }

    fn part(&mut self, sides: &[Side]) {
        for side in sides {
            self.across[side.corner as usize] = None;
        }
    }

    /// For each corner the lowest corner of those that joints connect it to around its vertex.
    fn fans(&self, connectivity: &Connectivity) -> Vec<u32> {
        let mut fans = SignedSets::new(self.across.len());
        for side in connectivity.edges().flatten() {
            if let Some((other, _)) = self.across[side.corner as usize] {
                let ends = [*side, other].map(|side| connectivity.corners_at_ends(side));
                for (a, b) in ends[0].into_iter().zip(ends[1]) {
                    fans.join(a, b, false);
                }
            }
        }
        fans.into_roots()
    }
}

/// The faces around an edge.
struct Hinge {
    /// For each face its direction away from the edge, of length 1 or 0.
    directions: Vec<[f64; 3]>,
    /// Unit normals to those and to the edge, on the side that the face is seen from.
    normals: Vec<[f64; 3]>,
    /// Whether it runs along the edge from the smaller vertex.
    is_forward: Vec<bool>,
}

impl Hinge {
    fn new(soup: &TriangleSoup, sides: &[Side]) -> Self {
        let apex = |side: &Side| soup.faces[side.face() as usize][((side.corner + 2) % 3) as usize];
        let vertices = sides[0].edge.into_iter().chain(sides.iter().map(apex));
        let points = Local::new(vertices.map(|v| soup.positions[v as usize])).points;
        let (from, along) = (points[0], unit(sub(points[1], points[0])));
        let directions: Vec<[f64; 3]> = points[2..]
            .iter()
            .map(|&apex| {
                let to = sub(apex, from);
                let height = dot(to, along);
                unit(sub(to, along.map(|x| x * height)))
            })
            .collect();
        let is_forward: Vec<bool> = sides.iter().map(|side| side.is_forward(&soup.faces)).collect();
        let normals = directions
            .iter()
            .zip(&is_forward)
            .map(|(&direction, &forward)| {
                let normal = cross(along, direction);
                if forward { normal } else { normal.map(|x| -x) }
            })
            .collect();
        Self { directions, normals, is_forward }
    }

    /// What makes a pair of faces go on into each other, the least first: that they agree in
    /// orientation, that the surface turns little, that it is convex.
    fn rank(&self, [i, j]: [usize; 2]) -> [i64; 3] {
        let (a, b) = (self.directions[i], self.directions[j]);
        let angle = norm(cross(a, b)).atan2(dot(a, b));
        let disagrees = self.is_forward[i] == self.is_forward[j];
        let is_concave = dot(b, self.normals[i]) > ALIKE;
        [i64::from(disagrees), ((PI - angle) / ALIKE).round() as i64, i64::from(is_concave)]
    }
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = norm(v);
    if length > 0.0 { v.map(|x| x / length) } else { [0.0; 3] }
}
