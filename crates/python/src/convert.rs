//! Between the types of Python and those of the crates.

use dynamics::{SolverKind, Vec3};
use nalgebra::Quaternion;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

pub fn refused(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// One of `choices` by name.
pub fn choose<T: Copy>(name: &str, found: &str, choices: &[(&str, T)]) -> PyResult<T> {
    choices.iter().find(|(choice, _)| *choice == found).map(|(_, value)| *value).ok_or_else(|| {
        let expected: Vec<&str> = choices.iter().map(|(choice, _)| *choice).collect();
        refused(format!("{name} is '{found}', expected {}", expected.join(" or ")))
    })
}

pub fn solver(name: &str) -> PyResult<SolverKind> {
    choose("solver", name, &[("reduced", SolverKind::Reduced), ("general", SolverKind::General)])
}

pub fn vector(py: Python<'_>, v: Vec3) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_slice(py, v.as_slice())
}

pub fn quaternion(q: [f64; 4]) -> Quaternion<f64> {
    Quaternion::new(q[0], q[1], q[2], q[3])
}

/// `w, x, y, z`.
pub fn quaternion_array<'py>(py: Python<'py>, q: &Quaternion<f64>) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, &[q.w, q.i, q.j, q.k])
}

/// Rows of `N` numbers as an array of shape `(rows, N)`.
pub fn table<'py, const N: usize>(py: Python<'py>, rows: &[[f64; N]]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), N])
}
