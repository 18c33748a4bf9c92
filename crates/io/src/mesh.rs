//! The neutral polygon mesh that every reader fills.

use crate::{Format, Note};
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind, Attributes};

/// A mesh as a file states it: nothing is repaired, triangulated or reordered.
///
/// Every index in `polygons` and `lines` is below `positions.len()`, every coordinate is finite, and
/// every polygon has at least three corners. A polygon may repeat a vertex, and vertices may be unused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PolygonMesh {
    /// One point per vertex, in the units of the file.
    pub positions: Vec<[f64; 3]>,
    /// The faces.
    pub polygons: Polygons,
    /// Segments of the `l` polylines of an OBJ file: candidates for feature edges. A segment need not
    /// be an edge of the mesh.
    pub lines: Vec<[u32; 2]>,
    /// What else it says of vertices, corners and polygons, if it says it of all of them.
    pub attributes: Attributes,
    /// The format of the content.
    pub format: Format,
    /// What was changed or left out.
    pub notes: Vec<Note>,
}

impl PolygonMesh {
    pub(crate) fn new(format: Format) -> Self {
        Self {
            positions: Vec::new(),
            polygons: Polygons::default(),
            lines: Vec::new(),
            attributes: Attributes::default(),
            format,
            notes: Vec::new(),
        }
    }

    /// The first texture coordinates of the corners.
    #[must_use]
    pub fn corner_uvs(&self) -> Option<&Attribute> {
        let mut uvs = self.attributes.of_kind(AttributeKind::Uv);
        uvs.find(|uvs| uvs.domain == AttributeDomain::Corner)
    }
}

/// A list of polygons, stored flat.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Polygons {
    /// Where each polygon ends in `vertices`.
    ends: Vec<usize>,
    vertices: Vec<u32>,
}

impl Polygons {
    /// An empty list.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The number of polygons.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no polygon.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The vertices of polygon `i`, in order.
    ///
    /// # Panics
    /// If `i` is not below [`Polygons::len`].
    #[must_use]
    pub fn get(&self, i: usize) -> &[u32] {
        &self.vertices[self.corner_start(i)..self.ends[i]]
    }

    /// The position of the first corner of polygon `i` in [`Polygons::corners`].
    ///
    /// # Panics
    /// If `i` is not below [`Polygons::len`].
    #[must_use]
    pub fn corner_start(&self, i: usize) -> usize {
        if i == 0 { 0 } else { self.ends[i - 1] }
    }

    /// The polygons in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> + Clone {
        (0..self.len()).map(|i| self.get(i))
    }

    /// The vertices of all corners, polygon after polygon.
    #[must_use]
    pub fn corners(&self) -> &[u32] {
        &self.vertices
    }

    /// Appends a polygon.
    pub fn push(&mut self, polygon: &[u32]) {
        self.vertices.extend_from_slice(polygon);
        self.ends.push(self.vertices.len());
    }
}

impl<'a> FromIterator<&'a [u32]> for Polygons {
    fn from_iter<T: IntoIterator<Item = &'a [u32]>>(polygons: T) -> Self {
        let mut list = Self::new();
        for polygon in polygons {
            list.push(polygon);
        }
        list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_keep_their_order_and_size() {
        let mut polygons = Polygons::new();
        assert!(polygons.is_empty());
        polygons.push(&[0, 1, 2]);
        polygons.push(&[2, 1, 3, 4]);
        assert_eq!(polygons.len(), 2);
        assert_eq!(polygons.get(1), [2, 1, 3, 4]);
        assert_eq!(polygons.corner_start(1), 3);
        assert_eq!(polygons.corners(), [0, 1, 2, 2, 1, 3, 4]);
        assert_eq!(polygons.iter().collect::<Polygons>(), polygons);
    }
}
