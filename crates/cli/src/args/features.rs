//! Arguments that ask for features.

use crate::features::FeatureSource;
use std::path::Path;

/// Edges that the map should follow.
#[derive(Debug, Clone, Default, clap::Args)]
pub(crate) struct FeatureArgs {
    /// Feature edges, from one of these sources; may be given several times
    ///
    /// angle:DEGREES  where the surface bends by that much or more
    /// lines          the `l` elements of the mesh, an OBJ file
    /// pairs:FILE     two vertices a line, counted from 0; # starts a comment
    /// sharp:FILE     a .sharp file of QuadWild: the count, then `type,face,side` a line
    ///
    /// Vertices and faces are those of the file, also with `--repair`.
    #[arg(long, value_name = "SOURCE", verbatim_doc_comment)]
    pub(crate) features: Vec<FeatureSource>,

    /// Align the boundary as well
    #[arg(long)]
    pub(crate) align_boundary: bool,
}

impl FeatureArgs {
    /// Whether any feature is asked for.
    pub(crate) fn is_given(&self) -> bool {
        self.align_boundary || !self.features.is_empty()
    }

    /// The files that features are read from.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        self.features.iter().filter_map(FeatureSource::file)
    }
}
