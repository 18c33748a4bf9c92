//! Short straight lines between cones.

use super::gauss::{Form, Gauss, Overflow, add_scaled, scaled};
use super::space::IntegerSpace;
use crate::cut::{Cut, SeamGraph};
use crate::quarter::turn;
use num_complex::Complex64;
use seamstress_surface::{Halfedge, HalfedgeData, TriMesh, VertexData};

/// A straight line on the flat surface from one cone to another, or back to the same.
#[derive(Debug, Clone)]
pub struct Connection {
    /// Its length, in the units of the layout.
    pub length: f64,
    /// From its first to its second end, as an exact form in the coordinates zeta.
    pub displacement: Form,
}

/// Triangles that the search may cross in all.
const MOST_CROSSINGS: usize = 20_000_000;

/// All straight lines between cones that are shorter than a radius and pass through no other cone, one
/// for lines that differ by a unit only, shortest first.
///
/// From every corner at a cone, a beam of directions is followed from triangle to triangle, split where
/// a vertex stands in it, until it leaves the radius. The displacement is exact: what the seams that
/// were crossed and the wedges at both ends add.
///
/// # Errors
/// [`Overflow`].
pub fn connections(
    mesh: &TriMesh,
    cut: &Cut,
    matching: &HalfedgeData<i32>,
    is_cone: &VertexData<bool>,
    space: &IntegerSpace,
    z: &[Complex64],
    radius: f64,
) -> Result<Vec<Connection>, Overflow> {
    let mut search = Search {
        mesh,
        cut,
        matching,
        is_cone,
        z: mesh.halfedges().map(|h| z[cut.wedge[h] as usize]).collect(),
        radius,
        found: Vec::new(),
        crossings: 0,
    };
    for h in mesh.halfedges().filter(|&h| is_cone[mesh.origin(h)]) {
        search.look_from(h);
    }
    let graph = SeamGraph::new(mesh, cut, is_cone);
    let mut connections = Vec::with_capacity(search.found.len());
    for sight in &search.found {
        let form = sight.displacement(cut, matching, &graph, space)?;
        let displacement = canonical(space.lattice().pull_back(&form)?)?;
        if !displacement.is_empty() {
            connections.push(Connection { length: sight.length, displacement });
        }
    }
    connections
        .sort_by(|a, b| a.displacement.cmp(&b.displacement).then(a.length.total_cmp(&b.length)));
    connections.dedup_by(|b, a| a.displacement == b.displacement);
    connections
        .sort_by(|a, b| a.length.total_cmp(&b.length).then(a.displacement.cmp(&b.displacement)));
    Ok(connections)
}

/// Two sides of every triangle whose corners are all cones, from its first corner: the integers alone decide
/// about such a triangle.
///
/// # Errors
/// [`Overflow`].
pub fn cone_triangles(
    mesh: &TriMesh,
    cut: &Cut,
    is_cone: &VertexData<bool>,
    space: &IntegerSpace,
    z: &[Complex64],
) -> Result<Vec<[Connection; 2]>, Overflow> {
    let mut triangles = Vec::new();
    for f in mesh.faces() {
        if mesh.face_vertices(f).iter().all(|&v| is_cone[v]) {
            let [a, b, c] = f.halfedges().map(|h| cut.wedge[h]);
            let side = |to: u32| {
                let mut form = space.form(to).clone();
                add_scaled(&mut form, space.form(a), Gauss::ONE.negated())?;
                let length = (z[to as usize] - z[a as usize]).norm();
                Ok(Connection { length, displacement: space.lattice().pull_back(&form)? })
            };
            triangles.push([side(b)?, side(c)?]);
        }
    }
    Ok(triangles)
}

/// The multiple by a unit whose first coefficient has a positive real part and an imaginary part that is
/// not negative.
fn canonical(form: Form) -> Result<Form, Overflow> {
    let Some((_, &first)) = form.iter().next() else { return Ok(form) };
    let mut k = 0;
    while k < 3 {
        let c = first.times(Gauss::unit(k))?;
        if c.re > 0 && c.im >= 0 {
            break;
        }
        k += 1;
    }
    scaled(&form, Gauss::unit(k))
}

/// A cone seen from a corner: the corner, the corner where it was found, and the edges crossed.
struct Sight {
    from: Halfedge,
    to: Halfedge,
    length: f64,
    crossed: Vec<Halfedge>,
}

impl Sight {
    /// The displacement as a form in the integral variables.
    fn displacement(
        &self,
        cut: &Cut,
        matching: &HalfedgeData<i32>,
        graph: &SeamGraph,
        space: &IntegerSpace,
    ) -> Result<Form, Overflow> {
        let (mut turns, mut form) = (0, Form::new());
        for &h in &self.crossed {
            if let Some((chain, along)) = graph.chain_of[h] {
                let after = turns - matching[h];
                let t = Form::from([(chain, Gauss::ONE)]);
                // A point q beyond the seam is at i^-r (q - t), from its left side; from the right,
                // the chain's own translation leads back.
                let factor = if along { Gauss::unit(after).negated() } else { Gauss::unit(turns) };
                add_scaled(&mut form, &t, factor)?;
                turns = after;
            }
        }
        add_scaled(&mut form, space.form(cut.wedge[self.to]), Gauss::unit(turns))?;
        add_scaled(&mut form, space.form(cut.wedge[self.from]), Gauss::ONE.negated())?;
        Ok(form)
    }
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

struct Search<'a> {
    mesh: &'a TriMesh,
    cut: &'a Cut,
    matching: &'a HalfedgeData<i32>,
    is_cone: &'a VertexData<bool>,
    /// Position of each corner.
    z: HalfedgeData<Complex64>,
    radius: f64,
    found: Vec<Sight>,
    crossings: usize,
}

impl Search<'_> {
    fn look_from(&mut self, h: Halfedge) {
        let origin = self.z[h];
        let (right, left) = (self.z[h.next()] - origin, self.z[h.prev()] - origin);
        let mut crossed = Vec::new();
        // The edge on the left is the one on the right of the next corner: cones are inside.
        self.see(h, h.next(), right, &crossed);
        let mut stack =
            vec![Beam { edge: h.next(), right_end: right, turns: 0, right, left, depth: 0 }];
        while let Some(beam) = stack.pop() {
            let Some(t) = self.mesh.twin(beam.edge) else { continue };
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
        let turns = if self.cut.is_seam[beam.edge] {
            beam.turns - self.matching[beam.edge]
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
        let right_near = distance(beam.right_end, apex) < self.radius;
        let left_near = distance(apex, left_end) < self.radius;
        if of_right > 0.0 && of_left < 0.0 {
            self.see(from, t.prev(), apex, crossed);
            // A cone in the way ends the lines through it.
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

    /// Notes a cone at a corner, from the end with the smaller vertex only.
    fn see(&mut self, from: Halfedge, to: Halfedge, at: Complex64, crossed: &[Halfedge]) {
        let (a, b) = (self.mesh.origin(from), self.mesh.origin(to));
        let length = at.norm();
        if self.is_cone[b] && a <= b && length < self.radius {
            self.found.push(Sight { from, to, length, crossed: crossed.to_vec() });
        }
    }
}

/// Distance of the origin from a segment.
fn distance(a: Complex64, b: Complex64) -> f64 {
    let d = b - a;
    let square = d.norm_sqr();
    let t = if square > 0.0 { (-(a.conj() * d).re / square).clamp(0.0, 1.0) } else { 0.0 };
    (a + d * t).norm()
}
