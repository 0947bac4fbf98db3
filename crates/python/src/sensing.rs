//! What was measured in a trial, and its comparison with paths.

use crate::convert::{choose, quaternion, refused, table};
use ::sensing::{Angle, Camera, Channel, Column, LOCAL, Measured, Path, Seen, Tolerances, Whiten};
use nalgebra::UnitQuaternion;
use numpy::ndarray::ArrayView1;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use std::f64::consts::{PI, TAU};
use std::thread::available_parallelism;

/// One channel: its name, times, measured numbers or quaternions, and the matrix that whitens it.
type PyColumn<'py> = (String, PyReadonlyArray1<'py, f64>, PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, f64>);
/// A path: the interval of its rows, its time when the sensor's clock says 0, and the rows.
type PyPath<'py> = (f64, f64, PyReadonlyArray2<'py, f64>);
/// One trial of a run: its path, or none, and the outcomes' scaled differences.
type PySeen<'py> = (Option<PyPath<'py>>, PyReadonlyArray2<'py, f64>);
/// Clocks and origins, what all share, and the whitened differences.
type PyCompared<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>, Vec<Option<Bound<'py, PyArray1<f64>>>>);

/// What a name means for a channel whose measurements are given.
#[derive(Clone, Copy)]
enum Kind {
    Place(usize),
    Tilt,
    Heading(f64),
    Turn(Angle),
}

const KINDS: [(&str, Kind); 9] = [
    ("x", Kind::Place(0)),
    ("y", Kind::Place(1)),
    ("z", Kind::Place(2)),
    ("tilt", Kind::Tilt),
    ("heading", Kind::Heading(TAU)),
    ("axis_heading", Kind::Heading(PI)),
    ("turn_tilt", Kind::Turn(Angle::Tilt)),
    ("turn_twist", Kind::Turn(Angle::Twist)),
    ("turn_heading", Kind::Turn(Angle::Heading)),
];

#[pyclass(name = "Measured", module = "tumblers._core", frozen)]
pub struct PyMeasured(Measured);

#[pymethods]
impl PyMeasured {
    #[new]
    fn new(
        columns: Vec<PyColumn<'_>>,
        tolerance: PyReadonlyArray2<'_, f64>,
        outcomes: usize,
        whole: usize,
    ) -> PyResult<Self> {
        let columns = columns
            .iter()
            .map(|(name, times, values, whiten)| {
                let rows = whiten.as_array();
                Ok(Column {
                    channel: channel(choose("channel", name, &KINDS)?, values)?,
                    times: times.as_array().to_vec(),
                    whiten: Whiten::new(rows.outer_iter().map(|row| row.to_vec())).map_err(refused)?,
                })
            })
            .collect::<PyResult<Vec<Column>>>()?;
        let tolerance = tolerance.as_array();
        let flat = tolerance.iter().copied().collect();
        Measured::new(columns, flat, tolerance.ncols(), outcomes, whole).map(Self).map_err(refused)
    }

    fn whitened<'py>(
        &self,
        py: Python<'py>,
        run: PySeen<'py>,
        local: [f64; LOCAL],
        shared: Vec<f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let seen = seen(run.0.as_ref(), &run.1)?;
        let path = seen.path.ok_or_else(|| refused("a trial that was not run has no differences"))?;
        let expected = self.0.shared() + Camera::COUNT;
        if (seen.outcomes.len(), shared.len()) != (self.0.outcomes(), expected) {
            return Err(refused(format!(
                "outcomes and shared have {} and {} numbers, expected {} and {expected}",
                seen.outcomes.len(),
                shared.len(),
                self.0.outcomes(),
            )));
        }
        Ok(PyArray1::from_vec(py, self.0.whitened(&path, &seen.outcomes, &local, &shared)))
    }
}

#[pyfunction]
#[pyo3(signature = (
    trials, runs, local_bounds, local_sigmas, shared, train, outcome_weight=1.0, held=None, fit=true, threads=0
))]
#[allow(clippy::too_many_arguments)] // keywords of one Python call
pub fn compare<'py>(
    py: Python<'py>,
    trials: Vec<PyRef<'py, PyMeasured>>,
    runs: Vec<Vec<PySeen<'py>>>,
    local_bounds: Vec<[f64; LOCAL]>,
    local_sigmas: Vec<[f64; LOCAL]>,
    shared: (Vec<f64>, Vec<f64>, Vec<f64>),
    train: Vec<bool>,
    outcome_weight: f64,
    held: Option<Vec<f64>>,
    fit: bool,
    threads: usize,
) -> PyResult<Vec<PyCompared<'py>>> {
    let seen = runs
        .iter()
        .map(|run| run.iter().map(|(path, outcomes)| seen(path.as_ref(), outcomes)).collect())
        .collect::<PyResult<Vec<Vec<Seen>>>>()?;
    let measured: Vec<&Measured> = trials.iter().map(|trial| &trial.0).collect();
    let (shared_low, shared_high, shared_sigmas) = shared;
    let tolerances = Tolerances { local_bounds, local_sigmas, shared_low, shared_high, shared_sigmas };
    let compared = py
        .detach(|| {
            // No more threads than there are paths to compare.
            let most = (measured.len() * seen.len()).max(1);
            let threads = if threads == 0 { available_parallelism().map_or(1, usize::from) } else { threads }.min(most);
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
            pool.install(|| {
                ::sensing::compare(&measured, &seen, &tolerances, &train, outcome_weight, held.as_deref(), fit)
            })
            .map_err(|error| error.to_string())
        })
        .map_err(refused)?;
    compared
        .into_iter()
        .map(|one| {
            let array = |values: Vec<f64>| PyArray1::from_vec(py, values);
            let wrong = one.wrong.into_iter().map(|values| values.map(array)).collect();
            Ok((table(py, &one.nuisances.local)?, array(one.nuisances.shared), wrong))
        })
        .collect()
}

fn seen<'a>(path: Option<&'a PyPath<'_>>, outcomes: &PyReadonlyArray2<'_, f64>) -> PyResult<Seen<'a>> {
    let path = path
        .map(|(interval, clock, poses)| {
            width("a path's poses", poses, 7)?;
            let rows = poses.as_array().to_slice().ok_or_else(|| refused("a path's poses are not row after row"))?;
            Path::new(*interval, *clock, rows.as_chunks::<7>().0).map_err(refused)
        })
        .transpose()?;
    width("outcomes", outcomes, 2)?;
    let outcomes = outcomes.as_array().outer_iter().map(|line| [line[0], line[1]]).collect();
    Ok(Seen { path, outcomes })
}

fn channel(kind: Kind, values: &PyReadonlyArray2<'_, f64>) -> PyResult<Channel> {
    width("a channel", values, if matches!(kind, Kind::Turn(_)) { 4 } else { 1 })?;
    let values = values.as_array();
    let numbers = || values.iter().copied().collect();
    Ok(match kind {
        Kind::Place(k) => Channel::Place(k, numbers()),
        Kind::Tilt => Channel::Tilt(numbers()),
        Kind::Heading(turn) => Channel::Heading(turn, numbers()),
        Kind::Turn(angle) => {
            let turn = |q: ArrayView1<'_, f64>| UnitQuaternion::new_unchecked(quaternion([q[0], q[1], q[2], q[3]]));
            Channel::Turn(angle, values.outer_iter().map(turn).collect())
        }
    })
}

fn width(what: &str, values: &PyReadonlyArray2<'_, f64>, expected: usize) -> PyResult<()> {
    let found = values.as_array().ncols();
    if found == expected {
        Ok(())
    } else {
        Err(refused(format!("{what} has {found} numbers a row, expected {expected}")))
    }
}
