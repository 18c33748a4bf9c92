//! How the faces of a soup meet: sides sorted by edge, fans around vertices, patches of faces.

use super::sets::SignedSets;

/// One side of a face: the step from corner `corner % 3` of face `corner / 3` to the next corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    /// The two vertices, the smaller first.
    pub(super) edge: [u32; 2],
    /// The corner it starts from.
    pub(super) corner: u32,
}

impl Side {
    pub(super) fn face(self) -> u32 {
        self.corner / 3
    }

    /// Whether it runs from the smaller to the larger vertex.
    pub(super) fn is_forward(self, faces: &[[u32; 3]]) -> bool {
        faces[self.face() as usize][(self.corner % 3) as usize] == self.edge[0]
    }

    /// The corners of its face at `edge[0]` and at `edge[1]`.
    fn corners_at_ends(self, faces: &[[u32; 3]]) -> [u32; 2] {
        let next = next_corner(self.corner);
        if self.is_forward(faces) { [self.corner, next] } else { [next, self.corner] }
    }
}

fn next_corner(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// The sides of the live faces of a soup, sorted by edge and then by face.
#[derive(Debug)]
pub(super) struct Connectivity<'a> {
    faces: &'a [[u32; 3]],
    sides: Vec<Side>,
}

impl<'a> Connectivity<'a> {
    /// Sorts the sides of those faces that are `live`; these must have three different vertices.
    pub(super) fn new(faces: &'a [[u32; 3]], live: &[bool]) -> Self {
        let mut sides = Vec::with_capacity(3 * faces.len());
        for (face, triple) in faces.iter().enumerate().filter(|&(face, _)| live[face]) {
            for k in 0..3 {
                let (a, b) = (triple[k], triple[(k + 1) % 3]);
                sides.push(Side { edge: [a.min(b), a.max(b)], corner: (3 * face + k) as u32 });
            }
        }
        sides.sort_unstable();
        Self { faces, sides }
    }

    /// The edges in increasing order, each as its sides in order of their faces.
    pub(super) fn edges(&self) -> impl Iterator<Item = &[Side]> {
        self.sides.chunk_by(|a, b| a.edge == b.edge)
    }

    /// The two sides of an edge with exactly two faces, and whether they run the same way.
    pub(super) fn pair(&self, sides: &[Side]) -> Option<(Side, Side, bool)> {
        match *sides {
            [a, b] => Some((a, b, a.is_forward(self.faces) == b.is_forward(self.faces))),
            _ => None,
        }
    }

    /// Groups the corners at each vertex into fans: corners whose faces share an edge there.
    /// Returns for each corner the lowest corner of its fan.
    pub(super) fn fans(&self) -> Vec<u32> {
        let mut fans = SignedSets::new(3 * self.faces.len());
        for sides in self.edges() {
            for step in sides.windows(2) {
                let [a0, a1] = step[0].corners_at_ends(self.faces);
                let [b0, b1] = step[1].corners_at_ends(self.faces);
                fans.join(a0, b0, false);
                fans.join(a1, b1, false);
            }
        }
        fans.into_roots()
    }

    /// The corners of the face of `side` at its `edge[0]` and `edge[1]`.
    pub(super) fn corners_at_ends(&self, side: Side) -> [u32; 2] {
        side.corners_at_ends(self.faces)
    }

    /// Groups faces that share an edge, of however many faces. Returns for each face the lowest
    /// face of its component.
    pub(super) fn components(&self) -> Vec<u32> {
        let mut components = SignedSets::new(self.faces.len());
        for sides in self.edges() {
            for step in sides.windows(2) {
                components.join(step[0].face(), step[1].face(), false);
            }
        }
        components.into_roots()
    }

    /// Groups faces that are joined across edges with two faces, signed by their orientation.
    pub(super) fn patches(&self) -> Patches {
        let mut sets = SignedSets::new(self.faces.len());
        let mut conflicts = Vec::new();
        for sides in self.edges() {
            if let Some((a, b, same_way)) = self.pair(sides)
                && !sets.join(a.face(), b.face(), same_way)
            {
                conflicts.push(a);
            }
        }
        // A patch may have grown after a conflict was found: name it by its final lowest face.
        let mut not_orientable: Vec<(u32, [u32; 2])> =
            conflicts.into_iter().map(|side| (sets.find(side.face()).0, side.edge)).collect();
        not_orientable.sort_unstable();
        not_orientable.dedup_by_key(|&mut (patch, _)| patch);
        let of_face = (0..self.faces.len() as u32).map(|face| sets.find(face)).collect();
        Patches { of_face, not_orientable }
    }
}

/// Faces grouped across edges with two faces.
#[derive(Debug)]
pub(super) struct Patches {
    /// For each face the lowest face of its patch, and whether it is oriented against it.
    pub(super) of_face: Vec<(u32, bool)>,
    /// The patches no orientation fits, by lowest face, each with an edge that shows it.
    pub(super) not_orientable: Vec<(u32, [u32; 2])>,
}

/// A face with the vertices of an earlier one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Twin {
    pub(super) face: u32,
    pub(super) first: u32,
    /// The face is the reverse of `first`, else it is a copy.
    pub(super) reversed: bool,
}

/// Live faces whose vertices another live face has too, in order of the later face. Of each kind
/// (one orientation or the other) the first is the original, all later ones are its copies; the
/// later of two reversed originals is the reverse of the earlier.
pub(super) fn twins(faces: &[[u32; 3]], live: &[bool]) -> Vec<Twin> {
    let mut keys: Vec<([u32; 3], u32)> = faces
        .iter()
        .zip(0u32..)
        .filter(|&(_, face)| live[face as usize])
        .map(|(&triple, face)| (sorted(triple), face))
        .collect();
    keys.sort_unstable();
    let mut twins = Vec::new();
    for group in keys.chunk_by(|a, b| a.0 == b.0) {
        let first = group[0].1;
        let mut reverse = None;
        for &(_, face) in &group[1..] {
            let reversed = is_even(faces[face as usize]) != is_even(faces[first as usize]);
            twins.push(match (reversed, reverse) {
                (false, _) => Twin { face, first, reversed: false },
                (true, Some(original)) => Twin { face, first: original, reversed: false },
                (true, None) => {
                    reverse = Some(face);
                    Twin { face, first, reversed: true }
                }
            });
        }
    }
    twins.sort_unstable();
    twins
}

fn sorted(mut triple: [u32; 3]) -> [u32; 3] {
    triple.sort_unstable();
    triple
}

/// Whether the triple is an even permutation of its sorted form.
fn is_even([a, b, c]: [u32; 3]) -> bool {
    (a < b) ^ (b < c) ^ (a < c)
}

#[cfg(test)]
mod tests {
    use super::{Connectivity, Twin, is_even, twins};

    #[test]
    fn parity_of_all_six_orders() {
        for even in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            assert!(is_even(even));
        }
        for odd in [[0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            assert!(!is_even(odd));
        }
    }

    #[test]
    fn copies_and_reverses_find_their_originals() {
        let faces = [[0, 1, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [0, 1, 3]];
        let found = twins(&faces, &[true; 5]);
        let expected = [
            Twin { face: 1, first: 0, reversed: true },
            Twin { face: 2, first: 1, reversed: false },
            Twin { face: 3, first: 0, reversed: false },
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn two_triangles_share_an_edge_and_its_fans() {
        let faces = [[0, 1, 2], [2, 1, 3]];
        let connectivity = Connectivity::new(&faces, &[true, true]);
        assert_eq!(connectivity.edges().count(), 5);
        let inner = connectivity.edges().find(|sides| sides.len() == 2).unwrap();
        assert_eq!(inner[0].edge, [1, 2]);
        let (a, b, same_way) = connectivity.pair(inner).unwrap();
        assert_eq!((a.face(), b.face(), same_way), (0, 1, false));
        // Vertex 1 is corner 1 of both faces; vertex 2 is corner 2 of one and 0 of the other.
        assert_eq!(connectivity.fans(), [0, 1, 2, 2, 1, 5]);
    }
}
