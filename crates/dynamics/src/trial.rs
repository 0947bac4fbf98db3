//! One trial: a robot on a substrate in a field, for a time.

use crate::contact::downward;
use crate::error::{Invalid, finite, not_negative, positive};
use crate::rotation::matrix;
use crate::{Field, MagneticTorque, Model, Robot, State, Substrate, Vec3};
use geometry::Support;
use nalgebra::Quaternion;

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
    /// `φ`, rad.
    pub incline: f64,
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
    load: Vec3,
    steps: u64,
}

impl Trial {
    /// A trial of `parts`, or the first thing about them that is refused.
    pub fn new(parts: TrialParts) -> Result<Self, Invalid> {
        parts.substrate.checked()?;
        finite("incline_deg", parts.incline)?;
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
        // F_ext = m g (0, -sin φ, -cos φ) - F_elect n
        let weight = parts.robot.mass() * parts.gravity;
        let (sin, cos) = parts.incline.sin_cos();
        let load = Vec3::new(0.0, -weight * sin, -weight * cos - parts.substrate.electrostatic_force);
        Ok(Self { parts, initial, support, load, steps: found as u64 })
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

    /// `F_ext`, N.
    pub fn load(&self) -> Vec3 {
        self.load
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
