//! Energies that measure the distance to a rotation or a similarity.
//!
//! They stay finite as a triangle collapses, so Newton steps run into the edge of the flip-free region and
//! stall there; a logarithmic barrier that fades out leads along it.

use super::{Energy, Jet};

/// As-rigid-as-possible energy `(s1 - 1)^2 + (s2 - 1)^2`, eq. (4): the squared distance to the nearest rotation.
#[derive(Debug, Clone, Copy, Default)]
pub struct Arap;

impl Energy for Arap {
    #[inline]
    fn value(&self, s1: f64, s2: f64) -> f64 {
        (s1 - 1.0) * (s1 - 1.0) + (s2 - 1.0) * (s2 - 1.0)
    }

    #[inline]
    fn jet(&self, s1: f64, s2: f64) -> Jet {
        Jet {
            value: self.value(s1, s2),
            d: [2.0 * (s1 - 1.0), 2.0 * (s2 - 1.0)],
            dd: [2.0, 0.0, 2.0],
        }
    }
}

/// `(s1 - s2)^2 / 2 - reward s1 s2`: the squared distance to the nearest similarity, eq. (10), and a
/// reward on area without which everything would shrink to a point.
#[derive(Debug, Clone, Copy)]
pub struct Asap {
    /// Reward per area in the plane.
    pub reward: f64,
}

impl Energy for Asap {
    #[inline]
    fn value(&self, s1: f64, s2: f64) -> f64 {
        0.5 * (s1 - s2) * (s1 - s2) - self.reward * s1 * s2
    }

    #[inline]
    fn jet(&self, s1: f64, s2: f64) -> Jet {
        Jet {
            value: self.value(s1, s2),
            d: [s1 - s2 - self.reward * s2, s2 - s1 - self.reward * s1],
            dd: [1.0, -1.0 - self.reward, 1.0],
        }
    }
}

/// An energy with the barrier `-weight ln(s1 s2)`.
#[derive(Debug, Clone, Copy)]
pub struct Guarded<E> {
    /// The energy.
    pub energy: E,
    /// Weight of the barrier.
    pub weight: f64,
}

impl<E: Energy> Energy for Guarded<E> {
    #[inline]
    fn value(&self, s1: f64, s2: f64) -> f64 {
        self.energy.value(s1, s2) - self.weight * (s1 * s2).ln()
    }

    #[inline]
    fn jet(&self, s1: f64, s2: f64) -> Jet {
        let inner = self.energy.jet(s1, s2);
        let w = self.weight;
        Jet {
            value: inner.value - w * (s1 * s2).ln(),
            d: [inner.d[0] - w / s1, inner.d[1] - w / s2],
            dd: [inner.dd[0] + w / (s1 * s1), inner.dd[1], inner.dd[2] + w / (s2 * s2)],
        }
    }
}
