//! `Field`.

use crate::convert::refused;
use dynamics::{Field, Vec3};
use pyo3::prelude::*;

#[pyclass(name = "Field", module = "tumblers._core", frozen)]
pub struct PyField(pub Field);

#[pymethods]
impl PyField {
    #[staticmethod]
    #[pyo3(signature = (strength_T, frequency_Hz, rotation_axis, initial_direction, quadrature_ratio=1.0,
        phase_error_rad=0.0))]
    fn rotating(
        strength_T: f64,
        frequency_Hz: f64,
        rotation_axis: [f64; 3],
        initial_direction: [f64; 3],
        quadrature_ratio: f64,
        phase_error_rad: f64,
    ) -> PyResult<Self> {
        let field = Field::rotating(strength_T, frequency_Hz, rotation_axis.into(), initial_direction.into());
        let field = field.and_then(|field| field.with_quadrature(quadrature_ratio, phase_error_rad));
        field.map(Self).map_err(refused)
    }

    #[staticmethod]
    fn uniform(strength_T: f64, direction: [f64; 3]) -> PyResult<Self> {
        Field::constant(strength_T, direction.into()).map(Self).map_err(refused)
    }

    #[staticmethod]
    fn table(time_s: Vec<f64>, field_T: Vec<[f64; 3]>) -> PyResult<Self> {
        let fields: Vec<Vec3> = field_T.into_iter().map(Vec3::from).collect();
        Field::table(&time_s, &fields).map(Self).map_err(refused)
    }

    /// `B(t)`, T.
    fn at(&self, time_s: f64) -> [f64; 3] {
        self.0.at(time_s).into()
    }
}
