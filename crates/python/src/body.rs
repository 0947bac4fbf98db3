//! `Body`.

use crate::convert::{refused, table};
use geometry::{Body, Draft, DraftModel};
use numpy::PyArray2;
use pyo3::prelude::*;
use std::sync::Arc;

#[pyclass(name = "Body", module = "tumblers._core", frozen)]
pub struct PyBody(pub Arc<Body>);

fn built(body: Result<Body, geometry::GeometryError>) -> PyResult<PyBody> {
    body.map(|body| PyBody(Arc::new(body))).map_err(refused)
}

fn draft(angle_rad: f64, as_released: bool) -> Draft {
    let model = if as_released { DraftModel::AsReleased } else { DraftModel::Geometric };
    Draft { angle_rad, model }
}

#[pymethods]
impl PyBody {
    #[staticmethod]
    fn cuboid(length_m: f64, width_m: f64, height_m: f64, draft_rad: f64) -> PyResult<Self> {
        built(Body::cuboid(length_m, width_m, height_m, draft(draft_rad, false)))
    }

    #[staticmethod]
    fn spiked(
        length_m: f64,
        width_m: f64,
        height_m: f64,
        spike_base_m: f64,
        overall_height_m: f64,
        draft_rad: f64,
        draft_as_released: bool,
    ) -> PyResult<Self> {
        let draft = draft(draft_rad, draft_as_released);
        built(Body::spiked(length_m, width_m, height_m, spike_base_m, overall_height_m, draft))
    }

    #[staticmethod]
    fn spiked_ends(
        length_m: f64,
        width_m: f64,
        height_m: f64,
        spike_base_m: f64,
        spike_height_m: f64,
        draft_rad: f64,
        draft_as_released: bool,
    ) -> PyResult<Self> {
        let draft = draft(draft_rad, draft_as_released);
        built(Body::spiked_ends(length_m, width_m, height_m, spike_base_m, spike_height_m, draft))
    }

    #[staticmethod]
    fn curved(
        outer_radius_m: f64,
        inner_radius_m: f64,
        half_angle_rad: f64,
        width_m: f64,
        draft_rad: f64,
    ) -> PyResult<Self> {
        built(Body::curved(outer_radius_m, inner_radius_m, half_angle_rad, width_m, draft(draft_rad, false)))
    }

    #[staticmethod]
    fn ellipsoid(semi_axes_m: [f64; 3]) -> PyResult<Self> {
        built(Body::ellipsoid(semi_axes_m))
    }

    #[staticmethod]
    fn hull(vertices_m: Vec<[f64; 3]>) -> PyResult<Self> {
        built(Body::hull(&vertices_m))
    }

    fn with_center_of_mass(&self, offset_m: [f64; 3]) -> PyResult<Self> {
        built(self.0.with_center_of_mass(offset_m))
    }

    #[getter]
    fn volume_m3(&self) -> f64 {
        self.0.volume()
    }

    #[getter]
    fn unit_inertia_m2<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let inertia = self.0.unit_inertia();
        let rows: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| inertia[(i, j)]));
        table(py, &rows)
    }

    #[getter]
    fn size_m(&self) -> f64 {
        self.0.size()
    }

    #[getter]
    fn hull_perimeter_m(&self) -> f64 {
        self.0.hull_perimeter()
    }

    #[getter]
    fn outline<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        self.0
            .outline()
            .iter()
            .map(|polygon| {
                let corners: Vec<[f64; 3]> = polygon.iter().map(|corner| (*corner).into()).collect();
                table(py, &corners)
            })
            .collect()
    }
}
