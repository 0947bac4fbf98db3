//! The sensor's nuisances, and how far the nominal numbers are off, at their best for given paths.
//!
//! They minimise
//!
//! ```text
//! Σ_t w_t |W (y - m(τ, o, ψ, s)) - D η|² + Σ (τ/σ_τ)² + |o/σ_o|² + (ψ/σ_ψ)² + (s/σ_s)² + |η|²
//! ```
//!
//! within their tolerances, by Gauss and Newton's method: the clock `τ` and the origin `o` of each trial for itself, the
//! camera's heading `ψ` and scale `s` and the nominal numbers' being off (`η`, in their tolerances) over all trials that
//! count. A trial that the paths are far from counts less, `w_t = 1/(1 + mean square/κ)`.

use crate::loss::{huber, weight};
use crate::measured::{Measured, Row, dot};
use crate::{Path, SensingError};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;

const ITERATIONS: usize = 3;
/// The camera's numbers among those that all trials share.
pub(crate) const CAMERA: usize = 2;

/// A camera that is turned about `+z` and scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Length seen over true length.
    pub(crate) size: f64,
    /// Sine and cosine of the heading, and of its half.
    pub(crate) turned: (f64, f64),
    pub(crate) half: (f64, f64),
}

impl Camera {
    /// A camera that is turned by `heading` from `+y` towards `-x`, and shows lengths greater by the share `scale`.
    pub fn new(heading: f64, scale: f64) -> Self {
        Self { size: 1.0 + scale, turned: heading.sin_cos(), half: (0.5 * heading).sin_cos() }
    }

    /// By what share lengths are greater.
    pub fn scale(&self) -> f64 {
        self.size - 1.0
    }
}

/// How far the nuisances may be off.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerances {
    /// By trial, of the clock (s) and the origin (m): bounds, and standard deviations.
    pub local_bounds: Vec<[f64; 3]>,
    /// Standard deviations of the same.
    pub local_sigmas: Vec<[f64; 3]>,
    /// Of the camera's heading (rad) and scale, then of the nominal numbers in their tolerances.
    pub shared_low: Vec<f64>,
    /// Upper bounds of the same.
    pub shared_high: Vec<f64>,
    /// Standard deviations of the same.
    pub shared_sigmas: Vec<f64>,
}

/// What a hypothesis says of one trial.
#[derive(Debug, Clone)]
pub struct Seen<'a> {
    /// None where the model cannot be run.
    pub path: Option<Path<'a>>,
    /// Scaled differences of the outcomes, `[constant, by the camera's scale]` each.
    pub outcomes: Vec<[f64; 2]>,
}

/// Nuisances at their best.
#[derive(Debug, Clone, PartialEq)]
pub struct Nuisances {
    /// Clock (s) and origin (m) by trial.
    pub local: Vec<[f64; 3]>,
    /// The camera's heading (rad) and scale, then how far the nominal numbers are off.
    pub shared: Vec<f64>,
}

/// How wrong one run of all trials is.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// At their best.
    pub nuisances: Nuisances,
    /// By trial the whitened differences, none where it was not run.
    pub wrong: Vec<Option<Vec<f64>>>,
}

/// Compares some runs of all trials with what was measured in them.
///
/// What all trials share is fitted from those of `train`; the nominal numbers are held where `held` says how far they are
/// off, and nothing is fitted where `fit` is false.
pub fn compare(
    trials: &[&Measured],
    runs: &[Vec<Seen>],
    tolerances: &Tolerances,
    train: &[bool],
    held: Option<&[f64]>,
    fit: bool,
) -> Result<Vec<Compared>, SensingError> {
    let count = tolerances.shared_sigmas.len();
    let same = |what, found, expected| {
        if found == expected { Ok(()) } else { Err(SensingError::Rows { what, found, expected }) }
    };
    same("local_bounds", tolerances.local_bounds.len(), trials.len())?;
    same("local_sigmas", tolerances.local_sigmas.len(), trials.len())?;
    same("shared_low", tolerances.shared_low.len(), count)?;
    same("shared_high", tolerances.shared_high.len(), count)?;
    same("train", train.len(), trials.len())?;
    same("held", held.map_or(count, |off| off.len() + CAMERA), count)?;
    for trial in trials {
        same("a trial's shared numbers", trial.shared() + CAMERA, count)?;
    }
    for run in runs {
        same("a run", run.len(), trials.len())?;
        for (seen, trial) in run.iter().zip(trials) {
            same("a trial's outcomes", seen.outcomes.len(), if seen.path.is_some() { trial.outcomes() } else { 0 })?;
        }
    }
    Ok(runs
        .par_iter()
        .map(|run| {
            let problem = Problem { trials, run, tolerances, train, held: held.is_some() };
            let start = Nuisances { local: vec![[0.0; 3]; trials.len()], shared: problem.perfect(held) };
            let found = if fit { problem.fitted(start) } else { start };
            let wrong = problem
                .each(|i, trial, path| trial.whitened(path, &run[i].outcomes, &found.local[i], &found.shared).ok());
            Compared { nuisances: found, wrong }
        })
        .collect())
}

/// The nuisances of one run.
struct Problem<'a> {
    trials: &'a [&'a Measured],
    run: &'a [Seen<'a>],
    tolerances: &'a Tolerances,
    train: &'a [bool],
    held: bool,
}

/// The normal equations of one trial: of its own nuisances, of these by what all share, and of what all share.
struct Normal {
    own: Matrix3<f64>,
    own_right: Vector3<f64>,
    by_shared: DMatrix<f64>,
    shared: DMatrix<f64>,
    shared_right: DVector<f64>,
}

impl Problem<'_> {
    fn perfect(&self, held: Option<&[f64]>) -> Vec<f64> {
        let mut shared = vec![0.0; self.tolerances.shared_sigmas.len()];
        if let Some(off) = held {
            shared[CAMERA..].copy_from_slice(off);
        }
        shared
    }

    /// What `of` makes of each trial that was run.
    fn each<T: Send>(&self, of: impl Fn(usize, &Measured, &Path) -> Option<T> + Sync) -> Vec<Option<T>> {
        self.run.par_iter().enumerate().map(|(i, seen)| of(i, self.trials[i], seen.path.as_ref()?)).collect()
    }

    fn fitted(&self, start: Nuisances) -> Nuisances {
        let mut at = start;
        let clocks = self.each(|i, trial, path| {
            Some(trial.clock(path, self.tolerances.local_bounds[i][0], &self.tolerances.local_sigmas[i]))
        });
        for (local, clock) in at.local.iter_mut().zip(clocks) {
            local[0] = clock.unwrap_or(0.0);
        }
        for _ in 0..ITERATIONS {
            at = self.improved(&at);
        }
        at
    }

    /// One step of Gauss and Newton's method.
    fn improved(&self, at: &Nuisances) -> Nuisances {
        let bounds = self.tolerances;
        let precision =
            DVector::from_iterator(at.shared.len(), bounds.shared_sigmas.iter().map(|sigma| sigma.powi(-2)));
        let mut normal = DMatrix::from_diagonal(&precision);
        let mut right = -precision.component_mul(&DVector::from_column_slice(&at.shared));
        if self.held {
            right.rows_mut(CAMERA, at.shared.len() - CAMERA).fill(0.0);
        }
        let blocks = self.each(|i, trial, path| {
            let block = self.normal(trial, path, &self.run[i].outcomes, &at.local[i], &at.shared);
            let weights = Vector3::from(bounds.local_sigmas[i].map(|sigma| sigma.powi(-2)));
            let own = block.own_right + weights.component_mul(&Vector3::from(at.local[i]));
            let inverse = (block.own + Matrix3::from_diagonal(&weights)).cholesky()?.inverse();
            Some((block, inverse, own))
        });
        for (block, inverse, own) in
            blocks.iter().zip(self.train).filter_map(|(block, train)| block.as_ref().filter(|_| *train))
        {
            let reduced = block.by_shared.transpose() * inverse;
            normal += &block.shared - &reduced * &block.by_shared;
            right -= &block.shared_right - &reduced * own;
        }
        let change = normal.lu().solve(&right).unwrap_or_else(|| DVector::zeros(at.shared.len()));
        let mut next = at.clone();
        for (k, value) in next.shared.iter_mut().enumerate() {
            *value = (*value + change[k]).clamp(bounds.shared_low[k], bounds.shared_high[k]);
        }
        for (i, block) in blocks.iter().enumerate() {
            let Some((block, inverse, own)) = block else { continue };
            let moved = inverse * (own + &block.by_shared * &change);
            for k in 0..3 {
                let most = bounds.local_bounds[i][k];
                next.local[i][k] = (at.local[i][k] - moved[k]).clamp(-most, most);
            }
        }
        next
    }

    fn normal(&self, trial: &Measured, path: &Path, outcomes: &[[f64; 2]], local: &[f64; 3], shared: &[f64]) -> Normal {
        let (off, count) = (&shared[CAMERA..], shared.len());
        let mut rows = trial.linearised(path, outcomes, local, &Camera::new(shared[0], shared[1]));
        for (row, by) in rows.iter_mut().zip(trial.tolerance()) {
            row[5] -= dot(by, off);
        }
        // One trial that the model cannot follow must not turn the camera of all.
        let lost = rows[..trial.tracked()].iter().map(|row| huber(row[5])).sum();
        let weight = weight(lost, trial.whole());
        // By the trial's own, the camera's, and the difference; then these by the nominal numbers, and the latter by themselves.
        let mut sensor = [[0.0; 6]; 6];
        let mut by_number = DMatrix::zeros(6, count - CAMERA);
        let mut numbers = DMatrix::zeros(count - CAMERA, count - CAMERA);
        for (row, by) in rows.iter().zip(trial.tolerance()) {
            add(&mut sensor, row);
            if !self.held {
                for (k, b) in by.iter().enumerate() {
                    for (n, r) in row.iter().enumerate() {
                        by_number[(n, k)] -= r * b;
                    }
                    for (l, c) in by[..=k].iter().enumerate() {
                        numbers[(k, l)] += b * c;
                    }
                }
            }
        }
        numbers.fill_upper_triangle_with_lower_triangle();
        let sensor = weight * DMatrix::from_fn(6, 6, |r, c| sensor[r.max(c)][r.min(c)]);
        by_number *= weight;
        let mut by_shared = DMatrix::zeros(3, count);
        by_shared.columns_mut(0, CAMERA).copy_from(&sensor.view((0, 3), (3, CAMERA)));
        by_shared.columns_mut(CAMERA, count - CAMERA).copy_from(&by_number.rows(0, 3));
        let mut all = DMatrix::zeros(count, count);
        all.view_mut((0, 0), (CAMERA, CAMERA)).copy_from(&sensor.view((3, 3), (CAMERA, CAMERA)));
        all.view_mut((0, CAMERA), (CAMERA, count - CAMERA)).copy_from(&by_number.rows(3, CAMERA));
        all.view_mut((CAMERA, 0), (count - CAMERA, CAMERA)).copy_from(&by_number.rows(3, CAMERA).transpose());
        all.view_mut((CAMERA, CAMERA), (count - CAMERA, count - CAMERA)).copy_from(&(weight * numbers));
        let mut shared_right = DVector::zeros(count);
        shared_right.rows_mut(0, CAMERA).copy_from(&sensor.view((3, 5), (CAMERA, 1)));
        shared_right.rows_mut(CAMERA, count - CAMERA).copy_from(&by_number.row(5).transpose());
        Normal {
            own: sensor.fixed_view::<3, 3>(0, 0).into_owned(),
            own_right: sensor.fixed_view::<3, 1>(0, 5).into_owned(),
            by_shared,
            shared: all,
            shared_right,
        }
    }
}

/// Adds the products of a row's numbers with each other, the lower triangle.
#[inline]
fn add(products: &mut [[f64; 6]; 6], row: &Row) {
    for r in 0..6 {
        for c in 0..=r {
            products[r][c] += row[r] * row[c];
        }
    }
}
