//! Short lines to isolines, which may not vanish either.

use crate::gauss::{Form, Gauss, Overflow, add_scaled};
use crate::isolines::part;
use crate::linear::Row;
use crate::scene::{Carry, Connection, Scene, Sight};
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, HalfedgeData};
use seamstress_parametrize::quarter::turn;

/// A direction this close to an edge, as the sine of the angle, runs along it.
const ALONG: f64 = 1e-7;
/// Triangles that a ray may cross.
const MOST_CROSSINGS: usize = 10_000;

/// What must keep its length and sense along isolines:
/// * from every vertex on an isoline, and from every grid point, the lines straight to the next isolines;
/// * the pieces of isolines between grid points;
/// * the heights of triangles between an aligned edge and a vertex at another level.
///
/// The overlap of two parallel isolines ends at an end of one of them, so that lines from vertices
/// are enough.
///
/// # Errors
/// [`Overflow`].
pub fn lines_to_isolines(scene: &Scene<'_>, radius: f64) -> Result<Vec<Connection>, Overflow> {
    if scene.needs.levels.is_empty() {
        return Ok(Vec::new());
    }
    let mut level = HalfedgeData::filled(scene.mesh.n_halfedges(), None);
    for &(h, coordinate) in &scene.needs.levels {
        level[h] = Some(coordinate);
    }
    let rays = Rays { scene, level, radius };
    let mut found = Vec::new();
    for h in scene.mesh.halfedges() {
        for quarters in 0..4 {
            found.extend(rays.ray(h, quarters)?);
        }
    }
    for &(h, coordinate) in &scene.needs.levels {
        found.extend(rays.piece(h)?);
        found.extend(rays.height(h, coordinate)?);
    }
    Ok(found)
}

struct Rays<'a> {
    scene: &'a Scene<'a>,
    /// For aligned half-edges the coordinate their ends share.
    level: HalfedgeData<Option<u32>>,
    radius: f64,
}

impl Rays<'_> {
    /// The line from a corner in the direction `i^quarters` to the first isoline across it.
    fn ray(&self, h: Halfedge, quarters: i32) -> Result<Option<Connection>, Overflow> {
        let scene = self.scene;
        // Along u a corner has to have an integral u.
        let own = scene.space.level(scene.cut.wedge[h], quarters.rem_euclid(2) as u32)?;
        let Some(own) = own else { return Ok(None) };
        let direction = turn(Complex64::ONE, quarters);
        let origin = scene.at(h);
        let (right, left) = (scene.at(h.next()) - origin, scene.at(h.prev()) - origin);
        let side = |z: Complex64| (direction.conj() * z).im;
        let starts_here = side(right) < ALONG * right.norm() && side(left) > ALONG * left.norm();
        if !starts_here || self.runs_along(h, right, direction) {
            return Ok(None);
        }
        let (mut edge, mut right_end, mut turns) = (h.next(), right, 0);
        let mut crossed = Vec::new();
        while crossed.len() < MOST_CROSSINGS {
            let distance = (direction.conj() * right_end).re;
            if let Some(coordinate) = self.level[edge] {
                let is_across = (quarters - turns).rem_euclid(2) as u32 == coordinate;
                if !is_across || distance >= self.radius {
                    return Ok(None);
                }
                let rows = self.rise(&own, &crossed, edge, coordinate, quarters)?;
                let ends = [h, edge].map(|h| scene.mesh.origin(h));
                return Ok(Some(Connection { ends, length: distance, rows, minimum: 1 }));
            }
            let Some(t) = scene.mesh.twin(edge) else { return Ok(None) };
            crossed.push(edge);
            if scene.cut.is_seam[edge] {
                turns -= scene.matching[edge];
            }
            let placed =
                |corner: Halfedge| right_end + turn(scene.at(corner) - scene.at(t.next()), turns);
            let (apex, left_end) = (placed(t.prev()), placed(t));
            let is_far = [right_end, apex, left_end]
                .iter()
                .all(|z| (direction.conj() * z).re >= self.radius);
            if is_far {
                return Ok(None);
            }
            (edge, right_end) =
                if side(apex) > 0.0 { (t.next(), right_end) } else { (t.prev(), apex) };
        }
        Ok(None)
    }

    /// Whether a direction runs along the aligned edge on the right of a corner.
    fn runs_along(&self, h: Halfedge, right: Complex64, direction: Complex64) -> bool {
        self.level[h].is_some() && (direction.conj() * right).im.abs() < ALONG * right.norm()
    }

    /// By how much the level of an edge beyond some crossings is further in a direction than a level here.
    fn rise(
        &self,
        own: &Form,
        crossed: &[Halfedge],
        edge: Halfedge,
        coordinate: u32,
        quarters: i32,
    ) -> Result<[Row; 2], Overflow> {
        let scene = self.scene;
        let Carry { turns, form: carried } = scene.path(crossed)?;
        let real = |sign: i64| Gauss { re: sign, im: 0 };
        // The first two directions are along the axes, the others against them.
        let sense = |quarters: i32| real(if quarters.rem_euclid(4) < 2 { 1 } else { -1 });
        let there = scene.space.level(scene.cut.wedge[edge], coordinate)?.unwrap_or_default();
        let mut rise = Form::new();
        add_scaled(&mut rise, &there, sense(quarters - turns))?;
        let axis = quarters.rem_euclid(2) as u32;
        add_scaled(&mut rise, &part(&carried, axis), sense(quarters))?;
        add_scaled(&mut rise, own, sense(quarters).negated())?;
        Ok([scene.space.row(&rise)?, Vec::new()])
    }

    /// The piece of an isoline that begins at a grid point with an aligned half-edge, up to the next one,
    /// seen from its left.
    fn piece(&self, first: Halfedge) -> Result<Option<Connection>, Overflow> {
        let (mesh, is_point) = (self.scene.mesh, &self.scene.needs.is_point);
        if !is_point[mesh.origin(first)] {
            return Ok(None);
        }
        let (mut h, mut length, mut crossed) = (first, 0.0, Vec::new());
        loop {
            length += (self.scene.at(h.next()) - self.scene.at(h)).norm();
            if length >= self.radius {
                return Ok(None);
            }
            if is_point[mesh.tip(h)] {
                let sight = Sight { from: first, to: h.next(), length, crossed };
                return self.scene.line(&sight).map(Some);
            }
            let mut onward = h.next();
            while self.level[onward].is_none() {
                let Some(t) = mesh.twin(onward) else { return Ok(None) };
                crossed.push(onward);
                onward = t.next();
            }
            if mesh.twin(h) == Some(onward) {
                // An open end.
                return Ok(None);
            }
            h = onward;
        }
    }

    /// The height of the triangle on an aligned edge, if its third corner is at a level of the same kind.
    fn height(&self, h: Halfedge, coordinate: u32) -> Result<Option<Connection>, Overflow> {
        let scene = self.scene;
        let (apex, foot) = (h.prev(), h);
        let Some(own) = scene.space.level(scene.cut.wedge[foot], coordinate)? else {
            return Ok(None);
        };
        let Some(mut rise) = scene.space.level(scene.cut.wedge[apex], coordinate)? else {
            return Ok(None);
        };
        add_scaled(&mut rise, &own, Gauss::ONE.negated())?;
        let way = scene.at(apex) - scene.at(foot);
        let length = if coordinate == 0 { way.re } else { way.im }.abs();
        let rows = [scene.space.row(&rise)?, Vec::new()];
        let ends = [apex, foot].map(|h| scene.mesh.origin(h));
        Ok((length < self.radius).then_some(Connection { ends, length, rows, minimum: 1 }))
    }
}
