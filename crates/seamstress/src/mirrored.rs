//! Symmetric maps and quads: those of one side of planes of symmetry, and their images.
//!
//! A reflection turns triangles around, and their UVs must be reflected as well to keep their sides: of images, `v` has
//! the other sign. The edges in the planes lie on isolines, so that the seam along them is a shift, or half a turn and a
//! shift, and the whole is seamless.

use crate::context::Watcher;
use crate::error::{Error, ErrorKind, Stage};
use crate::features::FeatureReport;
use crate::map::SeamlessMap;
use crate::options::{MapOptions, QuadOptions};
use crate::parts::{PartReport, Selection};
use crate::quads::PartQuads;
use crate::surface::Surface;
use crate::symmetric::Side;
use crate::symmetry::Symmetry;
use seamstress_parametrize::{self as method, ReleasedFeature, Tolerance};

impl Surface {
    /// The map of one side of planes of symmetry, and its images.
    ///
    /// # Errors
    /// [`ErrorKind::NotSymmetric`] where the triangles are not symmetric, and those of [`Surface::parametrize`].
    pub(crate) fn symmetric_map(
        &self,
        side: &Side,
        options: &MapOptions,
        settings: method::MapOptions,
        watcher: &mut Watcher,
    ) -> Result<SeamlessMap, Error> {
        let corners = side.corners().ok_or_else(|| {
            let text =
                "triangles are not symmetric, or cross a plane; a map keeps them as they are";
            Error::new(ErrorKind::NotSymmetric, text).at_stage(Some(Stage::Check))
        })?;
        // The rim is followed whatever the features are.
        let followed = options.features.clone().with_boundary();
        let of_side = options.clone().symmetry(Symmetry::None).features(followed);
        let made = side.surface.make_map(side.curves.clone(), &of_side, settings, watcher)?;
        let report = made.features().map(|features| features.report.clone());
        side.require_rim(report.as_ref())?;
        let uv = |(corner, sign): (usize, f64)| {
            let [u, v] = made.inner().corner_uvs()[corner];
            [u, sign * v]
        };
        let uvs = corners.into_iter().map(uv).collect();
        let map = method::SeamlessMap::certify(self.mesh(), uvs, &Tolerance::default())
            .map_err(|violations| self.misaligned(&violations))?;
        let report = report.map(|report| side.feature_report(report));
        let dropped = self.dropped(report.as_ref(), options)?;
        let features = || self.aligned(side.asked.clone(), &map, &dropped);
        let features = (!options.features.is_none()).then(features).transpose()?;
        let components = made.report().components.clone();
        let whole = SeamlessMap::new(self, map, features, options, components);
        Ok(whole.with_symmetry(side.report()))
    }

    /// The quads of one side of planes of symmetry, and their images.
    ///
    /// # Errors
    /// Those of [`Surface::quad_mesh`].
    pub(crate) fn symmetric_quads(
        &self,
        side: &Side,
        options: &QuadOptions,
        watcher: &mut Watcher,
    ) -> Result<(PartQuads, PartReport), Error> {
        // The rim is followed whatever the features are.
        let followed = options.map.features.clone().with_boundary();
        let of_side = options.clone().features(followed);
        let share = (side.surface.metric().side() / self.metric().side()).powi(2);
        let size = options.size.of_share(share);
        let make = |selection: &Selection, size| selection.quads(size, &of_side, watcher);
        let made = side.surface.make_parts(&side.curves, size, options.parts, make);
        let component_of = self.component_of_input_faces();
        let (made, mut parts) = made.map_err(|error| error.with_parts_numbered(&component_of))?;
        parts.failed.iter_mut().for_each(|part| part.renumber(&component_of));
        let (extraction, connectivity) = side.mirrored(&made.extraction, made.features.as_ref())?;
        let is_asked = !options.map.features.is_none();
        let features = made.features.filter(|_| is_asked).map(|f| side.feature_report(f));
        self.dropped(features.as_ref(), &options.map)?;
        let empty = self.components_without(&extraction.sources);
        Ok((PartQuads { extraction, connectivity, features, empty, ..made }, parts))
    }

    /// The features that were dropped.
    ///
    /// # Errors
    /// [`ErrorKind::DroppedFeatures`] where none must be.
    fn dropped(
        &self,
        report: Option<&FeatureReport>,
        options: &MapOptions,
    ) -> Result<Vec<ReleasedFeature>, Error> {
        let dropped = report.iter().flat_map(|report| report.dropped.iter().flatten());
        let dropped: Vec<ReleasedFeature> = dropped.copied().collect();
        match options.features_strict && !dropped.is_empty() {
            true => Err(self.no_strict_map(&dropped)),
            false => Ok(dropped),
        }
    }
}
