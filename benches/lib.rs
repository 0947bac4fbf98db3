//! The trials that the benchmarks run.

use dynamics::trial::TrialParts;
use dynamics::{
    AdhesionActsAt, AdhesionEnters, Field, MagneticTorque, Model, Relief, Robot, SolverKind, Stepper, Substrate,
    Surroundings, Trial, Vec3,
};
use geometry::{Body, ContactMode, Draft, DraftModel};
use nalgebra::Quaternion;
use std::sync::Arc;

/// The half-size PDMS robots of the paper.
#[derive(Clone, Copy)]
pub enum Shape {
    Spiked,
    SpikedEnds,
}

fn draft(degrees: f64) -> Draft {
    Draft { angle_rad: degrees.to_radians(), model: DraftModel::Geometric }
}

fn parts(body: Body, mass: f64, moment: Vec3, substrate: Substrate, strength: f64, frequency: f64) -> TrialParts {
    TrialParts {
        robot: Robot::new(Arc::new(body), mass, moment).expect("a robot of the paper"),
        substrate,
        field: Field::rotating(strength, frequency, -Vec3::x(), Vec3::y()).expect("a field of the paper"),
        model: Model {
            magnetic_torque: MagneticTorque::EndOfStep,
            adhesion_acts_at: AdhesionActsAt::Ecp,
            adhesion_enters: AdhesionEnters::Normal,
        },
        relief: Relief::flat(),
        surroundings: Surroundings::none(),
        incline: 0.0,
        side_incline: 0.0,
        gravity: 9.8,
        duration: 1.0,
        step: 5e-4,
        position: None,
        orientation: Quaternion::identity(),
        linear: Vec3::zeros(),
        angular: Vec3::zeros(),
    }
}

fn trial(parts: TrialParts) -> Trial {
    Trial::new(parts).expect("a trial of the paper")
}

fn cuboid_parts(frequency: f64) -> TrialParts {
    let substrate = Substrate {
        friction_coefficient: 0.3,
        friction_drift: 0.0,
        friction_ellipsoid: [1.0, 1.0, 0.1],
        adhesion: 1.19,
        electrostatic_force: 6.54e-7,
        line_contact_width: 0.0,
        compliance: 0.0,
    };
    let body = Body::cuboid(8e-4, 4e-4, 1e-4, draft(0.0)).expect("the cuboid");
    let axis = Vec3::new(0.0, 27f64.to_radians().cos(), 27f64.to_radians().sin());
    parts(body, 3.78e-8, axis * (2.9e-11 * 15000.0), substrate, 0.01, frequency)
}

/// The cuboid on paper at 10 mT.
pub fn cuboid_on_paper(frequency: f64) -> Trial {
    trial(cuboid_parts(frequency))
}

/// The cuboid dropped from a height that it does not fall through.
pub fn cuboid_in_the_air(frequency: f64) -> Trial {
    trial(TrialParts { position: Some(Vec3::new(0.0, 0.0, 100.0)), ..cuboid_parts(frequency) })
}

/// A PDMS robot on aluminium at 20 mT and 1 Hz, with its manufacturing errors.
pub fn pdms(shape: Shape, draft_deg: f64, theta1_deg: f64, theta2_deg: f64) -> Trial {
    let substrate = Substrate {
        friction_coefficient: 0.8,
        friction_drift: 0.0,
        friction_ellipsoid: [1.0, 1.0, 0.1],
        adhesion: 340.115,
        electrostatic_force: 2.2022e-7,
        line_contact_width: 0.0,
        compliance: 0.0,
    };
    let draft = draft(draft_deg);
    let body = match shape {
        Shape::Spiked => Body::spiked(4e-4, 2e-4, 7.5e-5, 1.25e-4, 3.25e-4, draft),
        Shape::SpikedEnds => Body::spiked_ends(4e-4, 2e-4, 7.5e-5, 1e-4, 1e-4, draft),
    }
    .expect("a robot of the paper");
    let (one, two) = (theta1_deg.to_radians(), theta2_deg.to_radians());
    let axis = Vec3::new(two.sin() * one.sin(), one.cos(), two.cos() * one.sin());
    let (mass, moment) = (2668.4 * body.volume(), axis * (18661.0 * body.volume()));
    trial(parts(body, mass, moment, substrate, 0.02, 1.0))
}

/// The paper's 592 cases of manufacturing errors.
pub fn grid(shape: Shape) -> Vec<Trial> {
    let cases = std::iter::once((0.0, 0.0)).chain((1..=36).map(|n| (10.0, 10.0 * f64::from(n))));
    let cases: Vec<(f64, f64)> = cases.collect();
    (0..16).flat_map(|d| cases.iter().map(move |(one, two)| pdms(shape, f64::from(d), *one, *two))).collect()
}

/// `trial` taken to the first step after `after` (s) that ends in `mode`.
///
/// # Panics
///
/// If the trial has no such step.
pub fn in_mode(trial: &Trial, mode: ContactMode, after: f64) -> Stepper<'_> {
    let mut stepper = Stepper::new(trial, SolverKind::Reduced);
    for _ in 0..trial.steps() {
        let found = stepper.advance().patch.mode == mode;
        if found && stepper.time() >= after {
            return stepper;
        }
    }
    panic!("no step in {mode:?} after {after} s")
}
