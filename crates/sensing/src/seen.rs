//! What a hypothesis says that a sensor should have seen.

use crate::Path;

/// What a hypothesis says of one trial.
#[derive(Debug, Clone)]
pub struct Seen<'a> {
    /// None where the model cannot be run.
    pub path: Option<Path<'a>>,
    /// Scaled differences of the outcomes, `[constant, by the camera's scale]` each.
    pub outcomes: Vec<[f64; 2]>,
}
