//! The files that commands write which make quads.

use super::{inputs, reports, targets};
use crate::failure::Failure;
use crate::output::{Kind, Plan, Target};
use seamstress::{Error, Output, QuadMesh, ShapeOptions, ViewOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The quad mesh, its report and its picture.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct QuadFiles {
    /// Write the quad mesh to this OBJ, OFF, PLY, STL or GLB file, replacing an existing one; `-` is standard output,
    /// as OBJ (with `--source-points` as PLY)
    ///
    /// What the mesh carries comes along as far as the format holds it: UVs with their seams, materials, groups, colours,
    /// normals and other properties. STL and GLB have two triangles for each quad. A name that ends in `.gz` is compressed.
    #[arg(short, long, value_name = "QUADS")]
    output: PathBuf,

    /// Write everything about the run to this file: a page to look at with a name in .html, else JSON; may be given
    /// several times
    #[arg(long, value_name = "FILE")]
    report: Vec<PathBuf>,

    /// Write a picture of the quad mesh with its irregular vertices to this PNG file
    #[arg(long, value_name = "FILE.png", group = "drawn")]
    picture: Option<PathBuf>,
}

impl QuadFiles {
    pub(super) fn plan<'a>(
        &self,
        input: &'a Path,
        others: impl IntoIterator<Item = &'a Path>,
        shape: ShapeOptions,
    ) -> Result<Plan, Failure> {
        if shape.source_points {
            Output::SourcePoints.check_name(&self.output)?;
        }
        let mut files = targets(Kind::Picture, &self.picture);
        files.extend(reports(&self.report));
        files.extend(targets(Kind::Quads, [&self.output]));
        Plan::new(&inputs(input, others), None, files)
    }

    pub(super) fn pictures(
        &self,
        quads: &QuadMesh,
        view: &ViewOptions,
    ) -> Result<Vec<Vec<u8>>, Error> {
        self.picture.iter().map(|_| quads.picture(view)).collect()
    }
}

pub(super) fn write(quads: &QuadMesh, target: &Target, mut file: &mut dyn Write) -> io::Result<()> {
    quads.write_as(&target.path, &mut file)
}
