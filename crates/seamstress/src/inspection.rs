//! From a file or arrays to triangles that have been checked, and welded and repaired if asked.

use crate::checked::Checked;
use crate::error::{Error, ErrorKind, Stage};
use crate::finding::{Finding, Severity, listing};
use crate::polygons::Polygons;
use crate::report::SurfaceReport;
use crate::surface_options::SurfaceOptions;
use crate::words::counted;
use seamstress_mesh::attributes::Attributes;
use seamstress_mesh::soup::TriangleSoup;
#[cfg(feature = "io")]
use std::path::Path;

/// Faults of each kind that the error for what is no surface lists.
const LISTED: usize = 5;

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
