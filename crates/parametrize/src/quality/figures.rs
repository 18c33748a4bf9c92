//! The figures that layouts are compared by while they are made.

use crate::energy::{Alignment, CHUNK, Triangle};
use num_complex::Complex64;
use seamstress_parallel::prelude::*;

/// Mean energy and tau of a layout, as [`Distortion`](super::Distortion) has them, in one pass.
#[derive(Debug, Clone, Copy)]
pub struct Figures {
    /// The best global scale of the symmetric Dirichlet energy.
    pub scale: f64,
    /// Its mean at that scale.
    pub symmetric_dirichlet: f64,
    /// The mean pull towards wanted directions at that scale.
    pub pull: f64,
    /// `sqrt(sigma_1 max / sigma_2 min)`, infinite if a triangle is flipped or collapsed.
    pub tau: f64,
}

/// Sums and extremes over some triangles.
#[derive(Clone, Copy)]
struct Tally {
    weight: f64,
    /// `sigma_1^2 + sigma_2^2`, and of the inverses.
    squares: f64,
    inverse_squares: f64,
    pull: f64,
    largest: f64,
    smallest: f64,
}

impl Tally {
    const NONE: Self = Self {
        weight: 0.0,
        squares: 0.0,
        inverse_squares: 0.0,
        pull: 0.0,
        largest: 0.0,
        smallest: f64::INFINITY,
    };

    fn of(triangle: &Triangle, z: &[Complex64]) -> Self {
        let jacobian = triangle.jacobian(z);
        let (s1, s2) = jacobian.singular_values();
        let pull = Alignment::new(triangle, &jacobian).map_or(0.0, |pull| pull.value(&jacobian));
        let [p, q] = [s1 * s1, s2 * s2];
        Self {
            weight: triangle.weight,
            squares: triangle.weight * (p + q),
            inverse_squares: triangle.weight * (1.0 / p + 1.0 / q),
            pull: triangle.weight * pull,
            largest: s1,
            smallest: s2,
        }
    }

    fn join(self, other: Self) -> Self {
        Self {
            weight: self.weight + other.weight,
            squares: self.squares + other.squares,
            inverse_squares: self.inverse_squares + other.inverse_squares,
            pull: self.pull + other.pull,
            largest: self.largest.max(other.largest),
            smallest: self.smallest.min(other.smallest),
        }
    }
}

impl Figures {
    /// Of a layout: `z` holds the positions of the wedges.
    pub fn of_layout(triangles: &[Triangle], z: &[Complex64]) -> Self {
        let of_chunk = |chunk: &[Triangle]| {
            chunk.iter().map(|t| Tally::of(t, z)).fold(Tally::NONE, Tally::join)
        };
        let tallies: Vec<Tally> = triangles.par_chunks(CHUNK).map(of_chunk).collect();
        let all = tallies.into_iter().fold(Tally::NONE, Tally::join);
        if all.smallest > 0.0 && all.weight > 0.0 {
            // The minimum of `s^2 P + Q / s^2`.
            let scale = (all.inverse_squares / all.squares).powf(0.25);
            let least = 2.0 * (all.squares * all.inverse_squares).sqrt() / all.weight;
            let tau = (all.largest / all.smallest).sqrt();
            let pull = scale * scale * all.pull / all.weight;
            Self { scale, symmetric_dirichlet: least, pull, tau }
        } else {
            let none = f64::INFINITY;
            Self { scale: 1.0, symmetric_dirichlet: none, pull: none, tau: none }
        }
    }
}
