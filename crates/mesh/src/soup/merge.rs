//! Polygons after their vertices are merged, without corners that say nothing.

use super::repair::Repair;

/// Polygons with fewer vertices, and how they came from those given.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Merged {
    /// Positions of the vertices that are merged into none, in their order.
    pub positions: Vec<[f64; 3]>,
    /// The polygons that are left, in their order.
    pub polygons: Vec<Vec<u32>>,
    /// For each vertex the one that it was.
    pub vertex_origin: Vec<u32>,
    /// For each polygon the one that it was.
    pub polygon_origin: Vec<u32>,
    /// Polygons that lost corners, and those that are gone.
    pub repairs: Vec<Repair>,
}

/// Merges vertices of polygons, `into[v]` being what vertex `v` becomes, and leaves out corners that
/// say nothing: a repeated one after itself, and the tip between a corner and itself. Polygons of
/// fewer than three corners are dropped. All vertices must exist.
#[must_use]
pub fn merge<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]>,
    into: &[u32],
) -> Merged {
    let vertex_origin: Vec<u32> =
        into.iter().zip(0u32..).filter(|(into, v)| **into == *v).map(|(_, v)| v).collect();
    let mut renamed = vec![0; into.len()];
    for (&origin, v) in vertex_origin.iter().zip(0u32..) {
        renamed[origin as usize] = v;
    }
    let mut merged = Merged {
        positions: vertex_origin.iter().map(|&v| positions[v as usize]).collect(),
        polygons: Vec::new(),
        vertex_origin,
        polygon_origin: Vec::new(),
        repairs: Vec::new(),
    };
    for (polygon, face) in polygons.zip(0u32..) {
        let corners = reduced(polygon.iter().map(|&v| renamed[into[v as usize] as usize]));
        if corners.len() < 3 {
            merged.repairs.push(Repair::DroppedDegenerateFace { face });
            continue;
        }
        if corners.len() < polygon.len() {
            merged.repairs.push(Repair::ReducedFace { face, corners: corners.len() });
        }
        merged.polygons.push(corners);
        merged.polygon_origin.push(face);
    }
    merged
}

/// A cycle of corners without steps from a corner to itself, and without steps there and back.
fn reduced(corners: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut kept: Vec<u32> = Vec::new();
    for corner in corners {
        match kept[..] {
            [.., last] if last == corner => {}
            [.., before, _] if before == corner => {
                kept.pop();
            }
            _ => kept.push(corner),
        }
    }
    // The same across the place where the cycle closes.
    let mut start = 0;
    loop {
        match kept[start..] {
            [first, .., last] if first == last => {
                kept.pop();
            }
            [first, .., before, _] if first == before => {
                kept.pop();
            }
            [_, second, .., last] if second == last => start += 1,
            _ => return kept.split_off(start),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle(corners: &[u32]) -> Vec<u32> {
        reduced(corners.iter().copied())
    }

    #[test]
    fn corners_that_say_nothing_are_left_out() {
        assert_eq!(cycle(&[0, 1, 2, 3]), [0, 1, 2, 3]);
        assert_eq!(cycle(&[0, 1, 1, 2]), [0, 1, 2]);
        assert_eq!(cycle(&[0, 1, 2, 0]), [0, 1, 2]);
        assert_eq!(cycle(&[0, 1, 2, 1]).len(), 2, "nothing but a step there and back");
        assert_eq!(cycle(&[0, 1, 2, 3, 2]), [0, 1, 2], "3 is a tip");
        assert_eq!(cycle(&[3, 2, 0, 1, 2]), [2, 0, 1], "also where the cycle closes");
        assert_eq!(cycle(&[2, 0, 1, 2, 3]), [2, 0, 1]);
        assert_eq!(cycle(&[4, 3, 2, 0, 1, 2, 3]), [2, 0, 1], "a tip of two steps");
        assert_eq!(cycle(&[5, 5, 5]).len(), 1);
        assert_eq!(cycle(&[0, 1, 2, 0, 3, 4]).len(), 6, "two triangles that touch stay");
    }

    #[test]
    fn vertices_and_polygons_are_renamed() {
        let positions = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|x| [x, x * x, 0.0]);
        let polygons: [&[u32]; 3] = [&[0, 1, 2], &[1, 2, 3, 5], &[2, 1, 4]];
        let merged = merge(&positions, polygons.into_iter(), &[0, 1, 1, 3, 4, 5]);
        assert_eq!(merged.vertex_origin, [0, 1, 3, 4, 5]);
        assert_eq!(merged.positions[2], positions[3]);
        assert_eq!(merged.polygons, [[1, 2, 4]]);
        assert_eq!(merged.polygon_origin, [1]);
        let expected = [
            Repair::DroppedDegenerateFace { face: 0 },
            Repair::ReducedFace { face: 1, corners: 3 },
            Repair::DroppedDegenerateFace { face: 2 },
        ];
        assert_eq!(merged.repairs, expected);
    }
}
