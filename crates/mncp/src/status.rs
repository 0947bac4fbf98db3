use std::fmt;

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    /// `max(|g|_∞, |min(v, f)|_∞) <= tolerance`.
    Solved,
    /// The iterations ran out.
    MaxIterations,
    /// No direction lowers the merit function `Ψ = ½|Φ|²` any more: a stationary point of `Ψ` that is no solution, or
    /// a tolerance below what rounding permits.
    Stalled,
    /// `g`, `f` or their Jacobian is NaN or infinite where the solver cannot step around it.
    NotFinite,
}

impl Status {
    /// Whether the natural residual came below the tolerance.
    pub fn is_solved(self) -> bool {
        self == Status::Solved
    }
}

impl fmt::Display for Status {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Status::Solved => "solved",
            Status::MaxIterations => "maximum number of iterations reached",
            Status::Stalled => "stalled at a point where the merit function cannot be lowered",
            Status::NotFinite => "the problem's functions are not finite",
        })
    }
}
