//! What is drawn, and the checks it must pass.

use crate::RenderError;

/// A mesh with what is to be shown on it. All lists are borrowed; optional ones may be empty.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scene<'a> {
    /// Positions of the vertices.
    pub positions: &'a [[f64; 3]],
    /// Vertices of the faces, anticlockwise seen from outside.
    pub faces: &'a [[u32; 3]],
    /// UVs of the corners, three for each face in the order of its vertices.
    pub corner_uvs: Option<&'a [[f64; 2]]>,
    /// Cones: a vertex and its index in quarters of a turn.
    pub cones: &'a [(u32, i32)],
    /// Seams, by the vertices at their ends.
    pub seams: &'a [[u32; 2]],
    /// Feature lines, by the vertices at their ends.
    pub features: &'a [[u32; 2]],
    /// Feature lines that could not be kept.
    pub released: &'a [[u32; 2]],
    /// Vertices at which feature lines meet or turn.
    pub corners: &'a [u32],
    /// Vertices at which feature lines end inside the surface.
    pub open_ends: &'a [u32],
}

/// More faces or dots than this are refused: corners and overlays share the 32-bit ids of the samples.
const MAX_ELEMENTS: usize = 1 << 30;

impl Scene<'_> {
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        if self.faces.is_empty() {
            return Err(RenderError::EmptyScene);
        }
        if self.faces.len() > MAX_ELEMENTS {
            return Err(RenderError::TooMany { what: "faces", found: self.faces.len() });
        }
        let dots = self.cones.len() + self.corners.len() + self.open_ends.len();
        if dots > MAX_ELEMENTS {
            return Err(RenderError::TooMany { what: "cones, corners and ends", found: dots });
        }
        check_finite("vertex", self.positions)?;
        self.check_vertices("face", self.faces.iter().map(|f| &f[..]))?;
        self.check_vertices("cone", self.cones.iter().map(|c| std::slice::from_ref(&c.0)))?;
        self.check_vertices("seam", self.seams.iter().map(|s| &s[..]))?;
        self.check_vertices("feature", self.features.iter().map(|s| &s[..]))?;
        self.check_vertices("released feature", self.released.iter().map(|s| &s[..]))?;
        self.check_vertices("corner", self.corners.iter().map(std::slice::from_ref))?;
        self.check_vertices("open end", self.open_ends.iter().map(std::slice::from_ref))?;
        if let Some(uvs) = self.corner_uvs {
            if uvs.len() != 3 * self.faces.len() {
                return Err(RenderError::WrongCount {
                    what: "UVs of corners",
                    expected: 3 * self.faces.len(),
                    found: uvs.len(),
                });
            }
            check_finite("the UV of corner", uvs)?;
        }
        Ok(())
    }

    fn check_vertices<'b>(
        &self,
        what: &'static str,
        lists: impl Iterator<Item = &'b [u32]>,
    ) -> Result<(), RenderError> {
        let vertices = self.positions.len();
        for (index, list) in lists.enumerate() {
            if let Some(&vertex) = list.iter().find(|&&v| v as usize >= vertices) {
                return Err(RenderError::VertexOutOfRange { what, index, vertex, vertices });
            }
        }
        Ok(())
    }

    /// The UVs, or the error that they are missing.
    pub(crate) fn uvs(&self) -> Result<&[[f64; 2]], RenderError> {
        self.corner_uvs.ok_or(RenderError::MissingUvs)
    }
}

/// The first entry with a NaN or an infinity is an error.
pub(crate) fn check_finite<const N: usize>(
    what: &'static str,
    list: &[[f64; N]],
) -> Result<(), RenderError> {
    match list.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        Some(index) => Err(RenderError::NotFinite { what, index }),
        None => Ok(()),
    }
}
