//! Why there are no quads.

use crate::error::{Error, ErrorKind};
use crate::finding::{Elements, listing_of};
use crate::integer::FEWER_CONES;
use crate::options::IntegerMapOptions;
use crate::surface::Surface;
use seamstress_quads::{ExtractError, ManifoldError};

/// Elements of each kind that an error lists.
const LISTED: usize = 5;

impl Surface {
    /// Why there are no quads that are a manifold.
    pub(crate) fn no_manifold(&self, cause: ManifoldError, options: &IntegerMapOptions) -> Error {
        match cause {
            ManifoldError::Quantize(cause) => self.no_integer_map(cause, options.rounding),
            ManifoldError::Extract(ExtractError::Cancelled(_)) => Error::cancelled(),
            ManifoldError::NoManifold { faults, faces } => Error::no_manifold(&faults)
                .with_elements(self.in_input(&Elements { faces, ..Elements::default() }))
                .with_hint(FEWER_CONES),
            other => {
                let error =
                    Error::new(ErrorKind::NoQuads, format!("no quads were extracted: {other}"));
                error.with_hint(match self.report().coincident_vertices {
                    0 => "try more quads",
                    _ => "vertices in one place are not joined: `weld` joins them",
                })
            }
        }
    }

    /// Why a map has no quads, with the elements it names.
    pub(crate) fn no_quads(
        &self,
        cause: &ExtractError,
        corner_uvs: &[[f64; 2]],
        tolerance: f64,
    ) -> Error {
        let error = |text: String| {
            Error::new(ErrorKind::NoQuads, format!("no quads were extracted: {text}"))
        };
        match cause {
            ExtractError::Cancelled(_) => Error::cancelled(),
            ExtractError::NotInteger(faults) => {
                let lines = listing_of(&faults.0, LISTED).join("\n  ");
                let text =
                    format!("not an integer-grid map to within {tolerance} grid units:\n  {lines}");
                let flipped = || self.distortion(corner_uvs).flipped;
                error(text).with_hint(match faults.is_seamless() {
                    false => "a map of few digits may need a larger `tolerance`",
                    true if flipped() > 0 => {
                        "the map is not seamless either, since it has flips; `parametrize` makes one without"
                    }
                    true => "the map is seamless, but not an integer-grid map; `integer_map` makes it one",
                })
            }
            ExtractError::Folds { flipped, collapsed } => {
                let [flipped, collapsed] = [flipped, collapsed].map(|faces| {
                    faces.iter().map(|&face| self.face_named(face)).collect::<Vec<_>>()
                });
                let text = format!(
                    "the map folds{}{}",
                    folded("flipped", &flipped),
                    folded("collapsed", &collapsed)
                );
                let faces = [flipped, collapsed].concat();
                let elements = Elements { faces, ..Elements::default() };
                error(text).with_elements(elements).with_hint("`best_effort` extracts what it can")
            }
            other => error(other.to_string()),
        }
    }
}

fn folded(what: &str, faces: &[u32]) -> String {
    let shown: Vec<String> = faces.iter().take(LISTED).map(u32::to_string).collect();
    match faces.len() {
        0 => String::new(),
        1 => format!("\n  1 {what} face: {}", shown.join(", ")),
        n if n > LISTED => format!("\n  {n} {what} faces: {} ...", shown.join(", ")),
        n => format!("\n  {n} {what} faces: {}", shown.join(", ")),
    }
}
