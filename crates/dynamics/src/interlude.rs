//! Interludes: times in which another trial takes over from the one that runs.
//!
//! A cause may act in a part of a run alone: in a place, in a part of the field's cycle, from a moment on. Within an interlude a
//! step is one of the other trial, with its field, substrate, surroundings, slope, mass and moment; the body's shape, the relief
//! and the state go on as they are.

use crate::Trial;
use crate::error::{Invalid, finite};
use std::sync::Arc;

/// Another trial, and when it is at work.
#[derive(Debug, Clone)]
pub struct Interlude {
    other: Box<Trial>,
    edges: Arc<[f64]>,
}

impl Interlude {
    /// The trial `other` from the first of the increasing `edges` (s) to the second, from the third to the fourth, and so on;
    /// after the last to the end where their number is odd.
    pub fn new(other: Trial, edges: &[f64]) -> Result<Self, Invalid> {
        for (row, time) in edges.iter().enumerate() {
            finite("edges_s", *time)?;
            if row > 0 && *time <= edges[row - 1] {
                return Err(Invalid::EdgeOrder { row: row + 1, found: *time, before: edges[row - 1] });
            }
        }
        Ok(Self { other: Box::new(other), edges: edges.into() })
    }

    /// The other trial.
    pub fn other(&self) -> &Trial {
        &self.other
    }

    /// Whether it is at work in the step that begins at `time`.
    #[inline]
    pub fn holds(&self, time: f64) -> bool {
        self.edges.partition_point(|edge| *edge <= time) % 2 == 1
    }
}
