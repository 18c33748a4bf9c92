//! Where the layouts of the components stand in the plane.

use seamstress_mesh::{Component, Face, TriMesh};

/// Room between components side by side, as a part of the width of the left one: enough to tell them apart.
const MARGIN: f64 = 0.02;
/// A component smaller than this part of the largest one stands before it, nearer to the origin. Doubles are
/// the coarser the farther from it: among components of similar sizes, in whatever order, this costs up to 10
/// of their 53 bits, while a component of the size of the rounding of another would have none left.
const SMALL: f64 = 1.0 / 1024.0;

/// The UVs of all components, each given by its own with the lower left corner of its box at zero, side by
/// side from the origin: small ones first, the smallest nearest, then the others in the order of their first
/// faces.
///
/// What stands before a small component is smaller, so that it keeps all digits but those that count the
/// components.
pub(super) fn side_by_side(
    mesh: &TriMesh,
    pieces: &[Component],
    layouts: &[Vec<[f64; 2]>],
) -> Vec<[f64; 2]> {
    let sizes: Vec<f64> = layouts.iter().map(|uvs| size(uvs)).collect();
    let mut all = vec![[0.0; 2]; mesh.n_halfedges()];
    let mut left_edge = 0.0;
    for k in order(&sizes) {
        left_edge = place(&pieces[k], &layouts[k], left_edge, &mut all);
    }
    all
}

/// The larger side of the box of a layout that begins at zero.
fn size(uvs: &[[f64; 2]]) -> f64 {
    uvs.iter().flatten().fold(0.0, |size, x| size.max(*x))
}

/// The components from left to right.
fn order(sizes: &[f64]) -> Vec<usize> {
    let limit = SMALL * sizes.iter().fold(0.0, |largest: f64, x| largest.max(*x));
    let (mut small, others): (Vec<usize>, Vec<usize>) =
        (0..sizes.len()).partition(|&k| sizes[k] < limit);
    small.sort_by(|&a, &b| sizes[a].total_cmp(&sizes[b]));
    small.extend(others);
    small
}

/// Moves a component's UVs to the right of what stands there; returns the left edge of the next one.
fn place(piece: &Component, uvs: &[[f64; 2]], left_edge: f64, all: &mut [[f64; 2]]) -> f64 {
    let mut right_edge = left_edge;
    for (i, &Face(f)) in piece.faces.iter().enumerate() {
        for k in 0..3 {
            let [u, v] = uvs[3 * i + k];
            all[3 * f as usize + k] = [u + left_edge, v];
            right_edge = right_edge.max(u + left_edge);
        }
    }
    left_edge + (right_edge - left_edge) * (1.0 + MARGIN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_components_stand_first() {
        assert_eq!(order(&[]), [0; 0]);
        assert_eq!(order(&[2.0]), [0]);
        // Of similar sizes: as they come.
        assert_eq!(order(&[1.0, 0.01, 3.0, 0.5]), [0, 1, 2, 3]);
        assert_eq!(order(&[1.0, 1e-6, 3.0, 1e-15, 1e-6, 0.5]), [3, 1, 4, 0, 2, 5]);
    }
}
