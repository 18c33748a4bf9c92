//! Shaping of quads along the surface they come from.

use crate::input::LoadedMesh;
use crate::outcome::Failure;
use crate::text::{self, counted, row};
use seamstress_mesh::TriMesh;
use seamstress_quads::quality::Orientation;
use seamstress_quads::{
    Extraction, MendOptions, QuadMesh, SmoothError, SmoothOptions, mend, smooth,
};
use serde_json::{Value, json};

/// What is done to the vertices of extracted quads.
pub(crate) struct Shaping<'a> {
    /// Leave badly shaped quads as they are.
    pub(crate) raw: bool,
    /// Rounds of smoothing.
    pub(crate) smooth: u32,
    /// Edges of the source whose vertices stay on them, by their ends; those of the boundary do anyway.
    pub(crate) features: &'a [[u32; 2]],
}

/// What was done, and what came of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shaped {
    mended: usize,
    /// Mesh units.
    largest_move: f64,
    orientation: Orientation,
}

impl Shaping<'_> {
    /// Moves the vertices of quads, which must be a manifold.
    pub(crate) fn apply(
        &self,
        mesh: &LoadedMesh,
        source: &TriMesh,
        extraction: &mut Extraction,
    ) -> Result<Shaped, Failure> {
        let positions = &mesh.soup.positions;
        let constraints = extraction.constraints(source, positions, self.features);
        let surface = (positions.as_slice(), mesh.soup.faces.as_slice());
        let failure = |error: SmoothError| Failure::NoQuads {
            file: mesh.path.clone(),
            text: error.to_string(),
        };
        let (mut moved, mut largest_move) = (0, 0.0);
        let mut quads: Option<QuadMesh> = None;
        if !self.raw {
            let options =
                MendOptions { constraints: constraints.clone(), ..MendOptions::default() };
            let mended = mend(&extraction.mesh, surface, &options).map_err(failure)?;
            (moved, largest_move) = (mended.moved, mended.largest_move);
            quads = Some(mended.mesh);
        }
        if self.smooth > 0 {
            let options = SmoothOptions { rounds: self.smooth, constraints };
            let start = quads.as_ref().unwrap_or(&extraction.mesh);
            quads = Some(smooth(start, surface, &options).map_err(failure)?.mesh);
        }
        if let Some(quads) = quads {
            extraction.mesh = quads;
        }
        let polygons = extraction.mesh.quads().iter().map(<[u32; 4]>::as_slice);
        let orientation = Orientation::new(extraction.mesh.positions(), polygons, surface)
            .map_err(|error| failure(SmoothError::BadSurface(error.to_string())))?;
        Ok(Shaped { mended: moved, largest_move, orientation })
    }
}

impl Shaped {
    /// What is wrong with the quads, on standard error.
    pub(crate) fn tell_faults(&self) {
        if let Some(warning) = fault_warning(&self.orientation) {
            text::tell(&warning);
        }
    }

    /// Rows of the summary.
    pub(crate) fn rows(&self) -> Vec<String> {
        let vertices = counted(self.mended, "vertex");
        let text = format!("{vertices} of badly shaped quads moved along the surface");
        let mended = (self.mended > 0).then(|| row("mended", &text));
        mended.into_iter().chain([orientation_row(&self.orientation)]).collect()
    }

    pub(crate) fn mended(self) -> Value {
        json!({ "moved": self.mended, "largest_move": self.largest_move })
    }

    pub(crate) fn orientation(self) -> Orientation {
        self.orientation
    }
}

/// How quads lie to their source.
pub(crate) fn orientation_row(orientation: &Orientation) -> String {
    let corners = counted(orientation.turned_corners, "corner");
    let bent = match orientation.bent {
        0 => String::new(),
        n => format!("; {} bent over a thin sheet or sharp edge", counted(n, "face")),
    };
    let text = match orientation.inverted + orientation.crossed {
        0 => format!("no face is inverted; {corners} turned against the source{bent}"),
        _ => format!(
            "{} inverted, {} crossed; {corners} turned against the source{bent}",
            counted(orientation.inverted, "face"),
            orientation.crossed
        ),
    };
    row("orientation", &text)
}

fn fault_warning(orientation: &Orientation) -> Option<String> {
    let Orientation { inverted, crossed, .. } = *orientation;
    (inverted + crossed > 0).then(|| {
        let faces = counted(inverted, "face");
        format!("warning: {faces} inverted, {crossed} crossed, seen from the surface; more quads may help")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_told() {
        let mut orientation = Orientation::default();
        (orientation.bent, orientation.turned_corners) = (1, 3);
        assert_eq!(fault_warning(&orientation), None);
        let text = orientation_row(&orientation);
        assert!(text.ends_with(
            "no face is inverted; 3 corners turned against the source; 1 face bent over a thin sheet or sharp edge"
        ));
        (orientation.inverted, orientation.crossed) = (2, 1);
        assert!(
            fault_warning(&orientation)
                .is_some_and(|text| text.contains("2 faces inverted, 1 crossed"))
        );
        assert!(orientation_row(&orientation).contains("2 faces inverted, 1 crossed"));
    }
}
