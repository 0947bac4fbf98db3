//! A guide: where a point of a body was seen along `y`, to which a run is drawn.
//!
//! ```text
//! y ← y + (1 - e^(-γh)) (ŷ(t) - y - (R c)_y)      after each step, ŷ linear between the rows
//! ```
//!
//! with the body-fixed place `c` of what was seen. This is Newtonian relaxation, or nudging (Hoke and Anthes 1976, Mon.
//! Weather Rev. 104, 1551). It is no physics: with a model that is right it moves nothing but by the noise of `ŷ`, and one
//! that is wrong it keeps from losing the data's phase, so that what the model lacks can be found (Abarbanel and others
//! 2009, SIAM J. Appl. Dyn. Syst. 8, 1341). Where nothing was seen a body goes its own way.

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
    /// `point` is the body-fixed place of what was seen, from the centre of mass, m. A place is NaN where nothing was
    /// seen; between it and its neighbours nothing is drawn.
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
            if !place.is_nan() {
                finite("y_m", *place)?;
            }
            if row > 0 && *time <= times[row - 1] {
                return Err(Invalid::GuideOrder { row: row + 1, found: *time, before: times[row - 1] });
            }
        }
        Ok(Self { times: times.into(), places: places.into(), point, rate })
    }

    /// `ŷ(t)`, m; none before the first row, after the last, and beside one in which nothing was seen.
    #[inline]
    pub fn at(&self, t: f64) -> Option<f64> {
        let next = self.times.partition_point(|time| *time <= t);
        if next == 0 {
            return None;
        }
        let (before, y) = (self.times[next - 1], self.places[next - 1]);
        let place = if t == before {
            y
        } else if next == self.times.len() {
            return None;
        } else {
            y + (t - before) / (self.times[next] - before) * (self.places[next] - y)
        };
        place.is_finite().then_some(place)
    }

    /// By how much a body in `state` is moved at the time `t`, after a step of `h`, m.
    #[inline]
    pub fn shift(&self, state: &State, t: f64, h: f64) -> f64 {
        self.at(t).map_or(0.0, |place| {
            let seen = state.position.y + (matrix(&state.orientation) * self.point).y;
            -(-self.rate * h).exp_m1() * (place - seen)
        })
    }
}
