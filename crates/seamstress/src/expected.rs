//! What work on a surface is expected to take.

use crate::grid_size::GridSize;
use crate::memory::Memory;
use crate::surface::Surface;
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
    fn of_map(triangles: usize) -> Self {
        let time = Duration::from_secs_f64(OF_MAP * triangles as f64);
        Self { memory: Memory::of_map(triangles), time }
    }

    fn of_grid(triangles: usize, cells: f64) -> Self {
        let seconds = OF_GRID * triangles as f64 + OF_CELL * cells;
        // Cells without number are refused later, with their reason.
        let time = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        Self { memory: Memory::of_grid(triangles, cells), time }
    }
}

impl Surface {
    /// For a map of this surface, or another layout of it.
    pub(crate) fn expected_for_map(&self) -> Expected {
        Expected::of_map(self.faces().len())
    }

    /// For an integer-grid map or quads of about a size.
    pub(crate) fn expected_for_grid(&self, size: GridSize) -> Expected {
        Expected::of_grid(self.faces().len(), size.cells(self.metric().side()))
    }

    /// For the quads of a map in grid units.
    pub(crate) fn expected_for_cells(&self, corner_uvs: &[[f64; 2]]) -> Expected {
        let area = |uvs: &[[f64; 2]]| match *uvs {
            [a, b, c] => {
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
            }
            _ => 0.0,
        };
        Expected::of_grid(self.faces().len(), corner_uvs.chunks(3).map(area).sum())
    }
}
