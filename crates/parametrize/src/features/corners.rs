//! Where aligned curves have corners.

use seamstress_mesh::{Halfedge, Metric, TriMesh, Vertex, VertexData};
use std::f64::consts::FRAC_PI_2;

/// Where a curve of aligned edges has a corner: where it turns by an angle, in itself and over a reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerRule {
    /// The least turn of a corner, quarters.
    pub least: f64,
    /// Arc length on both sides over whose mean directions the turn has to last, in the unit of the metric: a curve
    /// that zigzags along the edges of the mesh does not turn. 0 for the next edge alone.
    pub reach: f64,
}

impl Default for CornerRule {
    /// The nearest quarter turn at every vertex.
    fn default() -> Self {
        Self { least: 0.5, reach: 0.0 }
    }
}

/// The curves along the boundary of a slit mesh, seen from the surface on their left.
pub(super) struct Curves<'a> {
    pub(super) slit: &'a TriMesh,
    pub(super) metric: &'a Metric,
    /// Turn of the boundary at its vertices, radians.
    pub(super) turn: &'a VertexData<f64>,
    /// Whether a curve goes on at a boundary vertex, so that no other curve meets it.
    pub(super) goes_on: &'a VertexData<bool>,
}

/// Turns this close to the middle of two whole numbers of quarters might as well be either.
const TIE: f64 = 0.1;

/// By how many quarters a corner should turn; 0 where there is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CornerTurn {
    /// What is nearest.
    pub(super) nearest: i32,
    /// The least and the most of what is as near but for a tie.
    pub(super) range: [i32; 2],
}

impl CornerTurn {
    /// One number of quarters.
    pub(super) fn exactly(quarters: i32) -> Self {
        Self { nearest: quarters, range: [quarters; 2] }
    }

    /// What of it lies within bounds.
    pub(super) fn clamp(self, low: i32, high: i32) -> Self {
        let clamp = |quarters: i32| quarters.clamp(low, high);
        Self { nearest: clamp(self.nearest), range: self.range.map(clamp) }
    }
}

impl Curves<'_> {
    /// By how many quarters the corner at a boundary vertex should turn.
    pub(super) fn quarters(&self, v: Vertex, rule: CornerRule) -> CornerTurn {
        let turn = self.turn[v] / FRAC_PI_2;
        let goes_on = self.goes_on[v];
        let lasting = if goes_on { self.lasting_turn(v, rule.reach) } else { turn };
        let strength = turn.abs().min(lasting.abs());
        let quarters = |tie: f64| {
            let whole = (turn.abs() + tie).round().max(1.0);
            if strength + tie >= rule.least { whole as i32 } else { 0 }
        };
        let [low, nearest, high] = [-TIE, 0.0, TIE].map(quarters);
        if turn < 0.0 {
            CornerTurn { nearest: -nearest, range: [-high, -low] }
        } else {
            CornerTurn { nearest, range: [low, high] }
        }
    }

    /// The turn from the mean direction of the curve before a vertex to that after it, quarters.
    fn lasting_turn(&self, v: Vertex, reach: f64) -> f64 {
        let after = self.mean_direction(v, reach, |v| self.after(v).map(|h| (h, self.slit.tip(h))));
        let before =
            self.mean_direction(v, reach, |v| self.before(v).map(|h| (h, self.slit.origin(h))));
        (self.turn[v] + after + before) / FRAC_PI_2
    }

    /// The mean direction of the curve on one side of a vertex over an arc length, measured from its first edge: what
    /// it turns by on the way out.
    fn mean_direction(
        &self,
        from: Vertex,
        reach: f64,
        step: impl Fn(Vertex) -> Option<(Halfedge, Vertex)>,
    ) -> f64 {
        let (mut direction, mut sum, mut covered) = (0.0, 0.0, 0.0);
        let mut at = from;
        while let Some((h, next)) = step(at).filter(|_| covered < reach) {
            let length = self.metric.length[h].min(reach - covered);
            sum += direction * length;
            covered += length;
            if next == from || !self.goes_on[next] {
                break;
            }
            direction += self.turn[next];
            at = next;
        }
        if covered > 0.0 { sum / covered } else { 0.0 }
    }

    /// The boundary half-edge that leaves a vertex.
    fn after(&self, v: Vertex) -> Option<Halfedge> {
        self.slit.outgoing(v).next().filter(|&h| self.slit.twin(h).is_none())
    }

    /// The boundary half-edge that arrives at a vertex.
    fn before(&self, v: Vertex) -> Option<Halfedge> {
        let last = self.slit.outgoing(v).last().map(Halfedge::prev);
        last.filter(|&h| self.slit.twin(h).is_none())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::Sectors;
    use seamstress_mesh::features::EdgeSet;

    /// Squares below a diagonal of an `n` by `n` grid, so that the rim goes down in steps; the squares are split from
    /// their upper right corners.
    fn stairs(n: u32) -> (TriMesh, Vec<[f64; 3]>) {
        let at = |x: u32, y: u32| y * (n + 1) + x;
        let cells = (0..n).flat_map(|y| (0..n - y).map(move |x| (x, y)));
        let faces: Vec<[u32; 3]> = cells
            .flat_map(|(x, y)| {
                let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let positions: Vec<[f64; 3]> =
            (0..(n + 1) * (n + 1)).map(|v| [v % (n + 1), v / (n + 1), 0].map(f64::from)).collect();
        (TriMesh::from_faces(positions.len(), &faces).unwrap(), positions)
    }

    /// The vertices at which the rim turns, with the quarters that it turns by.
    fn corners(mesh: &TriMesh, positions: &[[f64; 3]], least: f64, reach: f64) -> Vec<(u32, i32)> {
        let metric = Metric::from_positions(mesh, positions);
        let rule = CornerRule { least, reach: reach / metric.unit };
        let rim = EdgeSet::boundary(mesh);
        let sectors = Sectors::with_corners(mesh, &metric, &rim, rule);
        let turns = sectors.slit().vertices().map(|s| (sectors.vertex(s).0, sectors.preferred(s)));
        let mut turns: Vec<_> = turns.filter(|&(_, k)| k != 0).collect();
        turns.sort_unstable();
        turns
    }

    #[test]
    fn steps_of_a_rim_are_no_corners_of_curves_that_pass_over_them() {
        let (mesh, positions) = stairs(8);
        // Without reach every step has two; the convex ones outnumber the others by four.
        let all = corners(&mesh, &positions, 0.5, 0.0);
        assert_eq!(all.len(), 1 + 2 + 8 + 7 - 1 + 1);
        assert_eq!(all.iter().map(|&(_, k)| k).sum::<i32>(), 4);
        // Over four steps the rim is a triangle: it turns at its three corners alone.
        let lasting = corners(&mesh, &positions, 0.5, 4.0);
        assert!(lasting.contains(&(0, 1)), "{lasting:?}");
        let inner = |&(v, _): &(u32, i32)| (2..7).contains(&(v % 9)) && (2..7).contains(&(v / 9));
        assert!(!lasting.iter().any(inner), "{lasting:?}");
    }

    #[test]
    fn corners_turn_by_the_least_angle_or_more() {
        // A regular octagon, which turns by half a quarter at every vertex.
        let n = 8u32;
        let faces: Vec<_> = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
        let mesh = TriMesh::from_faces(9, &faces).unwrap();
        let rim = (0..n).map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            [angle.cos(), angle.sin(), 0.0]
        });
        let positions: Vec<_> = std::iter::once([0.0; 3]).chain(rim).collect();
        assert_eq!(corners(&mesh, &positions, 0.6, 0.0), []);
        // Sectors of two triangles turn by a quarter at least, to make room for the others.
        let all: Vec<(u32, i32)> = (1..=n).map(|v| (v, 1)).collect();
        assert_eq!(corners(&mesh, &positions, 0.4, 0.0), all);
        let sectors = |least| {
            let metric = Metric::from_positions(&mesh, &positions);
            let rim = EdgeSet::new(&mesh, mesh.halfedges().filter(|&h| mesh.twin(h).is_none()));
            let (mesh, rule) = (&mesh, CornerRule { least, reach: 0.0 });
            let sectors = Sectors::with_corners(mesh, &metric, &rim, rule);
            sectors.slit().vertices().map(|s| sectors.preferences(s)).collect::<Vec<_>>()
        };
        // Where half a quarter is about the least turn of a corner, either will do.
        assert_eq!(sectors(0.5)[1..], [[0, 1]; 8]);
        assert_eq!(sectors(0.7)[1..], [[0, 0]; 8]);
        assert_eq!(sectors(0.3)[1..], [[1, 1]; 8]);
    }
}
