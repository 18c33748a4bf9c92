//! Feature edges: what has to run along an axis of the map, and the sectors between them.

mod conflicts;
mod edges;
mod sectors;

pub use conflicts::{ReleaseReason, ReleasedFeature};
pub(crate) use conflicts::{dihedral_angles, drop_conflicts, release_near};
pub use edges::{FeatureEdges, FeatureError};
pub use sectors::{Road, Sectors};
