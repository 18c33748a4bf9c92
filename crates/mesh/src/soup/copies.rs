//! Polygons that are given twice.

use std::collections::HashMap;

/// A polygon with the corners of an earlier one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Copy {
    /// The first with these corners.
    pub(super) first: u32,
    /// Whether it goes around them the other way.
    pub(super) reversed: bool,
}

/// Among polygons of more than three corners, all different, those that go around the corners of an
/// earlier one: the same way, or the other way with a side of more than two polygons.
pub(super) fn copies(polygons: &[&[u32]]) -> HashMap<u32, Copy> {
    let larger = polygons.iter().zip(0u32..).filter(|(polygon, _)| polygon.len() > 3);
    let mut keys: Vec<(u64, u32)> = larger.map(|(polygon, id)| (digest(polygon), id)).collect();
    keys.sort_unstable();
    let mut copies = HashMap::new();
    for alike in keys.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1) {
        let mut firsts = HashMap::new();
        for &(_, id) in alike {
            let (cycle, turned) = canonical(polygons[id as usize]);
            let &mut (first, first_turned) = firsts.entry(cycle).or_insert((id, turned));
            if first != id {
                copies.insert(id, Copy { first, reversed: turned != first_turned });
            }
        }
    }
    if copies.values().any(|copy| copy.reversed) {
        let crowded = crowded(polygons);
        copies.retain(|&id, copy| !copy.reversed || crowded[id as usize]);
    }
    copies
}

/// The same for all polygons of the same corners in any order.
fn digest(polygon: &[u32]) -> u64 {
    /// The odd number next to 2^64 over the golden ratio, which spreads small numbers.
    const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;
    let spread = |v: u32| {
        let x = u64::from(v).wrapping_add(1).wrapping_mul(SPREAD);
        (x ^ (x >> 32)).wrapping_mul(SPREAD)
    };
    polygon.iter().fold(0, |sum: u64, &v| sum.wrapping_add(spread(v)))
}

/// A cycle from its smallest corner on towards the smaller neighbour, and whether that is backwards.
fn canonical(polygon: &[u32]) -> (Vec<u32>, bool) {
    let n = polygon.len();
    let start = (0..n).min_by_key(|&i| polygon[i]).unwrap_or(0);
    let turned = polygon[(start + n - 1) % n] < polygon[(start + 1) % n];
    let step = if turned { n - 1 } else { 1 };
    ((0..n).map(|i| polygon[(start + i * step) % n]).collect(), turned)
}

/// Which polygons have a side that more than two share.
fn crowded(polygons: &[&[u32]]) -> Vec<bool> {
    let mut sides = Vec::new();
    for (polygon, id) in polygons.iter().zip(0u32..) {
        let next = polygon.iter().cycle().skip(1);
        sides.extend(polygon.iter().zip(next).map(|(&a, &b)| ([a.min(b), a.max(b)], id)));
    }
    sides.sort_unstable();
    let mut crowded = vec![false; polygons.len()];
    for side in sides.chunk_by(|a, b| a.0 == b.0).filter(|side| side.len() > 2) {
        for &(_, id) in side {
            crowded[id as usize] = true;
        }
    }
    crowded
}
