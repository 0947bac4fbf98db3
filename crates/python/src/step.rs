//! `step`: one step and all its unknowns, for parity tests.

use crate::convert::{quaternion, refused, solver, table, vector};
use crate::trial::PyTrial;
use dynamics::{Adhesion, State, Stepper};
use geometry::Support;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pyfunction]
#[pyo3(signature = (trial, time_s, position_m, orientation, linear_velocity_m_per_s, angular_velocity_rad_per_s,
    adhesion_force_N, patch_centroid_m, solver="reduced"))]
#[allow(clippy::too_many_arguments, non_snake_case)] // a state, keyword by keyword
pub fn step<'py>(
    py: Python<'py>,
    trial: &PyTrial,
    time_s: f64,
    position_m: [f64; 3],
    orientation: [f64; 4],
    linear_velocity_m_per_s: [f64; 3],
    angular_velocity_rad_per_s: [f64; 3],
    adhesion_force_N: f64,
    patch_centroid_m: [f64; 3],
    solver: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let (kind, h) = (self::solver(solver)?, trial.0.step());
    let done = trial.0.steps_until(time_s).map_err(refused)?;
    let state = State {
        position: position_m.into(),
        orientation: quaternion(orientation),
        linear: linear_velocity_m_per_s.into(),
        angular: angular_velocity_rad_per_s.into(),
    };
    let adhesion = Adhesion { impulse: adhesion_force_N * h, centroid: patch_centroid_m.into() };
    let mut stepper = Stepper::from_state(&trial.0, kind, state, done, adhesion, Support::None);
    let solution = stepper.advance().clone();
    let out = PyDict::new(py);
    out.set_item("linear_velocity_m_per_s", vector(py, solution.linear))?;
    out.set_item("angular_velocity_rad_per_s", vector(py, solution.angular))?;
    out.set_item("ecp_m", vector(py, solution.ecp))?;
    out.set_item("ecp_substrate_m", vector(py, solution.ecp_substrate))?;
    out.set_item("friction_impulse", vector(py, solution.friction))?;
    out.set_item("multipliers", PyArray1::from_slice(py, &solution.multipliers))?;
    let gradients = solution.gradients(trial.0.robot().body(), &state, h);
    let gradients: Vec<[f64; 3]> = gradients.into_iter().map(Into::into).collect();
    out.set_item("gradients", table(py, &gradients)?)?;
    out.set_item("plane_multiplier", solution.plane_multiplier)?;
    out.set_item("sigma", solution.sigma)?;
    out.set_item("normal_impulse", solution.normal)?;
    out.set_item("active", solution.active)?;
    out.set_item("residual", solution.residual)?;
    out.set_item("penetration_m", solution.penetration)?;
    out.set_item("contact_mode", solution.patch.mode as i8)?;
    out.set_item("area_m2", solution.patch.area)?;
    out.set_item("newton_iterations", solution.iterations)?;
    out.set_item("converged", solution.converged)?;
    Ok(out)
}
