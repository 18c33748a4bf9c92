//! Patches: the pieces of one quad, glued across the edges of the mesh.

use super::fixed::Transition;
use super::pieces::Pieces;
use super::snap::GridMap;
use super::sweep::{cells_in_row, rows};
use seamstress_mesh::{Halfedge, TriMesh};
use seamstress_parallel::prelude::*;

/// The connected parts of the preimages of open cells.
pub(super) struct Patches {
    /// The patch of every piece; patches are numbered by their first pieces.
    pub(super) of_piece: Vec<u32>,
    /// Quarter turns from the chart of a piece to that of its patch.
    pub(super) turns: Vec<u8>,
    /// Whether the boundary of the mesh runs through a patch.
    pub(super) is_partial: Vec<bool>,
    /// Whether a patch winds around a cone, which takes a fold.
    pub(super) is_twisted: Vec<bool>,
}

/// Two pieces with a part of an edge in common, and the turns from the first to the second.
type Joint = (u32, u32, u8);

impl Patches {
    pub(super) fn new(mesh: &TriMesh, map: &GridMap, pieces: &Pieces) -> Self {
        let edges: Vec<(Halfedge, Halfedge)> =
            mesh.interior_edges().filter_map(|h| Some((h, mesh.twin(h)?))).collect();
        let joints: Vec<Joint> =
            edges.par_iter().flat_map_iter(|&(h, t)| joints(map, pieces, h, t)).collect();
        let mut forest = Forest::new(pieces.count());
        let mut twisted = Vec::new();
        for (left, right, turns) in joints {
            if !forest.join(left, right, turns) {
                twisted.push(left);
            }
        }
        let mut patches = Self::number(&mut forest);
        for piece in twisted {
            patches.is_twisted[patches.of_piece[piece as usize] as usize] = true;
        }
        for h in mesh.edges().filter(|&h| mesh.twin(h).is_none()) {
            for cell in cells(map, h) {
                if let Some(piece) = pieces.get(h.face(), cell) {
                    patches.is_partial[patches.of_piece[piece as usize] as usize] = true;
                }
            }
        }
        patches
    }

    fn number(forest: &mut Forest) -> Self {
        let n = forest.parent.len();
        let (mut of_piece, mut turns) = (vec![0; n], vec![0; n]);
        let mut count = 0;
        for piece in 0..n {
            let (root, to_root) = forest.root(piece as u32);
            turns[piece] = to_root;
            // A root is the smallest of its tree, so it has its number already.
            if root as usize == piece {
                of_piece[piece] = count;
                count += 1;
            } else {
                of_piece[piece] = of_piece[root as usize];
            }
        }
        let count = count as usize;
        Self { of_piece, turns, is_partial: vec![false; count], is_twisted: vec![false; count] }
    }

    /// Number of patches.
    pub(super) fn count(&self) -> usize {
        self.is_partial.len()
    }
}

/// The cells an edge runs through, in the chart of its half-edge.
fn cells(map: &GridMap, h: Halfedge) -> impl Iterator<Item = [i64; 2]> + use<> {
    let (unit, ends) = (map.unit, map.ends(h));
    rows(unit, &ends).flat_map(move |j| cells_in_row(unit, &ends, j).map(move |i| [i, j]))
}

fn joints<'a>(
    map: &'a GridMap,
    pieces: &'a Pieces,
    h: Halfedge,
    t: Halfedge,
) -> impl Iterator<Item = Joint> + 'a {
    let transition: Transition = map.transitions[h];
    cells(map, h).filter_map(move |cell| {
        let left = pieces.get(h.face(), cell)?;
        let right = pieces.get(t.face(), transition.cell(cell))?;
        Some((left, right, transition.turns))
    })
}

/// Disjoint sets whose members know the turns to their roots.
struct Forest {
    parent: Vec<u32>,
    turns: Vec<u8>,
}

impl Forest {
    fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect(), turns: vec![0; n] }
    }

    /// The root, and the turns to it.
    fn root(&mut self, x: u32) -> (u32, u8) {
        let (mut root, mut total) = (x, 0);
        while self.parent[root as usize] != root {
            total += self.turns[root as usize];
            total %= 4;
            root = self.parent[root as usize];
        }
        let (mut at, mut rest) = (x, total);
        while at != root {
            let (parent, turns) = (self.parent[at as usize], self.turns[at as usize]);
            self.parent[at as usize] = root;
            self.turns[at as usize] = rest;
            rest = (rest + 4 - turns) % 4;
            at = parent;
        }
        (root, total)
    }

    /// Joins two sets, `b`'s chart being `turns` from `a`'s; whether that agrees with what is known.
    fn join(&mut self, a: u32, b: u32, turns: u8) -> bool {
        let ((ra, ta), (rb, tb)) = (self.root(a), self.root(b));
        // From the root of a to that of b: back to a, over to b, up to its root.
        let between = (4 - ta + turns + tb) % 4;
        if ra == rb {
            return between == 0;
        }
        if ra < rb {
            self.parent[rb as usize] = ra;
            self.turns[rb as usize] = (4 - between) % 4;
        } else {
            self.parent[ra as usize] = rb;
            self.turns[ra as usize] = between;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_add_up_along_chains_and_contradictions_are_found() {
        let mut forest = Forest::new(6);
        for (a, b, turns) in [(5, 4, 1), (3, 4, 2), (1, 3, 3), (5, 0, 2)] {
            assert!(forest.join(a, b, turns));
        }
        // 1 -> 3 -> 4 -> 5 -> 0: 3 + 2 - 1 + 2 = 6.
        assert_eq!(forest.root(1), (0, 2));
        assert_eq!(forest.root(2), (2, 0));
        assert!(forest.join(1, 0, 2));
        assert!(!forest.join(1, 0, 3));
    }
}
