//! From a file to triangles that have been checked, and repaired if asked.

use crate::faults::listing;
use crate::map_file::Triangles;
use crate::outcome::Failure;
use crate::text::{self, counted};
use seamstress_io::{Format, PolygonMesh, Polygons, read_mesh};
use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::{
    self, Facts, Fault, Severity, TriangleSoup, Triangulation, TriangulationNotes,
};
use std::mem::discriminant;
use std::path::{Path, PathBuf};

/// Warnings of each kind told; the report has them all.
const SHOWN_WARNINGS: usize = 5;
/// Repairs told; the report has them all.
const SHOWN_REPAIRS: usize = 20;
/// Faults of each kind shown when a mesh is refused.
const SHOWN_WHEN_REFUSED: usize = 5;

/// A mesh as read, triangulated, perhaps repaired, and checked.
#[derive(Debug)]
pub(crate) struct LoadedMesh {
    pub(crate) path: PathBuf,
    pub(crate) format: Format,
    /// Vertices and polygons as read.
    pub(crate) n_read: [usize; 2],
    /// The polygons as read.
    pub(crate) polygons: Polygons,
    /// Segments of the `l` elements as read.
    pub(crate) lines: Vec<[u32; 2]>,
    /// For each vertex of `soup` the vertex it was in the file, if repairs may have changed that.
    pub(crate) vertex_origin: Option<Vec<u32>>,
    pub(crate) soup: TriangleSoup,
    /// Counts, topology and size of `soup`.
    pub(crate) facts: Facts,
    /// What is wrong, errors and warnings.
    pub(crate) faults: Vec<Fault>,
    /// Whether repairs would leave a mesh without errors, if there are any now.
    pub(crate) is_repairable: bool,
    /// What was changed or left out on the way.
    pub(crate) notes: Vec<String>,
    /// What was repaired.
    pub(crate) repairs: Vec<String>,
}

impl LoadedMesh {
    /// Reads, triangulates and checks a mesh, with repairs in between if `repair`.
    ///
    /// # Errors
    /// If the file cannot be read. A mesh with faults is no error here.
    pub(crate) fn load(path: &Path, repair: bool) -> Result<Self, Failure> {
        Ok(Self::from_read(path, read_mesh(path)?, repair))
    }

    /// Reads and checks a map: a mesh of triangles, and a UV for every corner.
    ///
    /// # Errors
    /// If the file cannot be read or is not a map. A mesh with faults is no error here.
    pub(crate) fn load_map(path: &Path) -> Result<(Self, Vec<[f64; 2]>), Failure> {
        let read = read_mesh(path)?;
        let corner_uvs = Triangles::of(path, &read)?.corner_uvs;
        Ok((Self::from_read(path, read, false), corner_uvs))
    }

    fn from_read(path: &Path, read: PolygonMesh, repair: bool) -> Self {
        let mut mesh = Self {
            path: path.to_owned(),
            format: read.format,
            n_read: [read.positions.len(), read.polygons.len()],
            polygons: Polygons::new(),
            lines: Vec::new(),
            vertex_origin: None,
            soup: TriangleSoup::default(),
            facts: Facts::default(),
            faults: Vec::new(),
            is_repairable: false,
            notes: read.notes.iter().map(ToString::to_string).collect(),
            repairs: Vec::new(),
        };
        if let Some(polygon_of_face) = mesh.triangulate(read) {
            mesh.check(repair, &polygon_of_face);
        }
        mesh
    }

    /// Splits the polygons; returns the polygon of each face.
    fn triangulate(&mut self, read: PolygonMesh) -> Option<Vec<u32>> {
        let triangulation = soup::triangulate(&read.positions, read.polygons.iter());
        self.soup.positions = read.positions;
        self.polygons = read.polygons;
        self.lines = read.lines;
        match triangulation {
            Ok(Triangulation { faces, polygon_of_face, notes, .. }) => {
                self.notes.extend(triangulation_notes(&notes));
                self.soup.faces = faces;
                Some(polygon_of_face)
            }
            Err(faults) => {
                [self.facts.n_vertices, self.facts.n_faces] = self.n_read;
                self.faults = faults;
                None
            }
        }
    }

    fn check(&mut self, repair: bool, polygon_of_face: &[u32]) {
        let report = soup::check(&self.soup);
        let rename = |fault: Fault| fault.with_faces_renamed(|f| polygon_of_face[f as usize]);
        let (is_mesh, before) = (report.is_mesh(), report.faults);
        self.facts = report.facts;
        if is_mesh && !repair {
            self.faults = before.into_iter().map(rename).collect();
        } else if repair {
            let repaired = soup::repair(std::mem::take(&mut self.soup));
            self.repairs = repaired.repairs.iter().map(ToString::to_string).collect();
            let after = soup::check(&repaired.soup);
            self.faults = if after.is_mesh() {
                after.faults
            } else {
                as_in_file(before, after.faults).map(rename).collect()
            };
            self.facts = after.facts;
            self.soup = repaired.soup;
            self.vertex_origin = Some(repaired.vertex_origin);
        } else {
            let repaired = soup::repair(self.soup.clone());
            self.is_repairable = soup::check(&repaired.soup).is_mesh();
            self.faults = before.into_iter().map(rename).collect();
        }
        self.note_coincident_vertices();
    }

    fn note_coincident_vertices(&mut self) {
        let count = self.facts.n_coincident_vertices;
        if count > 0 && !self.facts.is_closed() {
            let vertices = counted(count, "vertex");
            self.notes.push(format!(
                "{vertices} at the place of another; the surface is not joined there"
            ));
        }
    }

    /// The faults that keep this from being a mesh.
    pub(crate) fn errors(&self) -> impl Iterator<Item = &Fault> {
        let is_error = |fault: &&Fault| fault.severity() == Severity::Error;
        self.faults.iter().filter(is_error)
    }

    /// The faults that do not.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = &Fault> {
        let is_warning = |fault: &&Fault| fault.severity() == Severity::Warning;
        self.faults.iter().filter(is_warning)
    }

    /// Notes, warnings and repairs, on standard error.
    pub(crate) fn tell_findings(&self) {
        for note in &self.notes {
            text::tell(&format!("note: {note}"));
        }
        for repair in self.repairs.iter().take(SHOWN_REPAIRS) {
            text::tell(&format!("repair: {repair}"));
        }
        if self.repairs.len() > SHOWN_REPAIRS {
            let more = self.repairs.len() - SHOWN_REPAIRS;
            text::tell(&format!("repair: and {more} more"));
        }
        if !self.repairs.is_empty() {
            text::tell("note: the map is of the repaired mesh");
        }
        for warning in listing(self.warnings(), SHOWN_WARNINGS) {
            text::tell(&format!("warning: {warning}"));
        }
    }

    /// The connectivity of what is a mesh.
    ///
    /// # Errors
    /// If it is none, with its faults.
    pub(crate) fn connect(&self) -> Result<TriMesh, Failure> {
        self.require_mesh()?;
        TriMesh::from_faces(self.soup.positions.len(), &self.soup.faces)
            .map_err(|error| Failure::BadMesh { file: self.path.clone(), text: error.to_string() })
    }

    /// Refuses what is not a mesh, listing its faults.
    fn require_mesh(&self) -> Result<(), Failure> {
        let count = self.errors().count();
        if count == 0 {
            return Ok(());
        }
        let lines = listing(self.errors(), SHOWN_WHEN_REFUSED).join("\n  ");
        let advice = if self.is_repairable {
            "All of them can be repaired: add `--repair`".into()
        } else {
            let file = self.path.display();
            format!("`--repair` cannot mend all of them; `seamstress check {file}` lists them all")
        };
        let after_repairs = match self.repairs.len() {
            0 => String::new(),
            n => format!(", even after {}", counted(n, "repair")),
        };
        Err(Failure::BadMesh {
            file: self.path.clone(),
            text: format!(
                "not a mesh that can be mapped{after_repairs}; it has {} (elements counted from 0):\n  \
                 {lines}\n{advice}",
                counted(count, "fault")
            ),
        })
    }
}

/// The faults of the file that repairs have left: those of the kinds that are still there. Other
/// faults than those of the file are named as in the repaired mesh.
fn as_in_file(before: Vec<Fault>, after: Vec<Fault>) -> impl Iterator<Item = Fault> {
    let remains =
        |fault: &Fault| after.iter().any(|left| discriminant(left) == discriminant(fault));
    let kept: Vec<Fault> = before.into_iter().filter(remains).collect();
    kept.into_iter()
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
