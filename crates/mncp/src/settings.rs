use crate::Error;

/// The solver's constants. [`Solver::new`](crate::Solver::new) checks their ranges.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Solved when `max(|g|_∞, |min(v, f)|_∞) <= tolerance`. `> 0`.
    pub tolerance: f64,
    /// Steps in each of the two attempts, the direct one and the smoothing restart. `1 ..= 1_000_000`.
    pub max_iterations: usize,
    /// `σ` of Armijo's rule `Ψ(z + td) <= Ψ_ref + σ t ∇Ψᵀd`. In `(0, ½)`.
    pub armijo: f64,
    /// `β` of the step lengths `t = 1, β, β², ...`. In `(0, 1)`.
    pub backtracking: f64,
    /// `Ψ_ref` is the highest merit of so many last iterates; 1 makes the search monotone. `1 ..= 1000`.
    pub memory: usize,
    /// An attempt stalls when so many steps have not lowered `Ψ` by a tenth. `>= 1`.
    pub patience: usize,
    /// The shortest step along a Newton or Levenberg–Marquardt direction before the next kind is tried. In `(0, 1]`.
    pub min_step: f64,
    /// The shortest step along the negative gradient before the attempt stalls. In `(0, 1]`.
    pub min_gradient_step: f64,
    /// `θ` of the descent test `∇Ψᵀd <= -θ |∇Ψ| |d|`. In `(0, 1)`.
    pub descent: f64,
    /// `c` of the Levenberg–Marquardt parameter `λ = c |Φ|`. `> 0`.
    pub levenberg_marquardt: f64,
    /// A point with `|HᵀΦ| <= stationarity |H| |Φ|` is stationary. In `[0, 1)`.
    pub stationarity: f64,
    /// Whether a failed attempt is followed by one on `φ_ε(a, b) = a + b - sqrt(a² + b² + 2ε)` with falling `ε`.
    pub smoothing: bool,
    /// The first `ε`. `> 0`.
    pub smoothing_start: f64,
    /// The factor from one `ε` to the next. In `(0, 1)`.
    pub smoothing_reduction: f64,
    /// Below this `ε` is set to zero. `> 0`.
    pub smoothing_end: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            max_iterations: 100,
            armijo: 1e-4,
            backtracking: 0.5,
            memory: 1,
            patience: 20,
            min_step: 1e-2,
            min_gradient_step: 1e-10,
            descent: 1e-12,
            levenberg_marquardt: 1e-1,
            stationarity: 1e-14,
            smoothing: true,
            smoothing_start: 1.0,
            smoothing_reduction: 0.1,
            smoothing_end: 1e-10,
        }
    }
}

impl Settings {
    /// Checks every constant against its range.
    pub fn validate(&self) -> Result<(), Error> {
        let inside_unit = |x: f64| x > 0.0 && x < 1.0;
        let step = |x: f64| x > 0.0 && x <= 1.0;
        let positive = |x: f64| x > 0.0 && x.is_finite();
        check("tolerance", self.tolerance, positive, "positive and finite")?;
        let count = |limit: f64| move |x: f64| (1.0..=limit).contains(&x);
        check("max_iterations", self.max_iterations as f64, count(1e6), "from 1 to 1000000")?;
        check("armijo", self.armijo, |x| x > 0.0 && x < 0.5, "between 0 and 1/2")?;
        check("backtracking", self.backtracking, inside_unit, "between 0 and 1")?;
        check("memory", self.memory as f64, count(1e3), "from 1 to 1000")?;
        check("patience", self.patience as f64, positive, "positive")?;
        check("min_step", self.min_step, step, "positive and at most 1")?;
        check("min_gradient_step", self.min_gradient_step, step, "positive and at most 1")?;
        check("descent", self.descent, inside_unit, "between 0 and 1")?;
        check("levenberg_marquardt", self.levenberg_marquardt, positive, "positive and finite")?;
        check("stationarity", self.stationarity, |x| (0.0..1.0).contains(&x), "at least 0 and below 1")?;
        check("smoothing_start", self.smoothing_start, positive, "positive and finite")?;
        check("smoothing_reduction", self.smoothing_reduction, inside_unit, "between 0 and 1")?;
        check("smoothing_end", self.smoothing_end, positive, "positive and finite")
    }
}

fn check(name: &'static str, value: f64, valid: impl Fn(f64) -> bool, range: &'static str) -> Result<(), Error> {
    if valid(value) { Ok(()) } else { Err(Error::Setting { name, value, range }) }
}
