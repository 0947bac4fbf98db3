//! What is refused.

use thiserror::Error;

/// Sizes that do not belong together, or a path that cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SensingError {
    /// How many of something there are.
    #[error("{what}: {found} found, {expected} expected")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A bound or a standard deviation.
    #[error("{what} is {found}, which is refused")]
    Number {
        /// Which.
        what: &'static str,
        /// Its value.
        found: f64,
    },
    /// Numbers that are not finite: precisions make the equations definite otherwise.
    #[error("the normal equations of the nuisances of trial {trial} have no solution")]
    Singular {
        /// Its place.
        trial: usize,
    },
    /// The same of what all trials share.
    #[error("the normal equations of what all trials share have no solution")]
    SharedSingular,
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

impl SensingError {
    /// An error unless there are as many as expected.
    pub(crate) fn same(what: &'static str, found: usize, expected: usize) -> Result<(), Self> {
        if found == expected { Ok(()) } else { Err(Self::Count { what, found, expected }) }
    }
}
