//! Vertices at which quads meet in a point only.

use crate::connectivity::QuadConnectivity;

/// Gives every fan of quads a vertex of its own, the first one keeping the old.
///
/// Returns the vertex each new one is a copy of; new ones are numbered from `n_vertices`. Quads that
/// are no manifold along an edge stay as they are.
pub(crate) fn split_pinches(n_vertices: usize, quads: &mut [[u32; 4]]) -> Vec<u32> {
    let Some(fans) = QuadConnectivity::fans_of_corners(n_vertices, quads) else {
        return Vec::new();
    };
    let mut copies = Vec::new();
    let mut number = std::collections::BTreeMap::new();
    for (corner, &fan) in quads.as_flattened_mut().iter_mut().zip(&fans) {
        if fan > 0 {
            let old = *corner;
            *corner = *number.entry((old, fan)).or_insert_with(|| {
                copies.push(old);
                (n_vertices + copies.len() - 1) as u32
            });
        }
    }
    copies
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bow_tie_falls_apart() {
        let mut quads = [[0, 1, 2, 3], [2, 4, 5, 6], [6, 5, 7, 8]];
        assert_eq!(split_pinches(9, &mut quads), [2]);
        assert_eq!(quads, [[0, 1, 2, 3], [9, 4, 5, 6], [6, 5, 7, 8]]);
        assert_eq!(split_pinches(10, &mut quads), [0u32; 0]);
    }
}
