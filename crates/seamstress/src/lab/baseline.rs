//! The classical baseline: the Poisson layout of a smooth field, which may have flips.

use super::options::MethodOptions;
use crate::context::Watcher;
use crate::error::{Error, ErrorKind};
use crate::finding::{Finding, listing};
use crate::map::{CornerUvs, SeamlessMap, UvSet};
use crate::report::{ConeReport, Distortion, SurfaceReport, VERSION};
use crate::surface::Surface;
use crate::words::counted;
use seamstress_parametrize::map::Cone;
use seamstress_parametrize::{ComponentStats, FieldMapOptions, make_field_map};
use serde::Serialize;
use std::io;
use std::path::Path;

/// A certified map, or a layout that is none and says so.
#[derive(Debug, Clone)]
pub enum LaidOut {
    /// A certified map.
    Certified(Box<SeamlessMap>),
    /// The layout of a field, with flips that were allowed.
    Uncertified(Box<FieldLayout>),
}

/// The layout of a cross field that is no seamless map.
#[derive(Debug, Clone)]
pub struct FieldLayout {
    surface: Surface,
    corner_uvs: Vec<[f64; 2]>,
    cones: Vec<Cone>,
    report: FieldLayoutReport,
}

/// How such a layout is, and why it is no map.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FieldLayoutReport {
    /// The version that made it.
    pub seamstress: &'static str,
    /// The options it was made with.
    pub options: MethodOptions,
    /// The surface.
    pub input: SurfaceReport,
    /// How it was made, component by component.
    pub components: Vec<ComponentStats>,
    /// Its distortion.
    pub distortion: Distortion,
    /// The cones of the field.
    pub cones: ConeReport,
    /// There is none.
    pub certificate: Option<()>,
    /// Why not.
    pub violations: Vec<Finding>,
}

/// Violations of each kind that are listed.
const LISTED: usize = 5;

impl FieldLayout {
    /// The UV of every corner, three a face.
    pub fn corner_uvs(&self) -> &[[f64; 2]] {
        &self.corner_uvs
    }

    /// The cones of the field.
    pub fn cones(&self) -> &[Cone] {
        &self.cones
    }

    /// How it is, and why it is no map.
    pub fn report(&self) -> &FieldLayoutReport {
        &self.report
    }

    /// Counts what is wrong with it and names some of each kind.
    pub fn violations_text(&self) -> String {
        named(&self.report.violations)
    }

    /// Writes it in the format that a file of this name has: OBJ, PLY or GLB. OBJ if it says none.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_as(
        &self,
        name: impl AsRef<Path>,
        set: UvSet,
        writer: &mut impl io::Write,
    ) -> io::Result<()> {
        let title = "Uncertified layout of a cross field (triangles are flipped)";
        let lines = [self.report.distortion.line(self.cones.len())];
        let corners = CornerUvs::new(self.surface.faces(), &self.corner_uvs);
        crate::map::write_map(writer, name.as_ref(), &self.surface, title, (&corners, set), &lines)
    }
}

fn named(violations: &[Finding]) -> String {
    let is_flip =
        |v: &&Finding| matches!(v.kind.as_str(), "flipped-triangle" | "collapsed-triangle");
    let flips = violations.iter().filter(is_flip).count();
    let counts = format!(
        "{} flipped or collapsed and {} (elements counted from 0)",
        counted(flips, "triangle"),
        counted(violations.len() - flips, "other violation")
    );
    let lines = std::iter::once(counts).chain(listing(violations, LISTED));
    lines.collect::<Vec<_>>().join("\n  ")
}

impl Surface {
    /// The Poisson layout of a smooth field.
    pub(super) fn lay_out_field(
        &self,
        options: &MethodOptions,
        watcher: &mut Watcher,
    ) -> Result<LaidOut, Error> {
        let settings = FieldMapOptions {
            iterations: options.start.local_global,
            ..FieldMapOptions::default()
        };
        let mut observe = |progress| watcher.observe(progress);
        let made = make_field_map(self.mesh(), self.positions(), &settings, &mut observe)
            .map_err(|cause| self.no_map(cause))?;
        let layout = match made.map {
            Ok(map) => {
                let map = SeamlessMap::new(self, map, None, &options.map, made.components);
                return Ok(LaidOut::Certified(Box::new(map)));
            }
            Err(layout) => layout,
        };
        let violations = self.findings(&layout.violations);
        if !options.start.allow_flips {
            let text = format!("the layout of the field has {}", named(&violations));
            return Err(Error::new(ErrorKind::Uncertified, text)
                .with_findings(violations)
                .with_hint("lay it out with `exact`, or take it as it is with `allow_flips`"));
        }
        let report = FieldLayoutReport {
            seamstress: VERSION,
            options: options.clone(),
            input: self.report().clone(),
            components: made.components,
            distortion: Distortion::from(&made.distortion),
            cones: ConeReport::new(&made.field_cones),
            certificate: None,
            violations,
        };
        Ok(LaidOut::Uncertified(Box::new(FieldLayout {
            surface: self.clone(),
            corner_uvs: layout.corner_uvs,
            cones: made.field_cones,
            report,
        })))
    }
}
