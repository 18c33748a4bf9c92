//! How good a patch is.

use super::Site;
use crate::badness;
use crate::quality::Orientation;
use std::cmp::Ordering;

/// Badness of the worst corner of a quad, see [`badness`].
pub(super) fn worst_corner(quad: [Site; 4]) -> f64 {
    let corners = badness::on_surface(quad.map(|site| site.at), quad.map(|site| site.normal));
    corners.into_iter().fold(0.0, f64::max)
}

/// The sum over a patch is of this power of the quads' badness: the worst lead.
const POWER: i32 = 8;

/// The part by which that sum has to fall to count: less is not seen, and would be taken again and again.
const GAIN: f64 = 0.01;

/// Quads by how bad they are; what comes first matters more, and less is better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Score {
    /// Inverted, crossed or bent.
    faulty: usize,
    /// With a reflex corner, in space or seen along the surface's normals.
    reflex: usize,
    /// Worse than the bound.
    bad: usize,
    badness: f64,
}

impl Score {
    pub(super) fn new(quads: impl Iterator<Item = [Site; 4]>, bound: f64) -> Self {
        let none = Self { faulty: 0, reflex: 0, bad: 0, badness: 0.0 };
        quads.fold(none, |sum, quad| {
            let (points, normals) = (quad.map(|site| site.at), quad.map(|site| site.normal));
            let is_faulty = Orientation::of_polygon(&points, &normals).faults() > 0;
            let worst = worst_corner(quad);
            Self {
                faulty: sum.faulty + usize::from(is_faulty),
                reflex: sum.reflex + usize::from(worst > 1.0),
                bad: sum.bad + usize::from(worst > bound),
                badness: sum.badness + worst.powi(POWER),
            }
        })
    }

    /// Whether fewer quads are faulty, or as many and fewer reflex, or as many and fewer bad, or as many and all together clearly
    /// better.
    pub(super) fn is_better_than(&self, other: &Self) -> bool {
        let numbers = |score: &Self| (score.faulty, score.reflex, score.bad);
        match numbers(self).cmp(&numbers(other)) {
            Ordering::Less => true,
            Ordering::Equal => self.badness < (1.0 - GAIN) * other.badness,
            Ordering::Greater => false,
        }
    }

    /// Whether nothing is left to do.
    pub(super) fn is_good(&self) -> bool {
        self.faulty + self.reflex + self.bad == 0
    }
}
