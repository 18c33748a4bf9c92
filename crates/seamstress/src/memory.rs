//! Estimates of memory.

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
    /// Of a map with so many triangles.
    pub(crate) fn of_map(triangles: usize) -> Self {
        Self((BASE + OF_MAP * triangles as f64) as u64)
    }

    /// Of a grid on so many triangles.
    pub(crate) fn of_grid(triangles: usize, cells: f64) -> Self {
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
