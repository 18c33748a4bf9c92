//! Grid points around one vertex: what they span must leave room for the triangles there.

use super::gauss::{Form, Gauss, Overflow, add_scaled};
use super::scene::{Connection, Scene};
use crate::quarter::turn;
use num_complex::Complex64;
use seamstress_surface::{Halfedge, Vertex};
use std::f64::consts::PI;

/// Gaps of angle up to this, as seen from an ordinary vertex, are to stay below half a turn, radians.
const WIDEST_GAP: f64 = 0.95 * PI;
/// Half the side of the square in which a place is looked for, grid units.
const REACH: f64 = 1e4;
/// The least area of a place, grid units.
const LEAST_AREA: f64 = 1e-9;

/// Grid points that a vertex is joined with by edges, laid out around it, one of them the origin.
///
/// Edges of the mesh stay straight, so that there must be a place from which all the directed lines `sides`
/// are seen from their left: for an ordinary vertex, its own place; for a grid point between two of its
/// edges, the inside of the triangle that they span.
#[derive(Debug, Clone)]
pub struct Shape {
    /// The way from the origin to each other point.
    pub ways: Vec<Connection>,
    /// Lines between points by number, 0 the origin.
    pub sides: Vec<[usize; 2]>,
    /// Distance of the two nearest points, in the units of the layout.
    pub extent: f64,
    /// Whether it is a face of the mesh: it then has nothing else that could give way.
    pub is_face: bool,
}

/// A grid point at the other end of a spoke.
struct Tip {
    /// Its place in the frame of the first corner of the vertex, from the vertex.
    way: Complex64,
    /// The same as a form in X, up to where the vertex is.
    form: Form,
    /// Number of the spoke, counter-clockwise.
    spoke: usize,
    vertex: Vertex,
}

/// All shapes: triangles of three grid points, consecutive grid points around a grid point, and the grid
/// points around an ordinary vertex, of which there must be three.
///
/// # Errors
/// [`Overflow`].
pub fn shapes(scene: &Scene<'_>) -> Result<Vec<Shape>, Overflow> {
    let mut found = Vec::new();
    for v in scene.mesh.vertices() {
        let fan: Vec<Halfedge> = scene.mesh.outgoing(v).collect();
        let is_point = |v: Vertex| scene.needs.is_point[v];
        let n_points = fan.iter().filter(|h| is_point(scene.mesh.tip(**h))).count()
            + usize::from(fan.last().is_some_and(|h| {
                scene.mesh.twin(h.prev()).is_none() && is_point(scene.mesh.origin(h.prev()))
            }));
        if n_points < 2 {
            continue;
        }
        let tips = tips(scene, &fan)?;
        if is_point(v) {
            let own = scene.space.form(scene.cut.wedge[fan[0]]);
            for pair in tips.windows(2) {
                // A face is noted at the smallest of its corners.
                let is_face = pair[1].spoke == pair[0].spoke + 1;
                if !is_face || v < pair[0].vertex.min(pair[1].vertex) {
                    found.extend(gap(scene, own, [&pair[0], &pair[1]])?);
                }
            }
        } else if tips.len() > 3 - usize::from(scene.mesh.is_boundary(v)) {
            found.extend(star(scene, &tips, scene.mesh.is_boundary(v))?);
        }
    }
    Ok(found)
}

/// The grid points at the ends of the spokes of a fan, counter-clockwise; around an inner vertex the first
/// one once more at the end.
fn tips(scene: &Scene<'_>, fan: &[Halfedge]) -> Result<Vec<Tip>, Overflow> {
    let (mut crossed, mut tips) = (Vec::new(), Vec::new());
    let mut spoke = 0;
    let mut note = |corner: Halfedge, vertex: Halfedge, crossed: &[Halfedge], spoke: usize| {
        let tip = scene.mesh.origin(corner);
        if scene.needs.is_point[tip] {
            let (turns, mut form) = scene.carry(crossed)?;
            add_scaled(&mut form, scene.space.form(scene.cut.wedge[corner]), Gauss::unit(turns))?;
            let way = turn(scene.at(corner) - scene.at(vertex), turns);
            tips.push(Tip { way, form, spoke, vertex: tip });
        }
        Ok::<(), Overflow>(())
    };
    for &h in fan {
        note(h.next(), h, &crossed, spoke)?;
        spoke += 1;
        match scene.mesh.twin(h.prev()) {
            Some(_) => crossed.push(h.prev()),
            None => note(h.prev(), h, &crossed, spoke)?,
        }
    }
    if crossed.len() == fan.len() {
        // All around: the first spoke again, after all crossings.
        let mut first = None;
        for &h in fan {
            if scene.needs.is_point[scene.mesh.tip(h)] {
                first = Some(h);
                break;
            }
            spoke += 1;
        }
        if let Some(h) = first {
            let before = fan.iter().position(|&g| g == h).unwrap_or(0);
            let around: Vec<Halfedge> = crossed.iter().chain(&crossed[..before]).copied().collect();
            note(h.next(), h, &around, spoke)?;
        }
    }
    Ok(tips)
}

/// Two consecutive grid points around a grid point: the angle between them must stay positive.
fn gap(scene: &Scene<'_>, own: &Form, ends: [&Tip; 2]) -> Result<Option<Shape>, Overflow> {
    let [a, b] = ends;
    let is_face = b.spoke == a.spoke + 1;
    let angle = (a.way.conj() * b.way).arg();
    // A gap of several faces may open to half a turn and more.
    if !is_face && !(0.0..=0.5 * PI).contains(&angle) {
        return Ok(None);
    }
    let way = |tip: &Tip| {
        let mut form = tip.form.clone();
        add_scaled(&mut form, own, Gauss::ONE.negated())?;
        Ok::<_, Overflow>(Connection {
            length: tip.way.norm(),
            rows: scene.space.rows(&form)?,
            least: 1,
        })
    };
    let extent = (b.way - a.way).norm().min(a.way.norm()).min(b.way.norm());
    let sides = vec![[0, 1], [1, 2], [2, 0]];
    Ok(Some(Shape { ways: vec![way(a)?, way(b)?], sides, extent, is_face }))
}

/// The grid points around an ordinary vertex, the first of which comes again at the end unless the vertex is
/// on the boundary.
fn star(scene: &Scene<'_>, tips: &[Tip], is_open: bool) -> Result<Option<Shape>, Overflow> {
    let n = if is_open { tips.len() } else { tips.len() - 1 };
    let sides: Vec<[usize; 2]> = (1..tips.len())
        .filter(|&k| {
            let angle = (tips[k - 1].way.conj() * tips[k].way).arg();
            (0.0..WIDEST_GAP).contains(&angle)
        })
        .map(|k| [k - 1, k % n])
        .collect();
    if sides.len() < 2 {
        return Ok(None);
    }
    let mut ways = Vec::with_capacity(n - 1);
    let mut extent = f64::INFINITY;
    for (k, tip) in tips[..n].iter().enumerate().skip(1) {
        let mut form = tip.form.clone();
        add_scaled(&mut form, &tips[0].form, Gauss::ONE.negated())?;
        let length = (tip.way - tips[0].way).norm();
        ways.push(Connection { length, rows: scene.space.rows(&form)?, least: 1 });
        let nearest = tips[..k].iter().map(|other| (other.way - tip.way).norm());
        extent = nearest.fold(extent, f64::min);
    }
    Ok(Some(Shape { ways, sides, extent, is_face: false }))
}

/// Whether there is a place on the left of all sides; `at` gives the points, the origin included.
pub fn has_room(sides: &[[usize; 2]], at: impl Fn(usize) -> [f64; 2]) -> bool {
    let mut place = vec![[-REACH, -REACH], [REACH, -REACH], [REACH, REACH], [-REACH, REACH]];
    let origin = at(0);
    for &[a, b] in sides {
        let [a, b] = [at(a), at(b)].map(|[x, y]| [x - origin[0], y - origin[1]]);
        place = left_of(&place, a, b);
        if area(&place) < LEAST_AREA {
            return false;
        }
    }
    true
}

/// The part of a convex polygon on the left of a line.
fn left_of(polygon: &[[f64; 2]], a: [f64; 2], b: [f64; 2]) -> Vec<[f64; 2]> {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    if dx == 0.0 && dy == 0.0 {
        return Vec::new();
    }
    let height = |p: [f64; 2]| dx * (p[1] - a[1]) - dy * (p[0] - a[0]);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let (hp, hq) = (height(p), height(q));
        if hp >= 0.0 {
            kept.push(p);
        }
        if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
            let t = hp / (hp - hq);
            kept.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
        }
    }
    kept
}

fn area(polygon: &[[f64; 2]]) -> f64 {
    let cross = |k: usize| {
        let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        p[0] * q[1] - p[1] * q[0]
    };
    0.5 * (0..polygon.len()).map(cross).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> bool {
        let n = points.len();
        let sides: Vec<[usize; 2]> = (0..n).map(|k| [k, (k + 1) % n]).collect();
        has_room(&sides, |k| points[k])
    }

    #[test]
    fn polygons_seen_whole_from_one_place() {
        assert!(ring(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]));
        assert!(!ring(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]), "clockwise");
        assert!(!ring(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), "on one line");
        // a corner on a side takes nothing away
        assert!(ring(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 2.0]]));
        // an L is seen whole from its corner, a U from nowhere
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        assert!(ring(&l));
        let u = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        assert!(!ring(&u));
        // two points in one place, seen in different directions
        assert!(!ring(&[[0.0, 0.0], [0.0, 1.0], [0.0, 0.0], [-3.0, 0.5]]));
    }
}
