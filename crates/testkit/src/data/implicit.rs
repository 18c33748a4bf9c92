//! Surfaces where a function of space vanishes, by naive surface nets (after Gibson 1998).

use super::PolygonSoup;
use std::collections::BTreeMap;

/// The surface around the points where `f` is positive, as quads, over the cells of a cubic grid with
/// `n` points a side that fills the cube from -1 to 1.
pub(crate) fn surface(n: i32, f: impl Fn([f64; 3]) -> f64) -> PolygonSoup {
    let point = |p: [i32; 3]| p.map(|k| 2.0 * f64::from(k) / f64::from(n - 1) - 1.0);
    let value = |p: [i32; 3]| f(point(p));
    let mut soup = PolygonSoup::default();
    let mut numbers = BTreeMap::new();
    for z in 0..n {
        for y in 0..n {
            for x in 0..n {
                let from = [x, y, z];
                for axis in 0..3 {
                    let mut to = from;
                    to[axis] += 1;
                    if to[axis] == n || (value(from) > 0.0) == (value(to) > 0.0) {
                        continue;
                    }
                    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                    let cell = |back: [i32; 2]| {
                        let mut cell = from;
                        cell[b] -= back[0];
                        cell[c] -= back[1];
                        cell
                    };
                    let mut quad = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|back| {
                        let cell = cell(back);
                        *numbers.entry(cell).or_insert_with(|| {
                            soup.positions.push(crossing(cell, point, value));
                            soup.positions.len() as u32 - 1
                        })
                    });
                    if value(to) > 0.0 {
                        quad.reverse();
                    }
                    soup.polygons.push(quad.to_vec());
                }
            }
        }
    }
    soup
}

/// The mean of the points where the edges of a cell leave the inside.
fn crossing(
    cell: [i32; 3],
    point: impl Fn([i32; 3]) -> [f64; 3],
    value: impl Fn([i32; 3]) -> f64,
) -> [f64; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for axis in 0..3 {
        for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let mut from = cell;
            from[(axis + 1) % 3] += i;
            from[(axis + 2) % 3] += j;
            let mut to = from;
            to[axis] += 1;
            let (a, b) = (value(from), value(to));
            if (a > 0.0) == (b > 0.0) {
                continue;
            }
            let (t, p, q) = (a / (a - b), point(from), point(to));
            (0..3).for_each(|k| sum[k] += p[k] + t * (q[k] - p[k]));
            count += 1.0;
        }
    }
    sum.map(|x| x / count)
}
