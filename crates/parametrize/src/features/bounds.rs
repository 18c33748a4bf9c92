//! Indices that triangles can make.

/// Widest corner that triangles should get, in quarters: 130 degrees, which leave room below a half turn for triangles
/// that are not thin.
pub const QUARTERS_PER_CORNER: f64 = 1.44;

/// Smallest and largest index, in quarters, that an interior vertex of this valence should get: its
/// angle `(4 - k) pi / 2` is a quarter turn at least and less than 130 degrees per corner (a vertex of
/// valence 3 with k = -2 is impossible, and with -1 already costs dearly).
pub fn index_bounds(valence: usize) -> (i32, i32) {
    let most_quarters = (QUARTERS_PER_CORNER * valence as f64).ceil() as i32 - 1;
    (4 - most_quarters.max(1), 3)
}
