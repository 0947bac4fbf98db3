//! A random trial: a body, its substrate, field, surroundings and start, from one seed.

use super::random::Random;
use super::shape::{self, KINDS};
use geometry::{Body, Surface};
use nalgebra::{Quaternion, UnitQuaternion};
use std::fmt;
use std::sync::Arc;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{
    AdhesionActsAt, AdhesionEnters, Field, MagneticTorque, Model, Relief, Robot, Substrate, Surroundings, Trial, Vec3,
};

/// Half the decades over which parameters go in a case: twelve in the wildest, next to none in the tamest.
const DECADES: [f64; 4] = [0.2, 1.0, 3.0, 6.0];
/// The least wild: what a robot may be like.
pub const TAME: usize = 0;

/// A trial and what it was drawn as.
pub struct Case {
    pub kind: &'static str,
    /// Index of its decades.
    pub wildness: usize,
    pub trial: Trial,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let trial = &self.trial;
        let (robot, body) = (trial.robot(), trial.robot().body());
        writeln!(f, "a {} over {} decades:", self.kind, 2.0 * DECADES[self.wildness])?;
        writeln!(f, "  generators {}, faces {}", body.generators().len(), body.faces().len())?;
        writeln!(
            f,
            "  size {:e} m, mass {:e} kg, moment {:?} A m2",
            body.size(),
            robot.mass(),
            robot.moment().as_slice()
        )?;
        writeln!(f, "  step {:e} s, {} steps, load {:?} N", trial.step(), trial.steps(), trial.load(None).as_slice())?;
        writeln!(f, "  {:?}\n  {:?}\n  {:?}", trial.model(), trial.substrate(), trial.field())?;
        writeln!(f, "  {:?}\n  {:?}", trial.relief(), trial.surroundings())?;
        write!(f, "  {:?} on {:?}", trial.initial(), trial.initial_support())
    }
}

impl Case {
    /// The case of a seed, with hulls of `most_points` points at most, or why its parts were refused.
    pub fn new(seed: u64, most_points: usize) -> Result<Self, String> {
        let mut random = Random::new(seed);
        let wildness = random.whole(0, DECADES.len() - 1);
        let kind = random.whole(0, KINDS.len() - 1);
        let mut draw = Draw { random: &mut random, decades: DECADES[wildness] };
        let trial = draw.trial(kind, most_points)?;
        Ok(Self { kind: KINDS[kind], wildness, trial })
    }
}

/// Draws parameters that lie within `decades` of what is usual, either way.
struct Draw<'a> {
    random: &'a mut Random,
    decades: f64,
}

impl Draw<'_> {
    fn near(&mut self, usual: f64) -> f64 {
        usual * self.random.decades(-self.decades, self.decades)
    }

    /// Zero with the share `none`, else near what is usual.
    fn perhaps(&mut self, none: f64, usual: f64) -> f64 {
        if self.random.chance(none) { 0.0 } else { self.near(usual) }
    }

    fn vector(&mut self, none: f64, usual: f64) -> Vec3 {
        self.random.direction() * self.perhaps(none, usual)
    }

    fn trial(&mut self, kind: usize, most_points: usize) -> Result<Trial, String> {
        let scale = self.random.decades(-6.0, 6.0 - 6.0 / self.decades.max(1.0)).min(1e3);
        let mut body = shape::body(self.random, kind, most_points, scale).map_err(|refused| refused.to_string())?;
        check_body(&body);
        if self.random.chance(0.2) {
            let offset = self.random.in_cube() * body.size() * 0.05;
            body = body.with_center_of_mass(offset.into()).unwrap_or(body);
        }
        let size = body.size();
        let gravity = if self.random.chance(0.05) { 0.0 } else { self.near(9.8) };
        let mass = self.near(2000.0) * body.volume().max(1e-6 * size.powi(3));
        // The units of what follows: the weight, and the time in which the body falls by its size.
        let weight = mass * gravity.max(1e-3);
        let time = (size / gravity.max(1e-3)).sqrt();
        let step = self.near(0.05 * time);
        let count = self.random.decades(1.0, 4.0) as u64;
        let strength = self.near(0.01);
        let moment = self.vector(0.2, weight * size / strength);
        let orientation = self.orientation(&body);
        let position = self.random.chance(0.3).then(|| Vec3::new(0.0, 0.0, size + self.near(0.1 * size)));
        let mut parts = TrialParts {
            substrate: self.substrate(weight, size),
            field: self.field(strength, step, count)?,
            model: Model {
                magnetic_torque: self.random.one_of(&[
                    MagneticTorque::StartOfStep,
                    MagneticTorque::EndOfStep,
                    MagneticTorque::Midpoint,
                ]),
                adhesion_acts_at: self.random.one_of(&[AdhesionActsAt::Ecp, AdhesionActsAt::PatchCentroid]),
                adhesion_enters: self.random.one_of(&[AdhesionEnters::Normal, AdhesionEnters::FrictionOnly]),
            },
            relief: self.relief(size)?,
            surroundings: self.surroundings(weight, size, time, step, count),
            incline: if self.random.chance(0.4) { 0.0 } else { self.random.between(-1.5, 1.5) },
            side_incline: if self.random.chance(0.7) { 0.0 } else { self.random.between(-1.5, 1.5) },
            gravity,
            duration: step * count as f64,
            step,
            position,
            orientation,
            linear: self.vector(0.4, 0.3 * size / time),
            angular: self.vector(0.4, 0.3 / time),
            robot: Robot::new(Arc::new(body), mass, moment).map_err(|refused| refused.to_string())?,
        };
        // Last, so that the cases by their seeds are otherwise what they were before friction could drift.
        let drift = self.perhaps(0.7, 1.0 / parts.duration);
        parts.substrate.friction_drift = drift * self.random.one_of(&[-1.0, 1.0]);
        Trial::new(parts.clone()).or_else(|_| {
            // The torque at the start of a step asks for shorter ones.
            parts.model.magnetic_torque = MagneticTorque::EndOfStep;
            Trial::new(parts).map_err(|refused| refused.to_string())
        })
    }

    fn substrate(&mut self, weight: f64, size: f64) -> Substrate {
        let pull = self.perhaps(0.4, weight / (size * size));
        let ellipsoid = if self.random.chance(0.3) {
            [1.0, 1.0, 0.1]
        } else {
            [self.random.decades(-1.0, 0.5), self.random.decades(-1.0, 0.5), self.near(0.5 * size)]
        };
        Substrate {
            friction_coefficient: self.perhaps(0.1, 0.4),
            friction_drift: 0.0,
            friction_ellipsoid: ellipsoid,
            adhesion: pull,
            electrostatic_force: self.perhaps(0.5, weight),
            line_contact_width: self.perhaps(0.5, 0.01 * size),
            compliance: self.perhaps(0.7, 1e-3 * size / weight),
        }
    }

    fn field(&mut self, strength: f64, step: f64, count: u64) -> Result<Field, String> {
        let axis = self.random.direction();
        let field = match self.random.whole(0, 2) {
            0 => {
                // A scenario asks for twenty steps in a cycle.
                let frequency = self.near(0.02 / step).min(0.05 / step);
                let initial = axis.cross(&self.random.direction());
                let (ratio, phase) = (self.random.between(0.5, 1.5), self.random.between(-0.5, 0.5));
                Field::rotating(strength, frequency, axis, initial)
                    .and_then(|field| field.with_quadrature(ratio, phase))
            }
            1 => Field::constant(strength, axis),
            _ => {
                let times: Vec<f64> = (0..=4).map(|row| 0.25 * f64::from(row) * step * count as f64).collect();
                let fields: Vec<Vec3> = times.iter().map(|_| self.vector(0.2, strength)).collect();
                Field::table(&times, &fields)
            }
        };
        field.map_err(|refused| refused.to_string())
    }

    fn relief(&mut self, size: f64) -> Result<Relief, String> {
        if self.random.chance(0.85) {
            return Ok(Relief::flat());
        }
        let length = size * self.random.decades(1.0, 3.0);
        let height = 0.05 * length;
        let mut heights = || [0; 2].map(|_| height * self.random.between(-1.0, 1.0));
        let (cosine, sine) = (heights(), heights());
        Relief::new(length, &cosine, &sine).map_err(|refused| refused.to_string())
    }

    fn surroundings(&mut self, weight: f64, size: f64, time: f64, step: f64, count: u64) -> Surroundings {
        if self.random.chance(0.7) {
            return Surroundings::none();
        }
        let rows = self.random.whole(0, 3);
        let times = (0..rows).map(|row| (row as f64 + 0.5) / 3.0 * step * count as f64).collect();
        let wrenches = (0..rows).map(|_| (self.vector(0.3, weight), self.vector(0.3, weight * size))).collect();
        Surroundings {
            force: self.vector(0.5, 0.3 * weight),
            torque: self.vector(0.5, 0.3 * weight * size),
            translational_drag: self.perhaps(0.5, weight * time / size),
            rotational_drag: self.perhaps(0.5, weight * time * size),
            sheet_conductance: self.perhaps(0.5, 3e7),
            times,
            wrenches,
        }
    }

    /// Any orientation, or flat on a face.
    fn orientation(&mut self, body: &Body) -> Quaternion<f64> {
        if body.faces().is_empty() || self.random.chance(0.5) {
            return self.random.orientation();
        }
        let face = &body.faces()[self.random.whole(0, body.faces().len() - 1)];
        let Surface::HalfSpace(plane) = body.surfaces()[usize::from(face.surface)] else {
            return self.random.orientation();
        };
        let yaw = UnitQuaternion::from_axis_angle(&Vec3::z_axis(), self.random.between(-3.0, 3.0));
        let down = UnitQuaternion::rotation_between(&plane.normal, &-Vec3::z()).unwrap_or_else(|| {
            // The face is the upper one: half a turn about x.
            UnitQuaternion::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI)
        });
        *(yaw * down).quaternion()
    }
}

/// A body that was not refused has a volume, and an inertia that is positive and no more than a body can have.
fn check_body(body: &Body) {
    let moments = body.unit_inertia().symmetric_eigenvalues();
    let (size, [least, middle, most]) = (body.size(), {
        let mut sorted = [moments[0], moments[1], moments[2]];
        sorted.sort_by(f64::total_cmp);
        sorted
    });
    assert!(body.volume() > 0.0 && body.volume().is_finite(), "a volume of {:e} m3", body.volume());
    assert!(least > 0.0 && most <= 2.0 * (2.0 * size).powi(2), "moments of inertia {least:e} {middle:e} {most:e} m2");
    // I1 + I2 ≥ I3, which rounding may miss by as much as it makes of a flat body's thickness.
    assert!(least + middle >= most * (1.0 - 1e-9), "moments of inertia {least:e} {middle:e} {most:e} m2 of no body");
}
