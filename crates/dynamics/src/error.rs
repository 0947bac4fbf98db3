//! What a trial refuses.

use thiserror::Error;

/// A quantity that a trial cannot be built from.
#[allow(missing_docs)] // the messages say what each is
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Invalid {
    #[error("{name} is {found}, expected a finite number")]
    NotFinite { name: &'static str, found: f64 },
    #[error("{name} is {found}, expected a number greater than 0")]
    NotPositive { name: &'static str, found: f64 },
    #[error("{name} is {found}, expected 0 or more")]
    Negative { name: &'static str, found: f64 },
    #[error("{name} has length {found}, expected a direction that is not zero")]
    NoDirection { name: &'static str, found: f64 },
    #[error("rotation_axis and initial_direction have cosine {found}, expected them at right angles")]
    NotOrthogonal { found: f64 },
    #[error("step_s is {step}, expected less than {bound} s: start_of_step is unstable beyond it")]
    Unstable { step: f64, bound: f64 },
    #[error("the run of {duration:e} s has {found:e} steps, expected at most {limit:e}")]
    TooManySteps { duration: f64, found: f64, limit: f64 },
    #[error("row {row} of the field's table is at {found} s, expected a time after {before} s")]
    TableOrder { row: usize, found: f64, before: f64 },
    #[error("the field's table covers {first} s to {last} s, expected it to cover 0 s to {needed} s")]
    TableSpan { first: f64, last: f64, needed: f64 },
    #[error("the field's table has {found} rows, expected at least {expected}")]
    TableLength { found: usize, expected: usize },
    #[error("row {row} of wrench_time_s is at {found} s, expected a time after {before} s")]
    WrenchOrder { row: usize, found: f64, before: f64 },
    #[error("row {row} of the guide is at {found} s, expected a time after {before} s")]
    GuideOrder { row: usize, found: f64, before: f64 },
    #[error("row {row} of edges_s is at {found} s, expected a time after {before} s")]
    EdgeOrder { row: usize, found: f64, before: f64 },
    #[error("the other trial has another {what}, expected the same")]
    OtherTrial { what: &'static str },
    #[error("the other trial has a guide or an interlude of its own, expected neither")]
    NotAlone,
    #[error("the guide has no row, expected at least 1")]
    NoGuide,
    #[error("{name} has {found} entries, expected {expected}")]
    Lengths { name: &'static str, found: usize, expected: usize },
    #[error("time_s is {found}, expected a multiple of step_s {step}")]
    NotAStep { found: f64, step: f64 },
    #[error("position_m puts the body {depth} m into the substrate, expected it on or above the substrate")]
    Buried { depth: f64 },
}

/// A run whose state has left the finite numbers.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("the state is not finite any more at {time} s: the motion diverged")]
pub struct Diverged {
    /// s.
    pub time: f64,
}

/// The finite `value` named `name`, or why it is refused.
pub fn finite(name: &'static str, value: f64) -> Result<f64, Invalid> {
    if value.is_finite() { Ok(value) } else { Err(Invalid::NotFinite { name, found: value }) }
}

/// The finite `value > 0` named `name`, or why it is refused.
pub fn positive(name: &'static str, value: f64) -> Result<f64, Invalid> {
    let value = finite(name, value)?;
    if value > 0.0 { Ok(value) } else { Err(Invalid::NotPositive { name, found: value }) }
}

/// The finite `value >= 0` named `name`, or why it is refused.
pub fn not_negative(name: &'static str, value: f64) -> Result<f64, Invalid> {
    let value = finite(name, value)?;
    if value >= 0.0 { Ok(value) } else { Err(Invalid::Negative { name, found: value }) }
}

/// The finite vector named `name` at length one, or why it is refused.
pub fn direction(name: &'static str, value: crate::Vec3) -> Result<crate::Vec3, Invalid> {
    for component in value.iter() {
        finite(name, *component)?;
    }
    let length = value.norm();
    if length > 0.0 && length.is_finite() {
        Ok(value / length)
    } else {
        Err(Invalid::NoDirection { name, found: length })
    }
}
