//! Short straight lines between grid points.

use crate::gauss::Overflow;
use crate::scene::{Connection, Scene, Sight};
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, HalfedgeData};
use seamstress_parametrize::quarter::turn;

/// Triangles that the search may cross in all.
const MOST_CROSSINGS: usize = 20_000_000;

/// All straight lines between grid points that are shorter than a radius and pass through no other one.
///
/// From every corner at a grid point, a beam of directions is followed from triangle to triangle, split
/// where a vertex stands in it, until it leaves the radius. The displacement is exact: what the seams that
/// were crossed and the wedges at both ends add.
///
/// # Errors
/// [`Overflow`].
pub fn connections(scene: &Scene<'_>, radius: f64) -> Result<Vec<Connection>, Overflow> {
    let mesh = scene.mesh;
    let z = mesh.halfedges().map(|h| scene.at(h)).collect();
    let mut beams = Beams { scene, z, radius, found: Vec::new(), crossings: 0 };
    for h in mesh.halfedges().filter(|&h| scene.needs.is_point[mesh.origin(h)]) {
        beams.look_from(h);
    }
    beams.found.iter().map(|sight| scene.line(sight)).collect()
}

/// Directions still in view when an edge is about to be crossed.
#[derive(Debug, Clone, Copy)]
struct Beam {
    /// The edge, from the right end to the left one, as seen.
    edge: Halfedge,
    /// Where the edge's right end lies from the corner.
    right_end: Complex64,
    /// Quarter turns from the edge's face to the corner's.
    turns: i32,
    /// The rightmost and leftmost directions in view.
    right: Complex64,
    left: Complex64,
    /// Number of edges crossed before.
    depth: usize,
}

struct Beams<'a> {
    scene: &'a Scene<'a>,
    /// Position of each corner.
    z: HalfedgeData<Complex64>,
    radius: f64,
    found: Vec<Sight>,
    crossings: usize,
}

impl Beams<'_> {
    fn look_from(&mut self, h: Halfedge) {
        let origin = self.z[h];
        let (right, left) = (self.z[h.next()] - origin, self.z[h.prev()] - origin);
        let mut crossed = Vec::new();
        self.see(h, h.next(), right, &crossed);
        if self.scene.mesh.twin(h.prev()).is_none() {
            // Otherwise the edge on the left is the one on the right of the next corner.
            self.see(h, h.prev(), left, &crossed);
        }
        let mut stack =
            vec![Beam { edge: h.next(), right_end: right, turns: 0, right, left, depth: 0 }];
        while let Some(beam) = stack.pop() {
            let Some(t) = self.scene.mesh.twin(beam.edge) else { continue };
            self.crossings += 1;
            if self.crossings > MOST_CROSSINGS {
                return;
            }
            crossed.truncate(beam.depth);
            crossed.push(beam.edge);
            self.cross(h, beam, t, &crossed, &mut stack);
        }
    }

    /// Enters the triangle behind an edge.
    fn cross(
        &mut self,
        from: Halfedge,
        beam: Beam,
        t: Halfedge,
        crossed: &[Halfedge],
        stack: &mut Vec<Beam>,
    ) {
        let turns = if self.scene.cut.is_seam[beam.edge] {
            beam.turns - self.scene.matching[beam.edge]
        } else {
            beam.turns
        };
        let placed =
            |corner: Halfedge| beam.right_end + turn(self.z[corner] - self.z[t.next()], turns);
        let (apex, left_end) = (placed(t.prev()), placed(t));
        let [of_right, of_left] =
            [beam.right, beam.left].map(|direction| (direction.conj() * apex).im);
        let depth = beam.depth + 1;
        // Towards the right side of the triangle, and towards its left.
        let to_right = Beam { edge: t.next(), turns, depth, ..beam };
        let to_left = Beam { edge: t.prev(), right_end: apex, turns, depth, ..beam };
        let near = self.radius * self.radius;
        let right_near = squared_distance(beam.right_end, apex) < near;
        let left_near = squared_distance(apex, left_end) < near;
        if of_right > 0.0 && of_left < 0.0 {
            self.see(from, t.prev(), apex, crossed);
            // A grid point in the way ends the lines through it.
            if right_near {
                stack.push(Beam { left: apex, ..to_right });
            }
            if left_near {
                stack.push(Beam { right: apex, ..to_left });
            }
        } else if of_right <= 0.0 {
            if left_near {
                stack.push(to_left);
            }
        } else if right_near {
            stack.push(to_right);
        }
    }

    /// Notes a grid point at a corner, from the end with the smaller vertex only.
    fn see(&mut self, from: Halfedge, to: Halfedge, at: Complex64, crossed: &[Halfedge]) {
        let (a, b) = (self.scene.mesh.origin(from), self.scene.mesh.origin(to));
        let length = at.norm();
        if self.scene.needs.is_point[b] && a <= b && length < self.radius {
            self.found.push(Sight { from, to, length, crossed: crossed.to_vec() });
        }
    }
}

/// Square of the distance of the origin from a segment.
fn squared_distance(a: Complex64, b: Complex64) -> f64 {
    let d = b - a;
    let square = d.norm_sqr();
    let t = if square > 0.0 { (-(a.conj() * d).re / square).clamp(0.0, 1.0) } else { 0.0 };
    (a + d * t).norm_sqr()
}
