//! How layouts are reached.

/// How a layout was reached; the later, the harder the input.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", tag = "kind")]
#[non_exhaustive]
pub enum Route {
    /// The Poisson layout of a field, or local/global iterations from it; it may have flips.
    Poisson,
    /// The isometric layout itself: there was no seam to close.
    Isometric,
    /// As-rigid-as-possible iterations in the exact space.
    Rigid,
    /// The same, and untangling of the triangles it flipped.
    Untangled,
    /// The same, and vertices unwound around which it was wound once too often.
    Unwound,
    /// The barrier homotopy from the isometric layout.
    Barrier,
}

impl std::fmt::Display for Route {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Route::Poisson => "Poisson layout",
            Route::Isometric => "isometric layout",
            Route::Rigid => "rigid layout",
            Route::Untangled => "rigid layout, untangled",
            Route::Unwound => "rigid layout, unwound",
            Route::Barrier => "barrier homotopy",
        })
    }
}
