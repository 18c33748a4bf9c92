//! Shape of polygons: angles and edge lengths.

use crate::QuadMesh;
use crate::split::corner_positions;
use crate::vector::{cross, dot, norm, sub, unit, vector_area};
use std::collections::BTreeSet;

/// Angles at the corners of polygons, in degrees.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Angles {
    /// The smallest.
    pub min: f64,
    /// The largest; a corner that is not convex has more than 180.
    pub max: f64,
    /// Mean deviation from 90, over all corners.
    pub mean_deviation: f64,
    /// Polygons with a corner that is not convex: folded or worse.
    pub not_convex: usize,
    /// Polygons with an edge that has no length, whose angles there are left out.
    pub degenerate: usize,
}

/// Lengths of edges, each counted once, in mesh units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EdgeLengths {
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
    /// The mean.
    pub mean: f64,
    /// Standard deviation over mean.
    pub variation: f64,
}

impl Angles {
    /// Measures every corner.
    ///
    /// A corner is convex if it turns the way the polygon as a whole does (by its vector area).
    pub fn new<'a>(positions: &[[f64; 3]], polygons: impl Iterator<Item = &'a [u32]>) -> Self {
        let mut angles = Self {
            min: f64::NAN,
            max: f64::NAN,
            mean_deviation: 0.0,
            not_convex: 0,
            degenerate: 0,
        };
        let mut corners = 0usize;
        for polygon in polygons {
            let of_polygon = polygon_angles(&corner_positions(positions, polygon));
            angles.degenerate += usize::from(of_polygon.iter().any(Option::is_none));
            angles.not_convex += usize::from(of_polygon.iter().flatten().any(|&a| a > 180.0));
            for a in of_polygon.into_iter().flatten() {
                // `min` and `max` pass over the NaN they start from.
                angles.min = angles.min.min(a);
                angles.max = angles.max.max(a);
                angles.mean_deviation += (a - 90.0).abs();
                corners += 1;
            }
        }
        angles.mean_deviation /= corners as f64;
        angles
    }
}

/// The largest deviation of a corner from the angle of the regular polygon, degrees, for each polygon; not a
/// number where an edge has no length.
pub fn angle_deviations<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]>,
) -> Vec<f64> {
    let deviation = |polygon: &[u32]| {
        let points = corner_positions(positions, polygon);
        let regular = 180.0 - 360.0 / points.len() as f64;
        let angles = polygon_angles(&points).into_iter();
        angles.map(|a| a.map(|a| (a - regular).abs())).try_fold(0.0, |m: f64, a| Some(m.max(a?)))
    };
    polygons.map(|polygon| deviation(polygon).unwrap_or(f64::NAN)).collect()
}

/// Angle at each corner, degrees between 0 and 360; none where an edge has no length.
fn polygon_angles(points: &[[f64; 3]]) -> Vec<Option<f64>> {
    let n = points.len();
    let edge = |k: usize| unit(sub(points[(k + 1) % n], points[k % n]));
    let normal = vector_area(points);
    (0..n)
        .map(|k| {
            let (out, back) = (edge(k)?, edge(k + n - 1)?.map(|x| -x));
            let turn = cross(out, back);
            let angle = dot(turn, turn).sqrt().atan2(dot(out, back)).to_degrees();
            Some(if dot(turn, normal) < 0.0 { 360.0 - angle } else { angle })
        })
        .collect()
}

impl EdgeLengths {
    /// Measures every edge once.
    pub fn new<'a>(positions: &[[f64; 3]], polygons: impl Iterator<Item = &'a [u32]>) -> Self {
        let mut edges = BTreeSet::new();
        for polygon in polygons {
            for (k, &a) in polygon.iter().enumerate() {
                let b = polygon[(k + 1) % polygon.len()];
                edges.insert((a.min(b), a.max(b)));
            }
        }
        let lengths: Vec<f64> = edges
            .iter()
            .map(|&(a, b)| norm(sub(positions[a as usize], positions[b as usize])))
            .collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let variance = lengths.iter().map(|l| (l / mean - 1.0).powi(2)).sum::<f64>();
        Self {
            min: lengths.iter().copied().fold(f64::NAN, f64::min),
            max: lengths.iter().copied().fold(f64::NAN, f64::max),
            mean,
            variation: (variance / lengths.len() as f64).sqrt(),
        }
    }
}

/// The edge of a square with the area of each quad.
pub fn edge_lengths(mesh: &QuadMesh) -> Vec<f64> {
    let edge = |quad: &[u32; 4]| {
        (0.5 * norm(vector_area(&quad.map(|v| mesh.positions()[v as usize])))).sqrt()
    };
    mesh.quads().iter().map(edge).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angles(points: &[[f64; 2]]) -> Angles {
        let positions: Vec<[f64; 3]> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        let polygon: Vec<u32> = (0..points.len() as u32).collect();
        Angles::new(&positions, std::iter::once(polygon.as_slice()))
    }

    #[test]
    fn deviations_are_from_the_regular_polygon() {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let polygons: [&[u32]; 3] = [&[0, 1, 2, 3], &[0, 1, 2], &[0, 0, 1]];
        let deviations = angle_deviations(&positions, polygons.into_iter());
        assert!(deviations[0] < 1e-12 && (deviations[1] - 30.0).abs() < 1e-12);
        assert!(deviations[2].is_nan());
    }

    #[test]
    fn a_square_and_a_rhombus_by_hand() {
        let square = angles(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert!((square.min - 90.0).abs() < 1e-12 && (square.max - 90.0).abs() < 1e-12);
        let rhombus = angles(&[[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [1.0, 1.0]]);
        assert!((rhombus.min - 45.0).abs() < 1e-12 && (rhombus.max - 135.0).abs() < 1e-12);
        assert!((rhombus.mean_deviation - 45.0).abs() < 1e-12 && rhombus.not_convex == 0);
    }

    #[test]
    fn a_dart_is_not_convex_whichever_way_it_turns() {
        let dart = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
        let mut mirrored = dart;
        mirrored.reverse();
        for points in [dart, mirrored] {
            let a = angles(&points);
            assert!(a.not_convex == 1 && (a.max - 270.0).abs() < 1e-12, "{a:?}");
        }
    }

    #[test]
    fn an_edge_without_length_is_counted() {
        let a = angles(&[[0.0, 0.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert!(a.degenerate == 1 && a.min > 0.0);
    }

    #[test]
    fn edges_are_counted_once() {
        let positions = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let polygons: [&[u32]; 2] = [&[0, 1, 2, 3], &[3, 2, 1, 0]];
        let lengths = EdgeLengths::new(&positions, polygons.into_iter());
        assert!((lengths.mean - 2.0).abs() < 1e-15 && (lengths.variation - 0.5).abs() < 1e-15);
        assert!(lengths.min == 1.0 && lengths.max == 3.0);
    }
}
