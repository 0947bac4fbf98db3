//! Runs of all trials against what was measured in them.

use crate::nuisances::Problem;
use crate::{Camera, Measured, Nuisances, Seen, SensingError, Tolerances};
use rayon::prelude::*;

/// How wrong one run of all trials is.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// At their best.
    pub nuisances: Nuisances,
    /// By trial the whitened differences, none where it was not run.
    pub wrong: Vec<Option<Vec<f64>>>,
}

/// Compares some runs of all trials with what was measured in them, over the threads of the pool that it is called in.
///
/// What all trials share is fitted from those of `train`, an outcome having the weight of `outcome_weight` numbers of a
/// track; the nominal numbers are held where `held` says how far they are off, and nothing is fitted where `fit` is false.
pub fn compare(
    trials: &[&Measured],
    runs: &[Vec<Seen>],
    tolerances: &Tolerances,
    train: &[bool],
    outcome_weight: f64,
    held: Option<&[f64]>,
    fit: bool,
) -> Result<Vec<Compared>, SensingError> {
    let count = tolerances.shared_sigmas.len();
    tolerances.check(trials.len())?;
    if !(outcome_weight > 0.0 && outcome_weight.is_finite()) {
        return Err(SensingError::Number { what: "the weight of an outcome", found: outcome_weight });
    }
    SensingError::same("train", train.len(), trials.len())?;
    SensingError::same("held", held.map_or(count, |off| off.len() + Camera::COUNT), count)?;
    for trial in trials {
        SensingError::same("what a trial shares", trial.shared() + Camera::COUNT, count)?;
    }
    for run in runs {
        SensingError::same("a run", run.len(), trials.len())?;
        for (seen, trial) in run.iter().zip(trials).filter(|(seen, _)| seen.path.is_some()) {
            SensingError::same("outcomes", seen.outcomes.len(), trial.outcomes())?;
        }
    }
    runs.par_iter()
        .map(|run| {
            let problem = Problem { trials, run, tolerances, train, outcome_weight, held: held.is_some() };
            let start = Nuisances::perfect(trials.len(), count, held);
            let nuisances = if fit { problem.fitted(start)? } else { start };
            let wrong = problem.each(|i, trial, path| {
                Ok(trial.whitened(path, &run[i].outcomes, &nuisances.local[i], &nuisances.shared))
            })?;
            Ok(Compared { nuisances, wrong })
        })
        .collect()
}
