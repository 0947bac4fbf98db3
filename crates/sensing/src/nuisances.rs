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
use crate::{Camera, Path, Seen, SensingError, Tolerances};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;

const ITERATIONS: usize = 3;
/// The camera's numbers come first of those that all trials share.
const CAMERA: usize = Camera::COUNT;

/// Nuisances at their best.
#[derive(Debug, Clone, PartialEq)]
pub struct Nuisances {
    /// Clock (s) and origin (m) by trial.
    pub local: Vec<[f64; 3]>,
    /// The camera's heading (rad) and scale, then how far the nominal numbers are off.
    pub shared: Vec<f64>,
}

impl Nuisances {
    /// Those of a perfect sensor, of so many trials that share so many numbers.
    pub(crate) fn perfect(trials: usize, count: usize, held: Option<&[f64]>) -> Self {
        let mut shared = vec![0.0; count];
        if let Some(off) = held {
            shared[Camera::COUNT..].copy_from_slice(off);
        }
        Self { local: vec![[0.0; 3]; trials], shared }
    }
}

/// The nuisances of one run.
pub(crate) struct Problem<'a> {
    pub trials: &'a [&'a Measured],
    pub run: &'a [Seen<'a>],
    pub tolerances: &'a Tolerances,
    pub train: &'a [bool],
    pub held: bool,
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
    /// What `of` makes of each trial that was run.
    pub fn each<T: Send>(
        &self,
        of: impl Fn(usize, &Measured, &Path) -> Result<T, SensingError> + Sync,
    ) -> Result<Vec<Option<T>>, SensingError> {
        let one = |(i, seen): (usize, &Seen)| seen.path.as_ref().map(|path| of(i, self.trials[i], path)).transpose();
        self.run.par_iter().enumerate().map(one).collect()
    }

    /// The nuisances at their best, from a perfect sensor's.
    pub fn fitted(&self, start: Nuisances) -> Result<Nuisances, SensingError> {
        let mut at = start;
        let clocks = self.each(|i, trial, path| {
            Ok(trial.clock(path, self.tolerances.local_bounds[i][0], &self.tolerances.local_sigmas[i]))
        })?;
        for (local, clock) in at.local.iter_mut().zip(clocks) {
            local[0] = clock.unwrap_or(0.0);
        }
        for _ in 0..ITERATIONS {
            at = self.improved(&at)?;
        }
        Ok(at)
    }

    /// One step of Gauss and Newton's method.
    fn improved(&self, at: &Nuisances) -> Result<Nuisances, SensingError> {
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
            let definite = (block.own + Matrix3::from_diagonal(&weights)).cholesky();
            let inverse = definite.ok_or(SensingError::Singular { trial: i })?.inverse();
            Ok((block, inverse, own))
        })?;
        for (block, inverse, own) in
            blocks.iter().zip(self.train).filter_map(|(block, train)| block.as_ref().filter(|_| *train))
        {
            let reduced = block.by_shared.transpose() * inverse;
            normal += &block.shared - &reduced * &block.by_shared;
            right -= &block.shared_right - &reduced * own;
        }
        let change = normal.lu().solve(&right).ok_or(SensingError::SharedSingular)?;
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
        Ok(next)
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
