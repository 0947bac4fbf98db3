//! `Walk`: a run whose trial may be exchanged on the way, for a world whose laws change with time and place.

use crate::convert::{quaternion_array, refused, solver, vector};
use crate::trial::PyTrial;
use dynamics::{Adhesion, SolverKind, State, Stepper};
use geometry::Support;
use pyo3::exceptions::PyArithmeticError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pyclass(name = "Walk", module = "tumblers._core")]
pub struct PyWalk {
    kind: SolverKind,
    state: State,
    done: u64,
    adhesion: Adhesion,
    support: Support,
    step: f64,
}

#[pymethods]
impl PyWalk {
    #[new]
    #[pyo3(signature = (trial, solver="reduced"))]
    fn new(trial: &PyTrial, solver: &str) -> PyResult<Self> {
        let kind = self::solver(solver)?;
        let stepper = Stepper::new(&trial.0, kind);
        Ok(Self {
            kind,
            state: *stepper.state(),
            done: 0,
            adhesion: *stepper.adhesion(),
            support: trial.0.initial_support(),
            step: trial.0.step(),
        })
    }

    /// Makes `steps` steps of `trial` from where the walk is.
    fn advance<'py>(&mut self, py: Python<'py>, trial: &PyTrial, steps: u64) -> PyResult<Bound<'py, PyDict>> {
        if trial.0.step() != self.step {
            return Err(refused(format!("step_s is {}, expected {}, that of the walk", trial.0.step(), self.step)));
        }
        let mut stepper = Stepper::from_state(&trial.0, self.kind, self.state, self.done, self.adhesion, self.support);
        let mut converged = true;
        for _ in 0..steps {
            converged &= stepper.advance().converged;
        }
        if !stepper.is_finite() {
            let message = format!("the state is not finite any more at {} s: the motion diverged", stepper.time());
            return Err(PyArithmeticError::new_err(message));
        }
        self.state = *stepper.state();
        self.done += steps;
        self.adhesion = *stepper.adhesion();
        self.support = stepper.solution().support;
        let (seen, turned) = trial.0.seen(&self.state);
        let out = PyDict::new(py);
        out.set_item("time_s", stepper.time())?;
        out.set_item("position_m", vector(py, self.state.position))?;
        out.set_item("orientation", quaternion_array(py, &self.state.orientation))?;
        out.set_item("linear_velocity_m_per_s", vector(py, self.state.linear))?;
        out.set_item("angular_velocity_rad_per_s", vector(py, self.state.angular))?;
        out.set_item("seen_position_m", vector(py, seen))?;
        out.set_item("seen_orientation", quaternion_array(py, &turned))?;
        out.set_item("contact_mode", stepper.solution().patch.mode as i8)?;
        out.set_item("normal_force_N", stepper.solution().normal / self.step)?;
        out.set_item("converged", converged)?;
        Ok(out)
    }
}
