//! Poses between the rows of a run.

use crate::{Pose, SensingError};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// How near to the last row the end of a path is read, in rows.
pub const END_ROWS: f64 = 1e-6;

/// The seen poses of one run at even times: place, then the unit quaternion `w, x, y, z`, of one sign along the path.
#[derive(Debug, Clone, Copy)]
pub struct Path<'a> {
    interval: f64,
    clock: f64,
    poses: &'a [[f64; 7]],
}

impl<'a> Path<'a> {
    /// A path whose rows are `interval` apart, and whose time is `clock` when the sensor's clock says 0.
    pub fn new(interval: f64, clock: f64, poses: &'a [[f64; 7]]) -> Result<Self, SensingError> {
        if poses.len() < 2 {
            return Err(SensingError::Poses { found: poses.len() });
        }
        if interval.is_nan() || interval <= 0.0 {
            return Err(SensingError::Interval { found: interval });
        }
        if !clock.is_finite() {
            return Err(SensingError::Number { what: "a path's clock", found: clock });
        }
        Ok(Self { interval, clock, poses })
    }

    /// The pose at a time of the sensor's clock, the ends held.
    #[inline]
    pub fn at(&self, time: f64) -> Pose {
        let place = ((time + self.clock) / self.interval).clamp(0.0, self.poses.len() as f64 - 1.0 - END_ROWS);
        let row = place as usize;
        let share = place - row as f64;
        let (before, after) = (self.poses[row], self.poses[row + 1]);
        let quaternion = |[_, _, _, w, x, y, z]: [f64; 7]| Quaternion::new(w, x, y, z);
        let place = |[x, y, z, ..]: [f64; 7]| Vector3::new(x, y, z);
        Pose {
            position: place(before).lerp(&place(after), share),
            orientation: UnitQuaternion::new_normalize(quaternion(before).lerp(&quaternion(after), share)),
        }
    }
}
