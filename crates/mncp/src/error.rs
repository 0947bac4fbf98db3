/// Input that no solve can start from. Not converging is a [`Status`](crate::Status), not an error.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// `z` does not have `n_e + n_c` entries.
    #[error("the point has {found} entries, the solver was made for {expected}")]
    PointLength {
        /// `n_e + n_c` of the solver.
        expected: usize,
        /// The length of `z`.
        found: usize,
    },
    /// The problem's `(n_e, n_c)` are not those of the solver.
    #[error("the problem has (equalities, pairs) = {found:?}, the solver was made for {expected:?}")]
    ProblemDimensions {
        /// `(n_e, n_c)` of the solver.
        expected: (usize, usize),
        /// `(n_e, n_c)` of the problem.
        found: (usize, usize),
    },
    /// `z` holds a NaN or an infinity.
    #[error("entry {index} of the start is {value}")]
    NonFiniteStart {
        /// The first such entry.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A setting is out of its range.
    #[error("setting `{name}` = {value} has to be {range}")]
    Setting {
        /// The field of [`Settings`](crate::Settings).
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range that it has to be in.
        range: &'static str,
    },
}
