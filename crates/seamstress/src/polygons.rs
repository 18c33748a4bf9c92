//! Polygons, stored flat.

/// Polygons of any number of corners.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Polygons {
    ends: Vec<usize>,
    corners: Vec<u32>,
}

impl Polygons {
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(crate) fn get(&self, polygon: usize) -> Option<&[u32]> {
        let end = *self.ends.get(polygon)?;
        Some(&self.corners[self.corner_start(polygon)..end])
    }

    /// The position of the first corner of a polygon among those of all.
    pub(crate) fn corner_start(&self, polygon: usize) -> usize {
        polygon.checked_sub(1).map_or(0, |before| self.ends[before])
    }

    /// The vertices of all corners, polygon after polygon.
    pub(crate) fn corners(&self) -> &[u32] {
        &self.corners
    }

    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> + Clone {
        (0..self.len()).map(|polygon| self.get(polygon).unwrap_or_default())
    }
}

impl<P: AsRef<[u32]>> FromIterator<P> for Polygons {
    fn from_iter<I: IntoIterator<Item = P>>(polygons: I) -> Self {
        let mut flat = Self::default();
        for polygon in polygons {
            flat.corners.extend_from_slice(polygon.as_ref());
            flat.ends.push(flat.corners.len());
        }
        flat
    }
}
