//! A seamless map rounded to a grid, with the features that the grid has room for.

use crate::context::Watcher;
use crate::error::Error;
use crate::features::{FeatureCurves, ordered};
use crate::integer::SeamlessStart;
use crate::options::IntegerMapOptions;
use crate::surface::Surface;
use seamstress_mesh::features::{Curve, EdgeSet, FeatureGraph, strips_and_slivers};
use seamstress_parametrize::{ReleaseReason, ReleasedFeature};
use seamstress_quads::{GoesOn, ManifoldError};
use seamstress_quantize::{QuantizationFailure, QuantizeError, QuantizeOptions};
use std::collections::BTreeSet;

/// Maps made at most, each with fewer features.
const MOST_MAPS: usize = 6;
/// Curves shorter than so many cells are given up before others.
const SHORT: f64 = 1.0;

impl Surface {
    /// Makes a seamless map and rounds it. Of strips much narrower than a cell one side is given up first. Where features
    /// are too close together for the grid asked for, the shortest curves there are given up, and the map is made again;
    /// where there are none to give up, the grid gets finer.
    ///
    /// # Errors
    /// Those of [`Surface::make_seamless`], and of the rounding with the fewest features.
    pub(crate) fn make_gridded<T>(
        &self,
        asked: &FeatureCurves,
        options: &IntegerMapOptions,
        watcher: &mut Watcher,
        round: impl Fn(
            &SeamlessStart,
            &QuantizeOptions,
            &mut GoesOn<'_>,
            &mut Watcher,
        ) -> Result<T, ManifoldError>,
    ) -> Result<(SeamlessStart, T), Error> {
        let (mesh, settings) = (self.mesh(), options.to_quantize());
        let cell = settings.size.cell(self.cell_metric().side());
        let is_strict = options.map.features_strict;
        let mut given_up = Vec::new();
        let mut give_up = |edges: &EdgeSet| {
            let pairs = edges.vertex_pairs(mesh).into_iter().map(ordered);
            given_up.extend(pairs.map(|pair| ReleasedFeature::new(pair, ReleaseReason::Crowded)));
        };
        let details = |edges: &EdgeSet| match is_strict {
            true => EdgeSet::new(mesh, []),
            false => strips_and_slivers(mesh, self.positions(), self.cell_metric(), edges, cell),
        };
        let first = details(&asked.edges);
        give_up(&first);
        let mut curves = asked.without(self, &first);
        let mut n_maps = 1;
        let (start, made) = loop {
            let start = self.make_seamless(curves.clone(), options, watcher)?;
            // The map may have dropped an edge beside a sliver.
            let more = details(&start.kept(mesh));
            give_up(&more);
            let start = start.without(mesh, &more);
            let kept = start.kept(mesh);
            let may_give_up = n_maps < MOST_MAPS && !is_strict;
            let crowded = |failure: &QuantizationFailure| match may_give_up {
                true => self.crowded(failure, &kept, cell),
                false => EdgeSet::new(mesh, []),
            };
            let mut goes_on = |failure: &_| crowded(failure).is_empty();
            let cause = match round(&start, &settings, &mut goes_on, watcher) {
                Ok(made) => break (start, made),
                Err(cause) => cause,
            };
            let failed = match &cause {
                ManifoldError::Quantize(QuantizeError::Components(failed)) => &failed[..],
                _ => &[],
            };
            let crowded = failed.iter().flat_map(|part| crowded(&part.cause).edges().to_vec());
            let crowded = EdgeSet::new(mesh, crowded);
            if crowded.is_empty() {
                return Err(self.no_manifold(cause, options));
            }
            give_up(&crowded);
            curves = curves.without(self, &crowded.union(mesh, &more));
            n_maps += 1;
        };
        let features = start.features.map(|features| features.among(asked, given_up));
        Ok((SeamlessStart { features, ..start }, made))
    }

    /// The edges to give up where a component has failed: of the curves at lines of the grid that would meet, the short
    /// ones, or else the shortest at each place.
    fn crowded(&self, failure: &QuantizationFailure, kept: &EdgeSet, cell: f64) -> EdgeSet {
        let QuantizationFailure::TooCoarse { pairs, .. } = failure else {
            return EdgeSet::new(self.mesh(), []);
        };
        let graph = FeatureGraph::new(self.mesh(), self.cell_metric(), kept);
        let inside: Vec<&Curve> =
            graph.curves.iter().filter(|curve| curve.boundary_edges == 0).collect();
        let at = |pair: &[u32; 2]| {
            let touches = |curve: &&&Curve| curve.vertices.iter().any(|v| pair.contains(&v.0));
            inside.iter().copied().filter(|curve| touches(&curve)).collect::<Vec<_>>()
        };
        let ends: BTreeSet<[u32; 2]> = pairs.iter().copied().collect();
        let crowds: Vec<Vec<&Curve>> = ends.iter().map(at).collect();
        let short: Vec<&Curve> =
            crowds.iter().flatten().copied().filter(|curve| curve.length < SHORT * cell).collect();
        let given_up = match short.is_empty() {
            true => crowds
                .iter()
                .filter_map(|crowd| crowd.iter().min_by(|a, b| a.length.total_cmp(&b.length)))
                .copied()
                .collect(),
            false => short,
        };
        EdgeSet::new(self.mesh(), given_up.iter().flat_map(|curve| curve.edges.iter().copied()))
    }
}
