//! From a file or arrays to triangles that have been checked, and welded and repaired if asked.

use crate::error::{Error, ErrorKind, Stage};
use crate::finding::{Finding, Severity, listing};
use crate::mesh_format::MeshFormat;
use crate::polygons::Polygons;
use crate::report::SurfaceReport;
use crate::words::{counted, rounded};
use seamstress_mesh::attributes::Attributes;
use seamstress_mesh::soup::{
    self, Facts, Fault, Merged, Repair, TriangleSoup, Triangulation, TriangulationNotes,
};
use serde::{Deserialize, Serialize};
#[cfg(feature = "io")]
use std::path::Path;
use std::str::FromStr;

/// Faults of each kind that the error for what is no surface lists.
const LISTED: usize = 5;

/// How a surface is made of what is read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct SurfaceOptions {
    /// Repair what can be repaired without moving a vertex, and go on with the repaired mesh
    ///
    /// Drops degenerate and repeated faces and unused vertices, leaves out repeated corners, collapses edges
    /// of length zero, turns faces over that disagree with their neighbours, cuts edges of three or more faces
    /// apart into sheets and pieces such as Moebius bands open, and splits vertices where surfaces only touch.
    /// Every repair is listed.
    #[cfg_attr(feature = "clap", arg(long))]
    pub repair: bool,

    /// Merge vertices within this distance of another, in mesh units
    ///
    /// Without a distance, or with `auto`: exact copies, and within the noise of the copies if there is one, far
    /// below the lengths of edges. `soups` does so where faces share next to no vertices, `off` never.
    #[cfg_attr(feature = "clap", arg(long, value_name = "TOLERANCE", num_args = 0..=1,
        default_value = "soups", default_missing_value = "auto"))]
    pub weld: Weld,

    /// Format of the mesh, as of standard input, where neither name nor content says it [default: as they say]
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "FORMAT"))]
    pub format: Option<MeshFormat>,
}

/// Which vertices are merged on reading.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Weld {
    /// Copies of one vertex, where faces share next to no vertices.
    #[default]
    Soups,
    /// Copies of one vertex.
    Auto,
    /// None.
    Off,
    /// Those within this distance of another, mesh units; with 0 those in the same place.
    Within(f64),
}

impl FromStr for Weld {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "soups" => Ok(Self::Soups),
            "auto" => Ok(Self::Auto),
            "off" => Ok(Self::Off),
            _ => match text.parse::<f64>() {
                Ok(x) if x.is_finite() && x >= 0.0 => Ok(Self::Within(x)),
                _ => Err("expected a distance, 0 or larger, or `auto`, `soups` or `off`; \
                          files go before `--weld`"
                    .into()),
            },
        }
    }
}

impl SurfaceOptions {
    /// Whether to repair what can be repaired without moving a vertex.
    pub fn repair(mut self, repair: bool) -> Self {
        self.repair = repair;
        self
    }

    /// Sets which vertices are merged.
    pub fn weld(mut self, weld: Weld) -> Self {
        self.weld = weld;
        self
    }

    /// Sets the format of the file.
    pub fn format(mut self, format: MeshFormat) -> Self {
        self.format = Some(format);
        self
    }
}

/// A mesh as it was given, triangulated, perhaps repaired, and checked.
///
/// It need not be a surface: [`Inspection::surface`] makes one of it, or says why it cannot.
#[derive(Debug, Clone)]
pub struct Inspection {
    pub(crate) parts: Parts,
    report: SurfaceReport,
    findings: Vec<Finding>,
    is_repairable: bool,
    is_repaired: bool,
}

/// What a surface keeps of its input.
#[derive(Debug, Clone, Default)]
pub(crate) struct Parts {
    /// The file as it was named.
    pub(crate) input: Option<String>,
    /// The polygons as given, whose sides files of features name, and by which quads are compared.
    pub(crate) polygons: Polygons,
    /// Segments of the `l` elements of an OBJ file.
    pub(crate) lines: Vec<[u32; 2]>,
    /// What the input carries.
    pub(crate) attributes: Attributes,
    pub(crate) n_input_vertices: usize,
    pub(crate) soup: TriangleSoup,
    /// For each vertex of the input the one that it was merged into; none if no vertices were merged.
    pub(crate) merged_into: Option<Vec<u32>>,
    /// For each vertex the one that it was in the input; none if merging and repairs have not touched them.
    pub(crate) vertex_origin: Option<Vec<u32>>,
    /// For each face its polygon in the input.
    pub(crate) face_origin: Vec<u32>,
}

impl Inspection {
    /// Reads and checks a mesh: OBJ, OFF, PLY, STL or glTF.
    ///
    /// # Errors
    /// [`ErrorKind::Unreadable`]. A mesh with faults is no error here.
    #[cfg(feature = "io")]
    pub fn read(path: impl AsRef<Path>, options: &SurfaceOptions) -> Result<Self, Error> {
        let path = path.as_ref();
        Ok(Self::of_mesh(path, crate::files::read_mesh(path, options.format)?, options))
    }

    /// Checks a mesh that is in memory as a file: OBJ, OFF, PLY, STL or glTF, as its content says. The name stands for
    /// it in messages and reports, and the format of the options or its ending decides where the content is unclear.
    ///
    /// # Errors
    /// [`ErrorKind::Unreadable`].
    #[cfg(feature = "io")]
    pub fn of_file_content(
        content: &[u8],
        name: impl AsRef<Path>,
        options: &SurfaceOptions,
    ) -> Result<Self, Error> {
        let name = name.as_ref();
        let format = options.format.map(seamstress_io::Format::from);
        let format = format.or_else(|| seamstress_io::Format::from_path(name));
        let read = seamstress_io::parse_mesh(content, format, &name.display().to_string())?;
        Ok(Self::of_mesh(name, read, options))
    }

    #[cfg(feature = "io")]
    pub(crate) fn of_mesh(
        path: &Path,
        read: seamstress_io::PolygonMesh,
        options: &SurfaceOptions,
    ) -> Self {
        let input = Given {
            input: Some(path.display().to_string()),
            format: Some(read.format.to_string()),
            attributes: read.attributes,
            lines: read.lines,
            notes: read.notes.iter().map(ToString::to_string).collect(),
        };
        Self::of(input, read.positions, read.polygons.iter().collect(), *options)
    }

    /// Checks polygons given as lists of vertices, counted from 0, counter-clockwise seen from outside.
    pub fn of_polygons<P: AsRef<[u32]>>(
        positions: &[[f64; 3]],
        polygons: impl IntoIterator<Item = P>,
        options: &SurfaceOptions,
    ) -> Self {
        let polygons = polygons.into_iter().collect();
        Self::of(Given::default(), positions.to_vec(), polygons, *options)
    }

    fn of(
        given: Given,
        positions: Vec<[f64; 3]>,
        polygons: Polygons,
        options: SurfaceOptions,
    ) -> Self {
        let checked = Checked::new(&positions, &polygons, options);
        let findings: Vec<Finding> = checked.faults.iter().map(Finding::from).collect();
        let coincident_vertices = checked.coincident_vertices();
        let mut notes = given.notes;
        notes.extend(checked.notes);
        if coincident_vertices > 0 && !checked.facts.is_closed() {
            let vertices = counted(coincident_vertices, "vertex");
            notes.push(format!(
                "{vertices} in the place of another, where the surface is not joined; `weld` joins them"
            ));
        }
        let report = SurfaceReport {
            file: given.input.clone(),
            format: given.format,
            vertices_read: positions.len(),
            polygons_read: polygons.len(),
            welded_vertices: checked.welded_vertices,
            weld_tolerance: checked.weld_tolerance,
            junction_edges: checked.junctions,
            coincident_vertices,
            notes,
            warnings: of_severity(&findings, Severity::Warning).cloned().collect(),
            repairs: checked.repairs,
            ..SurfaceReport::new(&checked.facts)
        };
        let parts = Parts {
            input: given.input,
            polygons,
            lines: given.lines,
            attributes: given.attributes,
            n_input_vertices: positions.len(),
            soup: checked.soup,
            merged_into: checked.merged_into,
            vertex_origin: checked.vertex_origin,
            face_origin: checked.face_origin,
        };
        let is_repairable = checked.is_repairable;
        Self { parts, report, findings, is_repairable, is_repaired: options.repair }
    }

    /// Everything found wrong, errors and warnings, with vertices and faces of the input.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Whether there is no error among the findings.
    pub fn is_surface(&self) -> bool {
        of_severity(&self.findings, Severity::Error).next().is_none()
    }

    /// Whether repairs would leave no error, where there are any now.
    pub fn is_repairable(&self) -> bool {
        self.is_repairable
    }

    /// Counts, topology, size, notes, warnings and repairs.
    pub fn report(&self) -> &SurfaceReport {
        &self.report
    }

    /// Its parts and its report, unless it is no surface.
    pub(crate) fn into_parts(self) -> Result<(Parts, SurfaceReport), Error> {
        if !self.is_surface() {
            return Err(self.refusal());
        }
        Ok((self.parts, self.report))
    }

    fn refusal(self) -> Error {
        let errors: Vec<Finding> = of_severity(&self.findings, Severity::Error).cloned().collect();
        let after_repairs = match self.report.repairs.len() {
            0 => String::new(),
            n => format!(", even after {}", counted(n, "repair")),
        };
        let message = format!(
            "not a mesh that can be mapped{after_repairs}; it has {} (elements counted from 0):\n  {}",
            counted(errors.len(), "fault"),
            listing(&errors, LISTED).join("\n  ")
        );
        let hint = match (self.is_repaired, self.is_repairable) {
            (true, _) => "`inspect` lists them all",
            (false, true) => "all of them can be repaired: add `repair`",
            (false, false) => "`repair` cannot mend all of them; `inspect` lists them all",
        };
        Error::new(ErrorKind::NotASurface, message)
            .at_stage(Some(Stage::Check))
            .with_findings(errors)
            .with_hint(hint)
            .of(self.parts.input.as_deref())
    }
}

fn of_severity(findings: &[Finding], severity: Severity) -> impl Iterator<Item = &Finding> {
    findings.iter().filter(move |finding| finding.severity == severity)
}

/// What a file says beside positions and polygons.
#[derive(Default)]
struct Given {
    input: Option<String>,
    format: Option<String>,
    lines: Vec<[u32; 2]>,
    attributes: Attributes,
    notes: Vec<String>,
}

/// Triangles after check, merging and repairs.
#[derive(Default)]
struct Checked {
    soup: TriangleSoup,
    facts: Facts,
    /// In the vertices and polygons of the input.
    faults: Vec<Fault>,
    is_repairable: bool,
    notes: Vec<String>,
    repairs: Vec<String>,
    welded_vertices: usize,
    weld_tolerance: Option<f64>,
    /// In the vertices of the input.
    junctions: Vec<[u32; 2]>,
    merged_into: Option<Vec<u32>>,
    vertex_origin: Option<Vec<u32>>,
    face_origin: Vec<u32>,
}

impl Checked {
    fn new(positions: &[[f64; 3]], polygons: &Polygons, options: SurfaceOptions) -> Self {
        let slices: Vec<&[u32]> = polygons.iter().collect();
        let faults = soup::polygon_faults(positions.len(), &slices);
        let has_bad_corners = !faults.is_empty();
        let is_of_corners = |fault: &Fault| {
            matches!(fault, Fault::RepeatedVertex { .. } | Fault::TooFewCorners { .. })
        };
        if !faults.iter().all(is_of_corners) {
            return Self::unsplit(positions, slices.len(), faults);
        }
        let mut checked = Self::default();
        let mut repairs = Vec::new();
        let into = checked.merge_vertices(positions, polygons, options, &mut repairs);
        let merged = match into {
            Some(_) => into,
            None if options.repair && has_bad_corners => {
                Some((0..positions.len() as u32).collect())
            }
            None => None,
        }
        .map(|into| (soup::merge(positions, polygons.iter(), &into), into));
        match merged {
            None => checked.split(positions.to_vec(), polygons.iter(), None, options, repairs),
            Some((mut merged, into)) => {
                repairs.append(&mut merged.repairs);
                checked.merged_into = Some(into);
                let positions = std::mem::take(&mut merged.positions);
                let polygons = std::mem::take(&mut merged.polygons);
                let slices = polygons.iter().map(Vec::as_slice);
                checked.split(positions, slices, Some(&merged), options, repairs);
            }
        }
        let is_error = |fault: &Fault| fault.severity() == soup::Severity::Error;
        if !options.repair && checked.faults.iter().any(is_error) {
            let repaired = Self::new(positions, polygons, options.repair(true));
            checked.is_repairable = !repaired.faults.iter().any(is_error);
        }
        checked
    }

    /// For each vertex what it is merged into, if any is.
    fn merge_vertices(
        &mut self,
        positions: &[[f64; 3]],
        polygons: &Polygons,
        options: SurfaceOptions,
        repairs: &mut Vec<Repair>,
    ) -> Option<Vec<u32>> {
        let is_soup = || soup::is_unwelded(positions.len(), polygons.iter());
        let automatic = || soup::weld_tolerance(positions, polygons.iter());
        let tolerance = match options.weld {
            Weld::Off => None,
            Weld::Soups => is_soup().then(automatic),
            Weld::Auto => Some(automatic()),
            Weld::Within(tolerance) => Some(tolerance),
        };
        if let Some(tolerance) = tolerance {
            let into = soup::weld(positions, tolerance);
            let count = n_merged(&into);
            if count == 0 && options.weld == Weld::Soups {
                return None;
            }
            (self.welded_vertices, self.weld_tolerance) = (count, Some(tolerance));
            self.notes.push(weld_note(count, tolerance, options.weld));
            return (count > 0).then_some(into);
        }
        if !options.repair {
            return None;
        }
        let into = soup::collapse(positions, polygons.iter());
        let mut sets: Vec<[u32; 2]> = into.iter().copied().zip(0..).map(<[u32; 2]>::from).collect();
        sets.sort_unstable();
        let joined = sets.chunk_by(|a, b| a[0] == b[0]).filter(|set| set.len() > 1);
        repairs.extend(joined.map(|set| Repair::CollapsedSides {
            vertices: set.iter().map(|pair| pair[1]).collect(),
        }));
        (n_merged(&into) > 0).then_some(into)
    }

    /// Splits polygons into triangles, and checks these, after repairs if they are asked for.
    fn split<'a>(
        &mut self,
        positions: Vec<[f64; 3]>,
        polygons: impl ExactSizeIterator<Item = &'a [u32]>,
        merged: Option<&Merged>,
        options: SurfaceOptions,
        repairs: Vec<Repair>,
    ) {
        self.repairs = repairs.iter().map(ToString::to_string).collect();
        let polygon_was = |polygon: u32| match merged {
            Some(merged) => merged.polygon_origin[polygon as usize],
            None => polygon,
        };
        let vertex_was = |vertex: u32| match merged {
            Some(merged) => merged.vertex_origin[vertex as usize],
            None => vertex,
        };
        let n_polygons = polygons.len();
        let (faces, polygon_of_face) = match soup::triangulate(&positions, polygons) {
            Ok(Triangulation { faces, polygon_of_face, mut notes, .. }) => {
                for polygon in &mut notes.unresolved {
                    *polygon = polygon_was(*polygon);
                }
                self.notes.extend(triangulation_notes(&notes));
                (faces, polygon_of_face.into_iter().map(polygon_was).collect::<Vec<u32>>())
            }
            Err(faults) => {
                let faults = faults.into_iter().map(|fault| {
                    fault.with_faces_renamed(polygon_was).with_vertices_renamed(vertex_was)
                });
                let unsplit = Self::unsplit(&positions, n_polygons, faults.collect());
                (self.soup, self.facts, self.faults) =
                    (unsplit.soup, unsplit.facts, unsplit.faults);
                return;
            }
        };
        let soup = TriangleSoup { positions, faces };
        self.vertex_origin = merged.map(|merged| merged.vertex_origin.clone());
        self.face_origin = polygon_of_face;
        self.soup = match options.repair {
            false => soup,
            true => self.repair(soup, vertex_was),
        };
        let report = soup::check(&self.soup);
        let in_input = |fault: Fault| {
            let fault = fault.with_faces_renamed(|face| self.face_origin[face as usize]);
            match &self.vertex_origin {
                Some(origin) => fault.with_vertices_renamed(|v| origin[v as usize]),
                None => fault,
            }
        };
        self.faults = report.faults.into_iter().map(in_input).collect();
        // Triangles of one polygon may have one fault.
        self.faults.dedup();
        self.facts = report.facts;
    }

    fn repair(&mut self, soup: TriangleSoup, vertex_was: impl Fn(u32) -> u32) -> TriangleSoup {
        let done = soup::repair(soup);
        let polygon_was = |face: u32| self.face_origin[face as usize];
        let mut repairs: Vec<Repair> =
            done.repairs.into_iter().map(|r| r.renamed(polygon_was, &vertex_was)).collect();
        repairs.dedup();
        self.repairs.extend(repairs.iter().map(ToString::to_string));
        self.junctions = done.junctions.iter().map(|edge| edge.map(&vertex_was)).collect();
        self.vertex_origin = Some(done.vertex_origin.into_iter().map(&vertex_was).collect());
        self.face_origin = done.face_origin.into_iter().map(polygon_was).collect();
        done.soup
    }

    /// Vertices in the place of another, not counting the copies that repairs have made.
    fn coincident_vertices(&self) -> usize {
        let mut origins = self.vertex_origin.clone().unwrap_or_default();
        let n_vertices = origins.len();
        origins.sort_unstable();
        origins.dedup();
        self.facts.n_coincident_vertices.saturating_sub(n_vertices - origins.len())
    }

    /// Polygons that could not be split.
    fn unsplit(positions: &[[f64; 3]], n_polygons: usize, faults: Vec<Fault>) -> Self {
        let mut facts = Facts::default();
        (facts.n_vertices, facts.n_faces) = (positions.len(), n_polygons);
        let soup = TriangleSoup { positions: positions.to_vec(), faces: Vec::new() };
        Self { soup, facts, faults, ..Self::default() }
    }
}

fn n_merged(into: &[u32]) -> usize {
    into.iter().zip(0u32..).filter(|(into, v)| **into != *v).count()
}

fn weld_note(count: usize, tolerance: f64, weld: Weld) -> String {
    let place = match tolerance > 0.0 {
        true => format!("within {} of another", rounded(tolerance)),
        false => "in the place of another".into(),
    };
    let reason = match weld {
        Weld::Soups => "; the faces shared next to none",
        _ => "",
    };
    match count {
        0 => format!("no vertex is {place}"),
        n => format!("merged {} {place}{reason}", counted(n, "vertex")),
    }
}

fn triangulation_notes(notes: &TriangulationNotes) -> Vec<String> {
    let mut lines = Vec::new();
    let quads = counted(notes.quads, "quad");
    let larger = counted(notes.larger, "polygon");
    match (notes.quads, notes.larger) {
        (0, 0) => {}
        (_, 0) => lines.push(format!("{quads} split into triangles")),
        (0, _) => lines.push(format!("{larger} split into triangles")),
        _ => lines.push(format!("{quads} and {larger} of more corners split into triangles")),
    }
    if let [first, ..] = notes.unresolved[..] {
        lines.push(format!(
            "{} could not be split into triangles that are not flat or overlapping; the first is face {first}",
            counted(notes.unresolved.len(), "polygon")
        ));
    }
    lines
}
