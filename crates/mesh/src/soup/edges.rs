//! The edges of a mesh in the making.

use std::collections::HashSet;

/// The edges of a mesh in the making, as pairs of vertices.
#[derive(Debug, Default)]
pub(super) struct Edges(HashSet<[u32; 2]>);

impl Edges {
    pub(super) fn contain(&self, a: u32, b: u32) -> bool {
        self.0.contains(&[a.min(b), a.max(b)])
    }

    pub(super) fn add(&mut self, a: u32, b: u32) {
        self.0.insert([a.min(b), a.max(b)]);
    }

    pub(super) fn add_triangle(&mut self, [a, b, c]: [u32; 3]) {
        self.add(a, b);
        self.add(b, c);
        self.add(c, a);
    }

    pub(super) fn add_sides(&mut self, polygons: &[&[u32]]) {
        for polygon in polygons {
            let next = polygon.iter().cycle().skip(1);
            for (&a, &b) in polygon.iter().zip(next) {
                self.add(a, b);
            }
        }
    }
}
