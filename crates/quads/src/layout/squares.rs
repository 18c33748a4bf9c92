//! Unit squares, placed one after the other.

use super::{LayoutError, QuadLayout};
use crate::QuadMesh;
use crate::split::split_quads;
use seamstress_mesh::{Face, Halfedge, TriMesh};
use std::collections::VecDeque;

/// A point of the integer grid.
type Point = [i64; 2];

/// Where a unit square lies: its first corner, and the direction of its first edge as a power of i.
#[derive(Debug, Clone, Copy)]
struct Placement {
    corner: Point,
    turns: u8,
}

/// Free columns between components.
const GAP: i64 = 1;

impl Placement {
    /// Corner `k` of the square, counter-clockwise.
    fn at(self, k: usize) -> Point {
        let [x, y]: Point = [[0, 0], [1, 0], [1, 1], [0, 1]][k];
        let [x, y] = match self.turns {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        [self.corner[0] + x, self.corner[1] + y]
    }

    /// The square on the other side of this one's edge `k`, met there with its own edge `other`.
    fn neighbour(self, k: usize, other: usize) -> Self {
        // Its edge runs the opposite way, two quarter turns on.
        let turns = (usize::from(self.turns) + k + 2 + 4 - other) as u8 % 4;
        let unmoved = Self { corner: [0, 0], turns };
        let (there, here) = (unmoved.at(other), self.at((k + 1) % 4));
        Self { corner: [here[0] - there[0], here[1] - there[1]], turns }
    }
}

/// Lays every quad out as a unit square with corners at integers: breadth first from the first quad of
/// each component, each new quad joined to the one it was reached from.
///
/// The result is an integer seamless parametrization: its coordinates are integers exactly, its cones
/// the irregular vertices. Components lie side by side.
///
/// # Errors
/// [`LayoutError::NoManifold`].
///
/// # Source
/// Levi 2021, supplement, section 7.
pub fn lay_out_squares(quads: &QuadMesh) -> Result<QuadLayout, LayoutError> {
    let faces = split_quads(quads);
    let mesh = TriMesh::from_faces(quads.positions().len(), &faces)?;
    let mut placements: Vec<Option<Placement>> = vec![None; quads.quads().len()];
    let mut right = 0;
    for seed in 0..placements.len() {
        if placements[seed].is_none() {
            right = place_component(&mesh, seed, right, &mut placements) + GAP;
        }
    }
    let corner_uvs = placements
        .iter()
        .flatten()
        .flat_map(|placement| [0, 1, 2, 0, 2, 3].map(|k| placement.at(k).map(|x| x as f64)))
        .collect();
    Ok(QuadLayout { mesh, faces, corner_uvs })
}

/// Places the component of a quad with its left edge at `left`; returns its right edge.
fn place_component(
    mesh: &TriMesh,
    seed: usize,
    left: i64,
    placements: &mut [Option<Placement>],
) -> i64 {
    let start = Placement { corner: [0, 0], turns: 0 };
    placements[seed] = Some(start);
    let mut queue = VecDeque::from([(seed, start)]);
    let mut members = Vec::new();
    while let Some((quad, placement)) = queue.pop_front() {
        members.push(quad);
        for k in 0..4 {
            let Some(twin) = mesh.twin(edge(quad, k)) else { continue };
            let (other, back) = quad_edge(twin);
            if placements[other].is_none() {
                let next = placement.neighbour(k, back);
                placements[other] = Some(next);
                queue.push_back((other, next));
            }
        }
    }
    let columns =
        || members.iter().flat_map(|&q| placements[q]).flat_map(|p| [0, 2].map(|k| p.at(k)[0]));
    let (low, high) = (columns().min().unwrap_or(0), columns().max().unwrap_or(0));
    for quad in members {
        if let Some(placement) = &mut placements[quad] {
            placement.corner[0] += left - low;
        }
    }
    left + high - low
}

/// The half-edge of edge `k` of a quad in the split mesh.
fn edge(quad: usize, k: usize) -> Halfedge {
    let face = Face((2 * quad + k / 2) as u32);
    face.halfedges()[[0, 1, 1, 2][k]]
}

/// The quad and its edge of a half-edge that is no diagonal.
fn quad_edge(h: Halfedge) -> (usize, usize) {
    let face = h.face().at();
    (face / 2, h.at() % 3 + face % 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_quads_are_found_again() {
        for (quad, k) in [(0, 0), (0, 1), (0, 2), (0, 3), (7, 1), (7, 3)] {
            assert_eq!(quad_edge(edge(quad, k)), (quad, k));
        }
    }

    #[test]
    fn neighbours_share_their_edge_the_other_way_round() {
        let here = Placement { corner: [3, -2], turns: 1 };
        for k in 0..4 {
            for other in 0..4 {
                let there = here.neighbour(k, other);
                assert_eq!(there.at(other), here.at((k + 1) % 4));
                assert_eq!(there.at((other + 1) % 4), here.at(k));
            }
        }
    }
}
