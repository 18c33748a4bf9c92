//! Shaping of quads along the surface they come from.

use crate::input::LoadedMesh;
use crate::outcome::Failure;
use crate::text::{counted, row};
use seamstress_quads::{
    Extraction, MendOptions, QuadMesh, SmoothError, SmoothOptions, mend, smooth,
};
use seamstress_surface::TriMesh;
use serde_json::{Value, json};

/// What is done to the vertices of extracted quads.
pub(crate) struct Shaping<'a> {
    /// Leave badly shaped quads as they are.
    pub(crate) raw: bool,
    /// Rounds of smoothing.
    pub(crate) smooth: u32,
    /// Edges of the source that keep their vertices, by their ends; the boundary does anyway.
    pub(crate) features: &'a [[u32; 2]],
}

/// What was done.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Shaped {
    mended: usize,
    /// Mesh units.
    largest_move: f64,
}

impl Shaping<'_> {
    /// Moves the vertices of quads, which must be a manifold.
    pub(crate) fn apply(
        &self,
        mesh: &LoadedMesh,
        source: &TriMesh,
        extraction: &mut Extraction,
    ) -> Result<Shaped, Failure> {
        let fixed = extraction.vertices_on(source, self.features);
        let surface = (mesh.soup.positions.as_slice(), mesh.soup.faces.as_slice());
        let failure = |error: SmoothError| {
            let file = mesh.path.clone();
            match error {
                SmoothError::NoManifold(faults) => Failure::NoManifold { file, faults },
                error => Failure::NoQuads { file, text: error.to_string() },
            }
        };
        let mut shaped = Shaped::default();
        let mut quads: Option<QuadMesh> = None;
        if !self.raw {
            let options = MendOptions { fixed: fixed.clone(), ..MendOptions::default() };
            let mended = mend(&extraction.mesh, surface, &options).map_err(failure)?;
            shaped = Shaped { mended: mended.moved, largest_move: mended.largest_move };
            quads = Some(mended.mesh);
        }
        if self.smooth > 0 {
            let options = SmoothOptions { rounds: self.smooth, fixed };
            let start = quads.as_ref().unwrap_or(&extraction.mesh);
            quads = Some(smooth(start, surface, &options).map_err(failure)?.mesh);
        }
        if let Some(quads) = quads {
            extraction.mesh = quads;
        }
        Ok(shaped)
    }
}

impl Shaped {
    /// A row of the summary, if there is something to say.
    pub(crate) fn row(&self) -> Option<String> {
        let vertices = counted(self.mended, "vertex");
        let text = format!("{vertices} of badly shaped quads moved along the surface");
        (self.mended > 0).then(|| row("mended", &text))
    }

    pub(crate) fn json(&self) -> Value {
        json!({ "moved": self.mended, "largest_move": self.largest_move })
    }
}
