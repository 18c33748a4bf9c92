//! What the rounding minimises, and what it has to keep.

use super::basis::ReducedBasis;
use crate::linear::{Dense, Row, apply, apply_exactly, dot};
use crate::scene::Connection;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_linalg::dense::invert_spd;
use seamstress_mesh::Vertex;
use std::ops::Range;
use std::sync::Arc;

/// The energy of moving integer coordinates: `(x - mean)' P (x - mean)`, with a mean diagonal of one.
#[derive(Debug, Clone)]
pub struct ReducedEnergy {
    /// The matrix P.
    pub matrix: Dense,
    /// Its inverse.
    pub covariance: Dense,
    /// Steps along which the search moves.
    pub basis: ReducedBasis,
    /// The area, if the coordinates alone decide on it.
    pub area: Option<AreaForm>,
}

/// The area as a function of the coordinates: half of `x' G x`.
#[derive(Debug, Clone)]
pub struct AreaForm {
    /// The matrix G.
    pub matrix: Dense,
    /// The same on multiples of the vectors of the basis.
    pub in_basis: Dense,
}

impl AreaForm {
    /// The area at a point.
    pub fn at(&self, x: &[f64]) -> f64 {
        0.5 * dot(x, &self.matrix.multiply(x))
    }
}

/// What it costs to miss the area, as a multiple of what a uniform change of size would cost: the number of quads is that
/// area, and a cell may be stretched to keep it where others had to be.
const AREA_WEIGHT: f64 = 16.0;

/// Shift of the energy as a share of its mean diagonal, for directions that cost nothing.
const SHIFT: f64 = 1e-12;
/// What turning the map costs, as a share of what it costs to change its size by as much. Along a straight line of
/// coordinates a turn of angle t makes the map longer by 1 / cos t, which an energy of second order does not see.
const TURNING: f64 = 0.5;

impl ReducedEnergy {
    /// Of a matrix, given the coordinates of the map, real and imaginary parts by turns, if it may be turned; and the
    /// matrix of its area, if the coordinates alone decide on that.
    ///
    /// # Errors
    /// When the matrix is not positive definite.
    pub fn new(
        matrix: &Dense,
        turnable: Option<&[f64]>,
        area: Option<Dense>,
    ) -> Result<Self, NotPositiveDefinite> {
        let mut matrix = matrix.normalized();
        let n = matrix.order;
        if let Some(map) = turnable {
            add_turning(&mut matrix, map);
        }
        let mut shifted = matrix.values.clone();
        (0..n).for_each(|k| shifted[k * n + k] += SHIFT * matrix.trace() / n as f64);
        let covariance = Dense { order: n, values: invert_spd(&shifted, n)? };
        let basis = ReducedBasis::new(&matrix);
        let area = area.map(|matrix| AreaForm { in_basis: basis.express(&matrix), matrix });
        Ok(Self { matrix, covariance, basis, area })
    }
}

/// Adds what turning the map costs.
fn add_turning(energy: &mut Dense, map: &[f64]) {
    let n = energy.order;
    let turn: Vec<f64> = map.chunks(2).flat_map(|z| [-z[1], z[0]]).collect();
    let square = dot(&turn, &turn);
    if square > 0.0 {
        let resize = dot(map, &energy.multiply(map));
        let weight = TURNING * resize / square.powi(2);
        for (k, value) in energy.values.iter_mut().enumerate() {
            *value += weight * turn[k / n] * turn[k % n];
        }
    }
}

/// Areas below this part of the one wanted count as that: some are not positive.
const SMALLEST_RATIO: f64 = 1e-3;

/// A displacement on the grid that may neither vanish nor turn around.
#[derive(Debug, Clone)]
pub struct Constraint {
    /// Real and imaginary part of the displacement.
    pub rows: [Row; 2],
    /// The displacement in the seamless map, grid units, which the rounded one must not point away from, if that
    /// matters.
    pub direction: Option<[f64; 2]>,
    /// Length of the connection in the seamless map, grid units; the shortest are rounded first.
    pub length: f64,
    /// Grid units that a walk along the grid from one end to the other has at a minimum; with 0 anything is allowed.
    pub minimum: i64,
    /// The vertices that it keeps apart, if it is a line between some.
    pub ends: Option<[Vertex; 2]>,
}

/// An inner product with the direction above this points the same way.
const SAME_WAY: f64 = 1e-9;

impl Constraint {
    /// From a connection, for coordinates `from` of the seamless map and cells of size `h`, both in the layout's units.
    pub fn new(line: &Connection, from: &[f64], h: f64) -> Self {
        let (rows, minimum, ends) = (line.rows.clone(), line.minimum, Some(line.ends));
        let direction = Some(rows.each_ref().map(|row| apply(row, from) / h));
        Self { rows, direction, length: line.length / h, minimum, ends }
    }

    /// A coordinate without any condition of its own, rounded early.
    pub fn free(row: Row) -> Self {
        let rows = [row, Row::new()];
        Self { rows, direction: None, length: 0.0, minimum: 0, ends: None }
    }

    /// By how many grid units a displacement with this value is too short; one if it has only turned around.
    pub fn shortage(&self, d: [f64; 2]) -> i64 {
        let short = self.minimum - (d[0].abs() + d[1].abs()).round() as i64;
        short.max(i64::from(self.turns_around(d)))
    }

    /// Whether a displacement with this value at least neither vanishes nor turns around.
    pub fn keeps_apart(&self, d: [f64; 2]) -> bool {
        let vanishes = self.minimum > 0 && d[0].abs() + d[1].abs() < HALF;
        !vanishes && !self.turns_around(d)
    }

    fn turns_around(&self, d: [f64; 2]) -> bool {
        self.direction.is_some_and(|[u, v]| d[0] * u + d[1] * v <= SAME_WAY)
    }

    /// The displacement at integers.
    pub fn at(&self, x: &[i64]) -> [i64; 2] {
        self.rows.each_ref().map(|row| apply_exactly(row, x))
    }
}

/// What must hold of several displacements.
#[derive(Debug, Clone)]
pub enum Rule {
    /// Two sides of a triangle of the mesh, which stays counter-clockwise.
    Oriented,
    /// An infeasibility cut, or a wish: the sum of force times real part is more than a bound.
    Beyond {
        /// One for each member.
        forces: Arc<[f64]>,
        /// The bound.
        bound: f64,
    },
}

/// Between integers and what they are compared to: sums of coordinates, and twice the areas of triangles of the grid,
/// are integers.
const HALF: f64 = 0.5;

impl Rule {
    /// Whether it holds of displacements, those that are not determined yet left out.
    pub fn allows(&self, mut displacements: impl Iterator<Item = Option<[f64; 2]>>) -> bool {
        match self {
            Self::Oriented => match (displacements.next(), displacements.next()) {
                (Some(Some([a, b])), Some(Some([c, d]))) => a * d - b * c > HALF,
                _ => true,
            },
            Self::Beyond { forces, bound } => {
                let along = |sum, (d, f): (Option<[f64; 2]>, &f64)| Some(sum + f * d?[0]);
                displacements.zip(forces.iter()).try_fold(0.0, along).is_none_or(|sum| sum > *bound)
            }
        }
    }
}

/// What it costs to miss an area.
#[derive(Debug, Clone, Copy)]
pub(super) struct SizeCost {
    wanted: f64,
    weight: f64,
}

impl SizeCost {
    /// The cost of an area.
    pub(super) fn at(self, area: f64) -> f64 {
        self.weight * (area / self.wanted).max(SMALLEST_RATIO).ln().powi(2)
    }
}

/// A closest vector problem: energy over integer points that satisfy constraints.
#[derive(Debug, Clone)]
pub struct RoundingProblem<'a> {
    /// The energy.
    pub energy: &'a ReducedEnergy,
    /// The coordinates of the seamless map in grid units.
    pub mean: Vec<f64>,
    /// Displacements that must survive.
    pub constraints: Vec<Constraint>,
    /// What must hold of several of them, given by number; none is among two such groups.
    pub joint: Vec<(Range<usize>, Rule)>,
}

/// What does not hold at integers.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Violations {
    /// How many constraints, single and joint ones.
    pub count: usize,
    /// How many of them are infeasibility cuts and wishes.
    pub cuts: usize,
    /// The displacements that have a part in it, by number.
    pub involved: Vec<usize>,
}

impl RoundingProblem<'_> {
    /// Adds constraints with what must hold of them jointly.
    pub fn add(&mut self, members: impl Iterator<Item = Constraint>, rule: Rule) {
        let first = self.constraints.len();
        self.constraints.extend(members);
        self.joint.push((first..self.constraints.len(), rule));
    }

    /// What does not hold at integers.
    pub fn violations(&self, x: &[i64]) -> Violations {
        let at = |i: usize| self.constraints[i].at(x).map(|d| d as f64);
        let single =
            (0..self.constraints.len()).filter(|&i| self.constraints[i].shortage(at(i)) > 0);
        let mut involved: Vec<usize> = single.collect();
        let (mut count, mut cuts) = (involved.len(), 0);
        for (members, rule) in &self.joint {
            if !rule.allows(members.clone().map(|i| Some(at(i)))) {
                count += 1;
                cuts += usize::from(matches!(rule, Rule::Beyond { .. }));
                involved.extend(members.clone());
            }
        }
        Violations { count, cuts, involved }
    }

    /// For each constraint the joint one that it is a member of.
    pub(super) fn memberships(&self) -> Vec<Option<usize>> {
        let mut memberships = vec![None; self.constraints.len()];
        for (k, (members, _)) in self.joint.iter().enumerate() {
            memberships[members.clone()].fill(Some(k));
        }
        memberships
    }

    /// The energy at integers, with what it costs to miss the area of the map.
    pub fn energy_at(&self, x: &[i64]) -> f64 {
        let size = self.energy.area.as_ref().map_or(0.0, |form| {
            let at: Vec<f64> = x.iter().map(|&x| x as f64).collect();
            self.size_cost().at(form.at(&at))
        });
        self.energy.matrix.energy(&self.mean, x) + size
    }

    /// What it costs to miss the area of the map.
    pub(super) fn size_cost(&self) -> SizeCost {
        let Some(form) = &self.energy.area else { return SizeCost { wanted: 1.0, weight: 0.0 } };
        let resize = dot(&self.mean, &self.energy.matrix.multiply(&self.mean));
        // Lengths change by half as much as the area does.
        SizeCost { wanted: form.at(&self.mean), weight: AREA_WEIGHT * resize / 4.0 }
    }
}
