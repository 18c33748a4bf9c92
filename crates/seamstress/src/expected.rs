//! How much memory work on a surface is expected to take.

use crate::grid_size::GridSize;
use crate::memory::Memory;
use crate::surface::Surface;

impl Surface {
    /// Of a map of this surface, or of another layout of it.
    pub(crate) fn memory_of_map(&self) -> Memory {
        Memory::of_map(self.faces().len())
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
