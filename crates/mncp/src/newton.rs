use std::mem::swap;

use crate::direction::Directions;
use crate::line_search::{LineSearch, Outcome};
use crate::linearisation::Linearisation;
use crate::merit::{Point, norm};
use crate::{Direction, Error, Iteration, Problem, Settings, Solution, Statistics, Status};

/// Semismooth Newton method for problems of one size, with all storage that a solve needs.
///
/// [`Solver::solve`] allocates nothing. The product kernels that faer uses from 33 unknowns on hold a buffer for each
/// thread, which [`Solver::new`] makes for its own: such a solver, moved to another thread, allocates once in its first
/// solve there.
pub struct Solver {
    settings: Settings,
    equalities: usize,
    pairs: usize,
    current: Point,
    trial: Point,
    best: Vec<f64>,
    best_residual: f64,
    linearisation: Linearisation,
    directions: Directions,
    line_search: LineSearch,
    statistics: Statistics,
}

impl Solver {
    /// Storage for `n_e` equalities and `n_c` pairs.
    pub fn new(equalities: usize, pairs: usize, settings: Settings) -> Result<Self, Error> {
        settings.validate()?;
        let point = Point::new(equalities, pairs);
        Ok(Self {
            equalities,
            pairs,
            current: point.clone(),
            trial: point,
            best: vec![0.0; equalities + pairs],
            best_residual: f64::NAN,
            linearisation: Linearisation::new(equalities, pairs),
            directions: Directions::new(equalities + pairs),
            line_search: LineSearch::new(settings.memory, settings.patience),
            statistics: Statistics::with_capacity(2 * settings.max_iterations),
            settings,
        })
    }

    /// Solves `0 = g(u, v)`, `0 <= v ⟂ f(u, v) >= 0` from `z = [u; v]`, and leaves there the point with the lowest natural
    /// residual `max(|g|_∞, |min(v, f)|_∞)` that was met, whatever the status. Entries of `v` may be negative by up to
    /// that residual.
    pub fn solve(&mut self, problem: &impl Problem, z: &mut [f64]) -> Result<Solution, Error> {
        self.check(problem, z)?;
        self.begin(problem, z, 0.0);
        self.best.copy_from_slice(z);
        self.best_residual = self.current.residual;
        self.statistics.restart(self.best_residual);

        let mut status = self.attempt(problem, 0.0);
        if !status.is_solved() && self.settings.smoothing {
            self.begin(problem, z, self.settings.smoothing_start);
            status = self.attempt(problem, self.settings.smoothing_start);
        }

        z.copy_from_slice(&self.best);
        Ok(Solution { status, residual: self.best_residual, iterations: self.statistics.iterations().len() })
    }

    /// The steps of the last solve.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The constants that this solver was made with.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Damped Newton steps on `Φ_ε(z) = 0` (De Luca, Facchinei, Kanzow 1996). Where `ε > 0` it falls, to
    /// zero in the end, as soon as `|Φ_ε| <= ε`: `φ_ε ≈ (ab - ε)/a` where `b << a`, so that a looser test would leave the
    /// path `ab = ε`.
    fn attempt(&mut self, problem: &impl Problem, mut smoothing: f64) -> Status {
        for _ in 0..self.settings.max_iterations {
            if !self.current.is_finite() {
                return Status::NotFinite;
            }
            if self.is_solved() {
                return Status::Solved;
            }
            while smoothing > 0.0 && norm(&self.current.phi) <= smoothing {
                smoothing = self.reduce(smoothing);
            }
            self.linearisation.evaluate(problem, &self.current, smoothing);
            if !self.linearisation.is_finite() {
                return Status::NotFinite;
            }
            match self.step(problem, smoothing) {
                Outcome::Accepted(_) if self.line_search.is_advancing() => {}
                _ if smoothing > 0.0 => smoothing = self.reduce(smoothing),
                Outcome::NotFinite => return Status::NotFinite,
                _ => return if self.is_solved() { Status::Solved } else { Status::Stalled },
            }
        }
        if self.is_solved() { Status::Solved } else { Status::MaxIterations }
    }

    /// Moves to the start and forgets the merits before it.
    fn begin(&mut self, problem: &impl Problem, start: &[f64], smoothing: f64) {
        self.current.z.copy_from_slice(start);
        self.current.evaluate(problem, smoothing);
        self.line_search.restart(self.current.merit);
    }

    fn is_solved(&self) -> bool {
        self.current.residual <= self.settings.tolerance
    }

    /// One step along the first kind of direction on which the line search finds one.
    fn step(&mut self, problem: &impl Problem, smoothing: f64) -> Outcome {
        let flat = self.settings.stationarity * self.linearisation.norm * norm(&self.current.phi);
        let mut outcome = Outcome::Rejected;
        if norm(&self.linearisation.gradient) <= flat {
            return outcome;
        }
        for kind in Direction::ALL {
            let found = self.directions.find(kind, &self.linearisation, &self.current, &self.settings);
            let Some(slope) = found else { continue };
            let along = (kind, self.directions.vector.as_slice(), slope);
            let (current, trial) = (&self.current, &mut self.trial);
            outcome = self.line_search.search(problem, &self.settings, along, current, smoothing, trial);
            if let Outcome::Accepted(step) = outcome {
                self.accept(Iteration {
                    residual: self.trial.residual,
                    merit: self.trial.merit,
                    step,
                    direction: kind,
                    smoothing,
                });
                break;
            }
        }
        outcome
    }

    /// Moves to the trial point.
    fn accept(&mut self, iteration: Iteration) {
        swap(&mut self.current, &mut self.trial);
        self.line_search.push(iteration.merit);
        self.statistics.record(iteration);
        if self.current.residual < self.best_residual {
            self.best.copy_from_slice(&self.current.z);
            self.best_residual = self.current.residual;
        }
    }

    /// The next `ε`, with the merits measured anew.
    fn reduce(&mut self, smoothing: f64) -> f64 {
        let next = smoothing * self.settings.smoothing_reduction;
        let next = if next < self.settings.smoothing_end { 0.0 } else { next };
        self.current.measure(next);
        self.line_search.restart(self.current.merit);
        next
    }

    fn check(&self, problem: &impl Problem, z: &[f64]) -> Result<(), Error> {
        let (expected, found) = ((self.equalities, self.pairs), (problem.equalities(), problem.pairs()));
        if expected != found {
            return Err(Error::ProblemDimensions { expected, found });
        }
        let (expected, found) = (self.equalities + self.pairs, z.len());
        if expected != found {
            return Err(Error::PointLength { expected, found });
        }
        match z.iter().position(|x| !x.is_finite()) {
            Some(index) => Err(Error::NonFiniteStart { index, value: z[index] }),
            None => Ok(()),
        }
    }
}
