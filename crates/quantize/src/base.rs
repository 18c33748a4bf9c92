//! The vertex that a wedge lies at.

/// What a wedge's position depends on besides the integral variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Base {
    /// `i^turns` times the position of an ordinary vertex.
    Ordinary {
        /// Its number among the ordinary vertices.
        vertex: u32,
        /// Quarter turns.
        turns: i32,
    },
    /// Nothing: the wedge is at a grid point, or at the vertex that is held at the origin.
    Fixed,
}
