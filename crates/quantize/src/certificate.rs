//! Certified integer-grid maps.

use seamstress_mesh::TriMesh;
use seamstress_parametrize::map::{IntegerCertificate, SeamlessMap, Tolerance, Violations};

/// A seamless map whose grid of unit squares closes up over the whole surface.
///
/// Translations between the two sides of every edge and the positions of cones are integers, and the quarter
/// turns are exact, all of it in the doubles themselves. It can only be had by passing
/// [`IntegerGridMap::certify`].
///
/// Two cones are never closer than one grid unit along the surface: a straight line between them is laid
/// out without a flip as a segment between grid points that is not a point.
#[derive(Debug, Clone)]
pub struct IntegerGridMap {
    map: SeamlessMap,
    certificate: IntegerCertificate,
}

impl IntegerGridMap {
    /// Checks a map given by one UV per corner, in grid units.
    ///
    /// # Errors
    /// Every violation, each naming its element: those of [`SeamlessMap::certify`] first, and if there
    /// are none, edges that do not fit to the last bit and what is not integral.
    pub fn certify(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        Self::certify_aligned(mesh, corner_uvs, &[], tolerance)
    }

    /// Checks a map, in grid units, whose isolines at integers hold edges given by their end vertices.
    ///
    /// Beyond everything [`IntegerGridMap::certify`] checks, on either side of each such edge both ends have the
    /// same integer as one coordinate, and where these edges turn they are at a grid point. The grid's quads
    /// then have these edges along theirs.
    ///
    /// # Errors
    /// As [`IntegerGridMap::certify`], and those of [`SeamlessMap::alignment`].
    pub fn certify_aligned(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        aligned: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        let map = SeamlessMap::certify(mesh, corner_uvs, tolerance)?;
        map.alignment(mesh, aligned, &Tolerance::default())?;
        let certificate = map.integers(mesh, aligned, &Tolerance::default())?;
        Ok(Self { map, certificate })
    }

    /// The seamless map; UVs in grid units.
    pub fn seamless(&self) -> &SeamlessMap {
        &self.map
    }

    /// One UV per corner, three per face, in grid units.
    pub fn corner_uvs(&self) -> &[[f64; 2]] {
        self.map.corner_uvs()
    }

    /// The figures of the certificate beyond those of the seamless map.
    pub fn certificate(&self) -> &IntegerCertificate {
        &self.certificate
    }
}
