//! What work on a surface is expected to take.

use crate::forecast::Expected;
use crate::grid_size::GridSize;
use crate::surface::Surface;

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
