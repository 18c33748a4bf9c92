//! How good a patch is.

use super::Site;
use crate::badness;
use crate::quality::Orientation;

/// Badness of the worst corner of a quad, see [`badness`].
pub(super) fn worst_corner(quad: [Site; 4]) -> f64 {
    let corners = badness::on_surface(quad.map(|site| site.at), quad.map(|site| site.normal));
    corners.into_iter().fold(0.0, f64::max)
}

/// The sum over a patch is of this power of the quads' badness: the worst lead.
const POWER: i32 = 8;

/// Quads by how bad they are; what comes first matters more, and less is better.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
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

    /// Whether nothing is left to do.
    pub(super) fn is_good(&self) -> bool {
        self.faulty + self.reflex + self.bad == 0
    }
}
