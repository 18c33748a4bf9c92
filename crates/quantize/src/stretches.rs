//! How many cells curves should have to look round.
//!
//! A hole that is small against the cells has few of them around it by its length alone; where a flat ring joins it to a
//! smaller one, both have the same number.

use crate::gauss::Overflow;
use crate::linear::{Row, apply, negated};
use crate::scene::{Scene, Sight};
use seamstress_mesh::{Halfedge, HalfedgeData, Metric};
use std::f64::consts::{FRAC_PI_4, PI};

/// How far the middle of a chord may be from its curve, cells.
const SAG: f64 = 0.115;
/// Curves that turn by less have no need of cells to look round, radians.
const LEAST_TURN: f64 = FRAC_PI_4;

/// A stretch of aligned edges from one grid point to the next, or all around a loop that has none.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    /// The displacement along it, a form in the coordinates that is positive in the seamless map.
    pub(crate) row: Row,
    /// That in the seamless map, in the units of the layout.
    pub(crate) displacement: f64,
    /// Its length on the surface, in the same units.
    length: f64,
    /// What it turns by within the surface, on the side where that is more; radians.
    turn: f64,
}

impl Stretch {
    /// The cells that it should have where a cell has this size, so that the chords of an arc of its length and turn are
    /// close to it.
    pub(crate) fn cells(&self, h: f64) -> f64 {
        if self.turn < LEAST_TURN {
            return 1.0;
        }
        let radius = self.length / (h * self.turn);
        let half_angle = (1.0 - SAG / radius).max(0.0).acos();
        (self.turn / (2.0 * half_angle)).ceil()
    }
}

/// All stretches of aligned edges, each once, for a layout with a mesh length as its unit.
///
/// # Errors
/// [`Overflow`].
pub(crate) fn stretches(
    scene: &Scene<'_>,
    metric: &Metric,
    unit: f64,
    coordinates: &[f64],
) -> Result<Vec<Stretch>, Overflow> {
    let mut is_aligned = HalfedgeData::filled(scene.mesh.n_halfedges(), false);
    scene.needs.levels.iter().for_each(|&(h, _)| is_aligned[h] = true);
    let is_seen = HalfedgeData::filled(scene.mesh.n_halfedges(), false);
    let mut walk = Walk { scene, metric, is_aligned, is_seen };
    let is_point = |h: Halfedge| scene.needs.is_point[scene.mesh.origin(h)];
    let mut found: Vec<Stretch> = Vec::new();
    // Those that begin at a grid point first: what is left are loops.
    for from_points in [true, false] {
        for &(h, _) in &scene.needs.levels {
            if walk.is_seen[h] || (from_points && !is_point(h)) {
                continue;
            }
            let Some((sight, length, turn)) = walk.stretch_at(h) else { continue };
            let line = scene.line(&sight)?;
            let along = |row: &Row| apply(row, coordinates);
            let row =
                line.rows.into_iter().max_by(|a, b| along(a).abs().total_cmp(&along(b).abs()));
            let Some(row) = row.filter(|row| !row.is_empty()) else { continue };
            let (displacement, length) = (along(&row), length * metric.unit / unit);
            let row = if displacement < 0.0 { negated(&row) } else { row };
            found.push(Stretch { row, displacement: displacement.abs(), length, turn: turn.abs() });
        }
    }
    // Both sides of an edge.
    found.sort_by(|a, b| a.row.cmp(&b.row).then(b.turn.total_cmp(&a.turn)));
    found.dedup_by(|other, stretch| other.row == stretch.row);
    Ok(found)
}

/// Follows aligned edges on the side of their faces.
struct Walk<'s> {
    scene: &'s Scene<'s>,
    metric: &'s Metric,
    is_aligned: HalfedgeData<bool>,
    is_seen: HalfedgeData<bool>,
}

impl Walk<'_> {
    /// The stretch that begins with a half-edge: what its displacement is seen from, its length, and its turn. None if
    /// it comes to an edge where the surface ends, or to where a curve does.
    fn stretch_at(&mut self, start: Halfedge) -> Option<(Sight, f64, f64)> {
        let mesh = self.scene.mesh;
        let (mut h, mut crossed, mut length, mut turn) = (start, Vec::new(), 0.0, 0.0);
        loop {
            self.is_seen[h] = true;
            length += self.metric.length[h];
            let mut next = h.next();
            if self.scene.needs.is_point[mesh.origin(next)] {
                return Some((Sight { from: start, to: next, length, crossed }, length, turn));
            }
            turn += PI - self.metric.angle[next];
            while !self.is_aligned[next] {
                crossed.push(next);
                next = mesh.twin(next)?.next();
                turn -= self.metric.angle[next];
            }
            if next == start {
                return Some((Sight { from: start, to: start, length, crossed }, length, turn));
            }
            if self.is_seen[next] {
                return None;
            }
            h = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn chords_of_so_many_cells_are_as_close_as_wanted() {
        for turn in [FRAC_PI_4, 0.5 * PI, PI, TAU] {
            for radius in [0.4, 0.9, 1.5, 4.0, 20.0] {
                let (row, displacement, length) = (Row::new(), 0.0, 3.0 * radius * turn);
                let stretch = Stretch { row, displacement, length, turn };
                let cells = stretch.cells(3.0);
                let sag = |cells: f64| radius * (1.0 - (0.5 * turn / cells).cos());
                assert!(sag(cells) <= SAG + 1e-9, "{turn} {radius}: {cells}");
                assert!(cells == 1.0 || sag(cells - 1.0) > SAG, "{turn} {radius}: {cells}");
            }
        }
        let straight = Stretch { row: Row::new(), displacement: 9.0, length: 9.0, turn: 0.1 };
        assert_eq!(straight.cells(1.0), 1.0);
    }
}
