//! The unknowns of a solve, cut into pieces that threads can work on side by side.
//!
//! Each group of subtrees is a piece with a vector of its own: its pivots, then its *rim*, the rows that its fronts
//! have in the top of the tree. What the rims gather on the way forwards goes to the top, one piece after the other;
//! on the way back they hold what the top has found. The tree fixes the pieces, so that sums have one order.

use super::forest::{Forest, roots};
use super::symbolic::Symbolic;
use std::ops::Range;

/// The numbers of unknowns within pieces.
pub(super) struct Pieces {
    pub(super) subtrees: Vec<Piece<Range<usize>>>,
    pub(super) top: Piece<Vec<usize>>,
    /// First pivot of each front.
    pub(super) first: Vec<u32>,
    /// Rows of all fronts below their pivots, in the order of the fronts.
    pub(super) rows: Vec<u32>,
}

/// A group of subtrees, or the top of the tree.
pub(super) struct Piece<F> {
    pub(super) fronts: F,
    /// The unknown that each pivot stands for.
    pub(super) unknowns: Vec<u32>,
    /// Where the top has each row of the rim.
    pub(super) rim: Vec<u32>,
    /// Columns of the front that has most.
    pub(super) widest: usize,
}

impl<F> Piece<F> {
    /// Length of its vector.
    pub(super) fn len(&self) -> usize {
        self.unknowns.len() + self.rim.len()
    }
}

impl Pieces {
    pub(super) fn new(symbolic: &Symbolic) -> Self {
        // Solves take as long as it takes to read the factor. The top is solved by one thread: it has to be small.
        const PARTS: f64 = 8.0;
        // Quads that are read in 20 microseconds.
        const LEAST: f64 = 8192.0;
        let (m, parent) = (symbolic.len(), symbolic.parents());
        let size = (0..m).map(|s| symbolic.panels(s..s + 1).len() as f64).collect();
        let Forest { subtrees, top } = Forest::new(&parent, size, PARTS, LEAST);
        let mut numbers = Numbers {
            symbolic,
            of_row: vec![0; symbolic.order.len()],
            first: vec![0; m],
            rows: vec![0; symbolic.row_range(0..m).len()],
        };
        let top_piece = numbers.number(top.iter().copied(), Vec::new());
        let in_top = numbers.of_row.clone();
        let subtrees = subtrees.into_iter().map(|fronts| {
            let roots = roots(&parent, fronts.clone());
            let mut rim: Vec<u32> = roots.flat_map(|s| symbolic.front(s).rows).copied().collect();
            rim.sort_unstable();
            rim.dedup();
            let mut piece = numbers.number(fronts, rim);
            piece.rim.iter_mut().for_each(|row| *row = in_top[*row as usize]);
            piece
        });
        let subtrees = subtrees.collect();
        let Piece { unknowns, rim, widest, .. } = top_piece;
        let top = Piece { fronts: top, unknowns, rim, widest };
        Self { subtrees, top, first: numbers.first, rows: numbers.rows }
    }
}

/// Numbers given to unknowns piece by piece.
struct Numbers<'a> {
    symbolic: &'a Symbolic,
    /// The last number of each row.
    of_row: Vec<u32>,
    first: Vec<u32>,
    rows: Vec<u32>,
}

impl Numbers<'_> {
    /// Numbers the pivots of a piece and then its rim, and with these numbers its fronts.
    fn number<F: Iterator<Item = usize> + Clone>(&mut self, fronts: F, rim: Vec<u32>) -> Piece<F> {
        let symbolic = self.symbolic;
        let pivots = fronts.clone().flat_map(|s| symbolic.pivots(s..s + 1));
        let rows = pivots.clone().chain(rim.iter().map(|&row| row as usize));
        rows.enumerate().for_each(|(number, k)| self.of_row[k] = number as u32);
        let mut widest = 0;
        for s in fronts.clone() {
            let front = symbolic.front(s);
            widest = widest.max(front.columns);
            self.first[s] = self.of_row[front.first];
            let rows = &mut self.rows[symbolic.row_range(s..s + 1)];
            for (number, &row) in rows.iter_mut().zip(front.rows) {
                *number = self.of_row[row as usize];
            }
        }
        let unknowns = pivots.map(|k| symbolic.order[k]).collect();
        Piece { fronts, unknowns, rim, widest }
    }
}
