//! Why there is no map.

use crate::error::{Error, ErrorKind};
use crate::finding::{Elements, listing};
use crate::surface::Surface;
use crate::words::counted;
use seamstress_mesh::Vertex;
use seamstress_parametrize::map::first_in_words;
use seamstress_parametrize::{MapError, MethodError, ReleasedFeature, Violation, Violations};
use std::collections::BTreeMap;

/// What may help where the method fails.
const LIMIT: &str = "this is a limit of the method: try another `cone_bias`, or remesh triangles that are very thin or \
                     without area";

/// Violations of each kind that an error lists.
const LISTED: usize = 5;

impl Surface {
    /// Why there is no map.
    pub(crate) fn no_map(&self, cause: MapError) -> Error {
        match cause {
            MapError::Cancelled(_) => Error::cancelled(),
            MapError::Released { released } => self.no_strict_map(&released),
            MapError::Field(_) | MapError::Cones(_) => {
                Error::new(ErrorKind::BadStart, cause.to_string())
            }
            MapError::Components(failed) => {
                let failed = failed.into_iter().map(|part| {
                    let named = |cause: MethodError| {
                        cause.renamed(|v| self.vertex_named(v), |face| self.face_named(face))
                    };
                    let error = Error::new(ErrorKind::NoMap, named(part.cause).to_string());
                    self.failed_part(part.component, &error.with_hint(LIMIT))
                });
                self.no_parts(ErrorKind::NoMap, "no certified map", failed.collect())
            }
            _ => {
                let message = format!("no certified map could be made: {cause}");
                let error = Error::new(ErrorKind::NoMap, message).with_hint(LIMIT);
                match cause {
                    MapError::Uncertified(violations) => {
                        error.with_findings(self.findings(&violations))
                    }
                    _ => error,
                }
            }
        }
    }

    /// Why there is no map along all features: what of each component could not be aligned.
    pub(crate) fn no_strict_map(&self, released: &[ReleasedFeature]) -> Error {
        let (component_of, n_components) = self.mesh().connected_faces();
        let mut released_of = BTreeMap::<usize, Vec<ReleasedFeature>>::new();
        for feature in released {
            let at = self.mesh().outgoing(Vertex(feature.vertices[0])).next();
            let component = at.map_or(0, |h| component_of[h.face()] as usize);
            released_of.entry(component).or_default().push(*feature);
        }
        let error = |released: Vec<ReleasedFeature>| {
            let named = |feature: ReleasedFeature| {
                ReleasedFeature::new(self.edge_named(feature.vertices), feature.reason)
            };
            let mut released: Vec<_> = released.into_iter().map(named).collect();
            released.dedup();
            let edges = released.iter().map(|feature| feature.vertices).collect();
            let elements = Elements { edges, ..Elements::default() };
            Error::new(ErrorKind::DroppedFeatures, MapError::Released { released }.to_string())
                .with_elements(elements)
                .with_hint("without `features_strict` the map is made without them")
        };
        if n_components == 1 {
            return error(released.to_vec());
        }
        let failed = released_of
            .into_iter()
            .map(|(component, released)| self.failed_part(component, &error(released)));
        self.no_parts(ErrorKind::DroppedFeatures, "no map along all features", failed.collect())
    }

    /// A fault of this program.
    pub(crate) fn misaligned(&self, violations: &Violations) -> Error {
        let first = first_in_words(&violations.0);
        let text = format!("a map was made, but its features are not aligned: {first}");
        Error::new(ErrorKind::Internal, text)
            .with_findings(self.findings(violations))
            .with_hint("please report this with the mesh")
    }

    /// The error for what is no seamless map of this surface.
    pub(crate) fn not_a_map(&self, violations: &Violations) -> Error {
        let findings = self.findings(violations);
        let text = format!(
            "not a seamless map: {} (elements counted from 0):\n  {}",
            counted(findings.len(), "violation"),
            listing(&findings, LISTED).join("\n  ")
        );
        let error = Error::new(ErrorKind::NotAMap, text).with_findings(findings);
        let is_open = violations.0.iter().all(|v| matches!(v, Violation::OpenSeam { .. }));
        match is_open {
            true => error.with_hint("a larger `tolerance` allows seams that are open by rounding"),
            false => error,
        }
    }
}
