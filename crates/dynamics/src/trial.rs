//! One trial: a robot on a substrate in a field, for a time.

use crate::contact::downward;
use crate::error::{Invalid, finite, not_negative, positive};
use crate::rotation::matrix;
use crate::{
    Field, Guide, Interlude, MagneticTorque, Mat3, Model, Relief, Robot, State, Substrate, Surroundings, Vec3,
};
use geometry::Support;
use nalgebra::Quaternion;
use std::sync::Arc;

/// Over `ℓ`: how close to the plane counts as touching at the start, and how deep as rounding.
const AT_REST: f64 = 1e-9;
/// A run longer than this is a slip of the pen.
const MOST_STEPS: f64 = 1e9;

/// What a trial is made of.
#[derive(Debug, Clone)]
pub struct TrialParts {
    /// What moves.
    pub robot: Robot,
    /// What it moves on.
    pub substrate: Substrate,
    /// What moves it.
    pub field: Field,
    /// The choices that the paper leaves open.
    pub model: Model,
    /// The substrate's heights.
    pub relief: Relief,
    /// What else acts on it.
    pub surroundings: Surroundings,
    /// `φ`, the slope along `y`, rad.
    pub incline: f64,
    /// `σ`, the slope along `x`, rad.
    pub side_incline: f64,
    /// `g`, m/s².
    pub gravity: f64,
    /// s.
    pub duration: f64,
    /// `h`, s.
    pub step: f64,
    /// Centre of mass at the start, m; without one the body rests on the substrate.
    pub position: Option<Vec3>,
    /// Body to substrate.
    pub orientation: Quaternion<f64>,
    /// `v` at the start, m/s.
    pub linear: Vec3,
    /// `ω` at the start, rad/s.
    pub angular: Vec3,
}

/// A trial whose every number has been checked.
#[derive(Debug, Clone)]
pub struct Trial {
    parts: TrialParts,
    initial: State,
    support: Support,
    weight: Vec3,
    steps: u64,
    guide: Option<Guide>,
    interlude: Option<Interlude>,
}

impl Trial {
    /// A trial of `parts`, or the first thing about them that is refused.
    pub fn new(parts: TrialParts) -> Result<Self, Invalid> {
        parts.substrate.checked()?;
        parts.surroundings.check()?;
        finite("incline_deg", parts.incline)?;
        finite("side_incline_deg", parts.side_incline)?;
        not_negative("gravity_m_per_s2", parts.gravity)?;
        positive("duration_s", parts.duration)?;
        positive("step_s", parts.step)?;
        for component in parts.linear.iter().chain(parts.angular.iter()) {
            finite("initial velocity", *component)?;
        }
        let q = parts.orientation;
        for component in q.coords.iter() {
            finite("orientation", *component)?;
        }
        positive("length of orientation", q.norm())?;

        // The run covers its duration in whole steps; a rounding beyond the end is not another step.
        let found = (parts.duration / parts.step - 1e-9).ceil().max(1.0);
        if found > MOST_STEPS {
            return Err(Invalid::TooManySteps { duration: parts.duration, found, limit: MOST_STEPS });
        }
        parts.field.covers(parts.duration)?;
        if parts.model.magnetic_torque == MagneticTorque::StartOfStep {
            let bound = parts.robot.stability_bound(parts.field.greatest_strength());
            if parts.step >= bound {
                return Err(Invalid::Unstable { step: parts.step, bound });
            }
        }

        let orientation = q / q.norm();
        let body = parts.robot.body();
        let rotation = matrix(&orientation);
        let down = downward(&rotation);
        let lowest = (rotation * body.lowest(&down).1).z;
        let position = match parts.position {
            None => Vec3::new(0.0, 0.0, -lowest),
            Some(position) => {
                for component in position.iter() {
                    finite("position_m", *component)?;
                }
                let depth = -(position.z + lowest);
                if depth > AT_REST * body.size() {
                    return Err(Invalid::Buried { depth });
                }
                position
            }
        };
        let touches = position.z + lowest <= AT_REST * body.size();
        let support = if touches { body.touching(&down, AT_REST * body.size()) } else { Support::None };
        let initial = State { position, orientation, linear: parts.linear, angular: parts.angular };
        // m g (-sin σ, -sin φ cos σ, -cos φ cos σ)
        let weight = parts.robot.mass() * parts.gravity;
        let (sin, cos) = parts.incline.sin_cos();
        let (side_sin, side_cos) = parts.side_incline.sin_cos();
        // 0 - 0 is +0, and so is the force along x on a substrate that does not lean.
        let weight = Vec3::new(0.0 - weight * side_sin, -weight * sin * side_cos, -weight * cos * side_cos);
        Ok(Self { parts, initial, support, weight, steps: found as u64, guide: None, interlude: None })
    }

    /// The same trial, drawn to a guide.
    pub fn guided(self, guide: Guide) -> Self {
        Self { guide: Some(guide), ..self }
    }

    /// What the run is drawn to.
    #[inline]
    pub fn guide(&self) -> Option<&Guide> {
        self.guide.as_ref()
    }

    /// The same trial, from which another takes over at times: one of the same body on the same relief in the same step, that
    /// is on its own.
    pub fn with_interlude(self, interlude: Interlude) -> Result<Self, Invalid> {
        let other = interlude.other();
        if !Arc::ptr_eq(self.robot().shared_body(), other.robot().shared_body()) {
            return Err(Invalid::OtherTrial { what: "body" });
        }
        if other.step() != self.step() {
            return Err(Invalid::OtherTrial { what: "step_s" });
        }
        // The state on a relief is in the frame of its tangent plane.
        if other.relief() != self.relief() {
            return Err(Invalid::OtherTrial { what: "relief" });
        }
        if other.interlude.is_some() || other.guide.is_some() {
            return Err(Invalid::NotAlone);
        }
        other.field().covers(self.parts.duration)?;
        Ok(Self { interlude: Some(interlude), ..self })
    }

    /// The trial that is at work in the step that begins at `time`.
    #[inline]
    pub fn at(&self, time: f64) -> &Trial {
        match &self.interlude {
            Some(interlude) if interlude.holds(time) => interlude.other(),
            _ => self,
        }
    }

    /// What moves.
    pub fn robot(&self) -> &Robot {
        &self.parts.robot
    }

    /// What it moves on.
    pub fn substrate(&self) -> &Substrate {
        &self.parts.substrate
    }

    /// What moves it.
    pub fn field(&self) -> &Field {
        &self.parts.field
    }

    /// The choices that the paper leaves open.
    pub fn model(&self) -> Model {
        self.parts.model
    }

    /// `h`, s.
    pub fn step(&self) -> f64 {
        self.parts.step
    }

    /// How many steps the run has.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// How many steps have been done at `time`.
    pub fn steps_until(&self, time: f64) -> Result<u64, Invalid> {
        let h = self.parts.step;
        let done = (time / h).round();
        if done >= 0.0 && (done * h - time).abs() <= 1e-9 * h.max(time) {
            Ok(done as u64)
        } else {
            Err(Invalid::NotAStep { found: time, step: h })
        }
    }

    /// The substrate's heights.
    pub fn relief(&self) -> &Relief {
        &self.parts.relief
    }

    /// What else acts on the robot.
    pub fn surroundings(&self) -> &Surroundings {
        &self.parts.surroundings
    }

    /// The weight, turned by `tilt` where there is one, less `F_elect n`, N.
    #[inline]
    pub fn load(&self, tilt: Option<&Mat3>) -> Vec3 {
        let mut load = tilt.map_or(self.weight, |tilt| tilt * self.weight);
        load.z -= self.parts.substrate.electrostatic_force;
        load
    }

    /// Position (m) and orientation of `state` as they are seen from outside: on a relief the state is in the frame of the
    /// tangent plane.
    pub fn seen(&self, state: &State) -> (Vec3, Quaternion<f64>) {
        self.parts.relief.seen(state)
    }

    /// The state at the start.
    pub fn initial(&self) -> &State {
        &self.initial
    }

    /// What touches at the start.
    pub fn initial_support(&self) -> Support {
        self.support
    }
}
