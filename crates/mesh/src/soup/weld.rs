//! Vertices in one place, or nearly, and which of them are to be one.

use super::geometry::is_finite;
use super::sets::SignedSets;
use crate::vector::{norm, sub};
use rstar::RTree;
use rstar::primitives::GeomWithData;
use std::collections::HashMap;

/// Share of the vertices that more than one polygon of a soup may use.
const SHARED_IN_SOUP: f64 = 0.1;

/// Distances leave a gap where one is this many times the next smaller: copies of one vertex are on
/// its lower side, neighbours on its upper one.
const GAP: f64 = 25.0;

/// Share of the sides of polygons that the automatic tolerance may be longer than.
const SHORT_SIDES: f64 = 0.01;

/// A tolerance joins as many sides as another if it joins this share of theirs.
const AS_GOOD: f64 = 0.999;

type Placed = GeomWithData<[f64; 3], u32>;

/// Whether polygons share next to no vertices, as in files that give every polygon corners of its
/// own.
pub fn is_unwelded<'a>(n_vertices: usize, polygons: impl Iterator<Item = &'a [u32]>) -> bool {
    const ONE: u8 = 1;
    const MORE: u8 = 2;
    let (mut uses, mut n_polygons) = (vec![0u8; n_vertices], 0);
    for polygon in polygons {
        n_polygons += 1;
        for &v in polygon {
            if let Some(count) = uses.get_mut(v as usize) {
                *count = (*count + 1).min(MORE);
            }
        }
    }
    let used = uses.iter().filter(|&&count| count >= ONE).count();
    let shared = uses.iter().filter(|&&count| count == MORE).count();
    n_polygons > 1 && shared as f64 <= SHARED_IN_SOUP * used as f64
}

/// The distance within which vertices are copies of one, judged by the distances themselves: 0 where
/// exact copies are all there are.
///
/// A tolerance is tried in every gap of the distances (of vertices from the nearest in another
/// place, and along sides). Of those that join the most pairs of sides it is the smallest. It is
/// longer than next to no side, so that what it merges is noise.
#[must_use]
pub fn weld_tolerance<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]> + Clone,
) -> f64 {
    let cloud = Cloud::new(positions);
    let place = |v: u32| cloud.place(v);
    let mut sides: Vec<f64> = polygons
        .clone()
        .flat_map(|polygon| polygon.iter().zip(polygon.iter().cycle().skip(1)))
        .filter_map(|(&a, &b)| Some(norm(sub(place(a)?, place(b)?))))
        .filter(|&length| length > 0.0)
        .collect();
    sides.sort_unstable_by(f64::total_cmp);
    let mut distances = cloud.nearest_distances();
    distances.extend(&sides);
    distances.sort_unstable_by(f64::total_cmp);
    let is_noise = |tolerance: f64| {
        let shorter = sides.partition_point(|&side| side <= tolerance);
        shorter as f64 <= SHORT_SIDES * sides.len() as f64
    };
    let gaps = distances.windows(2).filter(|pair| pair[1] > GAP * pair[0]);
    let between = gaps.map(|pair| pair[0].sqrt() * pair[1].sqrt()).filter(|&x| is_noise(x));
    let tried: Vec<(f64, usize)> = std::iter::once(0.0)
        .chain(between)
        .map(|tolerance| (tolerance, joined_sides(polygons.clone(), &cloud.merged(tolerance))))
        .collect();
    let most = tried.iter().map(|&(_, joined)| joined).max().unwrap_or(0);
    let good = tried.iter().find(|&&(_, joined)| joined as f64 >= AS_GOOD * most as f64);
    good.map_or(0.0, |&(tolerance, _)| tolerance * cloud.unit)
}

/// For each vertex the one that it is merged into, its first within the tolerance. That one is merged
/// into none, so no vertex moves farther than the tolerance.
#[must_use]
pub fn weld(positions: &[[f64; 3]], tolerance: f64) -> Vec<u32> {
    let cloud = Cloud::new(positions);
    cloud.merged(tolerance / cloud.unit)
}

/// For each vertex the first of those that it is joined to by sides of length zero.
#[must_use]
pub fn collapse<'a>(positions: &[[f64; 3]], polygons: impl Iterator<Item = &'a [u32]>) -> Vec<u32> {
    let mut sets = SignedSets::new(positions.len());
    for polygon in polygons {
        for (&a, &b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            if a != b && positions.get(a as usize) == positions.get(b as usize) {
                sets.join(a, b, false);
            }
        }
    }
    sets.into_roots()
}

/// Sides that are those of exactly two polygons when vertices are merged.
fn joined_sides<'a>(polygons: impl Iterator<Item = &'a [u32]>, merged: &[u32]) -> usize {
    let now = |&v: &u32| merged.get(v as usize).copied().unwrap_or(v);
    let mut sides: Vec<[u32; 2]> = polygons
        .flat_map(|polygon| polygon.iter().zip(polygon.iter().cycle().skip(1)))
        .map(|(a, b)| (now(a), now(b)))
        .filter(|(a, b)| a != b)
        .map(|(a, b)| [a.min(b), a.max(b)])
        .collect();
    sides.sort_unstable();
    sides.chunk_by(|a, b| a == b).filter(|group| group.len() == 2).count()
}

/// Points in a unit of their own, and which are in one place.
struct Cloud {
    /// What the points are divided by.
    unit: f64,
    /// `None` for points that are not finite.
    points: Vec<Option<[f64; 3]>>,
    /// For each point the first in its place.
    first: Vec<u32>,
    /// The first points.
    tree: RTree<Placed>,
}

impl Cloud {
    fn new(positions: &[[f64; 3]]) -> Self {
        let finite = positions.iter().filter(|p| is_finite(**p)).flatten();
        let unit = Some(finite.fold(0.0, |max: f64, x| max.max(x.abs()))).filter(|&x| x > 0.0);
        let unit = unit.unwrap_or(1.0);
        let points: Vec<Option<[f64; 3]>> =
            positions.iter().map(|&p| is_finite(p).then(|| p.map(|x| x / unit))).collect();
        let mut places = HashMap::new();
        let first: Vec<u32> = positions
            .iter()
            .zip(0u32..)
            .map(|(&p, v)| match is_finite(p) {
                // Adding zero takes the sign off negative zeros.
                true => *places.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(v),
                false => v,
            })
            .collect();
        let firsts = points.iter().zip(&first).zip(0u32..).filter(|((_, first), v)| **first == *v);
        let placed = firsts.filter_map(|((point, _), v)| Some(Placed::new((*point)?, v)));
        let tree = RTree::bulk_load(placed.collect());
        Self { unit, points, first, tree }
    }

    fn place(&self, v: u32) -> Option<[f64; 3]> {
        *self.points.get(v as usize)?
    }

    /// Of every point that is the first in its place, the distance to the nearest other one.
    fn nearest_distances(&self) -> Vec<f64> {
        let nearest = |placed: &Placed| {
            let near = self.tree.nearest_neighbor_iter(*placed.geom());
            let other = near.into_iter().find(|other| other.data != placed.data)?;
            Some(norm(sub(*other.geom(), *placed.geom()))).filter(|&distance| distance > 0.0)
        };
        self.tree.iter().filter_map(nearest).collect()
    }

    /// For each point the first within a tolerance that is merged into none.
    fn merged(&self, tolerance: f64) -> Vec<u32> {
        let mut into: Vec<Option<u32>> = vec![None; self.points.len()];
        for v in 0..self.points.len() as u32 {
            let first = self.first[v as usize];
            if first != v || into[v as usize].is_some() {
                continue;
            }
            into[v as usize] = Some(v);
            if let Some(place) = self.place(v).filter(|_| tolerance > 0.0) {
                for near in self.tree.locate_within_distance(place, tolerance * tolerance) {
                    into[near.data as usize].get_or_insert(v);
                }
            }
        }
        let merged = |v: u32| into[self.first[v as usize] as usize].unwrap_or(v);
        (0..self.points.len() as u32).map(merged).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat grid of `n` by `n` unit squares in two triangles each, every corner a vertex of its own,
    /// moved by up to `noise`.
    fn grid(n: u32, noise: f64) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let mut positions = Vec::new();
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            for [x, y] in [[i, j], [i + 1, j], [i + 1, j + 1], [i, j], [i + 1, j + 1], [i, j + 1]] {
                let wave = (positions.len() as f64 * 1.7).sin();
                positions.push([f64::from(x) + noise * wave, f64::from(y), noise * wave]);
            }
        }
        let faces =
            (0..positions.len() as u32 / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        (positions, faces)
    }

    fn places(merged: &[u32]) -> usize {
        merged.iter().zip(0u32..).filter(|(into, v)| **into == *v).count()
    }

    fn tolerance((positions, faces): &(Vec<[f64; 3]>, Vec<[u32; 3]>)) -> f64 {
        weld_tolerance(positions, faces.iter().map(<[u32; 3]>::as_slice))
    }

    #[test]
    fn exact_copies_need_no_tolerance() {
        let soup = grid(4, 0.0);
        assert!(is_unwelded(soup.0.len(), soup.1.iter().map(<[u32; 3]>::as_slice)));
        assert_eq!(tolerance(&soup), 0.0);
        assert_eq!(places(&weld(&soup.0, 0.0)), 25);
    }

    #[test]
    fn noise_sets_the_tolerance_in_any_unit() {
        for unit in [1.0, 1e-200, 1e150] {
            let mut soup = grid(6, 1e-6);
            soup.0.iter_mut().flatten().for_each(|x| *x *= unit);
            let tolerance = tolerance(&soup) / unit;
            assert!(tolerance > 2e-6 && tolerance < 0.1, "{tolerance}");
            assert_eq!(places(&weld(&soup.0, tolerance * unit)), 49);
        }
    }

    #[test]
    fn the_sides_of_a_thin_sheet_stay_apart() {
        // Two grids with a distance far below their edges: joining them would leave no surface.
        let mut soup = grid(6, 0.0);
        let below: Vec<[f64; 3]> = soup.0.iter().map(|&[x, y, z]| [x, y, z - 1e-4]).collect();
        let n = soup.0.len() as u32;
        soup.0.extend(below);
        let turned: Vec<[u32; 3]> = soup.1.iter().map(|&[a, b, c]| [a + n, c + n, b + n]).collect();
        soup.1.extend(turned);
        assert_eq!(tolerance(&soup), 0.0);
    }

    #[test]
    fn meshes_are_no_soups() {
        let faces: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
        assert!(!is_unwelded(4, faces.into_iter()));
        assert!(!is_unwelded(3, [&[0, 1, 2][..]].into_iter()), "one triangle");
    }

    #[test]
    fn no_vertex_moves_farther_than_the_tolerance() {
        let line: Vec<[f64; 3]> = (0..10).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        assert_eq!(weld(&line, 1.5), [0, 0, 2, 2, 4, 4, 6, 6, 8, 8]);
    }

    #[test]
    fn points_that_are_nowhere_are_merged_with_none() {
        let points = [[f64::NAN, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [0.0; 3], [-0.0; 3]];
        assert_eq!(weld(&points, 1.0), [0, 1, 2, 2]);
        assert_eq!(weld(&[], 1.0), [0u32; 0]);
    }

    #[test]
    fn sides_without_length_are_collapsed_and_other_copies_stay() {
        let positions = [[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let polygons: [&[u32]; 2] = [&[0, 1, 2, 4], &[3, 4, 1]];
        assert_eq!(collapse(&positions, polygons.into_iter()), [0, 0, 2, 3, 4]);
    }
}
