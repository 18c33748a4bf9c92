//! Feature edges: what has to run along an axis of the map.

mod edges;

pub use edges::{FeatureEdges, FeatureError};
