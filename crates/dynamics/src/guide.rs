//! A guide: where a point of a body was seen along `y`, to which a run is drawn.
//!
//! ```text
//! y ← y + (1 - e^(-γ (t_k - t_(k-1)))) (ŷ_k - y - (R c)_y)      at each time t_k at which it was seen
//! ```
//!
//! with the body-fixed place `c` of what was seen, and what the run has there linear over the step. This is Newtonian
//! relaxation, or nudging (Hoke and Anthes 1976, Mon. Weather Rev. 104, 1551), once a frame. It is no physics: with a model
//! that is right it moves nothing but by the noise of `ŷ`, and one that is wrong it keeps from losing the data's phase, so
//! that what the model lacks can be found (Abarbanel and others 2009, SIAM J. Appl. Dyn. Syst. 8, 1341). Between frames,
//! and where they are lost, a body goes its own way.

use crate::error::{Invalid, finite, positive};
use crate::rotation::matrix;
use crate::{State, Vec3};
use std::sync::Arc;

/// Places along `y` over time, and how fast a body is drawn to them.
#[derive(Debug, Clone)]
pub struct Guide {
    times: Arc<[f64]>,
    places: Arc<[f64]>,
    point: Vec3,
    rate: f64,
}

impl Guide {
    /// A guide through `places` (m) at increasing `times` (s), with `γ = rate` (1/s).
    ///
    /// `point` is the body-fixed place of what was seen, from the centre of mass, m.
    pub fn new(times: &[f64], places: &[f64], point: Vec3, rate: f64) -> Result<Self, Invalid> {
        positive("rate_per_s", rate)?;
        for axis in point.iter() {
            finite("point_m", *axis)?;
        }
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
        Ok(Self { times: times.into(), places: places.into(), point, rate })
    }

    /// Where the point is along `y`, m.
    #[inline]
    pub fn seen(&self, state: &State) -> f64 {
        state.position.y + (matrix(&state.orientation) * self.point).y
    }

    /// By how much a body is moved after a step in which its point went from `before` to `after`, m.
    ///
    /// The step is given by its times. Of several frames in one step the last counts.
    #[inline]
    pub fn shift(&self, [before, after]: [f64; 2], [start, end]: [f64; 2]) -> f64 {
        let next = self.times.partition_point(|time| *time <= end);
        // What has been seen once only has not been seen for any time.
        if next < 2 || self.times[next - 1] <= start {
            return 0.0;
        }
        let row = next - 1;
        let there = after - (end - self.times[row]) / (end - start) * (after - before);
        -(-self.rate * (self.times[row] - self.times[row - 1])).exp_m1() * (self.places[row] - there)
    }
}
