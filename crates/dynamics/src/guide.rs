//! A guide: where a body was seen along `y`, to which a run is drawn.
//!
//! ```text
//! y ← y + (1 - e^(-γh)) (ŷ(t) - y)      after each step, ŷ linear between the rows
//! ```
//!
//! This is Newtonian relaxation, or nudging (Hoke and Anthes 1976, Mon. Weather Rev. 104, 1551). It is no physics: with a
//! model that is right it moves nothing but by the noise of `ŷ`, and one that is wrong it keeps from losing the data's
//! phase, so that what the model lacks can be found (Abarbanel and others 2009, SIAM J. Appl. Dyn. Syst. 8, 1341).

use crate::error::{Invalid, finite, positive};
use std::sync::Arc;

/// Places along `y` over time, and how fast a body is drawn to them.
#[derive(Debug, Clone)]
pub struct Guide {
    times: Arc<[f64]>,
    places: Arc<[f64]>,
    rate: f64,
}

impl Guide {
    /// A guide through `places` (m) at increasing `times` (s), with `γ = rate` (1/s).
    pub fn new(times: &[f64], places: &[f64], rate: f64) -> Result<Self, Invalid> {
        positive("rate_per_s", rate)?;
        if times.is_empty() {
            return Err(Invalid::NoGuide);
        }
        if places.len() != times.len() {
            return Err(Invalid::Lengths { name: "y_m", found: places.len(), expected: times.len() });
        }
        for (row, (time, place)) in times.iter().zip(places).enumerate() {
            finite("time_s", *time)?;
            finite("y_m", *place)?;
            if row > 0 && *time <= times[row - 1] {
                return Err(Invalid::GuideOrder { row: row + 1, found: *time, before: times[row - 1] });
            }
        }
        Ok(Self { times: times.into(), places: places.into(), rate })
    }

    /// `ŷ(t)`, m; the ends are held.
    #[inline]
    pub fn at(&self, t: f64) -> f64 {
        let next = self.times.partition_point(|time| *time <= t);
        if next == 0 || next == self.times.len() {
            return self.places[next.saturating_sub(1)];
        }
        let share = (t - self.times[next - 1]) / (self.times[next] - self.times[next - 1]);
        self.places[next - 1] + share * (self.places[next] - self.places[next - 1])
    }

    /// By how much a body at `y` is moved at the time `t`, after a step of `h`, m.
    #[inline]
    pub fn shift(&self, y: f64, t: f64, h: f64) -> f64 {
        -(-self.rate * h).exp_m1() * (self.at(t) - y)
    }
}
