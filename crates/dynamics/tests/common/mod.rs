//! Robots and trials of the paper, for the tests.
#![allow(dead_code)] // every test file uses some of them

use geometry::{Body, Draft, DraftModel};
use nalgebra::Quaternion;
use std::sync::Arc;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{
    AdhesionActsAt, AdhesionEnters, Field, MagneticTorque, Model, Relief, Robot, StepSolution, Stepper, Substrate,
    Surroundings, Trial, Vec3,
};

pub const MODEL: Model = Model {
    magnetic_torque: MagneticTorque::EndOfStep,
    adhesion_acts_at: AdhesionActsAt::Ecp,
    adhesion_enters: AdhesionEnters::Normal,
};

pub fn draft(degrees: f64) -> Draft {
    Draft { angle_rad: degrees.to_radians(), model: DraftModel::Geometric }
}

pub fn cuboid() -> Body {
    Body::cuboid(8e-4, 4e-4, 1e-4, draft(0.0)).unwrap()
}

pub fn spiked(degrees: f64) -> Body {
    Body::spiked(4e-4, 2e-4, 7.5e-5, 1.25e-4, 3.25e-4, draft(degrees)).unwrap()
}

pub fn spiked_ends(degrees: f64) -> Body {
    Body::spiked_ends(4e-4, 2e-4, 7.5e-5, 1e-4, 1e-4, draft(degrees)).unwrap()
}

pub fn curved() -> Body {
    Body::curved(1.25e-3, 1.1e-3, 25f64.to_radians(), 4e-4, draft(0.0)).unwrap()
}

pub fn smooth(friction_coefficient: f64) -> Substrate {
    Substrate {
        friction_coefficient,
        friction_drift: 0.0,
        friction_ellipsoid: [1.0, 1.0, 0.1],
        adhesion: 0.0,
        electrostatic_force: 0.0,
        line_contact_width: 0.0,
        compliance: 0.0,
    }
}

pub fn paper() -> Substrate {
    Substrate { adhesion: 1.19, electrostatic_force: 6.54e-7, ..smooth(0.3) }
}

pub fn aluminium_pdms() -> Substrate {
    Substrate { adhesion: 340.115, electrostatic_force: 2.2022e-7, ..smooth(0.8) }
}

pub fn no_field() -> Field {
    Field::constant(0.0, Vec3::z()).unwrap()
}

pub fn rotating(strength: f64, frequency: f64) -> Field {
    Field::rotating(strength, frequency, -Vec3::x(), Vec3::y()).unwrap()
}

/// A passive body at rest on `substrate`.
pub fn passive(body: Body, mass: f64, substrate: Substrate) -> TrialParts {
    TrialParts {
        robot: Robot::new(Arc::new(body), mass, Vec3::zeros()).unwrap(),
        substrate,
        field: no_field(),
        model: MODEL,
        relief: Relief::flat(),
        surroundings: Surroundings::none(),
        incline: 0.0,
        side_incline: 0.0,
        gravity: 9.8,
        duration: 0.1,
        step: 5e-4,
        position: None,
        orientation: Quaternion::identity(),
        linear: Vec3::zeros(),
        angular: Vec3::zeros(),
    }
}

/// The cuboid of the first generation on paper.
pub fn cuboid_on_paper(strength: f64, frequency: f64) -> TrialParts {
    let axis = Vec3::new(0.0, 27f64.to_radians().cos(), 27f64.to_radians().sin());
    TrialParts {
        robot: Robot::new(Arc::new(cuboid()), 3.78e-8, axis * (2.9e-11 * 15000.0)).unwrap(),
        field: rotating(strength, frequency),
        ..passive(cuboid(), 3.78e-8, paper())
    }
}

/// A half-size PDMS robot on aluminium at 20 mT and 1 Hz.
pub fn pdms(body: Body, theta1_deg: f64, theta2_deg: f64) -> TrialParts {
    let (one, two) = (theta1_deg.to_radians(), theta2_deg.to_radians());
    let axis = Vec3::new(two.sin() * one.sin(), one.cos(), two.cos() * one.sin());
    let (mass, moment) = (2668.4 * body.volume(), axis * (18661.0 * body.volume()));
    TrialParts {
        robot: Robot::new(Arc::new(body), mass, moment).unwrap(),
        substrate: aluminium_pdms(),
        field: rotating(0.02, 1.0),
        ..passive(cuboid(), mass, aluminium_pdms())
    }
}

/// `parts` with every term that the paper does not have.
pub fn disturbed(mut parts: TrialParts) -> TrialParts {
    let weight = parts.robot.mass() * parts.gravity;
    let body = parts.robot.body().with_center_of_mass([1e-5, -2e-5, 5e-6]).unwrap();
    parts.robot = Robot::new(Arc::new(body), parts.robot.mass(), *parts.robot.moment()).unwrap();
    parts.substrate.compliance = 0.5;
    parts.substrate.friction_drift = -0.4;
    parts.field = parts.field.with_quadrature(1.2, 0.2).unwrap();
    parts.side_incline = 0.05;
    parts.relief = Relief::new(2e-3, &[6e-6, -3e-6], &[1e-5, 2e-6]).unwrap();
    parts.surroundings = Surroundings {
        force: Vec3::new(0.05, 0.1, 0.02) * weight,
        torque: Vec3::new(0.1, -0.05, 0.02) * weight * 1e-4,
        translational_drag: 5e-6,
        rotational_drag: 1e-12,
        sheet_conductance: 3e7,
        times: Arc::new([0.01, 0.03]),
        wrenches: Arc::new([
            (Vec3::new(0.1, 0.0, -0.1) * weight, Vec3::zeros()),
            (Vec3::zeros(), Vec3::new(0.0, 0.0, 1e-5) * weight),
        ]),
    };
    parts
}

/// Runs to the end, checks what must hold at every step, and shows every step to `look`.
pub fn run_checked<'a>(stepper: &mut Stepper<'a>, trial: &'a Trial, mut look: impl FnMut(&Stepper, &StepSolution)) {
    let size = trial.robot().body().size();
    for step in 0..trial.steps() {
        stepper.advance();
        let solution = stepper.solution();
        assert!(solution.converged, "step {step} did not converge: {solution:?}");
        assert!(solution.residual <= 1e-10, "step {step} has residual {:e}", solution.residual);
        assert!(solution.penetration <= 1e-9 * size, "step {step} penetrates by {:e} m", solution.penetration);
        look(stepper, solution);
    }
}
