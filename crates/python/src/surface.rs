//! Surfaces, and what is made of them. Options come as JSON, reports go as JSON.

use crate::arrays::{array, numbers, rows};
use crate::attributes::{self, Given, Told};
use crate::errors;
use crate::json::{json, options};
use crate::map::Map;
use crate::quads::{CrossField, Curves, Quads};
use crate::run::Run;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use seamstress::{Error, Inspection, SurfaceOptions};
use serde::de::DeserializeOwned;
use std::path::PathBuf;

/// A surface.
#[pyclass(frozen, module = "seamstress_mesh._native")]
pub(crate) struct Surface(seamstress::Surface);

/// UVs and the three of each face, as bytes.
type GivenMap<'a> = (&'a [u8], &'a [u8]);

impl Surface {
    /// Makes something of the surface under the watch of a run; options as JSON.
    fn make<T: Send + 'static, O: DeserializeOwned + Send + 'static>(
        &self,
        py: Python<'_>,
        settings: &str,
        run: Run,
        work: impl FnOnce(&seamstress::Surface, &O) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let settings: O = options(py, settings)?;
        let surface = self.0.clone();
        run.call(py, move |context| work(&surface.with_context(context), &settings))
    }

    /// Makes something of a map of the surface.
    fn make_of<T: Send + 'static, O: DeserializeOwned + Send + 'static>(
        &self,
        py: Python<'_>,
        (uvs, face_uvs): GivenMap<'_>,
        settings: &str,
        run: Run,
        work: impl FnOnce(&seamstress::Surface, &[[f64; 2]], &[[u32; 3]], &O) -> Result<T, Error>
        + Send
        + 'static,
    ) -> PyResult<T> {
        let (uvs, face_uvs) = (rows(uvs), rows(face_uvs));
        self.make(py, settings, run, move |surface, options| {
            work(surface, &uvs, &face_uvs, options)
        })
    }
}

/// Polygons as lists of vertices.
fn polygons(sizes: &[u8], corners: &[u8]) -> Vec<Vec<u32>> {
    let mut corners = numbers::<u32>(corners).into_iter();
    let polygon = |size| corners.by_ref().take(size as usize).collect();
    numbers::<u32>(sizes).into_iter().map(polygon).collect()
}

#[pymethods]
impl Surface {
    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, settings: &str, run: Run) -> PyResult<Self> {
        let settings: SurfaceOptions = options(py, settings)?;
        let read = move |_| seamstress::Surface::read_with(path, &settings);
        run.call(py, read).map(Self)
    }

    /// Takes positions (n, 3) float64, and numbers of corners and corners of polygons, uint32.
    #[staticmethod]
    fn of_polygons(
        py: Python<'_>,
        positions: &[u8],
        sizes: &[u8],
        corners: &[u8],
        settings: &str,
        run: Run,
    ) -> PyResult<Self> {
        let settings: SurfaceOptions = options(py, settings)?;
        let (positions, polygons) = (rows(positions), polygons(sizes, corners));
        let make = move |_| Inspection::of_polygons(&positions, polygons, &settings).surface();
        run.call(py, make).map(Self)
    }

    /// Positions (n, 3) float64.
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.positions().as_flattened())
    }

    /// Vertices of triangles (m, 3) uint32.
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.faces().as_flattened())
    }

    /// The vertex of the input that each vertex was (n,) uint32.
    fn input_vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let vertices = (0..self.0.positions().len() as u32).filter_map(|v| self.0.input_vertex(v));
        array(py, &vertices.collect::<Vec<_>>())
    }

    /// The polygon of the input that each triangle is of (m,) uint32.
    fn input_faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let faces = (0..self.0.faces().len() as u32).filter_map(|f| self.0.input_face(f));
        array(py, &faces.collect::<Vec<_>>())
    }

    /// What it carries, for the elements of its input.
    fn attributes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Told<'py>>> {
        attributes::told(py, &self.0.attributes().all)
    }

    /// The same surface with other attributes.
    fn with_attributes(&self, py: Python<'_>, given: Vec<Given>) -> PyResult<Self> {
        let changed = self.0.clone().with_attributes(attributes::given(given).into());
        changed.map(Self).map_err(|error| errors::exception(py, &error))
    }

    /// The report as JSON.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        json(py, self.0.report())
    }

    /// A seamless map.
    fn parametrize(&self, py: Python<'_>, settings: &str, run: Run) -> PyResult<Map> {
        self.make(py, settings, run, seamstress::Surface::parametrize).map(Map::new)
    }

    /// An integer-grid map.
    fn integer_map(&self, py: Python<'_>, settings: &str, run: Run) -> PyResult<Map> {
        self.make(py, settings, run, seamstress::Surface::integer_map).map(Map::new)
    }

    /// The integer-grid map of a seamless map; settings are how this is certified, and the options.
    fn integer_map_of(
        &self,
        py: Python<'_>,
        map: GivenMap<'_>,
        settings: &str,
        run: Run,
    ) -> PyResult<Map> {
        let make = |surface: &seamstress::Surface, uvs: &[_], face_uvs: &[_], both: &(_, _)| {
            surface.integer_map_of(uvs, face_uvs, &both.0, &both.1)
        };
        self.make_of(py, map, settings, run, make).map(Map::new)
    }

    /// A quad mesh.
    fn quad_mesh(&self, py: Python<'_>, settings: &str, run: Run) -> PyResult<Quads> {
        self.make(py, settings, run, seamstress::Surface::quad_mesh).map(Quads)
    }

    /// The quads of an integer-grid map; settings are features, and the options.
    fn extract_quads(
        &self,
        py: Python<'_>,
        map: GivenMap<'_>,
        settings: &str,
        run: Run,
    ) -> PyResult<Quads> {
        let make = |surface: &seamstress::Surface, uvs: &[_], face_uvs: &[_], both: &(_, _)| {
            surface.extract_quads(uvs, face_uvs, &both.0, &both.1)
        };
        self.make_of(py, map, settings, run, make).map(Quads)
    }

    /// Another objective minimised, from a map or for a disk.
    fn optimize(
        &self,
        py: Python<'_>,
        map: Option<GivenMap<'_>>,
        settings: &str,
        run: Run,
    ) -> PyResult<Map> {
        let made = match map {
            Some(map) => self.make_of(py, map, settings, run, seamstress::Surface::optimize),
            None => self.make(py, settings, run, seamstress::Surface::flatten_disk),
        };
        made.map(Map::new)
    }

    /// Whether a map is seamless: whether all that was asked for holds, and the verdict as JSON.
    fn certify(
        &self,
        py: Python<'_>,
        map: GivenMap<'_>,
        settings: &str,
        run: Run,
    ) -> PyResult<(bool, String)> {
        let verdict = self.make_of(py, map, settings, run, seamstress::Surface::certify_with)?;
        Ok((verdict.is_passed(), json(py, &verdict)?))
    }

    /// The distortion of a map as JSON, and for each measure its values (m,) float64.
    fn measure<'py>(
        &self,
        py: Python<'py>,
        map: GivenMap<'_>,
        settings: &str,
        run: Run,
    ) -> PyResult<(String, Vec<Bound<'py, PyByteArray>>)> {
        let measured = self.make_of(py, map, settings, run, seamstress::Surface::measure)?;
        let values = measured.measures.iter().map(|one| array(py, &one.values));
        Ok((json(py, &measured)?, values.collect::<PyResult<_>>()?))
    }

    /// The cross field of a map.
    fn field(
        &self,
        py: Python<'_>,
        map: GivenMap<'_>,
        settings: &str,
        run: Run,
    ) -> PyResult<CrossField> {
        self.make_of(py, map, settings, run, seamstress::Surface::field).map(CrossField)
    }

    /// Feature edges.
    fn features(&self, py: Python<'_>, sources: &str, run: Run) -> PyResult<Curves> {
        self.make(py, sources, run, seamstress::Surface::features).map(Curves)
    }
}
