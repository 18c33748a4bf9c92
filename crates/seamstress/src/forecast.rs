//! Estimates of memory and time, from sizes alone.

use crate::memory::Memory;
use std::time::Duration;

/// Estimates before the work begins, for default options.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Expected {
    pub(crate) memory: Memory,
    /// On one thread.
    pub(crate) time: Duration,
}

/// Seconds for each triangle of a map: 20 to 48 millionths on meshes of a thousand to a million triangles, on a server of
/// 2025.
const OF_MAP: f64 = 3.5e-5;
/// The same of a grid: 1e-4 to 2e-4; with many features up to 1e-3.
const OF_GRID: f64 = 1.3e-4;
/// For each cell of a grid.
const OF_CELL: f64 = 8e-6;

impl Expected {
    /// For a map of so many triangles.
    pub(crate) fn of_map(triangles: usize) -> Self {
        let time = Duration::from_secs_f64(OF_MAP * triangles as f64);
        Self { memory: Memory::of_map(triangles), time }
    }

    /// For a grid on so many triangles.
    pub(crate) fn of_grid(triangles: usize, cells: f64) -> Self {
        let seconds = OF_GRID * triangles as f64 + OF_CELL * cells;
        // Cells without number are refused later, with their reason.
        let time = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        Self { memory: Memory::of_grid(triangles, cells), time }
    }
}
