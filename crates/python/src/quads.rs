//! Quad meshes, cross fields and feature curves.

use crate::arrays::{array, numbers};
use crate::attributes::{self, Told};
use crate::errors;
use crate::json::{json, options};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};
use seamstress::{Attribute, AttributeKind};

/// A quad mesh.
#[pyclass(frozen, module = "seamstress_mesh._native")]
pub(crate) struct Quads(pub(crate) seamstress::QuadMesh);

#[pymethods]
impl Quads {
    /// Positions (n, 3) float64.
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.positions().as_flattened())
    }

    /// Vertices of quads (k, 4) uint32.
    fn quads<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.quads().as_flattened())
    }

    /// Irregular vertices and their indices (n, 2) int32.
    fn irregular<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let irregular = self.0.irregular().iter();
        array(py, &irregular.flat_map(|v| [v.vertex as i32, v.index]).collect::<Vec<_>>())
    }

    /// The face of the surface that each vertex comes from (n,) uint32.
    fn source_face<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let sources = self.0.sources().iter();
        array(py, &sources.map(|source| source.face).collect::<Vec<_>>())
    }

    /// Where on it (n, 3) float64.
    fn source_bary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let sources = self.0.sources().iter();
        array(py, &sources.flat_map(|source| source.barycentric).collect::<Vec<_>>())
    }

    /// Values of the input of the surface carried over: rows of `width` numbers (n, width) float64 on `vertex`, `corner`
    /// or `face`, mixed unless they are labels.
    fn transfer<'py>(
        &self,
        py: Python<'py>,
        values: &[u8],
        width: usize,
        on: &str,
        is_label: bool,
    ) -> PyResult<Bound<'py, PyByteArray>> {
        let domain = attributes::domain(on);
        let kind = if is_label { AttributeKind::Label } else { AttributeKind::Number };
        let values: Vec<f64> = numbers(values);
        let attribute = Attribute::new("values", domain, kind, width, Vec::new());
        let attribute = attribute.with_values(domain, &values);
        let carried = py.detach(|| self.0.transfer(&[attribute]));
        let carried = carried.map_err(|error| errors::exception(py, &error))?;
        let rows = carried.iter().flat_map(|c| c.rows.iter().flat_map(|&row| c.row(row))).copied();
        array(py, &rows.collect::<Vec<f64>>())
    }

    /// What the surface carries, on the quads.
    fn attributes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Told<'py>>> {
        let carried = py.detach(|| self.0.attributes());
        attributes::told(py, &carried.map_err(|error| errors::exception(py, &error))?.all)
    }

    /// The report as JSON.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        json(py, self.0.report())
    }

    /// The content of a file of this name: OBJ, OFF, PLY, STL or GLB.
    fn file<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyBytes>> {
        let mut content = Vec::new();
        py.detach(|| self.0.write_as(name, &mut content))?;
        Ok(PyBytes::new(py, &content))
    }

    /// A picture, as PNG file; options as JSON.
    fn picture<'py>(&self, py: Python<'py>, settings: &str) -> PyResult<Bound<'py, PyBytes>> {
        let view = options(py, settings)?;
        let drawn = py.detach(|| self.0.picture(&view));
        Ok(PyBytes::new(py, &drawn.map_err(|error| errors::exception(py, &error))?))
    }
}

/// A cross field.
#[pyclass(frozen, module = "seamstress_mesh._native")]
pub(crate) struct CrossField(pub(crate) seamstress::CrossField);

#[pymethods]
impl CrossField {
    /// Four directions on each face (m, 4, 3) float64.
    fn directions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.directions().as_flattened().as_flattened())
    }

    /// Edges as ends, left and right face (-1 beyond the boundary) and matching (e, 5) int32.
    fn matchings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let rows = self.0.matchings().into_iter().flat_map(|edge| {
            let [from, to] = edge.vertices.map(|vertex| vertex as i32);
            let [left, right] = edge.faces.map(|face| face.map_or(-1, |face| face as i32));
            [from, to, left, right, edge.matching]
        });
        array(py, &rows.collect::<Vec<_>>())
    }

    /// Vertices and indices of cones (n, 2) int32.
    fn cones<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let cones = self.0.cones().iter();
        array(py, &cones.flat_map(|cone| [cone.vertex as i32, cone.index]).collect::<Vec<_>>())
    }

    /// The report as JSON.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        json(py, self.0.report())
    }
}

/// Feature edges and the curves that they form.
#[pyclass(frozen, module = "seamstress_mesh._native")]
pub(crate) struct Curves(pub(crate) seamstress::FeatureCurves);

#[pymethods]
impl Curves {
    /// Ends of edges (n, 2) uint32.
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.edges().as_flattened())
    }

    /// Vertices where curves meet or turn (n,) uint32.
    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.corners())
    }

    /// Vertices where curves end inside the surface (n,) uint32.
    fn open_ends<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        array(py, self.0.open_ends())
    }

    /// The report as JSON.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        json(py, self.0.report())
    }
}
