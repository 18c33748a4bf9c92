//! What a mesh carries beside its shape, in the ids of its input, brought to its triangles and to quads.

use crate::error::{Error, ErrorKind};
use crate::quads::QuadMesh;
use crate::surface::Surface;
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind, Attributes};
use seamstress_quads::Transfer;
use std::sync::Arc;

impl Surface {
    /// What its file says of its vertices, corners and faces beside their places: texture coordinates, colours, normals,
    /// materials, groups and other properties, for the vertices, corners and polygons of the input.
    pub fn attributes(&self) -> &Attributes {
        &self.attributes
    }

    /// The same surface with other attributes, for the vertices, corners and polygons of the input.
    ///
    /// # Errors
    /// [`ErrorKind::Options`] where one does not fit.
    pub fn with_attributes(mut self, attributes: Attributes) -> Result<Self, Error> {
        attributes.all.iter().try_for_each(|attribute| self.check(attribute))?;
        self.attributes = Arc::new(attributes);
        Ok(self)
    }

    fn check(&self, attribute: &Attribute) -> Result<(), Error> {
        let parts = self.parts();
        let n_elements = match attribute.domain {
            AttributeDomain::Vertex => parts.n_input_vertices,
            AttributeDomain::Corner => parts.polygons.corners().len(),
            AttributeDomain::Face => parts.polygons.len(),
        };
        attribute.check(n_elements).map_err(|text| Error::options(text).of(self.input()))
    }

    /// What the input carries, for this surface's vertices, triangle corners and triangles.
    #[cfg(feature = "io")]
    pub(crate) fn attributes_on_triangles(&self) -> Attributes {
        let all = self.attributes.all.iter().map(|attribute| self.on_triangles(attribute));
        let mut attributes = Attributes::from(all.collect::<Vec<_>>());
        attributes.material_files.clone_from(&self.attributes.material_files);
        attributes
    }

    /// An attribute of the input as one of this surface's vertices, triangle corners or triangles.
    pub(crate) fn on_triangles(&self, attribute: &Attribute) -> Attribute {
        let parts = self.parts();
        match attribute.domain {
            AttributeDomain::Face => {
                let faces = parts.face_origin.iter().map(|&face| face as usize);
                attribute.on(AttributeDomain::Face, faces)
            }
            AttributeDomain::Vertex if parts.merged_into.is_none() => {
                let vertices =
                    (0..self.positions().len() as u32).filter_map(|v| self.input_vertex(v));
                attribute.on(AttributeDomain::Vertex, vertices.map(|v| v as usize))
            }
            // Vertices that were merged may have had different values.
            AttributeDomain::Vertex => {
                let corners = parts.polygons.corners();
                let vertices = self.input_corners().map(|corner| corners[corner] as usize);
                self.simplified(attribute.on(AttributeDomain::Corner, vertices))
            }
            AttributeDomain::Corner => {
                self.simplified(attribute.on(AttributeDomain::Corner, self.input_corners()))
            }
        }
    }

    /// As one of vertices, where all corners of each have the same values.
    fn simplified(&self, of_corners: Attribute) -> Attribute {
        let corners = self.faces().as_flattened();
        of_corners.by_vertex(corners, self.positions().len()).unwrap_or(of_corners)
    }

    /// The corner of the input that each corner of the triangles is.
    fn input_corners(&self) -> impl Iterator<Item = usize> {
        let parts = self.parts();
        let merged = parts.merged_into.as_deref();
        let now = move |v: u32| merged.map_or(v, |into| into[v as usize]);
        self.faces().iter().zip(&parts.face_origin).flat_map(move |(face, &polygon)| {
            let first = parts.polygons.corner_start(polygon as usize);
            let vertices = parts.polygons.get(polygon as usize).unwrap_or_default();
            face.map(|v| {
                let vertex = self.input_vertex(v).map(now);
                let place = vertices.iter().position(|&other| Some(now(other)) == vertex);
                first + place.unwrap_or_default()
            })
        })
    }
}

impl QuadMesh {
    /// What the surface carries, brought over to the quads, as [`QuadMesh::transfer`] does; but what has the same value at
    /// all corners of every vertex is an attribute of vertices, and what has not one of corners. With
    /// [`source_points`](crate::ShapeOptions::source_points) also where each vertex comes from.
    ///
    /// # Errors
    /// A fault of this program.
    pub fn attributes(&self) -> Result<Attributes, Error> {
        let carried = self.surface().attributes();
        let mut all = self.carry(&carried.all, |_, on_triangles| on_triangles.domain)?;
        if self.writes_sources() {
            all.extend(self.source_points());
        }
        let mut attributes = Attributes::from(all);
        attributes.material_files.clone_from(&carried.material_files);
        Ok(attributes)
    }

    /// The point of the input that each vertex comes from: a face, three of its corners, and their weights.
    fn source_points(&self) -> [Attribute; 3] {
        let (surface, points) = (self.surface(), self.sources());
        let of_vertices = |name, kind, width, values| {
            Attribute::new(name, AttributeDomain::Vertex, kind, width, values)
        };
        let id = |id: Option<u32>| f64::from(id.unwrap_or_default());
        let faces = points.iter().map(|at| id(surface.input_face(at.face)));
        let vertices = points.iter().flat_map(|at| surface.faces()[at.face as usize]);
        let vertices = vertices.map(|v| id(surface.input_vertex(v)));
        let weights = points.iter().flat_map(|at| at.barycentric);
        [
            of_vertices("source_face", AttributeKind::Label, 1, faces.collect()),
            of_vertices("source_vertex", AttributeKind::Label, 3, vertices.collect()),
            of_vertices("source_weight", AttributeKind::Number, 3, weights.collect()),
        ]
    }

    /// Attributes of the input of the surface, brought over to the quads.
    ///
    /// Values of vertices are those of the surface where a vertex lies. A quad takes the values of its corners from one
    /// side of a seam, the one that its middle lies on, continued linearly to corners beyond. Values of faces are those
    /// of the triangles beneath a quad: the mean of numbers, of labels the one with the largest share. Labels are never
    /// mixed.
    ///
    /// # Errors
    /// [`ErrorKind::Options`] where one does not fit the input.
    pub fn transfer(&self, attributes: &[Attribute]) -> Result<Vec<Attribute>, Error> {
        attributes.iter().try_for_each(|attribute| self.surface().check(attribute))?;
        self.carry(attributes, |given, _| given.domain)
    }

    /// Brings attributes over to what is chosen by the attribute as it is given, and as it is on the triangles.
    fn carry(
        &self,
        attributes: &[Attribute],
        to: impl Fn(&Attribute, &Attribute) -> AttributeDomain,
    ) -> Result<Vec<Attribute>, Error> {
        if attributes.is_empty() {
            return Ok(Vec::new());
        }
        let surface = self.surface();
        let triangles = (surface.positions(), surface.faces());
        let transfer = Transfer::new(surface.mesh(), triangles, self.mesh(), self.sources());
        let transfer = transfer.map_err(|cause| {
            let text = format!("the quads were not found on their surface: {cause}");
            Error::new(ErrorKind::Internal, text).of(surface.input())
        })?;
        let carry = |attribute: &Attribute| {
            let on_triangles = surface.on_triangles(attribute);
            transfer.carry(&on_triangles, to(attribute, &on_triangles))
        };
        Ok(attributes.iter().map(carry).collect())
    }
}
