//! Surfaces, and what is made of them. Options come as JSON, reports go as JSON.

use crate::arrays::{array, numbers, rows};
use crate::json::{json, options};
use crate::map::Map;
use crate::quads::{CrossField, Curves, Quads};
use crate::run::Run;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use seamstress::{Error, Inspection, Measurements, SurfaceOptions};
use std::path::PathBuf;

/// A surface.
#[pyclass(frozen, module = "seamstress_mesh._native")]
pub(crate) struct Surface(seamstress::Surface);

/// UVs and the three of each face, as bytes.
type GivenMap<'a> = (&'a [u8], &'a [u8]);
/// UVs and the three of each face.
type Uvs = (Vec<[f64; 2]>, Vec<[u32; 3]>);

fn uvs((uvs, face_uvs): GivenMap<'_>) -> Uvs {
    (rows(uvs), rows(face_uvs))
}

impl Surface {
    /// Makes something of the surface under the watch of a run.
    fn make<T: Send + 'static>(
        &self,
        py: Python<'_>,
        run: Run,
        work: impl FnOnce(&seamstress::Surface) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let surface = self.0.clone();
        run.call(py, move |context| work(&surface.with_context(context)))
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

    /// The report as JSON.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        json(py, self.0.report())
    }

    /// A seamless map.
    fn parametrize(&self, py: Python<'_>, settings: &str, run: Run) -> PyResult<Map> {
        let settings = options(py, settings)?;
        self.make(py, run, move |surface| surface.parametrize(&settings)).map(Map::new)
    }

    /// An integer-grid map.
    fn integer_map(&self, py: Python<'_>, settings: &str, run: Run) -> PyResult<Map> {
        let settings = options(py, settings)?;
        self.make(py, run, move |surface| surface.integer_map(&settings)).map(Map::new)
    }

    /// The integer-grid map of a seamless map.
    fn integer_map_of(
        &self,
        py: Python<'_>,
        map: GivenMap<'_>,
        certify: &str,
        settings: &str,
        run: Run,
    ) -> PyResult<Map> {
        let (certify, settings) = (options(py, certify)?, options(py, settings)?);
        let (uvs, face_uvs) = uvs(map);
        let make = move |surface: &seamstress::Surface| {
            surface.integer_map_of(&uvs, &face_uvs, &certify, &settings)
        };
        self.make(py, run, make).map(Map::new)
    }

    /// A quad mesh.
    fn quad_mesh(&self, py: Python<'_>, settings: &str, run: Run) -> PyResult<Quads> {
        let settings = options(py, settings)?;
        self.make(py, run, move |surface| surface.quad_mesh(&settings)).map(Quads)
    }

    /// The quads of an integer-grid map.
    fn extract_quads(
        &self,
        py: Python<'_>,
        map: GivenMap<'_>,
        features: &str,
        settings: &str,
        run: Run,
    ) -> PyResult<Quads> {
        let (features, settings) = (options(py, features)?, options(py, settings)?);
        let (uvs, face_uvs) = uvs(map);
        let make = move |surface: &seamstress::Surface| {
            surface.extract_quads(&uvs, &face_uvs, &features, &settings)
        };
        self.make(py, run, make).map(Quads)
    }

    /// Another objective minimised, from a map or for a disk.
    fn optimize(
        &self,
        py: Python<'_>,
        map: Option<GivenMap<'_>>,
        settings: &str,
        run: Run,
    ) -> PyResult<Map> {
        let settings = options(py, settings)?;
        let map = map.map(uvs);
        let make = move |surface: &seamstress::Surface| match map {
            Some((uvs, face_uvs)) => surface.optimize(&uvs, &face_uvs, &settings),
            None => surface.flatten_disk(&settings),
        };
        self.make(py, run, make).map(Map::new)
    }

    /// Whether a map is seamless: whether all that was asked for holds, and the verdict as JSON.
    fn certify(
        &self,
        py: Python<'_>,
        map: GivenMap<'_>,
        settings: &str,
        run: Run,
    ) -> PyResult<(bool, String)> {
        let settings = options(py, settings)?;
        let (uvs, face_uvs) = uvs(map);
        let make =
            move |surface: &seamstress::Surface| surface.certify_with(&uvs, &face_uvs, &settings);
        let verdict = self.make(py, run, make)?;
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
        let settings = options(py, settings)?;
        let (uvs, face_uvs) = uvs(map);
        let make = move |surface: &seamstress::Surface| surface.measure(&uvs, &face_uvs, &settings);
        let measured: Measurements = self.make(py, run, make)?;
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
        let settings = options(py, settings)?;
        let (uvs, face_uvs) = uvs(map);
        let make = move |surface: &seamstress::Surface| surface.field(&uvs, &face_uvs, &settings);
        self.make(py, run, make).map(CrossField)
    }

    /// Feature edges.
    fn features(&self, py: Python<'_>, sources: &str, run: Run) -> PyResult<Curves> {
        let sources = options(py, sources)?;
        self.make(py, run, move |surface| surface.features(&sources)).map(Curves)
    }
}
