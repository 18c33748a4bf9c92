//! A seamless map rounded to a grid, with the features that the grid has room for.

use crate::context::Watcher;
use crate::error::{Error, ErrorKind};
use crate::features::{FeatureCurves, ordered};
use crate::options::IntegerMapOptions;
use crate::seamless_start::SeamlessStart;
use crate::surface::Surface;
use seamstress_mesh::features::{Curve, EdgeSet, FeatureGraph, strips_and_slivers};
use seamstress_parametrize::{ReleaseReason, ReleasedFeature};
use seamstress_quads::{GoesOn, ManifoldError};
use seamstress_quantize::{
    GridSize, Quantization, QuantizationFailure, QuantizeError, QuantizeOptions,
};
use std::collections::BTreeSet;

/// Maps made at most, each with fewer features.
const MOST_MAPS: i32 = 6;
/// The part of the work on a rounding that one is worth where there is another already.
const EFFORT_AGAIN: usize = 5;
/// Curves shorter than so many cells are given up first.
const SHORT: f64 = 1.0;
/// With every further map those are given up that are so many times as long, and always some: those less than so many times as
/// long as the shortest.
const LONGER: f64 = 4.0;

/// Rounds a map, and makes something of it on the grid.
pub(crate) trait Round<T>:
    Fn(&SeamlessStart, &QuantizeOptions, &mut GoesOn<'_>, &mut Watcher) -> Result<T, ManifoldError>
{
}

impl<T, R> Round<T> for R where
    R: Fn(
        &SeamlessStart,
        &QuantizeOptions,
        &mut GoesOn<'_>,
        &mut Watcher,
    ) -> Result<T, ManifoldError>
{
}

/// What is made of a map on a grid, and how it is found there.
pub(crate) struct Rounding<R, T> {
    pub(crate) round: R,
    /// The integer-grid map in what that makes.
    pub(crate) solution: fn(&T) -> &Quantization,
}

/// A map with what was made of it.
struct Gridded<T> {
    start: SeamlessStart,
    made: T,
    /// How far the number of quads is off, as a share.
    off: f64,
    /// Features that were given up for it.
    given_up: EdgeSet,
}

/// A map with some features, and its rounding.
struct Attempt<T> {
    made: Result<Gridded<T>, Error>,
    /// The features to give up before another attempt.
    crowd: EdgeSet,
}

impl Surface {
    /// Makes a seamless map and rounds it. Of strips much narrower than a cell one side is given up first. Where features
    /// are too close together for the grid asked for, the shortest curves there are given up, and the map is made again;
    /// where there are none to give up, the grid gets finer. Further maps are made as long as there are features to
    /// give up, and the one that comes closest to the number of quads asked for stays.
    ///
    /// # Errors
    /// Those of [`Surface::make_seamless`], and of the rounding with the fewest features.
    pub(crate) fn make_gridded<R: Round<T>, T>(
        &self,
        asked: &FeatureCurves,
        options: &IntegerMapOptions,
        watcher: &mut Watcher,
        rounding: &Rounding<R, T>,
    ) -> Result<(SeamlessStart, T), Error> {
        let (mesh, settings) = (self.mesh(), options.to_quantize());
        let mut given_up = self.details(&asked.edges, options);
        let mut best: Option<Gridded<T>> = None;
        let mut n_maps = 1;
        let best = loop {
            let effort = match best {
                None => settings.effort,
                Some(_) => settings.effort / EFFORT_AGAIN,
            };
            let settings = QuantizeOptions { effort, ..settings };
            let may_give_up = n_maps < MOST_MAPS && !options.map.features_strict;
            // The shortest curves first, later longer ones.
            let short = may_give_up.then(|| self.cell(options) * SHORT * LONGER.powi(n_maps - 1));
            let Attempt { made, crowd } =
                self.attempt((asked, &given_up), (options, &settings, short), watcher, rounding);
            best = match (made, best) {
                (Ok(made), best) => {
                    let closest = best.filter(|best| best.off <= made.off).unwrap_or(made);
                    if crowd.is_empty() {
                        break closest;
                    }
                    Some(closest)
                }
                (Err(error), _) if error.kind() == ErrorKind::Cancelled => return Err(error),
                (Err(_), Some(best)) if crowd.is_empty() => break best,
                (Err(error), None) if crowd.is_empty() => return Err(error),
                (Err(_), best) => best,
            };
            given_up = given_up.union(mesh, &crowd);
            n_maps += 1;
        };
        let pairs = best.given_up.vertex_pairs(mesh).into_iter().map(ordered);
        let given_up = pairs.map(|pair| ReleasedFeature::new(pair, ReleaseReason::Crowded));
        let given_up = given_up.collect();
        let features = best.start.features.map(|features| features.among(asked, given_up));
        Ok((SeamlessStart { features, ..best.start }, best.made))
    }

    /// The features that a grid has no room for.
    fn details(&self, edges: &EdgeSet, options: &IntegerMapOptions) -> EdgeSet {
        match options.map.features_strict {
            true => EdgeSet::new(self.mesh(), []),
            false => {
                let (cell, metric) = (self.cell(options), self.cell_metric());
                strips_and_slivers(self.mesh(), self.positions(), metric, edges, cell)
            }
        }
    }

    fn cell(&self, options: &IntegerMapOptions) -> f64 {
        options.size.to_quantize().cell(self.cell_metric().side())
    }

    /// Makes a map that follows all features asked for but those given up, and rounds it.
    fn attempt<R: Round<T>, T>(
        &self,
        (asked, given_up): (&FeatureCurves, &EdgeSet),
        (options, settings, short): (&IntegerMapOptions, &QuantizeOptions, Option<f64>),
        watcher: &mut Watcher,
        rounding: &Rounding<R, T>,
    ) -> Attempt<T> {
        let mesh = self.mesh();
        let none = EdgeSet::new(mesh, []);
        let start = match self.make_seamless(asked.without(self, given_up), options, watcher) {
            Ok(start) => start,
            Err(error) => return Attempt { made: Err(error), crowd: none },
        };
        // The map may have dropped an edge beside a sliver.
        let more = self.details(&start.kept(mesh), options);
        let start = start.without(mesh, &more);
        let kept = start.kept(mesh);
        let crowded = |pairs: &[[u32; 2]]| match short {
            Some(short) => self.crowded(pairs, &kept, short),
            None => EdgeSet::new(mesh, []),
        };
        let mut goes_on = |failure: &_| {
            let pairs: Vec<_> = close(failure).collect();
            crowded(&pairs).is_empty()
        };
        let rounded = (rounding.round)(&start, settings, &mut goes_on, watcher);
        let crowd = match &rounded {
            Ok(made) => crowded(&(rounding.solution)(made).crowded),
            Err(ManifoldError::Quantize(QuantizeError::Components(failed))) => {
                let pairs: Vec<_> = failed.iter().flat_map(|part| close(&part.cause)).collect();
                crowded(&pairs)
            }
            Err(_) => none,
        };
        let crowd = match crowd.is_empty() {
            true => crowd,
            false => crowd.union(mesh, &more),
        };
        let made = rounded.map_err(|cause| self.no_manifold(cause, options)).map(|made| {
            let off = match settings.size {
                GridSize::Quads(asked) => ((rounding.solution)(&made).quads() / asked - 1.0).abs(),
                GridSize::EdgeLength(_) | GridSize::Scale(_) => 0.0,
            };
            Gridded { start, made, off, given_up: given_up.union(mesh, &more) }
        });
        Attempt { made, crowd }
    }

    /// The edges to give up where vertices are too close together: of the curves at lines of the grid that would meet, the short
    /// ones.
    fn crowded(&self, pairs: &[[u32; 2]], kept: &EdgeSet, short: f64) -> EdgeSet {
        let graph = FeatureGraph::new(self.mesh(), self.cell_metric(), kept);
        let inside: Vec<&Curve> =
            graph.curves.iter().filter(|curve| curve.boundary_edges == 0).collect();
        let at = |pair: &[u32; 2]| {
            let touches = |curve: &&&Curve| curve.vertices.iter().any(|v| pair.contains(&v.0));
            inside.iter().copied().filter(|curve| touches(&curve)).collect::<Vec<_>>()
        };
        let ends: BTreeSet<[u32; 2]> = pairs.iter().copied().collect();
        let crowds: Vec<&Curve> = ends.iter().flat_map(at).collect();
        let shortest = crowds.iter().map(|curve| curve.length).fold(f64::INFINITY, f64::min);
        let short = short.max(LONGER * shortest);
        let given_up = crowds.into_iter().filter(|curve| curve.length < short);
        EdgeSet::new(self.mesh(), given_up.flat_map(|curve| curve.edges.iter().copied()))
    }
}

/// The pairs of vertices that a grid has not kept apart.
fn close(failure: &QuantizationFailure) -> impl Iterator<Item = [u32; 2]> + '_ {
    let pairs = match failure {
        QuantizationFailure::TooCoarse { pairs, .. }
        | QuantizationFailure::Blocked { pairs, .. } => &pairs[..],
        _ => &[],
    };
    pairs.iter().copied()
}
