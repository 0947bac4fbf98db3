//! What is refused.

use thiserror::Error;

/// Sizes that do not belong together, or a path that cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SensingError {
    /// A number of rows.
    #[error("{what} has {found} rows, expected {expected}")]
    Rows {
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A path of a single pose, or of none.
    #[error("a path has {found} poses, expected at least 2")]
    Poses {
        /// How many there are.
        found: usize,
    },
    /// Poses that are not apart in time.
    #[error("the poses of a path are {found} s apart, expected more than 0")]
    Interval {
        /// s.
        found: f64,
    },
}
