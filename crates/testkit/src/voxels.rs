//! Surfaces of unions of unit cubes: any genus, right angles only.

use seamstress_mesh::soup::TriangleSoup;
use std::collections::{BTreeMap, BTreeSet};

/// The surface of a union of unit cubes, given by their lowest corners; every square of it is
/// split along a diagonal.
///
/// Cubes that touch in an edge or a corner alone make the surface non-manifold there.
#[must_use]
pub fn voxel_surface(cells: &[[i32; 3]]) -> TriangleSoup {
    let solid: BTreeSet<[i32; 3]> = cells.iter().copied().collect();
    let mut soup = TriangleSoup::default();
    let mut vertices = BTreeMap::new();
    for &cell in &solid {
        for axis in 0..3 {
            for is_high in [false, true] {
                let mut beyond = cell;
                beyond[axis] += if is_high { 1 } else { -1 };
                if solid.contains(&beyond) {
                    continue;
                }
                let [a, b, c, d] = square(cell, axis, is_high).map(|corner| {
                    *vertices.entry(corner).or_insert_with(|| {
                        soup.positions.push(corner.map(f64::from));
                        soup.positions.len() as u32 - 1
                    })
                });
                soup.faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    soup
}

/// Corners of one side of a cell, counter-clockwise seen from outside.
fn square(cell: [i32; 3], axis: usize, is_high: bool) -> [[i32; 3]; 4] {
    let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |steps: [i32; 2]| {
        let mut p = cell;
        p[axis] += i32::from(is_high);
        p[right] += steps[0];
        p[up] += steps[1];
        p
    };
    let around = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let clockwise = [[0, 0], [0, 1], [1, 1], [1, 0]];
    (if is_high { around } else { clockwise }).map(corner)
}

/// A closed surface of genus `g`: a slab one unit high and three wide with `g` square holes in a
/// row.
#[must_use]
pub fn slab_with_holes(g: u32) -> TriangleSoup {
    let length = 2 * g.cast_signed() + 1;
    let cells = (0..length).flat_map(|x| (0..3).map(move |y| [x, y, 0]));
    let is_hole = |cell: &[i32; 3]| cell[0] % 2 == 1 && cell[1] == 1;
    voxel_surface(&cells.filter(|cell| !is_hole(cell)).collect::<Vec<_>>())
}

/// A closed surface of genus 2.
#[must_use]
pub fn double_torus() -> TriangleSoup {
    slab_with_holes(2)
}

/// An L of two arms, each three units long, one wide and two deep: all edges sharp, one of them
/// concave.
#[must_use]
pub fn l_bracket() -> TriangleSoup {
    let arms = [[0, 0], [1, 0], [2, 0], [0, 1], [0, 2]];
    let cells = arms.iter().flat_map(|&[x, z]| (0..2).map(move |y| [x, y, z]));
    voxel_surface(&cells.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::{double_torus, l_bracket, slab_with_holes, voxel_surface};
    use crate::testing::{six_volumes, topology};
    use seamstress_mesh::soup::{Fault, check};

    #[test]
    fn slabs_have_as_many_handles_as_holes() {
        for g in 0..5u32 {
            let slab = slab_with_holes(g);
            assert_eq!(topology(&slab), (2 - 2 * i64::from(g), g as usize, 0));
            // 3 (2g + 1) cells less g.
            assert_eq!(six_volumes(&slab), 6.0 * f64::from(5 * g + 3));
        }
        assert_eq!(double_torus(), slab_with_holes(2));
    }

    #[test]
    fn a_bracket_of_ten_cells() {
        let bracket = l_bracket();
        assert_eq!(topology(&bracket), (2, 0, 0));
        assert_eq!(six_volumes(&bracket), 60.0);
        // Seen from the sides: 2 × 5 squares; around: 12 steps, 2 deep.
        assert_eq!(bracket.faces.len(), 2 * (10 + 24));
    }

    #[test]
    fn cubes_that_touch_in_an_edge_are_not_manifold() {
        let faults = check(&voxel_surface(&[[0, 0, 0], [1, 1, 0]])).faults;
        let is_edge = |fault: &Fault| matches!(fault, Fault::NonManifoldEdge { faces, .. } if faces.len() == 4);
        assert_eq!(faults.iter().filter(|fault| is_edge(fault)).count(), 1);
        let faults = check(&voxel_surface(&[[0, 0, 0], [1, 1, 1]])).faults;
        assert!(matches!(faults[..], [Fault::NonManifoldVertex { fans: 2, .. }]));
    }
}
