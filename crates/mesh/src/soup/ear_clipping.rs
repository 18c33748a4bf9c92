//! Triangulating a simple polygon by cutting off its corners one by one.

use super::edges::Edges;
use super::geometry::{Local, shape};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Clips the ears of a polygon, those with the largest smallest angle first.
///
/// An ear is a corner whose triangle has positive area against `normal`, contains no other corner,
/// and is closed off by a diagonal that is not among `edges`. Returns triangles of corner numbers,
/// or nothing if the polygon runs out of ears: it crosses itself, is flat somewhere, or its
/// diagonals are taken. Time is proportional to the corners times the reflex corners.
pub(super) fn clip_ears(
    local: &Local,
    normal: [f64; 3],
    polygon: &[u32],
    edges: &Edges,
) -> Option<Vec<[usize; 3]>> {
    let n = polygon.len();
    let mut clipper = Clipper::new(local, normal, polygon, edges);
    let mut triangles = Vec::with_capacity(n - 2);
    while triangles.len() + 3 < n {
        let ear = clipper.next_ear()?;
        triangles.push(clipper.triangle(ear));
        clipper.cut(ear);
    }
    let last = clipper.triangle(clipper.any);
    triangles.push(last);
    local.is_positive(last, normal).then_some(triangles)
}

/// The polygon that is left, as a ring of corners.
struct Clipper<'a> {
    local: &'a Local,
    normal: [f64; 3],
    polygon: &'a [u32],
    edges: &'a Edges,
    before: Vec<usize>,
    after: Vec<usize>,
    /// A corner that is left.
    any: usize,
    /// How often each corner's triangle has changed; cutting the corner off is a change.
    age: Vec<u32>,
    /// The corners left that are not convex. A triangle that contains any corner contains one of
    /// these.
    blocking: Vec<usize>,
    /// Corners on offer.
    ears: BinaryHeap<Ear>,
    /// For each corner those offered whose triangle contains it.
    waiting: Vec<Vec<Ear>>,
}

impl<'a> Clipper<'a> {
    fn new(local: &'a Local, normal: [f64; 3], polygon: &'a [u32], edges: &'a Edges) -> Self {
        let n = polygon.len();
        let mut clipper = Self {
            local,
            normal,
            polygon,
            edges,
            before: (0..n).map(|i| (i + n - 1) % n).collect(),
            after: (0..n).map(|i| (i + 1) % n).collect(),
            any: 0,
            age: vec![0; n],
            blocking: Vec::new(),
            ears: BinaryHeap::new(),
            waiting: vec![Vec::new(); n],
        };
        clipper.blocking = (0..n).filter(|&i| !clipper.is_convex(i)).collect();
        for corner in 0..n {
            clipper.offer(corner);
        }
        clipper
    }

    fn triangle(&self, corner: usize) -> [usize; 3] {
        [self.before[corner], corner, self.after[corner]]
    }

    fn is_convex(&self, corner: usize) -> bool {
        self.local.is_positive(self.triangle(corner), self.normal)
    }

    /// Offers a corner for cutting if its triangle and diagonal allow it. Whether other corners
    /// lie in the triangle is found out when its turn comes: they may be gone by then.
    fn offer(&mut self, corner: usize) {
        let triangle = self.triangle(corner);
        let [a, _, c] = triangle.map(|i| self.polygon[i]);
        if self.is_convex(corner) && !self.edges.contain(a, c) {
            let min_angle = shape(triangle.map(|i| self.local.points[i])).min_angle;
            self.ears.push(Ear { min_angle, corner, age: self.age[corner] });
        }
    }

    /// The best ear there is. Offers found blocked wait for the corner that blocks them.
    fn next_ear(&mut self) -> Option<usize> {
        while let Some(ear) = self.ears.pop() {
            if ear.age != self.age[ear.corner] {
                continue;
            }
            match self.blocker(ear.corner) {
                Some(blocker) => self.waiting[blocker].push(ear),
                None => return Some(ear.corner),
            }
        }
        None
    }

    /// Another corner that lies in the triangle of `corner` or on its border.
    fn blocker(&self, corner: usize) -> Option<usize> {
        let [a, b, c] = self.triangle(corner);
        let bounds = self.local.bounds([a, b, c]);
        let is_right = |from, to, i| self.local.is_positive([to, from, i], self.normal);
        let is_outside = |i| is_right(a, b, i) || is_right(b, c, i) || is_right(c, a, i);
        self.blocking.iter().copied().find(|&i| {
            bounds.contain(self.local.points[i]) && ![a, b, c].contains(&i) && !is_outside(i)
        })
    }

    fn cut(&mut self, ear: usize) {
        let [a, _, c] = self.triangle(ear);
        self.after[a] = c;
        self.before[c] = a;
        self.any = a;
        self.age[ear] += 1;
        for neighbour in [a, c] {
            self.age[neighbour] += 1;
            self.offer(neighbour);
            let at = self.blocking.iter().position(|&i| i == neighbour);
            if let Some(at) = at.filter(|_| self.is_convex(neighbour)) {
                self.blocking.swap_remove(at);
                self.ears.append(&mut self.waiting[neighbour].drain(..).collect());
            }
        }
    }
}

/// A corner on offer. The greatest has the largest smallest angle; of equals the first corner.
#[derive(Debug, Clone, Copy)]
struct Ear {
    min_angle: f64,
    corner: usize,
    age: u32,
}

impl Ord for Ear {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_angle = self.min_angle.total_cmp(&other.min_angle);
        by_angle.then(other.corner.cmp(&self.corner)).then(self.age.cmp(&other.age))
    }
}

impl PartialOrd for Ear {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ear {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ear {}

#[cfg(test)]
mod tests {
    use crate::soup::{TriangleSoup, Triangulation, check, triangulate};

    /// Splits one polygon of the plane, tilted into space, and asserts that its triangles are a
    /// disk that covers it exactly.
    fn split(outline: &[[f64; 2]]) -> Triangulation {
        let positions: Vec<[f64; 3]> =
            outline.iter().map(|&[x, y]| [x + 10.0, 0.6 * y, 0.8 * y]).collect();
        let polygon: Vec<u32> = (0..outline.len() as u32).collect();
        let done = triangulate(&positions, std::iter::once(&polygon[..])).unwrap();
        assert_eq!(done.notes.unresolved, []);
        let area = |[a, b, c]: [[f64; 2]; 3]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let areas: Vec<f64> =
            done.faces.iter().map(|face| area(face.map(|v| outline[v as usize]))).collect();
        assert!(areas.iter().all(|&area| area > 0.0));
        let next = outline.iter().cycle().skip(1);
        let shoelace: f64 = outline.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum();
        assert!((areas.iter().sum::<f64>() / shoelace - 1.0).abs() < 1e-12);
        let report = check(&TriangleSoup { positions, faces: done.faces.clone() });
        assert_eq!(report.faults, []);
        assert_eq!((report.facts.euler_characteristic(), report.facts.boundary_loops()), (1, 1));
        done
    }

    #[test]
    fn a_skyline() {
        // Columns of different heights on one base: right angles only, many corners in line.
        for n in 2..40u32 {
            let mut outline = vec![[0.0, 0.0], [f64::from(n), 0.0]];
            for i in (0..n).rev() {
                let height = f64::from(1 + i % 2 * 5 + (7 * i * i + 3 * i) % 5);
                outline.extend([[f64::from(i + 1), height], [f64::from(i), height]]);
            }
            let done = split(&outline);
            assert_eq!(done.faces.len(), outline.len() - 2);
        }
    }

    #[test]
    fn a_spiral() {
        for n in [20, 50, 150] {
            let arm = |i: u32, width: f64| {
                let t = f64::from(i) * 0.3;
                [(t + width) * t.cos(), (t + width) * t.sin()]
            };
            let outer = (0..n).map(|i| arm(i, 4.0));
            let inner = (0..n).rev().map(|i| arm(i, 1.0));
            split(&outer.chain(inner).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_star_takes_its_best_ears_first() {
        // Five points, notched deeply: the tips are the only ears, then the pentagon is left.
        let corner = |i: u32| {
            let angle = f64::from(i) * std::f64::consts::PI / 5.0;
            let radius = [1.0, 0.3][i as usize % 2];
            [radius * angle.cos(), radius * angle.sin()]
        };
        let done = split(&(0..10).map(corner).collect::<Vec<_>>());
        let tips =
            done.faces.iter().filter(|face| face.iter().filter(|&v| v % 2 == 0).count() == 1);
        assert_eq!(tips.count(), 5);
    }

    #[test]
    fn taken_diagonals_are_avoided() {
        // Two teeth and the one between must be cut off at 5-0, 1-3 and 3-5; what is left is a
        // quad with a choice of two diagonals.
        let mut positions: Vec<[f64; 3]> = [[0, 0], [6, 0], [6, 4], [4, 1], [3, 4], [2, 1], [0, 4]]
            .iter()
            .map(|&[x, y]| [f64::from(x), f64::from(y), 0.0])
            .collect();
        positions.push([1.0, 0.0, 5.0]);
        let comb: &[u32] = &[0, 1, 2, 3, 4, 5, 6];
        for (taken, free) in [([0, 3], [1, 5]), ([1, 5], [0, 3])] {
            let polygons = [comb, &[taken[0], taken[1], 7]];
            let done = triangulate(&positions, polygons.into_iter()).unwrap();
            let has = |edge: [u32; 2]| {
                done.faces[..5].iter().any(|face| edge.iter().all(|v| face.contains(v)))
            };
            assert!(has(free) && !has(taken));
            assert_eq!(done.notes.unresolved, []);
        }
        // Without 5-0 there is no way.
        let polygons = [comb, &[5, 0, 7]];
        let done = triangulate(&positions, polygons.into_iter()).unwrap();
        assert_eq!(done.notes.unresolved, [0]);
    }
}
