//! Feature edges: what has to run along an axis of the map, and the sectors between them.

mod bounds;
mod conflicts;
mod corners;
mod sectors;

pub use bounds::{QUARTERS_PER_CORNER, index_bounds};
pub use conflicts::{ReleaseReason, ReleasedFeature};
pub(crate) use conflicts::{drop_conflicts, release_near, released, widened};
pub use corners::CornerRule;
pub(crate) use sectors::LARGEST_INDEX;
pub use sectors::{Road, Sectors};
