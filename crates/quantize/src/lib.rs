//! Integer-grid maps: seamless maps whose unit grid closes up over the surface (quantization).
//!
//! [`quantize`] rounds a certified seamless map. Per component it
//!
//! 1. reads the map as a layout in the exact space of integer-grid maps (`space`): the translations of chains, the
//!    cones, and of aligned edges their corners and isolines, as exact functions of free integer coordinates
//!    (`lattice`);
//! 2. reduces the energy to a quadratic function of those coordinates alone (`energy`);
//! 3. finds the lines between cones or isolines that may not collapse (`connections`, `rays`, `obstacles`);
//! 4. searches (`search`): rounds to the nearest integers in that energy that keep them (`rounding`), moves the layout
//!    there without a flip (`path`), and where it cannot go, learns from the collapsing triangles what other integers
//!    have to satisfy (`farkas`);
//! 5. writes doubles that fit to the last bit (`snap`).
//!
//! [`IntegerGridMap::certify`] is the only door to an integer-grid map.

#![allow(unreachable_pub, reason = "modules are private; tests see some through `internals`")]
#![cfg_attr(not(feature = "internals"), allow(dead_code))]

mod base;
mod certificate;
mod connections;
mod energy;
mod error;
mod faces;
mod farkas;
mod gauss;
mod isolines;
mod lattice;
mod layout;
mod linear;
mod obstacles;
mod options;
mod path;
mod quantize;
mod rays;
mod rounding;
mod scene;
mod search;
mod snap;
mod space;
mod stats;
mod stretches;
mod walk;

pub use certificate::IntegerGridMap;
pub use error::{QuantizationFailure, QuantizeError, Refusal};
pub use gauss::Overflow;
pub use options::{GridSize, QuantizeOptions, RoundingMethod};
pub use quantize::{Quantization, quantize, quantize_deciding};
pub use search::Decisions;
pub use stats::QuantizationStats;

/// What tests of this workspace look at; no promise is made of it.
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod internals {
    pub use crate::gauss::{Form, Gauss, add_scaled};
    pub use crate::isolines::turning_points;
    pub use crate::lattice::Lattice;
    pub use crate::space::{GridNeeds, IntegerSpace};
}
