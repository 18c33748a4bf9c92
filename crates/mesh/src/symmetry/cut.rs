//! The side of a mesh that lies over a plane.

use super::Mirror;
use crate::features::EdgeSet;
use crate::ids::{Face, Halfedge, Vertex};
use crate::mesh::TriMesh;
use crate::refine::FeaturePiece;
use crate::vector::{Point, norm, sub};
use std::collections::HashMap;

/// The side of a mesh over a plane. Kept vertices come first, in their order, then those where edges cross the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// Positions, #V by 3. Those on the rim lie on the plane.
    pub positions: Vec<[f64; 3]>,
    /// Vertices of the faces, #F by 3.
    pub faces: Vec<[u32; 3]>,
    /// For each vertex the edge of the source that it is on; twice the same vertex if it is one.
    pub vertex_origin: Vec<[u32; 2]>,
    /// For each face the one of the source that it is a piece of.
    pub face_origin: Vec<u32>,
    /// The feature edges, each with the one of the source that it is a piece of.
    pub features: Vec<FeaturePiece>,
    /// The edges in the plane on whose other side the source goes on, by their ends.
    pub rim: Vec<[u32; 2]>,
}

/// The side of a mesh that a plane's normal points to. Triangles that cross the plane are split flat; vertices within a
/// distance of the plane count as on it. Faces that lie in the plane are left out. None where no face is over it.
#[must_use]
pub fn cut(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    features: &EdgeSet,
    mirror: &Mirror,
    within: f64,
) -> Option<Cut> {
    let height = |&p: &Point| match mirror.height(p) {
        on if on.abs() <= within => 0.0,
        off => off,
    };
    let heights: Vec<f64> = positions.iter().map(height).collect();
    let source = Source { mesh, positions, mirror, heights };
    mesh.faces().any(|f| source.keeps(f)).then(|| source.cut(features))
}

/// A mesh and the heights of its vertices over a plane.
struct Source<'a> {
    mesh: &'a TriMesh,
    positions: &'a [Point],
    mirror: &'a Mirror,
    heights: Vec<f64>,
}

impl Source<'_> {
    fn is_on(&self, v: Vertex) -> bool {
        self.heights[v.at()] == 0.0
    }

    fn is_over(&self, v: Vertex) -> bool {
        self.heights[v.at()] > 0.0
    }

    /// Whether a part of a face is over the plane.
    fn keeps(&self, f: Face) -> bool {
        self.mesh.face_vertices(f).into_iter().any(|v| self.is_over(v))
    }

    fn cut(&self, features: &EdgeSet) -> Cut {
        let side = Side::new(self);
        let mut cut = Cut {
            positions: Vec::new(),
            faces: Vec::new(),
            vertex_origin: Vec::new(),
            face_origin: Vec::new(),
            features: Vec::new(),
            rim: Vec::new(),
        };
        for f in self.mesh.faces().filter(|&f| self.keeps(f)) {
            let corners: Vec<u32> = f.halfedges().iter().flat_map(|&h| side.kept(h)).collect();
            let faces = triangles(&corners, &side.positions);
            cut.face_origin.extend(faces.iter().map(|_| f.0));
            cut.faces.extend(faces);
            cut.rim.extend(side.rim(f));
        }
        let is_kept = |h: Halfedge| {
            self.keeps(h.face()) || self.mesh.twin(h).is_some_and(|twin| self.keeps(twin.face()))
        };
        for &h in features.edges().iter().filter(|&&h| is_kept(h)) {
            let ends: Vec<u32> = side.kept(h).into_iter().chain(side.tip(h)).collect();
            if let [a, b] = ends[..] {
                let source = [self.mesh.origin(h).0, self.mesh.tip(h).0];
                cut.features.push(FeaturePiece { vertices: [a, b], source });
            }
        }
        (cut.positions, cut.vertex_origin) = (side.positions, side.origin);
        cut
    }
}

/// The vertices of a side.
struct Side<'a> {
    source: &'a Source<'a>,
    positions: Vec<Point>,
    origin: Vec<[u32; 2]>,
    /// The number of each vertex of the source that is kept.
    number: Vec<Option<u32>>,
    /// The vertex on each edge that crosses the plane, by its ends, ascending.
    crossing: HashMap<[u32; 2], u32>,
}

impl<'a> Side<'a> {
    fn new(source: &'a Source<'a>) -> Self {
        let Source { mesh, positions, mirror, .. } = source;
        let mut is_kept = vec![false; mesh.n_vertices()];
        for v in mesh.faces().filter(|&f| source.keeps(f)).flat_map(|f| mesh.face_vertices(f)) {
            is_kept[v.at()] = source.is_over(v) || source.is_on(v);
        }
        let kept: Vec<Vertex> = mesh.vertices().filter(|v| is_kept[v.at()]).collect();
        let place = |&v: &Vertex| match source.is_on(v) {
            true => mirror.onto(positions[v.at()]),
            false => positions[v.at()],
        };
        let mut side = Self {
            source,
            positions: kept.iter().map(place).collect(),
            origin: kept.iter().map(|v| [v.0, v.0]).collect(),
            number: vec![None; mesh.n_vertices()],
            crossing: HashMap::new(),
        };
        kept.iter().zip(0..).for_each(|(v, number)| side.number[v.at()] = Some(number));
        for h in mesh.edges() {
            side.cross([mesh.origin(h), mesh.tip(h)]);
        }
        side
    }

    /// Adds the point where an edge crosses the plane, if it does.
    fn cross(&mut self, ends: [Vertex; 2]) {
        let [a, b] = ends.map(|v| self.source.heights[v.at()]);
        if a * b >= 0.0 {
            return;
        }
        let [p, q] = ends.map(|v| self.source.positions[v.at()]);
        let share = a / (a - b);
        let at = [0, 1, 2].map(|k| (1.0 - share) * p[k] + share * q[k]);
        let ends = key(ends);
        self.crossing.insert(ends, self.positions.len() as u32);
        self.positions.push(self.source.mirror.onto(at));
        self.origin.push(ends);
    }

    /// What is kept of a half-edge without its tip, from its origin on.
    fn kept(&self, h: Halfedge) -> Vec<u32> {
        let ends = [self.source.mesh.origin(h), self.source.mesh.tip(h)];
        let crossing = self.crossing.get(&key(ends)).copied();
        self.number[ends[0].at()].into_iter().chain(crossing).collect()
    }

    fn tip(&self, h: Halfedge) -> Option<u32> {
        self.number[self.source.mesh.tip(h).at()]
    }

    /// The side in the plane of what is kept of a face, if the source goes on there.
    fn rim(&self, f: Face) -> Option<[u32; 2]> {
        let (mesh, source) = (self.source.mesh, self.source);
        let in_plane = f.halfedges().into_iter().find(|&h| {
            source.is_on(mesh.origin(h))
                && source.is_on(mesh.tip(h))
                && mesh.twin(h).is_some_and(|twin| !source.keeps(twin.face()))
        });
        let on_plane = |h: &Halfedge| {
            let ends = [mesh.origin(*h), mesh.tip(*h)];
            let vertex = self.number[ends[0].at()].filter(|_| source.is_on(ends[0]));
            vertex.into_iter().chain(self.crossing.get(&key(ends)).copied())
        };
        let crosses = mesh.face_vertices(f).into_iter().any(|v| source.heights[v.at()] < 0.0);
        let ends: Vec<u32> = match (in_plane, crosses) {
            (Some(h), _) => self.kept(h).into_iter().chain(self.tip(h)).collect(),
            (None, true) => f.halfedges().iter().flat_map(on_plane).collect(),
            (None, false) => Vec::new(),
        };
        ends.try_into().ok()
    }
}

fn key([a, b]: [Vertex; 2]) -> [u32; 2] {
    [a.0.min(b.0), a.0.max(b.0)]
}

/// A triangle, or a quad split along its shorter diagonal.
fn triangles(corners: &[u32], positions: &[Point]) -> Vec<[u32; 3]> {
    let length = |a: u32, b: u32| norm(sub(positions[a as usize], positions[b as usize]));
    match *corners {
        [a, b, c] => vec![[a, b, c]],
        [a, b, c, d] if length(a, c) <= length(b, d) => vec![[a, b, c], [a, c, d]],
        [a, b, c, d] => vec![[a, b, d], [b, c, d]],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square in the plane where z is 0, around a vertex, as a fan of four.
    fn fan() -> (TriMesh, Vec<Point>) {
        let positions = vec![
            [0.0, 0.0, 0.0],
            [3.0, -1.0, 0.0],
            [3.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [-1.0, -1.0, 0.0],
        ];
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        (TriMesh::from_faces(5, &faces).unwrap(), positions)
    }

    #[test]
    fn a_fan_is_cut_through_its_vertex_and_through_its_triangles() {
        let (mesh, positions) = fan();
        let features = EdgeSet::boundary(&mesh);
        let through = cut(&mesh, &positions, &features, &Mirror::across(0, 0.0), 0.0).unwrap();
        assert_eq!(through.vertex_origin, [[0, 0], [1, 1], [2, 2], [2, 3], [1, 4]]);
        assert_eq!(through.positions[3..], [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]);
        assert_eq!(through.faces, [[0, 1, 2], [0, 2, 3], [0, 4, 1]]);
        assert_eq!(through.face_origin, [0, 1, 3]);
        assert_eq!(through.rim, [[0, 3], [0, 4]]);
        let sources: Vec<_> = through.features.iter().map(|piece| piece.source).collect();
        assert_eq!(sources, [[1, 2], [2, 3], [4, 1]]);
        assert_eq!(through.features[1].vertices, [2, 3]);

        let right = cut(&mesh, &positions, &features, &Mirror::across(0, 1.0), 0.0).unwrap();
        assert_eq!(right.faces.len(), 4, "a triangle, a quad in two, and a triangle");
        let area: f64 = right.faces.iter().map(|f| area(f, &right.positions)).sum();
        assert!((area - 4.0).abs() < 1e-12, "{area}");
        assert_eq!(right.rim.len(), 3);
        let mut on_rim: Vec<u32> = right.rim.concat();
        on_rim.sort_unstable();
        on_rim.dedup();
        assert!(on_rim.iter().all(|&v| right.positions[v as usize][0] == 1.0));
    }

    fn area(face: &[u32; 3], positions: &[Point]) -> f64 {
        let [a, b, c] = face.map(|v| positions[v as usize]);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    }

    #[test]
    fn borders_in_the_plane_are_no_rim_and_near_vertices_are_put_there() {
        let (mesh, mut positions) = fan();
        positions[0] = [1e-9, 0.0, 0.0];
        let none = EdgeSet::new(&mesh, []);
        let near = cut(&mesh, &positions, &none, &Mirror::across(0, 0.0), 1e-8).unwrap();
        assert_eq!((near.positions[0], near.faces.len()), ([0.0; 3], 3));
        let whole = cut(&mesh, &positions, &none, &Mirror::across(0, -1.0), 0.0).unwrap();
        assert_eq!((whole.faces.len(), whole.rim.len()), (4, 0));
        assert_eq!(cut(&mesh, &positions, &none, &Mirror::across(0, 5.0), 0.0), None);
        assert_eq!(cut(&mesh, &positions, &none, &Mirror::across(2, 0.0), 0.0), None);
    }

    #[test]
    fn faces_in_the_plane_are_left_out() {
        // A fold: a triangle over the plane where z is 0, one in it, and one under it.
        let positions =
            [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, -1.0, 1.0], [1.5, 1.0, -1.0]];
        let mesh = TriMesh::from_faces(5, &[[0, 1, 2], [1, 0, 3], [2, 1, 4]]).unwrap();
        let features = EdgeSet::new(&mesh, mesh.edges());
        let over = cut(&mesh, &positions, &features, &Mirror::across(2, 0.0), 0.0).unwrap();
        assert_eq!((over.face_origin, over.rim), (vec![1], vec![[1, 0]]));
        assert_eq!(over.features.len(), 3);
    }
}
