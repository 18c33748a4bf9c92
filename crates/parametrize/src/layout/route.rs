//! How layouts are reached.

/// How a layout was reached; the later, the harder the input.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Route {
    /// The Poisson layout of a field, or local/global iterations from it; it may have flips.
    Poisson,
    /// The isometric layout itself: there was no seam to close.
    Isometric,
    /// As-rigid-as-possible iterations in the exact space.
    Rigid,
    /// The same, and untangling of the few triangles it flipped.
    Untangled,
    /// The barrier homotopy from the isometric layout.
    Barrier,
    /// The lifted continuation from the isometric layout.
    Continuation,
    /// The lifted continuation over a dual tree that avoids what the matchings move.
    Retreed,
    /// The routes before in the snowflake metric with this exponent, then back to the metric asked for.
    Snowflake {
        /// Exponent of the lengths.
        exponent: f64,
    },
}

impl std::fmt::Display for Route {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Route::Poisson => f.write_str("Poisson layout"),
            Route::Isometric => f.write_str("isometric layout"),
            Route::Rigid => f.write_str("rigid layout"),
            Route::Untangled => f.write_str("rigid layout, untangled"),
            Route::Barrier => f.write_str("barrier homotopy"),
            Route::Continuation => f.write_str("lifted continuation"),
            Route::Retreed => f.write_str("lifted continuation over a new tree"),
            Route::Snowflake { exponent } => write!(f, "snowflake metric with exponent {exponent}"),
        }
    }
}
