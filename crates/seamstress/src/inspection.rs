//! From a file or arrays to triangles that have been checked, and repaired if asked.

use crate::error::{Error, ErrorKind, Stage};
use crate::finding::{Finding, Severity, listing};
use crate::polygons::Polygons;
use crate::report::SurfaceReport;
use crate::words::counted;
use seamstress_mesh::soup::{self, Facts, Fault, TriangleSoup, Triangulation, TriangulationNotes};
use serde::{Deserialize, Serialize};
use std::mem::discriminant;
#[cfg(feature = "io")]
use std::path::Path;

/// Faults of each kind that the error for what is no surface lists.
const LISTED: usize = 5;

/// How a surface is made of what is read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct SurfaceOptions {
    /// Repair what can be repaired without moving a vertex, and go on with the repaired mesh
    ///
    /// Drops degenerate and repeated faces and unused vertices, turns faces over that disagree with
    /// their neighbours, and splits vertices where surfaces only touch. Every repair is listed.
    #[cfg_attr(feature = "clap", arg(long))]
    pub repair: bool,
}

impl SurfaceOptions {
    /// Whether to repair what can be repaired without moving a vertex.
    pub fn repair(mut self, repair: bool) -> Self {
        self.repair = repair;
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
    pub(crate) n_input_vertices: usize,
    pub(crate) soup: TriangleSoup,
    /// For each vertex the one that it was in the input; none if repairs have not touched them.
    pub(crate) vertex_origin: Option<Vec<u32>>,
    /// For each face its polygon in the input.
    pub(crate) face_origin: Vec<u32>,
}

impl Inspection {
    /// Reads and checks a mesh: OBJ, OFF, PLY or STL.
    ///
    /// # Errors
    /// [`ErrorKind::Unreadable`]. A mesh with faults is no error here.
    #[cfg(feature = "io")]
    pub fn read(path: impl AsRef<Path>, options: &SurfaceOptions) -> Result<Self, Error> {
        let path = path.as_ref();
        Ok(Self::of_mesh(path, crate::files::read_mesh(path)?, options))
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
        let n_read = [positions.len(), polygons.len()];
        let mut notes = given.notes;
        let triangulation = soup::triangulate(&positions, polygons.iter());
        let mut parts = Parts {
            input: given.input,
            polygons,
            lines: given.lines,
            n_input_vertices: n_read[0],
            ..Parts::default()
        };
        let checked = match triangulation {
            Ok(Triangulation { faces, polygon_of_face, notes: split, .. }) => {
                notes.extend(triangulation_notes(&split));
                Checked::new(TriangleSoup { positions, faces }, &polygon_of_face, options.repair)
            }
            Err(faults) => Checked::unsplit(positions, n_read, faults),
        };
        notes.extend(coincidence_note(&checked.facts));
        let findings: Vec<Finding> = checked.faults.iter().map(Finding::from).collect();
        let report = SurfaceReport {
            file: parts.input.clone(),
            format: given.format,
            vertices_read: n_read[0],
            polygons_read: n_read[1],
            notes,
            warnings: of_severity(&findings, Severity::Warning).cloned().collect(),
            repairs: checked.repairs,
            ..SurfaceReport::new(&checked.facts)
        };
        (parts.soup, parts.vertex_origin) = (checked.soup, checked.vertex_origin);
        parts.face_origin = checked.face_origin;
        Self { parts, report, findings, is_repairable: checked.is_repairable }
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
        let hint = match self.is_repairable {
            true => "all of them can be repaired: add `repair`",
            false => "`repair` cannot mend all of them; `inspect` lists them all",
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
    notes: Vec<String>,
}

/// Triangles after check and repairs.
struct Checked {
    soup: TriangleSoup,
    facts: Facts,
    /// In the vertices and polygons of the input.
    faults: Vec<Fault>,
    is_repairable: bool,
    repairs: Vec<String>,
    vertex_origin: Option<Vec<u32>>,
    face_origin: Vec<u32>,
}

impl Checked {
    fn new(soup: TriangleSoup, polygon_of_face: &[u32], repair: bool) -> Self {
        let report = soup::check(&soup);
        let in_input = |faults: Vec<Fault>| {
            let renamed = faults
                .into_iter()
                .map(|fault| fault.with_faces_renamed(|f| polygon_of_face[f as usize]));
            renamed.collect()
        };
        if !repair {
            let is_repairable =
                !report.is_mesh() && soup::check(&soup::repair(soup.clone()).soup).is_mesh();
            return Self {
                soup,
                facts: report.facts,
                faults: in_input(report.faults),
                is_repairable,
                repairs: Vec::new(),
                vertex_origin: None,
                face_origin: polygon_of_face.to_vec(),
            };
        }
        let repaired = soup::repair(soup);
        let after = soup::check(&repaired.soup);
        let faults = if after.is_mesh() {
            after.faults
        } else {
            in_input(still_there(report.faults, &after.faults))
        };
        Self {
            soup: repaired.soup,
            facts: after.facts,
            faults,
            is_repairable: false,
            repairs: repaired.repairs.iter().map(ToString::to_string).collect(),
            vertex_origin: Some(repaired.vertex_origin),
            face_origin: repaired
                .face_origin
                .iter()
                .map(|&face| polygon_of_face[face as usize])
                .collect(),
        }
    }

    /// Polygons that could not be split.
    fn unsplit(positions: Vec<[f64; 3]>, n_read: [usize; 2], faults: Vec<Fault>) -> Self {
        let mut facts = Facts::default();
        [facts.n_vertices, facts.n_faces] = n_read;
        Self {
            soup: TriangleSoup { positions, faces: Vec::new() },
            facts,
            faults,
            is_repairable: false,
            repairs: Vec::new(),
            vertex_origin: None,
            face_origin: Vec::new(),
        }
    }
}

/// The faults of the input that repairs have left: those of the kinds that are still there.
fn still_there(before: Vec<Fault>, after: &[Fault]) -> Vec<Fault> {
    let remains =
        |fault: &Fault| after.iter().any(|left| discriminant(left) == discriminant(fault));
    before.into_iter().filter(remains).collect()
}

fn coincidence_note(facts: &Facts) -> Option<String> {
    let count = facts.n_coincident_vertices;
    (count > 0 && !facts.is_closed()).then(|| {
        let vertices = counted(count, "vertex");
        format!("{vertices} at the place of another; the surface is not joined there")
    })
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
