use crate::merit::Point;
use crate::{Direction, Problem, Settings};

/// What came of a search along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outcome {
    /// The step length; the point is in `trial`.
    Accepted(f64),
    /// No step lowers the merit enough.
    Rejected,
    /// `g` or `f` was not finite at any step.
    NotFinite,
}

/// Part of `Ψ` that `patience` steps have to take off for an attempt to go on.
const ADVANCE: f64 = 0.1;

/// The last merits, the highest of which is the reference of the nonmonotone rule.
#[derive(Clone, Debug)]
pub(crate) struct LineSearch {
    merits: Vec<f64>,
    next: usize,
    /// The last merit that was an advance on the one before, and the steps since.
    mark: f64,
    steps_since: usize,
    patience: usize,
}

impl LineSearch {
    pub fn new(memory: usize, patience: usize) -> Self {
        Self { merits: vec![f64::NEG_INFINITY; memory], next: 0, mark: f64::INFINITY, steps_since: 0, patience }
    }

    /// Forgets all merits but this.
    pub fn restart(&mut self, merit: f64) {
        self.merits.fill(f64::NEG_INFINITY);
        self.mark = f64::INFINITY;
        self.push(merit);
    }

    /// Remembers the merit of an accepted point.
    pub fn push(&mut self, merit: f64) {
        self.merits[self.next] = merit;
        self.next = (self.next + 1) % self.merits.len();
        self.steps_since += 1;
        if merit <= (1.0 - ADVANCE) * self.mark {
            (self.mark, self.steps_since) = (merit, 0);
        }
    }

    /// Whether the merit has fallen by a tenth within the last `patience` steps.
    pub fn is_advancing(&self) -> bool {
        self.steps_since < self.patience
    }

    /// The longest `t = 1, β, β², ...` with
    ///
    /// ```text
    /// Ψ(z + t d) <= max_{last m} Ψ + σ t ∇Ψᵀd
    /// ```
    ///
    /// (Grippo, Lampariello, Lucidi, *A nonmonotone line search technique for Newton's method*, SIAM J. Numer. Anal. 23,
    /// 1986), or at which the natural residual meets the tolerance, where rounding can hide the decrease of `Ψ`. The
    /// search ends where `t ∇Ψᵀd` is below the rounding of `Ψ`, since what it would find there is noise.
    pub fn search(
        &self,
        problem: &impl Problem,
        settings: &Settings,
        along: (Direction, &[f64], f64),
        current: &Point,
        smoothing: f64,
        trial: &mut Point,
    ) -> Outcome {
        let (kind, direction, slope) = along;
        let shortest = if kind == Direction::Gradient { settings.min_gradient_step } else { settings.min_step };
        let reference = self.merits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut finite = false;
        let mut step = 1.0;
        while step >= shortest && step * slope < -f64::EPSILON * current.merit {
            for ((x, z), d) in trial.z.iter_mut().zip(&current.z).zip(direction) {
                *x = z + step * d;
            }
            trial.evaluate(problem, smoothing);
            finite |= trial.is_finite();
            let lower = trial.merit <= reference + settings.armijo * step * slope;
            if trial.is_finite() && (lower || trial.residual <= settings.tolerance) {
                return Outcome::Accepted(step);
            }
            step *= settings.backtracking;
        }
        if finite { Outcome::Rejected } else { Outcome::NotFinite }
    }
}
