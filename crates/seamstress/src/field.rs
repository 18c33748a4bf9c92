//! Cross fields.

use crate::certify::CertifyOptions;
use crate::error::{Error, ErrorKind, Stage};
use crate::map::SeamlessMap;
use crate::report::{SurfaceReport, VERSION};
use crate::surface::Surface;
use seamstress_mesh::{Face, Halfedge, HalfedgeData, TriMesh};
use seamstress_parametrize::field::{self as method, DualLoop, Homology, directions_in_space};
use seamstress_parametrize::map::Cone;
use seamstress_parametrize::{self as parametrize};
use serde::Serialize;
#[cfg(feature = "io")]
use std::io;

/// A cross field on a surface: four directions at right angles on each face, and a matching across each edge.
#[derive(Debug, Clone)]
pub struct CrossField {
    surface: Surface,
    field: method::CrossField,
    report: FieldReport,
}

/// The indices of a field.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FieldReport {
    /// The version that made it.
    pub seamstress: &'static str,
    /// The surface.
    pub input: SurfaceReport,
    /// Vertices with an index other than zero, in quarters of a turn.
    pub cones: Vec<Cone>,
    /// Loops around handles, two for each.
    pub loops: Vec<FieldLoop>,
    /// Edges whose matching is not that of the files, 0 to 3, but full turns more or less.
    pub full_turns: Vec<FullTurns>,
}

/// A closed path of faces and the index of the field along it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FieldLoop {
    /// Minus the quarters by which the path turns left in the map.
    pub index: i32,
    /// The faces in order; the last is next to the first.
    pub faces: Vec<u32>,
    /// The ends of the edge by which each face is left, as that face has them.
    pub edges: Vec<[u32; 2]>,
}

/// The integer `k` of an edge in (13) of Levi 2021: with the matchings `r + 4 k` all indices are those of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FullTurns {
    /// The ends of the edge, as the face on its left has them.
    pub vertices: [u32; 2],
    /// `k`, from left to right.
    pub turns: i32,
}

/// The matching across an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EdgeMatching {
    /// The face on the left and the one on the right; none beyond the boundary.
    pub faces: [Option<u32>; 2],
    /// The ends of the edge, as the left face has them.
    pub vertices: [u32; 2],
    /// Quarter turns from left to right, 0 to 3.
    pub matching: i32,
}

impl CrossField {
    fn new(surface: &Surface, field: method::CrossField, homology: &Homology) -> Self {
        let mesh = surface.mesh();
        let indices = field.indices(mesh);
        let cones = indices.enumerate().filter(|(_, index)| **index != 0);
        let report = FieldReport {
            seamstress: VERSION,
            input: surface.report().clone(),
            cones: cones.map(|(v, &index)| Cone { vertex: v.0, index }).collect(),
            loops: homology.loops().iter().map(|path| field_loop(mesh, &field, path)).collect(),
            full_turns: full_turns(mesh, field.matching()),
        };
        Self { surface: surface.clone(), field, report }
    }

    /// The surface it is on.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Vertices with an index other than zero, in quarters of a turn.
    pub fn cones(&self) -> &[Cone] {
        &self.report.cones
    }

    /// The four unit directions on each face, counter-clockwise, the first along `u` of the map.
    pub fn directions(&self) -> Vec<[[f64; 3]; 4]> {
        directions_in_space(self.surface.mesh(), self.surface.positions(), &self.field)
    }

    /// The matchings of all edges.
    pub fn matchings(&self) -> Vec<EdgeMatching> {
        matchings(&self.surface, self.field.matching())
    }

    /// Its indices.
    pub fn report(&self) -> &FieldReport {
        &self.report
    }

    /// Writes it as `.rawfield`, with four directions a face, or as `.rosy`, with one, by the ending of the name.
    ///
    /// # Errors
    /// Those of the writer.
    #[cfg(feature = "io")]
    pub fn write_as(
        &self,
        name: impl AsRef<std::path::Path>,
        writer: &mut impl io::Write,
    ) -> io::Result<()> {
        let crosses = self.directions();
        match name.as_ref().extension().is_some_and(|e| e.eq_ignore_ascii_case("rosy")) {
            true => seamstress_io::write_rosy(writer, &crosses),
            false => seamstress_io::write_rawfield(writer, &crosses),
        }
    }
}

fn field_loop(mesh: &TriMesh, field: &method::CrossField, path: &DualLoop) -> FieldLoop {
    FieldLoop {
        index: field.loop_index(mesh, path),
        faces: path.exits.iter().map(|h| h.face().0).collect(),
        edges: path.exits.iter().map(|&h| ends(mesh, h)).collect(),
    }
}

fn full_turns(mesh: &TriMesh, matching: &HalfedgeData<i32>) -> Vec<FullTurns> {
    let turns =
        |h: Halfedge| FullTurns { vertices: ends(mesh, h), turns: matching[h].div_euclid(4) };
    mesh.edges().map(turns).filter(|edge| edge.turns != 0).collect()
}

fn ends(mesh: &TriMesh, h: Halfedge) -> [u32; 2] {
    [mesh.origin(h).0, mesh.tip(h).0]
}

/// All edges with their matchings modulo 4.
pub(crate) fn matchings(surface: &Surface, matching: &HalfedgeData<i32>) -> Vec<EdgeMatching> {
    let mesh = surface.mesh();
    let face = |Face(f): Face| f;
    let row = |h: Halfedge| EdgeMatching {
        faces: [Some(face(h.face())), mesh.twin(h).map(|t| face(t.face()))],
        vertices: ends(mesh, h),
        matching: matching[h].rem_euclid(4),
    };
    mesh.edges().map(row).collect()
}

/// Writes matchings as a `.matching` file of a surface.
///
/// # Errors
/// Those of the writer.
#[cfg(feature = "io")]
pub fn write_matchings(
    surface: &Surface,
    matchings: &[EdgeMatching],
    writer: &mut impl io::Write,
) -> io::Result<()> {
    let row = |edge: &EdgeMatching| seamstress_io::MatchingRow {
        faces: edge.faces.map(|face| face.map_or(-1, i64::from)),
        vertices: edge.vertices,
        matching: edge.matching,
    };
    let rows: Vec<_> = matchings.iter().map(row).collect();
    seamstress_io::write_matching(writer, surface.faces().len(), &rows)
}

/// Writes cones as a `.sing` file: the vertex and the index in quarters, a line each.
///
/// # Errors
/// Those of the writer.
#[cfg(feature = "io")]
pub fn write_cones(cones: &[Cone], writer: &mut impl io::Write) -> io::Result<()> {
    let rows: Vec<(u32, i32)> = cones.iter().map(|cone| (cone.vertex, cone.index)).collect();
    seamstress_io::write_singularities(writer, &rows)
}

impl<R> SeamlessMap<R> {
    /// The cross field that its axes are on the surface.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`] if it has no field.
    pub fn field(&self) -> Result<CrossField, Error> {
        self.surface().field_of(self.inner())
    }
}

impl Surface {
    /// The cross field that the axes of a seamless map are on this surface.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`] if it is no seamless map.
    ///
    /// # Source
    /// Levi 2021, suppl. sec. 6.
    pub fn field(
        &self,
        uvs: &[[f64; 2]],
        face_uvs: &[[u32; 3]],
        certify: &CertifyOptions,
    ) -> Result<CrossField, Error> {
        let map = self.seamless_map(self.corner_uvs(uvs, face_uvs)?, certify)?;
        self.field_of(&map)
    }

    pub(crate) fn field_of(&self, map: &parametrize::SeamlessMap) -> Result<CrossField, Error> {
        let homology = Homology::new(self.mesh());
        let field =
            method::extract(self.mesh(), self.metric(), &homology, map).map_err(|cause| {
                Error::new(ErrorKind::NotAMap, cause.to_string()).at_stage(Some(Stage::Certificate))
            })?;
        Ok(CrossField::new(self, field, &homology))
    }
}
