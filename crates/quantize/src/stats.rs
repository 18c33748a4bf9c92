//! How an integer-grid map was made.

/// How the integer-grid map of one component was made.
#[derive(Debug, Clone, Default, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuantizationStats {
    /// Faces.
    pub faces: usize,
    /// Real integer unknowns.
    pub integers: usize,
    /// Displacements of cones, isolines and sides of faces that were constrained.
    pub constraints: usize,
    /// Infeasibility cuts learned, over all grids.
    pub cuts: usize,
    /// Grids tried.
    pub grids: usize,
    /// Roundings, over all grids; the work that is bounded.
    pub roundings: usize,
    /// Those of them in which connections that were hard to keep came first the second time.
    pub second_roundings: usize,
    /// Those of them in which violated constraints were repaired at the cost of energy.
    pub repairs: usize,
    /// Moves that carried the layout to the integers.
    pub moves: usize,
    /// Newton iterations after that.
    pub polish: usize,
    /// Edge length of a cell, mesh units.
    pub cell: f64,
    /// By how many factors of 1.1 the number of cells is larger than on the grid asked for, because no map was found
    /// there.
    pub refinements: usize,
    /// Why the first grid would not do, if so.
    pub refined_because: Option<String>,
    /// Area in the plane, grid units.
    pub quads: f64,
    /// Seconds for reading the map and reducing the energy to the integers.
    pub seconds_reduction: f64,
    /// Seconds for rounding, over all grids tried.
    pub seconds_rounding: f64,
    /// Seconds for moving the layout to the integers, over all grids tried.
    pub seconds_moving: f64,
    /// Seconds for the polish.
    pub seconds_polish: f64,
}
