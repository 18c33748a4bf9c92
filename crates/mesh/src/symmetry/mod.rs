//! Planes of symmetry: how far a mesh is from one, and the side of it.
//!
//! * [`Mirror`]: a plane, and images across it; [`images_of`] several.
//! * [`images`]: the vertex that the image of each vertex is, where a mesh is its own image.
//! * [`Segments`]: what tells whether a point lies on a feature.
//! * [`cut`]: the side of a mesh, with triangles that cross the plane split flat.

mod cut;
mod images;
mod segments;

pub use cut::{Cut, cut};
pub use images::{Images, images};
pub use segments::Segments;

use crate::vector::{Point, dot, norm};

/// A plane that space is reflected at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mirror {
    normal: Point,
    offset: f64,
}

impl Mirror {
    /// The plane of the points whose product with a normal is an offset; the normal may have any length but zero.
    #[must_use]
    pub fn new(normal: [f64; 3], offset: f64) -> Option<Self> {
        let length = norm(normal);
        let plane = Self { normal: normal.map(|x| x / length), offset: offset / length };
        plane.normal.iter().chain([&plane.offset]).all(|x| x.is_finite()).then_some(plane)
    }

    /// The plane where a coordinate has a value.
    #[must_use]
    pub fn across(axis: usize, offset: f64) -> Self {
        Self { normal: [0, 1, 2].map(|k| f64::from(k == axis)), offset }
    }

    /// The unit normal, towards the side that [`cut`] keeps.
    #[must_use]
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// The product of the points of the plane with the normal.
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// How far a point is on the side of the normal.
    #[must_use]
    pub fn height(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, p) - self.offset
    }

    /// The reflection of a point.
    #[must_use]
    pub fn image(&self, p: [f64; 3]) -> [f64; 3] {
        self.moved(p, -2.0 * self.height(p))
    }

    /// A point as near as rounding allows that is the image of its own image to the last bit.
    #[must_use]
    pub fn settled(&self, p: [f64; 3]) -> [f64; 3] {
        self.image(self.image(p))
    }

    /// The nearest point of the plane.
    #[must_use]
    pub fn onto(&self, p: [f64; 3]) -> [f64; 3] {
        self.moved(p, -self.height(p))
    }

    fn moved(&self, p: Point, by: f64) -> Point {
        [0, 1, 2].map(|k| p[k] + by * self.normal[k])
    }
}

/// A point and its images across any of some planes: twice as many with each plane.
pub fn images_of(p: [f64; 3], mirrors: &[Mirror]) -> impl Iterator<Item = [f64; 3]> {
    (0..1usize << mirrors.len()).map(move |across| {
        let those = mirrors.iter().enumerate().filter(|(k, _)| across >> k & 1 == 1);
        those.fold(p, |p, (_, mirror)| mirror.image(p))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_by_hand() {
        let x = Mirror::across(0, 0.0);
        assert_eq!(x.image([0.3, -2.0, 7.1]), [-0.3, -2.0, 7.1]);
        assert_eq!(x.onto([1e-7, -2.0, 7.1]), [0.0, -2.0, 7.1]);
        let y = Mirror::across(1, 2.5);
        assert_eq!((y.height([9.0, 3.0, 9.0]), y.image([9.0, 3.0, 9.0])), (0.5, [9.0, 2.0, 9.0]));
        let diagonal = Mirror::new([3.0, -3.0, 0.0], 0.0).unwrap();
        let image = diagonal.image([1.0, 5.0, 2.0]);
        let gap = [0, 1, 2].map(|k| (image[k] - [5.0, 1.0, 2.0][k]).abs());
        assert!(gap.iter().all(|&x| x < 1e-14), "{image:?}");
        for k in 0..1000 {
            let x = Mirror::across(0, -2.4917 + 0.013 * f64::from(k));
            let p = x.settled([0.1 * f64::from(k).sqrt() - 1.7, 0.0, 0.0]);
            assert_eq!(x.image(x.image(p)), p, "{k}");
        }
        assert_eq!(Mirror::new([0.0; 3], 1.0), None);
        assert_eq!(Mirror::new([f64::NAN, 1.0, 0.0], 1.0), None);
    }
}
