//! How much memory work is expected to take.

use crate::grid_size::GridSize;
use crate::surface::Surface;
use std::fmt;

/// Bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Memory(pub(crate) u64);

/// The program and small meshes.
const BASE: f64 = 12e6;
/// For each triangle of a map. As measured on 49 meshes of up to 200,000 triangles; nearly all of them took 2.6 to 3.5 kB,
/// one of many handles 5.8 kB, and several components less, one after the other.
const OF_MAP: f64 = 3_500.0;
/// The same of a grid, whose whole numbers are searched for: 4 to 10 kB.
const OF_GRID: f64 = 7_000.0;
/// For each cell of a grid, up to 3 million of them.
const OF_CELL: f64 = 400.0;

impl Memory {
    fn of_grid(triangles: usize, cells: f64) -> Self {
        Self((BASE + OF_GRID * triangles as f64 + OF_CELL * cells) as u64)
    }
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.0 as f64;
        match self.0 {
            0..1_000_000 => write!(f, "{bytes} bytes"),
            1_000_000..1_000_000_000 => write!(f, "{:.0} MB", bytes / 1e6),
            _ => write!(f, "{:.1} GB", bytes / 1e9),
        }
    }
}

impl Surface {
    /// Of a map of this surface, or of another layout of it.
    pub(crate) fn memory_of_map(&self) -> Memory {
        Memory((BASE + OF_MAP * self.faces().len() as f64) as u64)
    }

    /// Of an integer-grid map or quads of about a size.
    pub(crate) fn memory_of_grid(&self, size: GridSize) -> Memory {
        Memory::of_grid(self.faces().len(), size.cells(self.metric().side()))
    }

    /// Of the quads of a map in grid units.
    pub(crate) fn memory_of_cells(&self, corner_uvs: &[[f64; 2]]) -> Memory {
        let area = |uvs: &[[f64; 2]]| match *uvs {
            [a, b, c] => {
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
            }
            _ => 0.0,
        };
        Memory::of_grid(self.faces().len(), corner_uvs.chunks(3).map(area).sum())
    }
}
