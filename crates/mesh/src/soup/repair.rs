//! Repairs that move no vertex.

use super::check::{crowded_faces, referenced, repeated};
use super::connectivity::{Connectivity, Twin, twins};
use super::fault::list;
use super::sheets::{Junction, cuts};
use super::{MAX_FACES, MAX_VERTICES, TriangleSoup};
use std::collections::BTreeMap;
use std::fmt;

/// One thing that [`merge`](super::merge) or [`repair`] did. Faces and vertices are those of the
/// polygons or the soup given, except for `copies`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Repair {
    /// Made one vertex of those that sides of length zero join.
    CollapsedSides {
        /// The vertices; the first stays.
        vertices: Vec<u32>,
    },
    /// Left out corners of a face that say nothing, such as one repeated after itself.
    ReducedFace {
        /// The face.
        face: u32,
        /// Its corners that are left.
        corners: usize,
    },
    /// Dropped a face that had fewer than three corners, or came to have them.
    DroppedDegenerateFace {
        /// The face.
        face: u32,
    },
    /// Dropped a face with the vertices and orientation of an earlier one.
    DroppedDuplicateFace {
        /// The face dropped.
        face: u32,
        /// The face kept.
        first: u32,
    },
    /// Dropped the reverse of an earlier face, where more than two faces shared an edge and two
    /// are left.
    DroppedOppositeFace {
        /// The face dropped.
        face: u32,
        /// The face kept.
        first: u32,
    },
    /// Turned over the smaller part of a component (of two equal parts the one without the lowest
    /// face), to orient it consistently.
    Reoriented {
        /// The faces turned over.
        faces: Vec<u32>,
    },
    /// Cut an edge of more than two faces apart, so that each sheet along it is a surface.
    CutEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// All its faces, in increasing order.
        faces: Vec<u32>,
        /// The number of sheets.
        sheets: usize,
    },
    /// Cut a piece open that no orientation fits, such as a Möbius band.
    CutOpen {
        /// Lowest face of the piece.
        face: u32,
        /// The edges cut.
        edges: Vec<[u32; 2]>,
    },
    /// Gave each fan of faces at a vertex a vertex of its own, in the same place.
    SplitVertex {
        /// The vertex; its first fan keeps it.
        vertex: u32,
        /// The vertices of the other fans in the repaired soup.
        copies: Vec<u32>,
    },
    /// Dropped the vertices that belong to no face.
    DroppedUnreferencedVertices {
        /// The vertices.
        vertices: Vec<u32>,
    },
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CollapsedSides { vertices } => {
                let vertices = counted(vertices, "vertex", "vertices");
                write!(f, "made one of {vertices}, joined by sides of length zero")
            }
            Self::ReducedFace { face, corners } => {
                write!(f, "left {corners} corners of face {face}; the others repeated them")
            }
            Self::DroppedDegenerateFace { face } => {
                write!(f, "dropped face {face}, which has fewer than 3 different corners")
            }
            Self::DroppedDuplicateFace { face, first } => {
                write!(f, "dropped face {face}, a copy of face {first}")
            }
            Self::DroppedOppositeFace { face, first } => {
                write!(f, "dropped face {face}, the reverse of face {first}")
            }
            Self::Reoriented { faces } => {
                write!(f, "turned over {}", counted(faces, "face", "faces"))
            }
            Self::CutEdge { vertices: [a, b], faces, sheets } => {
                let sheets = match sheets {
                    1 => "1 sheet".into(),
                    n => format!("{n} sheets"),
                };
                write!(f, "cut edge {a}-{b} apart: {} faces in {sheets}", faces.len())
            }
            Self::CutOpen { face, edges } => {
                let edges = match edges.len() {
                    1 => "1 edge".into(),
                    n => format!("{n} edges"),
                };
                write!(f, "cut the piece of face {face} open along {edges}, to orient it")
            }
            Self::SplitVertex { vertex, copies } => {
                let n = copies.len() + 1;
                write!(f, "split vertex {vertex} into {n}, one for each fan of faces")
            }
            Self::DroppedUnreferencedVertices { vertices } => {
                let vertices = counted(vertices, "vertex", "vertices");
                write!(f, "dropped {vertices} in no face")
            }
        }
    }
}

impl Repair {
    /// The same with other names for faces and vertices, except for `copies`.
    #[must_use]
    pub fn renamed(mut self, face: impl Fn(u32) -> u32, vertex: impl Fn(u32) -> u32) -> Self {
        let all = |elements: &mut Vec<u32>, name: &dyn Fn(u32) -> u32| {
            elements.iter_mut().for_each(|element| *element = name(*element));
            elements.dedup();
        };
        match &mut self {
            Self::CollapsedSides { vertices } | Self::DroppedUnreferencedVertices { vertices } => {
                all(vertices, &vertex);
            }
            Self::ReducedFace { face: f, .. } | Self::DroppedDegenerateFace { face: f } => {
                *f = face(*f);
            }
            Self::DroppedDuplicateFace { face: f, first }
            | Self::DroppedOppositeFace { face: f, first } => {
                (*f, *first) = (face(*f), face(*first));
            }
            Self::Reoriented { faces } => all(faces, &face),
            Self::CutEdge { vertices, faces, .. } => {
                *vertices = vertices.map(vertex);
                // Two triangles of one polygon may meet there.
                faces.iter_mut().for_each(|f| *f = face(*f));
            }
            Self::CutOpen { face: f, edges } => {
                *f = face(*f);
                edges.iter_mut().for_each(|edge| *edge = edge.map(&vertex));
            }
            Self::SplitVertex { vertex: v, .. } => *v = vertex(*v),
        }
        self
    }
}

fn counted(elements: &[u32], one: &str, many: &str) -> String {
    let noun = if elements.len() == 1 { one } else { many };
    format!("{noun} {}", list(elements))
}

/// A repaired soup, and how it came from the one given.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Repaired {
    /// The soup after all repairs.
    pub soup: TriangleSoup,
    /// What was done, in order; empty if the soup is unchanged.
    pub repairs: Vec<Repair>,
    /// For each vertex of `soup` the vertex it was.
    pub vertex_origin: Vec<u32>,
    /// For each face of `soup` the face it was.
    pub face_origin: Vec<u32>,
    /// The edges of more than two faces that were cut apart, by the vertices that their ends were, in
    /// increasing order.
    pub junctions: Vec<[u32; 2]>,
}

/// Repairs what can be repaired without moving or merging a vertex.
///
/// Drops faces that repeat a vertex, copies of faces, and the later of a face and its reverse
/// where that brings all their edges down to two faces; orients each component consistently by
/// turning over as few faces as possible; cuts edges of more than two faces apart into sheets, and
/// components open that no orientation fits; splits vertices where several fans of faces meet; and
/// drops vertices in no face. Faces and vertices that stay keep their order, copies of vertices
/// come last.
///
/// What is left is for [`check`](super::check()) to say: coordinates that are not finite stay. A soup
/// with an index out of range, or with more elements than can be numbered, is returned as it is.
#[must_use]
pub fn repair(soup: TriangleSoup) -> Repaired {
    let (n_vertices, n_faces) = (soup.positions.len(), soup.faces.len());
    let mut work = Repaired {
        soup,
        repairs: Vec::new(),
        vertex_origin: (0..n_vertices as u32).collect(),
        face_origin: (0..n_faces as u32).collect(),
        junctions: Vec::new(),
    };
    let is_missing = |&vertex: &u32| vertex as usize >= n_vertices;
    let too_large = n_faces > MAX_FACES || n_vertices > MAX_VERTICES;
    if too_large || work.soup.faces.iter().flatten().any(is_missing) {
        return work;
    }
    work.drop_faces();
    work.orient();
    work.drop_vertices();
    work.cut();
    work.split_vertices();
    work
}

/// Those of the reversed twins that share an edge with more faces than two, and none of whose
/// edges keeps more than two when all such twins are gone. (A pair of opposite faces that hangs on
/// an edge of a surface is not among them: without one of the two the other still hangs there.)
fn surplus(connectivity: &Connectivity, n_faces: usize, mut reverses: Vec<Twin>) -> Vec<Twin> {
    let crowded = crowded_faces(connectivity, n_faces);
    reverses.retain(|twin| crowded[twin.face as usize]);
    let mut is_surplus = vec![false; n_faces];
    for twin in &reverses {
        is_surplus[twin.face as usize] = true;
    }
    let mut helps = vec![true; n_faces];
    for sides in connectivity.edges() {
        let staying = sides.iter().filter(|side| !is_surplus[side.face() as usize]);
        if staying.count() > 2 {
            for side in sides {
                helps[side.face() as usize] = false;
            }
        }
    }
    reverses.retain(|twin| helps[twin.face as usize]);
    reverses
}

impl Repaired {
    /// Drops faces that are degenerate or stand in the way of another. Runs before any other
    /// repair: faces still are what they were.
    fn drop_faces(&mut self) {
        let faces = &self.soup.faces;
        let mut live = vec![true; faces.len()];
        for (&triple, face) in faces.iter().zip(0u32..) {
            if repeated(triple).is_some() {
                live[face as usize] = false;
                self.repairs.push(Repair::DroppedDegenerateFace { face });
            }
        }
        let (reverses, copies): (Vec<_>, Vec<_>) =
            twins(faces, &live).into_iter().partition(|twin| twin.reversed);
        for twin in copies {
            live[twin.face as usize] = false;
            let (face, first) = (twin.face, twin.first);
            self.repairs.push(Repair::DroppedDuplicateFace { face, first });
        }
        let connectivity = Connectivity::new(faces, &live);
        for twin in surplus(&connectivity, faces.len(), reverses) {
            live[twin.face as usize] = false;
            let (face, first) = (twin.face, twin.first);
            self.repairs.push(Repair::DroppedOppositeFace { face, first });
        }
        let mut keep = live.iter();
        self.soup.faces.retain(|_| keep.next() == Some(&true));
        self.face_origin.retain(|&face| live[face as usize]);
    }

    /// Turns over the minority of each patch that is not oriented consistently.
    fn orient(&mut self) {
        let n_faces = self.soup.faces.len();
        let patches = Connectivity::new(&self.soup.faces, &vec![true; n_faces]).patches();
        // For each patch how many more of its faces agree with its lowest face than do not; none
        // if it cannot be oriented.
        let mut excess = vec![Some(0i64); n_faces];
        for &(patch, _) in &patches.not_orientable {
            excess[patch as usize] = None;
        }
        for &(patch, odd) in &patches.of_face {
            if let Some(excess) = &mut excess[patch as usize] {
                *excess += if odd { -1 } else { 1 };
            }
        }
        let mut turned = BTreeMap::<u32, Vec<u32>>::new();
        for (face, &(patch, odd)) in patches.of_face.iter().enumerate() {
            if excess[patch as usize].is_some_and(|excess| odd == (excess >= 0)) {
                self.soup.faces[face].swap(1, 2);
                turned.entry(patch).or_default().push(self.face_origin[face]);
            }
        }
        self.repairs.extend(turned.into_values().map(|faces| Repair::Reoriented { faces }));
    }

    /// Drops vertices in no face. Runs while vertices still are what they were.
    fn drop_vertices(&mut self) {
        let used = referenced(&self.soup);
        let mut renamed = Vec::with_capacity(used.len());
        let mut dropped = Vec::new();
        let mut n_used = 0;
        for (&used, vertex) in used.iter().zip(0u32..) {
            renamed.push(n_used);
            if used {
                n_used += 1;
            } else {
                dropped.push(vertex);
            }
        }
        if dropped.is_empty() {
            return;
        }
        let mut keep = used.iter();
        self.soup.positions.retain(|_| keep.next() == Some(&true));
        self.vertex_origin.retain(|&vertex| used[vertex as usize]);
        for vertex in self.soup.faces.iter_mut().flatten() {
            *vertex = renamed[*vertex as usize];
        }
        self.repairs.push(Repair::DroppedUnreferencedVertices { vertices: dropped });
    }

    /// Cuts sheets apart and open, and orients them.
    fn cut(&mut self) {
        let Some(cuts) = cuts(&self.soup) else { return };
        let was = |vertices: [u32; 2]| vertices.map(|v| self.vertex_origin[v as usize]);
        let face_was = |&face: &u32| self.face_origin[face as usize];
        for (face, edges) in &cuts.opened {
            let edges = edges.iter().copied().map(was).collect();
            self.repairs.push(Repair::CutOpen { face: face_was(face), edges });
        }
        for Junction { edge, faces, sheets } in &cuts.junctions {
            let (vertices, faces) = (was(*edge), faces.iter().map(face_was).collect());
            self.repairs.push(Repair::CutEdge { vertices, faces, sheets: *sheets });
            self.junctions.push(vertices);
        }
        self.separate(&cuts.fans);
        self.orient();
    }

    /// Gives every fan but the first of each vertex a copy of it.
    fn split_vertices(&mut self) {
        let faces = &self.soup.faces;
        let fans = Connectivity::new(faces, &vec![true; faces.len()]).fans();
        for (vertex, copies) in self.separate(&fans) {
            self.repairs.push(Repair::SplitVertex { vertex, copies });
        }
    }

    /// Gives every one of the fans at a vertex but its first a copy of it, in order of the fans.
    /// Returns what the vertices were that are copied, and their copies.
    fn separate(&mut self, fans: &[u32]) -> Vec<(u32, Vec<u32>)> {
        let n_vertices = self.soup.positions.len();
        let mut keeper = vec![None; n_vertices];
        let mut copy_of_fan = vec![0; fans.len()];
        let mut copies = vec![Vec::new(); n_vertices];
        for (vertex, &fan) in self.soup.faces.as_flattened_mut().iter_mut().zip(fans) {
            let v = *vertex as usize;
            match keeper[v] {
                None => keeper[v] = Some(fan),
                Some(keeper) if keeper == fan => {}
                Some(_) => {
                    if copy_of_fan[fan as usize] == 0 {
                        let copy = self.soup.positions.len() as u32;
                        self.soup.positions.push(self.soup.positions[v]);
                        self.vertex_origin.push(self.vertex_origin[v]);
                        copy_of_fan[fan as usize] = copy;
                        copies[v].push(copy);
                    }
                    *vertex = copy_of_fan[fan as usize];
                }
            }
        }
        let split = copies.into_iter().zip(&self.vertex_origin);
        split.filter(|(copies, _)| !copies.is_empty()).map(|(copies, &v)| (v, copies)).collect()
    }
}

#[cfg(test)]
mod tests;
