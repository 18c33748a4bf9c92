//! Surfaces with boundary.

use seamstress_mesh::soup::TriangleSoup;
use std::f64::consts::TAU;

/// A disk: the graph of `height` over the square `[-1, 1]²` in `n` by `m` quads, each split along
/// a diagonal.
#[must_use]
pub fn graph(n: u32, m: u32, height: impl Fn(f64, f64) -> f64) -> TriangleSoup {
    assert!(n >= 1 && m >= 1, "a grid needs a quad");
    let coordinate = |i: u32, n: u32| 2.0 * f64::from(i) / f64::from(n) - 1.0;
    let mut positions = Vec::new();
    for j in 0..=m {
        for i in 0..=n {
            let (x, y) = (coordinate(i, n), coordinate(j, m));
            positions.push([x, y, height(x, y)]);
        }
    }
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let mut faces = Vec::new();
    for j in 0..m {
        for i in 0..n {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleSoup { positions, faces }
}

/// The flat square `[-1, 1]²` in `n` by `m` quads.
#[must_use]
pub fn disk_grid(n: u32, m: u32) -> TriangleSoup {
    graph(n, m, |_, _| 0.0)
}

/// The saddle z = x² − y² in `n` by `n` quads.
#[must_use]
pub fn saddle(n: u32) -> TriangleSoup {
    graph(n, n, |x, y| x * x - y * y)
}

/// The monkey saddle z = x³ − 3xy² in `n` by `n` quads.
#[must_use]
pub fn monkey_saddle(n: u32) -> TriangleSoup {
    graph(n, n, |x, y| x * x * x - 3.0 * x * y * y)
}

/// A band closed around the z-axis, `n` ≥ 3 steps around and `m` ≥ 1 rows of quads; `profile`
/// gives radius and height of each of the `m` + 1 rings.
fn band(n: u32, m: u32, profile: impl Fn(f64) -> [f64; 2]) -> TriangleSoup {
    assert!(n >= 3 && m >= 1, "a band needs 3 steps around and a row");
    let mut positions = Vec::new();
    for j in 0..=m {
        let [radius, z] = profile(f64::from(j) / f64::from(m));
        for i in 0..n {
            let angle = TAU * f64::from(i) / f64::from(n);
            positions.push([radius * angle.cos(), radius * angle.sin(), z]);
        }
    }
    let at = |i: u32, j: u32| j * n + i % n;
    let mut faces = Vec::new();
    for j in 0..m {
        for i in 0..n {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleSoup { positions, faces }
}

/// The flat annulus between radius 2 and radius 1, seen from above, in `n` ≥ 3 steps around and
/// `m` ≥ 1 rings.
#[must_use]
pub fn annulus(n: u32, m: u32) -> TriangleSoup {
    band(n, m, |t| [2.0 - t, 0.0])
}

/// The open cylinder of radius 1 and height 1 in `n` ≥ 3 steps around and `m` ≥ 1 rows.
#[must_use]
pub fn cylinder(n: u32, m: u32) -> TriangleSoup {
    band(n, m, |t| [1.0, t])
}

/// `valence` triangles around an apex at `height` above the centre of the unit circle. Closed, a
/// cone of `valence` ≥ 3 corners; open, half a cone whose apex is on the boundary.
#[must_use]
pub fn fan(valence: u32, height: f64, is_closed: bool) -> TriangleSoup {
    assert!(valence >= if is_closed { 3 } else { 1 }, "too few triangles for a fan");
    let n_rim = valence + u32::from(!is_closed);
    let turn = if is_closed { TAU } else { 0.5 * TAU };
    let rim = |i: u32| {
        let angle = turn * f64::from(i) / f64::from(valence);
        [angle.cos(), angle.sin(), 0.0]
    };
    let mut positions = vec![[0.0, 0.0, height]];
    positions.extend((0..n_rim).map(rim));
    let triangle = |i: u32| [0, 1 + i, 1 + (i + 1) % n_rim];
    TriangleSoup { positions, faces: (0..valence).map(triangle).collect() }
}

#[cfg(test)]
mod tests {
    use super::{annulus, cylinder, disk_grid, fan, monkey_saddle, saddle};
    use crate::testing::{sound, topology};

    #[test]
    fn disks() {
        for disk in [disk_grid(1, 1), disk_grid(5, 3), saddle(6), monkey_saddle(6)] {
            assert_eq!(topology(&disk), (1, 0, 1));
        }
        assert_eq!(disk_grid(5, 3).faces.len(), 30);
    }

    #[test]
    fn bands() {
        for shape in [annulus(3, 1), annulus(12, 4), cylinder(3, 1), cylinder(9, 5)] {
            assert_eq!(topology(&shape), (0, 0, 2));
        }
    }

    #[test]
    fn fans_closed_and_open() {
        assert_eq!(topology(&fan(3, 0.5, true)), (1, 0, 1));
        assert_eq!(topology(&fan(6, 0.5, false)), (1, 0, 1));
        let inner = |soup| sound(&soup).n_edges;
        assert_eq!(inner(fan(5, 1.0, true)), 10);
        assert_eq!(inner(fan(5, 1.0, false)), 11);
        assert_eq!(fan(1, 1.0, false).faces.len(), 1);
    }

    #[test]
    fn flat_shapes_look_up() {
        for flat in [disk_grid(4, 4), annulus(7, 2), fan(5, 0.0, true), fan(5, 1.0, false)] {
            for face in &flat.faces {
                let [a, b, c] = face.map(|v| flat.positions[v as usize]);
                assert!((b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]));
            }
        }
    }
}
