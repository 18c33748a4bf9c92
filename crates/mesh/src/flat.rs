//! The flat parts of a surface.

use crate::ids::{Face, FaceData, Halfedge};
use crate::mesh::TriMesh;
use crate::vector::{cross, dot, norm, sub};
use std::collections::VecDeque;

/// Faces that lie in one plane and hang together.
#[derive(Debug)]
pub(crate) struct FlatParts {
    /// The part of each face.
    pub(crate) of_face: FaceData<u32>,
    /// The faces of each part, ascending, in order of the first.
    pub(crate) faces: Vec<Vec<Face>>,
    /// The area of each part, square of the unit of the positions.
    pub(crate) area: Vec<f64>,
}

/// Vertices this far from a plane are in it, as a part of the longest side of the face that gives it: coordinates
/// in files often have seven digits.
const FLAT: f64 = 1e-6;
/// Normals of one plane have an inner product above this: they are within 2.5 degrees, which tells faces from the noise of
/// smaller ones.
const ALIKE: f64 = 0.999;
/// A face with a height below this part of its longest side has no area to speak of, and no plane.
const NO_AREA: f64 = 1e-9;

/// A face in space.
#[derive(Debug, Clone, Copy)]
struct Shape {
    /// Its unit normal; zero without area.
    normal: [f64; 3],
    area: f64,
    longest: f64,
    /// Side of that length.
    longest_side: usize,
}

impl Shape {
    fn new(corners: [[f64; 3]; 3]) -> Self {
        let sides = [0, 1, 2].map(|k| sub(corners[(k + 1) % 3], corners[k]));
        let lengths = sides.map(norm);
        let longest_side = (0..3).fold(0, |k, i| if lengths[i] > lengths[k] { i } else { k });
        let longest = lengths[longest_side];
        let doubled = cross(sides[0], sides[1]);
        let size = norm(doubled);
        let has_area = size > NO_AREA * longest * longest;
        let normal = if has_area { doubled.map(|x| x / size) } else { [0.0; 3] };
        Self { normal, area: 0.5 * size, longest, longest_side }
    }

    fn has_area(&self) -> bool {
        self.normal != [0.0; 3]
    }
}

impl FlatParts {
    /// The parts of a surface, given the edges that no part goes across.
    pub(crate) fn new(
        mesh: &TriMesh,
        positions: &[[f64; 3]],
        is_border: impl Fn(Halfedge) -> bool,
    ) -> Self {
        let shapes: FaceData<Shape> =
            mesh.faces().map(|f| Shape::new(corners(mesh, positions, f))).collect();
        let mut order: Vec<Face> = mesh.faces().collect();
        order.sort_by(|&f, &g| shapes[g].area.total_cmp(&shapes[f].area).then(f.cmp(&g)));
        let mut is_taken = FaceData::filled(mesh.n_faces(), false);
        let mut faces: Vec<Vec<Face>> = Vec::new();
        for seed in order {
            if std::mem::replace(&mut is_taken[seed], true) {
                continue;
            }
            let (plane, origin) = (shapes[seed], positions[mesh.origin(seed.halfedge(0)).at()]);
            let is_in_plane = |h: Halfedge| {
                let apex = positions[mesh.origin(h.prev()).at()];
                dot(sub(apex, origin), plane.normal).abs() <= FLAT * plane.longest
            };
            let (mut members, mut queue) = (vec![seed], VecDeque::from([seed]));
            while let Some(f) = queue.pop_front().filter(|_| plane.has_area()) {
                let sides = f.halfedges().into_iter().filter(|&h| !is_border(h));
                for twin in sides.filter_map(|h| mesh.twin(h)) {
                    let (g, shape) = (twin.face(), shapes[twin.face()]);
                    let faces_alike = match shape.has_area() {
                        true => dot(shape.normal, plane.normal) > ALIKE,
                        // It is a part of the longest of its sides.
                        false => shape.longest_side == twin.side(),
                    };
                    if !is_taken[g] && faces_alike && is_in_plane(twin) {
                        is_taken[g] = true;
                        members.push(g);
                        queue.push_back(g);
                    }
                }
            }
            members.sort_unstable();
            faces.push(members);
        }
        faces.sort_unstable();
        let mut of_face = FaceData::filled(mesh.n_faces(), 0);
        for (part, members) in faces.iter().enumerate() {
            members.iter().for_each(|&f| of_face[f] = part as u32);
        }
        let area = |faces: &Vec<Face>| faces.iter().map(|&f| shapes[f].area).sum();
        Self { area: faces.iter().map(area).collect(), of_face, faces }
    }
}

/// Whether three points span an area to speak of.
pub(crate) fn has_area(corners: [[f64; 3]; 3]) -> bool {
    Shape::new(corners).has_area()
}

pub(crate) fn corners(mesh: &TriMesh, positions: &[[f64; 3]], f: Face) -> [[f64; 3]; 3] {
    mesh.face_vertices(f).map(|v| positions[v.at()])
}

/// The angle at a corner, radians.
pub(crate) fn angle(corners: [[f64; 3]; 3], k: usize) -> f64 {
    let [a, b] = [1, 2].map(|i| sub(corners[(k + i) % 3], corners[k]));
    norm(cross(a, b)).atan2(dot(a, b))
}
