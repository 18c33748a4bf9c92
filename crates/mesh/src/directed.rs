//! Half-edges found by their ends.

/// Half-edges by their ends.
pub(crate) struct Directed {
    /// Where those from each vertex start; one more than there are vertices.
    starts: Vec<u32>,
    /// Tip and half-edge, ascending for each vertex.
    halfedges: Vec<(u32, u32)>,
}

impl Directed {
    /// Of faces whose vertices exist.
    pub(crate) fn new(n_vertices: usize, faces: &[[u32; 3]]) -> Self {
        let mut starts = vec![0u32; n_vertices + 1];
        faces.iter().flatten().for_each(|&v| starts[v as usize + 1] += 1);
        (0..n_vertices).for_each(|v| starts[v + 1] += starts[v]);
        let mut next = starts.clone();
        let mut halfedges = vec![(0, 0); 3 * faces.len()];
        for (h, (from, to)) in
            (0..).zip(faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]))
        {
            halfedges[next[from as usize] as usize] = (to, h);
            next[from as usize] += 1;
        }
        for ends in starts.windows(2) {
            halfedges[ends[0] as usize..ends[1] as usize].sort_unstable();
        }
        Self { starts, halfedges }
    }

    fn from(&self, vertex: u32) -> &[(u32, u32)] {
        &self.halfedges
            [self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }

    /// The half-edge from one vertex to another.
    pub(crate) fn find(&self, from: u32, to: u32) -> Option<u32> {
        let around = self.from(from);
        around.binary_search_by_key(&to, |&(tip, _)| tip).ok().map(|k| around[k].1)
    }

    /// Of the half-edges that run like one before them the first: its ends, and itself.
    pub(crate) fn first_repeated(&self) -> Option<(u32, u32, u32)> {
        let vertices = 0..self.starts.len() as u32 - 1;
        let repeated = vertices.flat_map(|from| {
            let pairs = self.from(from).windows(2);
            pairs.filter(|pair| pair[0].0 == pair[1].0).map(move |pair| (from, pair[1]))
        });
        repeated.map(|(from, (to, h))| (from, to, h)).min_by_key(|&(.., h)| h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_and_one_turned_over() {
        let directed = Directed::new(5, &[[0, 1, 2], [2, 1, 3]]);
        assert_eq!(directed.find(1, 2), Some(1));
        assert_eq!(directed.find(2, 1), Some(3));
        assert_eq!((directed.find(1, 0), directed.find(4, 0)), (None, None));
        assert_eq!(directed.first_repeated(), None);
        let turned = Directed::new(4, &[[0, 1, 2], [3, 1, 2], [2, 0, 3]]);
        assert_eq!(turned.first_repeated(), Some((1, 2, 4)));
    }
}
