//! The channels of a track: what each reads from a pose, and how that moves with the sensor's nuisances.

use crate::Pose;
use nalgebra::UnitQuaternion;

/// A component of the rotation from model to measurement, about a body axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Angle {
    /// About `x`.
    Tilt,
    /// About `y`.
    Twist,
    /// About `z`.
    Heading,
}

/// What was measured of a frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Channel {
    /// A coordinate of the place, 0 to 2, m.
    Place(usize, Vec<f64>),
    /// The angle of the long axis above the substrate.
    Tilt(Vec<f64>),
    /// The angle of the long axis's projection from `+y` towards `-x`, and after how much it comes back to itself: a whole
    /// turn of an end, half of one of an axis without ends.
    Heading(f64, Vec<f64>),
    /// A part of the whole orientation.
    Turn(Angle, Vec<UnitQuaternion<f64>>),
}

impl Channel {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        match self {
            Channel::Place(_, values) | Channel::Tilt(values) | Channel::Heading(_, values) => values.len(),
            Channel::Turn(_, values) => values.len(),
        }
    }

    /// `measured - model` in a frame, for a pose as the sensor sees it.
    #[inline]
    pub fn wrong(&self, frame: usize, seen: &Pose) -> f64 {
        match self {
            Channel::Place(k, values) => values[frame] - seen.position[*k],
            Channel::Tilt(values) => values[frame] - seen.tilt(),
            Channel::Heading(turn, values) => {
                let wrong = values[frame] - seen.heading();
                // The projection of an axis that stands upright points nowhere.
                (wrong - turn * (wrong / turn).round_ties_even()) * seen.tilt().cos()
            }
            Channel::Turn(angle, values) => seen.turn_to(&values[frame])[*angle as usize],
        }
    }

    /// The derivatives of `wrong` by the origin `(x, y, z)`, the camera's heading and its scale, for a pose of the model.
    #[inline]
    pub fn by_sensor(&self, pose: &Pose) -> [f64; 5] {
        let (x, y) = (pose.position.x, pose.position.y);
        match self {
            Channel::Place(0, _) => [-1.0, 0.0, 0.0, y, -x],
            Channel::Place(1, _) => [0.0, -1.0, 0.0, -x, -y],
            Channel::Place(..) => [0.0, 0.0, -1.0, 0.0, 0.0],
            Channel::Tilt(_) => [0.0; 5],
            Channel::Heading(..) => [0.0, 0.0, 0.0, -pose.tilt().cos(), 0.0],
            Channel::Turn(angle, _) => [0.0, 0.0, 0.0, -pose.upward()[*angle as usize], 0.0],
        }
    }
}
