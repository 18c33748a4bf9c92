//! The surface, from which everything is made.

use crate::context::Context;
use crate::error::{Error, ErrorKind, Stage};
use crate::finding::Finding;
use crate::inspection::{Inspection, Parts};
use crate::report::SurfaceReport;
use crate::surface_options::SurfaceOptions;
use seamstress_mesh::attributes::Attributes;
#[cfg(all(feature = "io", feature = "page"))]
use seamstress_mesh::coarse::coarsen;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::symmetry::Segments;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::{Violation, Violations};
use std::fmt;
#[cfg(feature = "io")]
use std::path::Path;
use std::sync::Arc;

/// An oriented manifold of triangles with positions. Cheap to clone.
///
/// Its faces are the polygons of the input, split into triangles; vertices and faces keep their order, and nothing is
/// moved. With repairs some may be gone or added: [`Surface::input_vertex`] and [`Surface::input_face`] tell where
/// each comes from.
#[derive(Clone)]
pub struct Surface {
    inner: Arc<Inner>,
    pub(crate) attributes: Arc<Attributes>,
    pub(crate) sizes: Option<Arc<Sizes>>,
    /// A direction to follow on each face, zero where there is none.
    pub(crate) directions: Option<Arc<Vec<[f64; 3]>>>,
    context: Context,
}

/// The sizes of cells at the vertices of a surface.
#[derive(Debug)]
pub(crate) struct Sizes {
    pub(crate) wishes: Wishes,
    /// As multiples of the length of a cell.
    pub(crate) factors: Vec<f64>,
    /// The metric in which all cells are alike.
    pub(crate) metric: Metric,
}

/// What sources say of sizes.
#[derive(Debug)]
pub(crate) struct Wishes {
    /// At the vertices, in proportion to edge lengths.
    pub(crate) painted: Vec<f64>,
    /// Edges at which cells are smaller, and how many times as long as elsewhere.
    pub(crate) near: Arc<Vec<(Segments, f64)>>,
}

struct Inner {
    parts: Parts,
    report: SurfaceReport,
    mesh: TriMesh,
    metric: Metric,
    /// Of another mesh of a surface: that surface, and the face of it that each face lies in.
    remesh_of: Option<(Surface, Vec<u32>)>,
}

impl Inspection {
    /// The surface.
    ///
    /// # Errors
    /// [`ErrorKind::NotASurface`], with every fault.
    pub fn surface(self) -> Result<Surface, Error> {
        let (mut parts, report) = self.into_parts()?;
        let attributes = Arc::new(std::mem::take(&mut parts.attributes));
        let soup = &parts.soup;
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).map_err(|cause| {
            Error::new(ErrorKind::NotASurface, cause.to_string()).of(parts.input.as_deref())
        })?;
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let inner = Arc::new(Inner { parts, report, mesh, metric, remesh_of: None });
        let context = Context::default();
        Ok(Surface { inner, attributes, sizes: None, directions: None, context })
    }
}

impl Surface {
    /// Reads a surface: OBJ, OFF, PLY, STL or glTF.
    ///
    /// # Errors
    /// [`ErrorKind::Unreadable`] and [`ErrorKind::NotASurface`].
    #[cfg(feature = "io")]
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::read_with(path, &SurfaceOptions::default())
    }

    /// Reads a surface, with repairs if the options ask for them.
    ///
    /// # Errors
    /// As [`Surface::read`].
    #[cfg(feature = "io")]
    pub fn read_with(path: impl AsRef<Path>, options: &SurfaceOptions) -> Result<Self, Error> {
        Inspection::read(path, options)?.surface()
    }

    /// Makes a surface of triangles: positions, #V by 3, and vertices counted from 0, #F by 3, counter-clockwise seen
    /// from outside.
    ///
    /// # Errors
    /// [`ErrorKind::NotASurface`], with every fault.
    pub fn from_triangles(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> Result<Self, Error> {
        Self::from_polygons(positions, faces)
    }

    /// Makes a surface of polygons, which are split into triangles.
    ///
    /// # Errors
    /// [`ErrorKind::NotASurface`], with every fault.
    pub fn from_polygons<P: AsRef<[u32]>>(
        positions: &[[f64; 3]],
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<Self, Error> {
        Inspection::of_polygons(positions, polygons, &SurfaceOptions::default()).surface()
    }

    /// The same surface whose work is watched, limited and spread over threads by a context.
    pub fn with_context(mut self, context: Context) -> Self {
        self.context = context;
        self
    }

    /// The same surface as one that was read from a file.
    #[cfg(feature = "lab")]
    pub(crate) fn named(mut self, input: Option<&str>) -> Self {
        if let Some(inner) = Arc::get_mut(&mut self.inner) {
            inner.parts.input = input.map(str::to_owned);
            inner.report.file = input.map(str::to_owned);
        }
        self
    }

    /// A finer mesh of the same surface, whose first vertices are those of this one, and each of whose faces lies in one
    /// of this one.
    ///
    /// # Errors
    /// A fault of this program.
    pub(crate) fn refined(
        &self,
        positions: Vec<[f64; 3]>,
        faces: Vec<[u32; 3]>,
        face_origin: &[u32],
    ) -> Result<Self, Error> {
        let vertices: Vec<u32> = (0..self.positions().len() as u32).collect();
        let soup = TriangleSoup { positions, faces };
        let finer = self.remeshed(soup, &vertices, face_origin)?;
        Ok(self.directed_part(finer, face_origin))
    }

    /// Some of its components, by the vertex and the face of this surface of each vertex and face.
    ///
    /// # Errors
    /// A fault of this program.
    pub(crate) fn restricted(&self, vertices: &[u32], faces: &[u32]) -> Result<Self, Error> {
        let renumbered = |v: u32| vertices.binary_search(&v).unwrap_or_default() as u32;
        let corners = |&face: &u32| self.faces()[face as usize].map(renumbered);
        let soup = TriangleSoup {
            positions: vertices.iter().map(|&v| self.positions()[v as usize]).collect(),
            faces: faces.iter().map(corners).collect(),
        };
        let part = self.remeshed(soup, vertices, faces)?;
        Ok(self.directed_part(self.sized_part(part, vertices), faces))
    }

    /// A coarser mesh of nearly the same surface, of about so many triangles; vertices of `kept` stay.
    ///
    /// # Errors
    /// A fault of this program.
    #[cfg(all(feature = "io", feature = "page"))]
    pub(crate) fn coarse(&self, n_faces: usize, kept: &[u32]) -> Result<Self, Error> {
        let coarse = coarsen(self.positions(), self.faces(), n_faces, kept);
        let soup = TriangleSoup {
            positions: coarse.vertices.iter().map(|&v| self.positions()[v as usize]).collect(),
            faces: coarse.faces,
        };
        self.remeshed(soup, &coarse.vertices, &coarse.face_origin)
    }

    /// Another mesh of the surface or a part of it, by the vertices of this one that its first vertices are, and the
    /// faces of this one that its faces lie in.
    ///
    /// # Errors
    /// A fault of this program.
    pub(crate) fn remeshed(
        &self,
        soup: TriangleSoup,
        vertices: &[u32],
        faces: &[u32],
    ) -> Result<Self, Error> {
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).map_err(|cause| {
            let text = format!("another mesh of the surface is none: {cause}");
            Error::new(ErrorKind::Internal, text).with_hint("please report this with the mesh")
        })?;
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let of_input = &self.inner.parts;
        let parts = Parts {
            input: of_input.input.clone(),
            n_input_vertices: of_input.n_input_vertices,
            // Vertices that are none of the input's come last.
            vertex_origin: Some(vertices.iter().map_while(|&v| self.input_vertex(v)).collect()),
            face_origin: faces.iter().map(|&face| of_input.face_origin[face as usize]).collect(),
            soup,
            ..Parts::default()
        };
        let report = self.inner.report.clone();
        let remesh_of = Some((self.clone(), faces.to_vec()));
        let inner = Arc::new(Inner { parts, report, mesh, metric, remesh_of });
        let (attributes, context) = (Arc::default(), self.context.clone());
        Ok(Self { inner, attributes, sizes: None, directions: None, context })
    }

    /// Positions, #V by 3, mesh units.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.inner.parts.soup.positions
    }

    /// Vertices of the triangles, #F by 3.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.inner.parts.soup.faces
    }

    /// The file it was read from, as it was named.
    pub fn input(&self) -> Option<&str> {
        self.inner.parts.input.as_deref()
    }

    /// The vertex of the input that a vertex was.
    pub fn input_vertex(&self, vertex: u32) -> Option<u32> {
        match &self.inner.parts.vertex_origin {
            Some(origin) => origin.get(vertex as usize).copied(),
            None => ((vertex as usize) < self.positions().len()).then_some(vertex),
        }
    }

    /// The polygon of the input that a face is of.
    pub fn input_face(&self, face: u32) -> Option<u32> {
        self.inner.parts.face_origin.get(face as usize).copied()
    }

    /// Counts, topology, size, notes, warnings and repairs.
    pub fn report(&self) -> &SurfaceReport {
        &self.inner.report
    }

    pub(crate) fn parts(&self) -> &Parts {
        &self.inner.parts
    }

    pub(crate) fn mesh(&self) -> &TriMesh {
        &self.inner.mesh
    }

    pub(crate) fn metric(&self) -> &Metric {
        &self.inner.metric
    }

    pub(crate) fn context(&self) -> &Context {
        &self.context
    }

    /// Of another mesh of a surface: that surface, and the face of it that each face lies in.
    pub(crate) fn remesh_of(&self) -> Option<(&Self, &[u32])> {
        self.inner.remesh_of.as_ref().map(|(surface, faces)| (surface, faces.as_slice()))
    }

    /// Violations as findings, with elements of the input.
    pub(crate) fn findings(&self, violations: &Violations) -> Vec<Finding> {
        let finding = |violation: &Violation| {
            let mut finding = Finding::from(violation);
            finding.elements = self.in_input(&finding.elements);
            finding
        };
        violations.0.iter().map(finding).collect()
    }

    /// Corner UVs, three a face, of UVs and the three of each face.
    pub(crate) fn corner_uvs(
        &self,
        uvs: &[[f64; 2]],
        face_uvs: &[[u32; 3]],
    ) -> Result<Vec<[f64; 2]>, Error> {
        let error = |text: String| {
            Err(Error::new(ErrorKind::NotAMap, text).at_stage(Some(Stage::Certificate)))
        };
        if face_uvs.len() != self.faces().len() {
            let (found, expected) = (face_uvs.len(), self.faces().len());
            return error(format!("UVs for {found} faces; the surface has {expected}"));
        }
        let corners = face_uvs.as_flattened();
        match corners.iter().position(|&corner| corner as usize >= uvs.len()) {
            None => Ok(corners.iter().map(|&corner| uvs[corner as usize]).collect()),
            Some(at) => {
                error(format!("face {} names UV {}; there are {}", at / 3, corners[at], uvs.len()))
            }
        }
    }
}

impl fmt::Debug for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Surface")
            .field("input", &self.input())
            .field("vertices", &self.positions().len())
            .field("faces", &self.faces().len())
            .finish_non_exhaustive()
    }
}
