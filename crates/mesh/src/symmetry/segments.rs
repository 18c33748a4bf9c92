//! The segment nearest to a point.

use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};

/// Segments of space that can be searched.
#[derive(Debug)]
pub struct Segments(RTree<GeomWithData<Line<[f64; 3]>, usize>>);

impl Segments {
    /// By their ends.
    pub fn new(segments: impl IntoIterator<Item = [[f64; 3]; 2]>) -> Self {
        let lines = segments.into_iter().map(|[a, b]| Line::new(a, b)).enumerate();
        Self(RTree::bulk_load(lines.map(|(k, line)| GeomWithData::new(line, k)).collect()))
    }

    /// The number of the one nearest to a point, and its distance.
    #[must_use]
    pub fn nearest(&self, at: [f64; 3]) -> Option<(usize, f64)> {
        let nearest = self.0.nearest_neighbor(at)?;
        Some((nearest.data, nearest.distance_2(&at).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_of_three() {
        let ends = [[[0.0; 3], [2.0, 0.0, 0.0]], [[0.0, 1.0, 0.0], [2.0, 1.0, 0.0]], [[5.0; 3]; 2]];
        let segments = Segments::new(ends);
        assert_eq!(segments.nearest([1.0, 0.25, 0.0]), Some((0, 0.25)));
        assert_eq!(segments.nearest([3.0, 1.0, 0.0]), Some((1, 1.0)));
        assert_eq!(Segments::new([]).nearest([0.0; 3]), None);
    }
}
