//! Polygons in an order in which each has an edge of one before, so that little is left to say of it.
//!
//! The walk goes from polygon to polygon, in breadth, through gates: sides of polygons before. For each gate it notes
//! what is behind, which is all that one who walks the same way needs to know.

use std::collections::{HashMap, VecDeque};

/// Behind a gate is no polygon, or one that the walk has met already.
const NOTHING: u32 = 0;
/// A corner at a wedge that the walk has not met.
const NEW: u32 = 1;
/// A corner at the last wedge met; one before that is one more, and so on.
const LAST: u32 = 2;

/// Corners with the same vertex and the same UV as one.
#[derive(Debug, Default)]
pub(super) struct Wedges {
    pub(super) of_corners: Vec<u32>,
    pub(super) vertices: Vec<u32>,
    pub(super) uvs: Vec<[f64; 2]>,
}

impl Wedges {
    pub(super) fn new(corners: &[u32], corner_uvs: Option<&[[f64; 2]]>) -> Self {
        let mut wedges = Self::default();
        let mut known = HashMap::new();
        for (corner, &vertex) in corners.iter().enumerate() {
            let uv = corner_uvs.map(|uvs| uvs[corner]);
            let next = wedges.vertices.len() as u32;
            let wedge = *known.entry((vertex, uv.map(|uv| uv.map(f64::to_bits)))).or_insert(next);
            wedges.of_corners.push(wedge);
            if wedge == next {
                wedges.vertices.push(vertex);
                wedges.uvs.extend(uv);
            }
        }
        wedges
    }
}

/// A wedge that the walk meets.
#[derive(Debug)]
pub(super) struct Step {
    pub(super) wedge: usize,
    /// The steps to the ends of the gate, and to the corner after it on the near side.
    pub(super) known: Option<[usize; 3]>,
}

/// A side of a polygon, by steps: its ends and the corner after it.
type Gate = [usize; 3];

/// A way through all polygons.
#[derive(Debug, Default)]
pub(super) struct Walk {
    /// The polygons in their order.
    pub(super) faces: Vec<u32>,
    /// What is behind each gate, and at each corner there.
    pub(super) codes: Vec<u32>,
    pub(super) steps: Vec<Step>,
}

impl Walk {
    /// The walk through polygons of a number of sides, given by the wedges of their corners.
    pub(super) fn new(wedges: &[u32], sides: usize) -> Self {
        let n_wedges = wedges.iter().max().map_or(0, |&wedge| wedge as usize + 1);
        let mut step_of: Vec<Option<usize>> = vec![None; n_wedges];
        let mut is_met = vec![false; wedges.len() / sides.max(1)];
        let after = |corner: usize| corner - corner % sides + (corner + 1) % sides;
        // Corners by the sides that start there.
        let starts: HashMap<[u32; 2], usize> = (0..wedges.len())
            .map(|corner| ([wedges[corner], wedges[after(corner)]], corner))
            .collect();
        let mut walk = Self::default();
        let mut gates = VecDeque::new();
        for seed in 0..is_met.len() {
            if is_met[seed] {
                continue;
            }
            walk.enter(wedges, sides, seed * sides, None, &mut step_of, &mut gates);
            is_met[seed] = true;
            while let Some(gate) = gates.pop_front() {
                let [from, to, _]: Gate = gate;
                let [from, to] = [from, to].map(|step| walk.steps[step].wedge as u32);
                match starts.get(&[to, from]).filter(|&&corner| !is_met[corner / sides]) {
                    None => walk.codes.push(NOTHING),
                    Some(&corner) => {
                        is_met[corner / sides] = true;
                        walk.enter(wedges, sides, corner, Some(gate), &mut step_of, &mut gates);
                    }
                }
            }
        }
        walk
    }

    /// Enters the polygon of a corner: through a gate, whose ends are that corner and the next, or as the first of a
    /// piece.
    fn enter(
        &mut self,
        wedges: &[u32],
        sides: usize,
        corner: usize,
        gate: Option<Gate>,
        step_of: &mut [Option<usize>],
        gates: &mut VecDeque<Gate>,
    ) {
        let face = corner / sides;
        self.faces.push(face as u32);
        let wedge = |k: usize| wedges[face * sides + (corner + k) % sides] as usize;
        let n_known = if gate.is_some() { 2 } else { 0 };
        for k in n_known..sides {
            let next = self.steps.len();
            let step = *step_of[wedge(k)].get_or_insert(next);
            if step == next {
                self.steps.push(Step { wedge: wedge(k), known: gate });
                self.codes.push(NEW);
            } else {
                self.codes.push(LAST + (next - 1 - step) as u32);
            }
        }
        let step = |k: usize| step_of[wedge(k % sides)].unwrap_or_default();
        let first = usize::from(gate.is_some());
        gates.extend((first..sides).map(|k| [step(k), step(k + 1), step(k + 2)]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_with_one_uv_are_one_wedge() {
        let corners = [0, 1, 2, 2, 1, 3];
        let uvs = [[0.0; 2], [1.0, 0.0], [0.0, 1.0], [5.0, 5.0], [1.0, 0.0], [1.0, 1.0]];
        let wedges = Wedges::new(&corners, Some(&uvs));
        assert_eq!(wedges.of_corners, [0, 1, 2, 3, 1, 4]);
        assert_eq!(wedges.vertices, [0, 1, 2, 2, 3]);
        assert_eq!(Wedges::new(&corners, None).of_corners, [0, 1, 2, 2, 1, 3]);
    }

    #[test]
    fn a_walk_through_two_triangles_and_one_apart() {
        let walk = Walk::new(&[0, 1, 2, 4, 5, 6, 2, 1, 3], 3);
        assert_eq!(walk.faces, [0, 2, 1]);
        // Three new corners; nothing behind the first side; a new corner behind the second; nothing behind the others.
        let pair = [NEW, NEW, NEW, NOTHING, NEW, NOTHING, NOTHING, NOTHING];
        let single = [NEW, NEW, NEW, NOTHING, NOTHING, NOTHING];
        assert_eq!(walk.codes, [&pair[..], &single].concat());
        let known: Vec<_> = walk.steps.iter().map(|step| step.known).collect();
        assert_eq!(known[..4], [None, None, None, Some([1, 2, 0])]);
    }

    #[test]
    fn corners_that_are_known_are_counted_back() {
        // A tetrahedron: the fourth triangle has no new corner.
        let walk = Walk::new(&[0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0], 3);
        assert_eq!(walk.faces, [0, 1, 2, 3]);
        assert_eq!(walk.codes[..6], [NEW, NEW, NEW, NEW, LAST, LAST]);
        assert!(walk.codes[6..].iter().all(|&code| code == NOTHING));
    }

    #[test]
    fn three_triangles_at_an_edge_are_all_met() {
        let walk = Walk::new(&[0, 1, 2, 1, 0, 3, 1, 0, 4], 3);
        let mut faces = walk.faces.clone();
        faces.sort_unstable();
        assert_eq!(faces, [0, 1, 2]);
        assert_eq!(walk.steps.len(), 5);
    }
}
