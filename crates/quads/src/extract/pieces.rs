//! Pieces: what a face and a cell of the grid have in common.

use super::error::ExtractError;
use super::fixed::{Point, Unit};
use super::snap::GridMap;
use super::sweep::{cells_in_row, rows};
use seamstress_mesh::{Face, TriMesh};
use seamstress_parallel::prelude::*;
use std::ops::Range;

/// The most pieces; some gigabytes are needed for as many.
const MOST_PIECES: u64 = 1 << 27;

/// Pieces of all faces, numbered face by face and row by row.
///
/// A face of positive area has a piece for every cell whose inside meets its own; a collapsed one for
/// every cell it passes through.
pub(super) struct Pieces {
    /// Where the rows of a face start; one more at the end.
    rows_of_face: Vec<u32>,
    /// The lowest row of a face.
    lowest: Vec<i64>,
    /// One more at the end.
    rows: Vec<Row>,
}

/// Neighbouring pieces of one face, from left to right.
struct Row {
    /// Number of the first cell.
    first: i64,
    /// Number of the first piece.
    base: u32,
}

impl Pieces {
    /// # Errors
    /// [`ExtractError::TooFine`].
    pub(super) fn new(mesh: &TriMesh, map: &GridMap) -> Result<Self, ExtractError> {
        let limit = |pieces: u64| match pieces {
            0..=MOST_PIECES => Ok(pieces),
            _ => Err(ExtractError::TooFine { pieces, limit: MOST_PIECES }),
        };
        let faces: Vec<Face> = mesh.faces().collect();
        let row_ranges: Vec<Range<i64>> =
            faces.par_iter().map(|&f| rows(map.unit, &map.triangle(f))).collect();
        limit(row_ranges.iter().map(|r| (r.end - r.start) as u64).sum())?;
        let cells: Vec<Vec<Range<i64>>> = faces
            .par_iter()
            .zip(&row_ranges)
            .map(|(&f, rows)| cells_of_rows(map.unit, &map.triangle(f), rows))
            .collect();
        limit(cells.iter().flatten().map(|r| (r.end - r.start) as u64).sum())?;
        let mut pieces = Self {
            rows_of_face: Vec::with_capacity(faces.len() + 1),
            lowest: row_ranges.iter().map(|r| r.start).collect(),
            rows: Vec::new(),
        };
        let mut base = 0;
        for rows in cells {
            pieces.rows_of_face.push(pieces.rows.len() as u32);
            for row in rows {
                pieces.rows.push(Row { first: row.start, base });
                base += (row.end - row.start) as u32;
            }
        }
        pieces.rows_of_face.push(pieces.rows.len() as u32);
        pieces.rows.push(Row { first: 0, base });
        Ok(pieces)
    }

    /// Number of pieces.
    pub(super) fn count(&self) -> usize {
        self.rows.last().map_or(0, |row| row.base as usize)
    }

    /// The piece of a face in a cell.
    pub(super) fn get(&self, face: Face, [i, j]: [i64; 2]) -> Option<u32> {
        let [start, end] = [face.at(), face.at() + 1].map(|f| self.rows_of_face[f] as usize);
        let row = usize::try_from(j - self.lowest[face.at()]).ok()?;
        if row >= end - start {
            return None;
        }
        let (row, next) = (&self.rows[start + row], &self.rows[start + row + 1]);
        let column = u32::try_from(i - row.first).ok()?;
        (column < next.base - row.base).then_some(row.base + column)
    }

    /// The pieces of a face with their cells.
    pub(super) fn of_face(&self, face: Face) -> impl Iterator<Item = (u32, [i64; 2])> + '_ {
        let [start, end] = [face.at(), face.at() + 1].map(|f| self.rows_of_face[f] as usize);
        let lowest = self.lowest[face.at()];
        (start..end).flat_map(move |at| {
            let (row, next) = (&self.rows[at], &self.rows[at + 1]);
            let j = lowest + (at - start) as i64;
            (row.base..next.base).map(move |p| (p, [row.first + i64::from(p - row.base), j]))
        })
    }
}

fn cells_of_rows(unit: Unit, triangle: &[Point; 3], rows: &Range<i64>) -> Vec<Range<i64>> {
    rows.clone().map(|row| cells_in_row(unit, triangle, row)).collect()
}
