//! The sensor's nuisances, and how far the nominal numbers are off, at their best for given paths.
//!
//! They minimise
//!
//! ```text
//! Σ_t w_t |W (y - m(τ, o, ψ, s)) - D η|² + n_c |outcomes - D η|² + Σ (τ/σ_τ)² + |o/σ_o|² + (ψ/σ_ψ)² + (s/σ_s)² + |η|²
//! ```
//!
//! within their tolerances, by Gauss and Newton's method: the clock `τ` and the origin `o` of each trial for itself, the
//! camera's heading `ψ` and scale `s` and the nominal numbers' being off (`η`, in their tolerances) over all trials that
//! count. A trial that the paths are far from counts less, `w_t = 1/(1 + mean square/κ)`; an outcome counts as `n_c` numbers
//! of a track.

use crate::bounded::{Block, least};
use crate::loss::{huber, weight};
use crate::measured::{LOCAL, Measured, dot};
use crate::{Camera, Path, Seen, SensingError, Tolerances};
use nalgebra::{DMatrix, DVector, Matrix4, Vector4};
use rayon::prelude::*;
use std::array::from_fn;

const ITERATIONS: usize = 3;
/// The camera's numbers come first of those that all trials share.
const CAMERA: usize = Camera::COUNT;

/// Nuisances at their best.
#[derive(Debug, Clone, PartialEq)]
pub struct Nuisances {
    /// Clock (s) and origin (m) by trial.
    pub local: Vec<[f64; LOCAL]>,
    /// The camera's heading (rad) and scale, then how far the nominal numbers are off.
    pub shared: Vec<f64>,
}

impl Nuisances {
    /// Those of a perfect sensor, of so many trials that share so many numbers.
    pub(crate) fn perfect(trials: usize, count: usize, held: Option<&[f64]>) -> Self {
        let mut shared = vec![0.0; count];
        if let Some(off) = held {
            shared[CAMERA..].copy_from_slice(off);
        }
        Self { local: vec![[0.0; LOCAL]; trials], shared }
    }
}

/// The nuisances of one run.
pub(crate) struct Problem<'a> {
    pub trials: &'a [&'a Measured],
    pub run: &'a [Seen<'a>],
    pub tolerances: &'a Tolerances,
    pub train: &'a [bool],
    pub outcome_weight: f64,
    pub held: bool,
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

    /// One step of Gauss and Newton's method, the least within the bounds.
    fn improved(&self, at: &Nuisances) -> Result<Nuisances, SensingError> {
        let bounds = self.tolerances;
        let precision =
            DVector::from_iterator(at.shared.len(), bounds.shared_sigmas.iter().map(|sigma| sigma.powi(-2)));
        let mut normal = DMatrix::from_diagonal(&precision);
        let mut slope = precision.component_mul(&DVector::from_column_slice(&at.shared));
        let count = at.shared.len();
        let products = self
            .each(|i, trial, path| Ok(self.products(trial, path, &self.run[i].outcomes, &at.local[i], &at.shared)))?;
        let mut blocks = Vec::with_capacity(products.len());
        for (i, products) in products.iter().enumerate() {
            let counted = self.train[i];
            blocks.push(products.as_ref().map(|products| {
                let weights = Vector4::from(bounds.local_sigmas[i].map(|sigma| sigma.powi(-2)));
                let local = Vector4::from(at.local[i]);
                Block {
                    own: products.fixed_view::<LOCAL, LOCAL>(0, 0) + Matrix4::from_diagonal(&weights),
                    by_shared: products.fixed_rows::<LOCAL>(0).columns(LOCAL, count).into_owned(),
                    slope: products.fixed_view::<LOCAL, 1>(0, LOCAL + count) + weights.component_mul(&local),
                    bounds: from_fn(|k| {
                        let most = bounds.local_bounds[i][k];
                        [-most - local[k], most - local[k]]
                    }),
                    counted,
                }
            }));
            if let (true, Some(products)) = (counted, products) {
                normal += products.view((LOCAL, LOCAL), (count, count));
                slope += products.view((LOCAL, LOCAL + count), (count, 1));
            }
        }
        let ends: Vec<[f64; 2]> = (0..count)
            .map(|k| match self.held && k >= CAMERA {
                true => [0.0; 2],
                false => [bounds.shared_low[k] - at.shared[k], bounds.shared_high[k] - at.shared[k]],
            })
            .collect();
        let (change, moved) = least(&blocks, &normal, &slope, &ends)?;
        let mut next = at.clone();
        for (k, value) in next.shared.iter_mut().enumerate() {
            *value = (*value + change[k]).clamp(bounds.shared_low[k], bounds.shared_high[k]);
        }
        for (i, changes) in moved.iter().enumerate() {
            let Some(changes) = changes else { continue };
            for k in 0..LOCAL {
                let most = bounds.local_bounds[i][k];
                next.local[i][k] = (at.local[i][k] + changes[k]).clamp(-most, most);
            }
        }
        Ok(next)
    }

    /// The products of all columns with each other: the derivatives by the trial's own nuisances and by what all share, and
    /// the differences.
    fn products(
        &self,
        trial: &Measured,
        path: &Path,
        outcomes: &[[f64; 2]],
        local: &[f64; LOCAL],
        shared: &[f64],
    ) -> DMatrix<f64> {
        let off = &shared[CAMERA..];
        let linear = trial.linearised(path, outcomes, local, &Camera::new(shared[0], shared[1]));
        let [sensor, wrong] = [LOCAL + CAMERA, LOCAL + shared.len()];
        let mut rows = DMatrix::zeros(linear.len(), wrong + 1);
        for (r, (row, by)) in linear.iter().zip(trial.tolerance()).enumerate() {
            for (k, derivative) in row[..sensor].iter().enumerate() {
                rows[(r, k)] = *derivative;
            }
            if !self.held {
                for (k, change) in by.iter().enumerate() {
                    rows[(r, sensor + k)] = -change;
                }
            }
            rows[(r, wrong)] = row[sensor] - dot(by, off);
        }
        // One trial that the model cannot follow must not turn the camera of all.
        let lost = rows.column(wrong).iter().take(trial.tracked()).map(|r| huber(*r)).sum();
        let followed = weight(lost, trial.whole());
        for r in trial.tracked()..linear.len() {
            rows.row_mut(r).scale_mut((self.outcome_weight / followed).sqrt());
        }
        followed * squared(&rows)
    }
}

/// `AᵀA`, whose half below the diagonal is that above it.
fn squared(a: &DMatrix<f64>) -> DMatrix<f64> {
    let mut made = DMatrix::zeros(a.ncols(), a.ncols());
    for j in 0..a.ncols() {
        for i in 0..=j {
            made[(i, j)] = a.column(i).dot(&a.column(j));
            made[(j, i)] = made[(i, j)];
        }
    }
    made
}
