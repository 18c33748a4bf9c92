//! Typed ids and the arrays they index.
//!
//! An id is a `u32` that knows what it counts; `VertexData<T>` and its siblings can be indexed only
//! by their own kind, so a face id cannot read a vertex value by mistake.

use std::ops::{Deref, DerefMut, Index, IndexMut};

macro_rules! id {
    ($(#[$id_doc:meta])* $id:ident, $(#[$data_doc:meta])* $data:ident) => {
        $(#[$id_doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $id(pub u32);

        impl $id {
            /// The id as an array position.
            #[inline]
            pub fn at(self) -> usize {
                self.0 as usize
            }
        }

        impl From<usize> for $id {
            #[inline]
            fn from(i: usize) -> Self {
                Self(i as u32)
            }
        }

        $(#[$data_doc])*
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct $data<T>(pub Vec<T>);

        impl<T: Clone> $data<T> {
            /// `n` copies of a value.
            pub fn filled(n: usize, value: T) -> Self {
                Self(vec![value; n])
            }
        }

        impl<T> $data<T> {
            /// Ids and values, in order.
            pub fn enumerate(&self) -> impl Iterator<Item = ($id, &T)> {
                self.0.iter().enumerate().map(|(i, x)| ($id(i as u32), x))
            }
        }

        impl<T> FromIterator<T> for $data<T> {
            fn from_iter<I: IntoIterator<Item = T>>(iter: I) -> Self {
                Self(iter.into_iter().collect())
            }
        }

        impl<T> Index<$id> for $data<T> {
            type Output = T;
            #[inline]
            fn index(&self, id: $id) -> &T {
                &self.0[id.at()]
            }
        }

        impl<T> IndexMut<$id> for $data<T> {
            #[inline]
            fn index_mut(&mut self, id: $id) -> &mut T {
                &mut self.0[id.at()]
            }
        }

        impl<T> Deref for $data<T> {
            type Target = [T];
            fn deref(&self) -> &[T] {
                &self.0
            }
        }

        impl<T> DerefMut for $data<T> {
            fn deref_mut(&mut self) -> &mut [T] {
                &mut self.0
            }
        }
    };
}

id!(
    /// A vertex of a mesh.
    Vertex,
    /// One value per vertex.
    VertexData
);
id!(
    /// A triangle.
    Face,
    /// One value per face.
    FaceData
);
id!(
    /// A directed side of a triangle: `3 f + k` runs from the `k`-th to the next vertex of face `f`.
    ///
    /// The same number names the *corner* of the face at the half-edge's origin.
    Halfedge,
    /// One value per half-edge or, by the same numbering, per corner.
    HalfedgeData
);

impl Halfedge {
    /// The face it belongs to.
    #[inline]
    pub fn face(self) -> Face {
        Face(self.0 / 3)
    }

    /// Its place in the face: 0, 1 or 2.
    #[inline]
    pub fn side(self) -> usize {
        (self.0 % 3) as usize
    }

    /// The next half-edge of the face, counter-clockwise.
    #[inline]
    pub fn next(self) -> Self {
        Self(if self.0 % 3 == 2 { self.0 - 2 } else { self.0 + 1 })
    }

    /// The previous half-edge of the face.
    #[inline]
    pub fn prev(self) -> Self {
        Self(if self.0.is_multiple_of(3) { self.0 + 2 } else { self.0 - 1 })
    }
}

impl Face {
    /// The half-edge at place `side` (0, 1 or 2); as a corner, the one at that vertex.
    #[inline]
    pub fn halfedge(self, side: usize) -> Halfedge {
        Halfedge(3 * self.0 + side as u32)
    }

    /// Its three half-edges (or corners).
    #[inline]
    pub fn halfedges(self) -> [Halfedge; 3] {
        [0, 1, 2].map(|k| self.halfedge(k))
    }
}
