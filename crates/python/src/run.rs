//! `simulate` and `sweep`.

use crate::convert::{refused, solver, table};
use crate::trial::PyTrial;
use dynamics::batch::{Control, Outcome, Until, rollouts as run_rollouts, sweep as run_batch};
use dynamics::recording::{Ended, record};
use dynamics::{Metrics, Rollout, SolverKind, Trial};
use numpy::IntoPyArray;
use pyo3::exceptions::{PyArithmeticError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::ThreadPoolBuildError;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// How often a run looks for Ctrl-C and reports its progress.
const LOOK: Duration = Duration::from_millis(50);
/// How many steps are made between two looks at the clock.
const STEPS_BETWEEN_CLOCKS: u64 = 256;

#[pyfunction]
#[pyo3(signature = (trial, every, solver="reduced", on_progress=None))]
pub fn simulate<'py>(
    py: Python<'py>,
    trial: &PyTrial,
    every: u64,
    solver: &str,
    on_progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let kind = self::solver(solver)?;
    if every == 0 {
        return Err(refused("every is 0, expected 1 or more"));
    }
    let mut interrupted = None;
    let mut looked = Instant::now();
    let recorded = py.detach(|| {
        record(&trial.0, kind, every, |done| {
            if done % STEPS_BETWEEN_CLOCKS != 0 || looked.elapsed() < LOOK {
                return ControlFlow::Continue(());
            }
            looked = Instant::now();
            match Python::attach(|py| report(py, on_progress.as_ref(), done)) {
                Ok(()) => ControlFlow::Continue(()),
                Err(error) => {
                    interrupted = Some(error);
                    ControlFlow::Break(())
                }
            }
        })
    });
    let (recording, metrics) = recorded.map_err(|ended| match ended {
        Ended::Stopped => interrupted.unwrap_or_else(|| PyKeyboardInterrupt::new_err(())),
        Ended::Diverged(diverged) => PyArithmeticError::new_err(diverged.to_string()),
    })?;
    report(py, on_progress.as_ref(), trial.0.steps())?;
    let out = PyDict::new(py);
    out.set_item("position_m", table(py, &recording.position)?)?;
    out.set_item("orientation", table(py, &recording.orientation)?)?;
    out.set_item("linear_velocity_m_per_s", table(py, &recording.linear)?)?;
    out.set_item("angular_velocity_rad_per_s", table(py, &recording.angular)?)?;
    out.set_item("ecp_m", table(py, &recording.ecp)?)?;
    out.set_item("friction_force_N", table(py, &recording.friction_force)?)?;
    out.set_item("time_s", recording.time.into_pyarray(py))?;
    out.set_item("contact_mode", recording.contact_mode.into_pyarray(py))?;
    out.set_item("normal_force_N", recording.normal_force.into_pyarray(py))?;
    out.set_item("adhesion_force_N", recording.adhesion_force.into_pyarray(py))?;
    out.set_item("slip_speed_m_per_s", recording.slip_speed.into_pyarray(py))?;
    out.set_item("residual", recording.residual.into_pyarray(py))?;
    out.set_item("newton_iterations", recording.newton_iterations.into_pyarray(py))?;
    out.set_item("twist_rad", metrics.twist)?;
    out.set_item("drift_m", metrics.drift)?;
    out.set_item("speed_m_per_s", metrics.speed)?;
    out.set_item("unconverged_steps", metrics.unconverged_steps)?;
    out.set_item("max_residual", metrics.max_residual)?;
    out.set_item("max_penetration_m", metrics.max_penetration)?;
    Ok(out)
}

#[pyfunction]
#[pyo3(signature = (trials, threads=0, on_progress=None))]
pub fn sweep<'py>(
    py: Python<'py>,
    trials: Vec<PyRef<'py, PyTrial>>,
    threads: usize,
    on_progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let trials: Vec<Trial> = trials.iter().map(|trial| trial.0.clone()).collect();
    let outcomes = watched(py, trials.len(), on_progress.as_ref(), |control| run_batch(&trials, threads, control))?;
    let metrics: Vec<Option<Metrics>> = outcomes
        .iter()
        .map(|outcome| if let Outcome::Done(metrics) = outcome { Some(*metrics) } else { None })
        .collect();
    let number = |of: fn(&Metrics) -> f64| -> Vec<f64> {
        metrics.iter().map(|metrics| metrics.as_ref().map_or(f64::NAN, of)).collect()
    };
    let count = |of: fn(&Metrics) -> u64| -> Vec<i64> {
        metrics.iter().map(|metrics| metrics.as_ref().map_or(0, of) as i64).collect()
    };
    let errors: Vec<Option<String>> = outcomes
        .iter()
        .map(|outcome| match outcome {
            Outcome::Done(_) => None,
            Outcome::Failed(message) => Some(message.clone()),
            Outcome::Stopped => Some("stopped before its end".to_owned()),
        })
        .collect();
    let out = PyDict::new(py);
    out.set_item("twist_rad", number(|m| m.twist).into_pyarray(py))?;
    out.set_item("drift_m", number(|m| m.drift).into_pyarray(py))?;
    out.set_item("speed_m_per_s", number(|m| m.speed).into_pyarray(py))?;
    out.set_item("max_residual", number(|m| m.max_residual).into_pyarray(py))?;
    out.set_item("max_penetration_m", number(|m| m.max_penetration).into_pyarray(py))?;
    out.set_item("unconverged_steps", count(|m| m.unconverged_steps).into_pyarray(py))?;
    out.set_item("newton_iterations", count(|m| m.newton_iterations).into_pyarray(py))?;
    out.set_item("error", errors)?;
    Ok(out)
}

#[pyfunction]
#[pyo3(signature = (trials, every, threads=0, on_progress=None, *, while_resolved=false, verified=true))]
pub fn rollouts<'py>(
    py: Python<'py>,
    trials: Vec<PyRef<'py, PyTrial>>,
    every: Vec<u64>,
    threads: usize,
    on_progress: Option<Py<PyAny>>,
    while_resolved: bool,
    verified: bool,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    if every.len() != trials.len() || every.contains(&0) {
        return Err(refused("every is refused, expected a whole number of at least 1 for each trial"));
    }
    let trials: Vec<Trial> = trials.iter().map(|trial| trial.0.clone()).collect();
    let until = if while_resolved { Until::Unresolved } else { Until::End };
    let kind = if verified { SolverKind::Reduced } else { SolverKind::Unverified };
    let outcomes = watched(py, trials.len(), on_progress.as_ref(), |control| {
        run_rollouts(&trials, &every, until, kind, threads, control)
    })?;
    outcomes
        .into_iter()
        .map(|outcome| {
            let out = PyDict::new(py);
            let (rollout, error) = match outcome {
                Outcome::Done(rollout) => (rollout, None),
                Outcome::Failed(message) => (Rollout::default(), Some(message)),
                Outcome::Stopped => (Rollout::default(), Some("stopped before its end".to_owned())),
            };
            out.set_item("time_s", rollout.time.into_pyarray(py))?;
            out.set_item("position_m", table(py, &rollout.position)?)?;
            out.set_item("orientation", table(py, &rollout.orientation)?)?;
            out.set_item("contact_mode", rollout.contact_mode.into_pyarray(py))?;
            out.set_item("unconverged_steps", rollout.unconverged_steps)?;
            out.set_item("error", error)?;
            Ok(out)
        })
        .collect()
}

/// Runs a batch on a thread of its own, and looks for Ctrl-C meanwhile.
fn watched<T: Send>(
    py: Python<'_>,
    total: usize,
    on_progress: Option<&Py<PyAny>>,
    run: impl FnOnce(&Control) -> Result<Vec<Outcome<T>>, ThreadPoolBuildError> + Send,
) -> PyResult<Vec<Outcome<T>>> {
    let control = Control::default();
    let outcomes = py.detach(|| {
        let (done, outcomes) = mpsc::channel();
        std::thread::scope(|scope| {
            scope.spawn(|| done.send(run(&control)));
            loop {
                match outcomes.recv_timeout(LOOK) {
                    Ok(outcomes) => return outcomes.map_err(refused),
                    Err(RecvTimeoutError::Disconnected) => return Err(refused("the batch ended without outcomes")),
                    Err(RecvTimeoutError::Timeout) => {}
                }
                let finished = control.finished.load(Ordering::Relaxed) as u64;
                if let Err(error) = Python::attach(|py| report(py, on_progress, finished)) {
                    control.stop.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
        })
    })?;
    report(py, on_progress, total as u64)?;
    Ok(outcomes)
}

/// Raises a pending Ctrl-C, then tells `on_progress` how much is done.
fn report(py: Python<'_>, on_progress: Option<&Py<PyAny>>, done: u64) -> PyResult<()> {
    py.check_signals()?;
    if let Some(callback) = on_progress {
        callback.call1(py, (done,))?;
    }
    Ok(())
}
