//! Seamless maps of every kind.

use crate::arrays::array;
use crate::errors;
use crate::json::options;
use crate::quads::CrossField;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};
use seamstress::{Described, Error, SeamlessMap, TextureOptions, UvSet};
use serde::Serialize;

/// A certified seamless map.
#[pyclass(frozen, module = "seamstress_mesh._native")]
pub(crate) struct Map(Box<dyn Mapped>);

/// What maps have in common, whatever their reports.
trait Mapped: Send + Sync {
    fn parts(&self) -> Parts<'_>;
    fn report(&self) -> serde_json::Result<String>;
    fn file(&self, name: &str, set: UvSet) -> std::io::Result<Vec<u8>>;
    fn pictures(&self, texture: &TextureOptions) -> Result<[Vec<u8>; 3], Error>;
    fn field(&self) -> Result<seamstress::CrossField, Error>;
}

/// The arrays of a map.
struct Parts<'a> {
    uvs: &'a [[f64; 2]],
    face_uvs: &'a [[u32; 3]],
    cones: &'a [seamstress::Cone],
    seams: &'a [seamstress::SeamEdge],
    aligned_edges: &'a [[u32; 2]],
}

impl<R: Described + Serialize + Send + Sync> Mapped for SeamlessMap<R> {
    fn parts(&self) -> Parts<'_> {
        Parts {
            uvs: self.uvs(),
            face_uvs: self.face_uvs(),
            cones: self.cones(),
            seams: self.seams(),
            aligned_edges: self.aligned_edges(),
        }
    }

    fn report(&self) -> serde_json::Result<String> {
        serde_json::to_string(SeamlessMap::report(self))
    }

    fn file(&self, name: &str, set: UvSet) -> std::io::Result<Vec<u8>> {
        let mut content = Vec::new();
        self.write_as(name, set, &mut content)?;
        Ok(content)
    }

    fn pictures(&self, texture: &TextureOptions) -> Result<[Vec<u8>; 3], Error> {
        let drawn = SeamlessMap::pictures(self, texture)?;
        Ok([drawn.front, drawn.back, drawn.layout])
    }

    fn field(&self) -> Result<seamstress::CrossField, Error> {
        SeamlessMap::field(self)
    }
}

impl Map {
    pub(crate) fn new<R>(map: SeamlessMap<R>) -> Self
    where
        R: Described + Serialize + Send + Sync + 'static,
    {
        Self(Box::new(map))
    }
}

#[pymethods]
impl Map {
    /// UVs (k, 2) float64.
    fn uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.parts().uvs.as_flattened())
    }

    /// The UVs of each face (m, 3) uint32.
    fn face_uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.parts().face_uvs.as_flattened())
    }

    /// Vertices and indices of cones (n, 2) int32.
    fn cones<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let cones = self.0.parts().cones.iter();
        array(py, &cones.flat_map(|cone| [cone.vertex as i32, cone.index]).collect::<Vec<_>>())
    }

    /// Ends and matchings of seam edges (n, 3) int32.
    fn seams<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let seams = self.0.parts().seams.iter();
        let rows = seams.flat_map(|seam| {
            let [from, to] = seam.vertices.map(|vertex| vertex as i32);
            [from, to, seam.matching]
        });
        array(py, &rows.collect::<Vec<_>>())
    }

    /// Ends of the feature edges that are aligned (n, 2) uint32.
    fn aligned_edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.parts().aligned_edges.as_flattened())
    }

    /// The report as JSON.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        self.0.report().map_err(|cause| errors::internal(py, &cause.to_string()))
    }

    /// The content of a file of this name: OBJ, PLY or GLB, with the map as the `first` or the `second` set of UVs.
    #[pyo3(signature = (name, uv_set = "first"))]
    fn file<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        uv_set: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let set = if uv_set == "second" { UvSet::Second } else { UvSet::First };
        Ok(PyBytes::new(py, &py.detach(|| self.0.file(name, set))?))
    }

    /// Front, back and layout, as PNG files; options as JSON.
    fn pictures<'py>(&self, py: Python<'py>, settings: &str) -> PyResult<[Bound<'py, PyBytes>; 3]> {
        let texture = options(py, settings)?;
        let drawn = py.detach(|| self.0.pictures(&texture));
        let drawn = drawn.map_err(|error| errors::exception(py, &error))?;
        Ok(drawn.map(|picture| PyBytes::new(py, &picture)))
    }

    /// The cross field of its axes.
    fn field(&self, py: Python<'_>) -> PyResult<CrossField> {
        let field = py.detach(|| self.0.field());
        field.map(CrossField).map_err(|error| errors::exception(py, &error))
    }
}
