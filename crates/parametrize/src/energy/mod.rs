//! What a layout is measured by: triangles, their Jacobians, and energies of the two signed singular values.

mod alignment;
mod bounded_dilatation;
mod dirichlet;
mod distance;
mod hessian;
mod jacobian;
mod triangle;
mod untangling;

pub use alignment::{Alignment, DIRECTION_ENERGY, keep_directions};
pub use bounded_dilatation::BoundedDilatation;
pub use dirichlet::SymmetricDirichlet;
pub use distance::{Arap, Asap, Guarded};
pub use hessian::ProjectedHessian;
pub use jacobian::Jacobian;
pub(crate) use triangle::{CHUNK, extremes, smallest_positive_root};
pub use triangle::{
    Triangle, at_corner, is_positive, largest_step, sum_over, triangles, triangles_of,
};
pub use untangling::Untangling;

/// Value, gradient and Hessian of an energy at `(sigma_1, sigma_2)`.
#[derive(Debug, Clone, Copy)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivatives.
    pub d: [f64; 2],
    /// Second derivatives: 11, 12, 22.
    pub dd: [f64; 3],
}

/// An energy per triangle; most grow without bound as the triangle collapses.
pub trait Energy: Sync {
    /// Value at singular values, with `s2 > 0` unless flips are allowed.
    fn value(&self, s1: f64, s2: f64) -> f64;
    /// Value and derivatives.
    fn jet(&self, s1: f64, s2: f64) -> Jet;
    /// Whether flipped triangles have a finite energy too.
    fn allows_flips(&self) -> bool {
        false
    }
}
