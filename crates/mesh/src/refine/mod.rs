//! A finer mesh of the same surface.
//!
//! Feature curves need room: where a triangle has two feature edges, or an edge joins two curves without being on
//! one, no map can turn as a corner asks for. And triangles without area are in the way of everything. Here flat
//! parts of the surface are triangulated anew, with points added inside and on edges; no point leaves the surface, and
//! what is curved stays as it is.

mod merge;
mod triangulate;

use crate::features::EdgeSet;
use crate::flat::{FlatParts, angle, corners, has_area};
use crate::ids::{Face, Halfedge, HalfedgeData, VertexData};
use crate::mesh::TriMesh;
use crate::vector::{norm, sub};
use merge::Merged;
use triangulate::{Part, fans, triangulate};

/// A mesh of the same surface. The vertices of the source keep their numbers and come first.
#[derive(Debug, Clone, PartialEq)]
pub struct Refinement {
    /// Positions, #V by 3.
    pub positions: Vec<[f64; 3]>,
    /// Vertices of the faces, #F by 3.
    pub faces: Vec<[u32; 3]>,
    /// For each face one of the source, in which its center lies.
    pub face_origin: Vec<u32>,
    /// The feature edges, each with the one of the source that it is a piece of.
    pub features: Vec<FeaturePiece>,
}

/// A piece of a feature edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FeaturePiece {
    /// Its ends.
    pub vertices: [u32; 2],
    /// The ends of the source's edge.
    pub source: [u32; 2],
}

/// Angles below this at a feature are those of needles, radians: five degrees.
const NEEDLE: f64 = 0.087;
/// Pieces of an edge that joins two feature curves, at a minimum.
const FEWEST_PIECES: usize = 2;
/// Edges of a part are at most as long as this multiple of the side of a square of its area, so that it gets points inside.
/// With 1, narrow parts, as the strips around holes, got half as many triangles again, and room for cones in each of them;
/// with 2 some have too little room for grids of few cells.
const PART: f64 = 1.4;
/// Pieces of an edge at most that this asks for: a needle would ask for any number.
const MOST_PIECES: f64 = 1000.0;
/// Points added at most, on borders and then inside, on a mesh of fewer vertices: what is long and narrow everywhere gets
/// longer edges.
const MOST_POINTS: usize = 20_000;

/// A finer mesh of the same surface where features lack room or triangles have no area, with edges of about a length in
/// mesh units there. None if all is well as it is.
pub fn refine(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    features: &EdgeSet,
    size: f64,
) -> Option<Refinement> {
    let Some(merged) = Merged::new(mesh, positions) else {
        let source = Source::new(mesh, positions, features);
        let is_any_in_need = source.needs_room.iter().any(|&needs| needs);
        return is_any_in_need.then(|| source.refinement(size));
    };
    let (edges, names) = merged.edges(mesh, features);
    let mut refined = Source::new(&merged.mesh, positions, &edges).refinement(size);
    refined.face_origin.iter_mut().for_each(|f| *f = merged.face_origin[*f as usize]);
    for piece in &mut refined.features {
        let [a, b] = piece.source;
        piece.source = names.get(&[a.min(b), a.max(b)]).copied().unwrap_or(piece.source);
    }
    Some(refined)
}

/// Vertices on feature edges.
fn on_curves(mesh: &TriMesh, features: &EdgeSet) -> VertexData<bool> {
    let mut is_on_curve = VertexData::filled(mesh.n_vertices(), false);
    for &h in features.edges() {
        is_on_curve[mesh.origin(h)] = true;
        is_on_curve[mesh.tip(h)] = true;
    }
    is_on_curve
}

/// A surface with its flat parts.
struct Source<'a> {
    mesh: &'a TriMesh,
    positions: &'a [[f64; 3]],
    features: &'a EdgeSet,
    is_on_curve: VertexData<bool>,
    parts: FlatParts,
    /// Whether features lack room in a part, or faces area.
    needs_room: Vec<bool>,
}

impl<'a> Source<'a> {
    fn new(mesh: &'a TriMesh, positions: &'a [[f64; 3]], features: &'a EdgeSet) -> Self {
        let parts = FlatParts::new(mesh, positions, |h| features.contains(h));
        let is_on_curve = on_curves(mesh, features);
        let mut source =
            Self { mesh, positions, features, is_on_curve, parts, needs_room: Vec::new() };
        let parts = source.parts.faces.iter();
        source.needs_room = parts.map(|faces| source.lacks_room(faces)).collect();
        source
    }

    /// Whether features lack room in a part, or faces area.
    fn lacks_room(&self, part: &[Face]) -> bool {
        part.iter().any(|&f| {
            let sides = f.halfedges();
            let n_features = sides.iter().filter(|&&h| self.features.contains(h)).count();
            let corners = corners(self.mesh, self.positions, f);
            let is_needle = |&h: &Halfedge| {
                let is_on_curve = self.is_on_curve[self.mesh.origin(h)];
                part.len() > 1 && is_on_curve && angle(corners, h.side()) < NEEDLE
            };
            n_features > 1
                || sides.iter().any(|&h| self.joins_curves(h))
                || sides.iter().any(is_needle)
                || (part.len() > 1 && !has_area(corners))
        })
    }

    /// Whether an edge has both ends on feature curves, without being a piece of one.
    fn joins_curves(&self, h: Halfedge) -> bool {
        let ends = [self.mesh.origin(h), self.mesh.tip(h)];
        !self.features.contains(h) && ends.iter().all(|&v| self.is_on_curve[v])
    }

    /// The finer mesh. Parts that share their border, as the sides of a sheet, must not join the same points across
    /// it; fans never do.
    fn refinement(&self, size: f64) -> Refinement {
        let refined = self.refined(size, triangulate);
        match TriMesh::from_faces(refined.positions.len(), &refined.faces) {
            Ok(_) => refined,
            Err(_) => self.refined(size, fans),
        }
    }

    fn refined(&self, size: f64, add: impl Fn(&Part<'_>, &mut Refinement)) -> Refinement {
        let mut refined = Refinement {
            positions: self.positions.to_vec(),
            faces: Vec::new(),
            face_origin: Vec::new(),
            features: Vec::new(),
        };
        let pieces = self.split_borders(size, &mut refined.positions);
        for (part, faces) in self.parts.faces.iter().enumerate() {
            let is_split = |&f: &Face| f.halfedges().iter().any(|&h| !pieces[h].is_empty());
            if !self.needs_room[part] && !faces.iter().any(is_split) {
                for &f in faces {
                    refined.faces.push(self.mesh.face_vertices(f).map(|v| v.0));
                    refined.face_origin.push(f.0);
                }
                continue;
            }
            let size = self.needs_room[part].then(|| self.size(part as u32, size));
            let part = Part { source: self, faces, pieces: &pieces, size };
            add(&part, &mut refined);
        }
        for &h in self.features.edges() {
            let source = [self.mesh.origin(h).0, self.mesh.tip(h).0];
            let chain = self.chain(h, &pieces);
            let of = |ends: &[u32]| FeaturePiece { vertices: [ends[0], ends[1]], source };
            refined.features.extend(chain.windows(2).map(of));
        }
        refined
    }

    /// Points that may be added in all.
    fn most_points(&self) -> usize {
        MOST_POINTS.max(self.mesh.n_vertices())
    }

    /// How many pieces the border of parts that need room is to have, of an edge that is on it.
    fn wanted_pieces(&self, h: Halfedge, size: f64) -> Option<f64> {
        let parts = [Some(h), self.mesh.twin(h)].into_iter().flatten();
        let parts = parts.map(|h| self.parts.of_face[h.face()]);
        let in_need = parts.filter(|&part| self.needs_room[part as usize] && self.is_border(h));
        let [a, b] = [self.mesh.origin(h), self.mesh.tip(h)].map(|v| self.positions[v.at()]);
        let length = norm(sub(b, a));
        let wanted = |part| match self.size(part, f64::INFINITY) {
            0.0 => 0.0,
            size => (length / size).min(MOST_PIECES),
        };
        in_need.map(wanted).reduce(f64::max).map(|n| n.max(length / size))
    }

    /// Points on the borders of parts that need room, for each half-edge from its origin on.
    fn split_borders(&self, size: f64, positions: &mut Vec<[f64; 3]>) -> HalfedgeData<Vec<u32>> {
        let mut pieces = HalfedgeData::filled(self.mesh.n_halfedges(), Vec::new());
        let edges = self.mesh.edges().filter_map(|h| Some((h, self.wanted_pieces(h, size)?)));
        let edges: Vec<(Halfedge, f64)> = edges.collect();
        let all: f64 = edges.iter().map(|(_, n)| n).sum();
        let share = (self.most_points() as f64 / all).min(1.0);
        for (h, wanted) in edges {
            let twin = self.mesh.twin(h);
            let [a, b] = [self.mesh.origin(h), self.mesh.tip(h)].map(|v| self.positions[v.at()]);
            let fewest = if self.joins_curves(h) { FEWEST_PIECES } else { 1 };
            let n = ((share * wanted).ceil() as usize).max(fewest);
            let first = positions.len() as u32;
            for k in 1..n {
                let t = k as f64 / n as f64;
                positions.push([0, 1, 2].map(|k| (1.0 - t) * a[k] + t * b[k]));
            }
            pieces[h] = (first..positions.len() as u32).collect();
            if let Some(twin) = twin {
                pieces[twin] = pieces[h].iter().rev().copied().collect();
            }
        }
        pieces
    }

    /// The length of edges in a part that needs room.
    fn size(&self, part: u32, size: f64) -> f64 {
        size.min(PART * self.parts.area[part as usize].sqrt())
    }

    fn is_border(&self, h: Halfedge) -> bool {
        let part = |h: Halfedge| self.parts.of_face[h.face()];
        self.features.contains(h) || self.mesh.twin(h).is_none_or(|twin| part(twin) != part(h))
    }

    /// The vertices on a half-edge from its origin to its tip.
    fn chain(&self, h: Halfedge, pieces: &HalfedgeData<Vec<u32>>) -> Vec<u32> {
        let (from, to) = (self.mesh.origin(h).0, self.mesh.tip(h).0);
        [&[from], pieces[h].as_slice(), &[to]].concat()
    }
}
