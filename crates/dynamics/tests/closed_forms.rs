//! Motions with a closed form.

mod common;

use common::*;
use geometry::{Body, ContactMode};
use nalgebra::Quaternion;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{Field, MagneticTorque, Robot, SolverKind, Stepper, Trial, Vec3};

fn end_of(parts: TrialParts) -> (Vec3, Vec3, Vec3) {
    let trial = Trial::new(parts).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    run_checked(&mut stepper, &trial, |_, _| {});
    let state = stepper.state();
    (state.position, state.linear, state.angular)
}

#[test]
fn a_block_sticks_below_the_friction_angle() {
    for degrees in [1.0, 10.0, 16.6] {
        let mut parts = passive(cuboid(), 3.78e-8, smooth(0.3));
        parts.incline = f64::to_radians(degrees);
        let (position, velocity, _) = end_of(parts);
        assert!(position.xy().norm() < 1e-15, "crept to {position:?}");
        assert!(velocity.norm() < 1e-14);
    }
}

#[test]
fn a_block_slides_above_the_friction_angle() {
    for degrees in [16.8f64, 25.0, 45.0, 60.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut parts = passive(cuboid(), 3.78e-8, smooth(0.3));
        parts.incline = degrees.to_radians();
        let (position, velocity, spin) = end_of(parts);
        // Backward Euler: v_N = a N h exactly, y_N = a h² N(N+1)/2.
        let acceleration = -9.8 * (sin - 0.3 * cos);
        assert!((velocity.y / (acceleration * 0.1) - 1.0).abs() < 1e-9);
        assert!((position.y / (acceleration * 25e-8 * 200.0 * 201.0 / 2.0) - 1.0).abs() < 1e-9);
        assert!(spin.norm() < 1e-9);
    }
}

#[test]
fn a_body_in_the_air_falls_freely() {
    let mut parts = passive(spiked(4.0), 2.4e-8, smooth(0.3));
    parts.position = Some(Vec3::new(0.0, 0.0, 1.0));
    parts.linear = Vec3::new(0.1, -0.2, 0.3);
    let (position, velocity, _) = end_of(parts);
    assert!((velocity - Vec3::new(0.1, -0.2, 0.3 - 0.98)).norm() < 1e-12);
    assert!((position - Vec3::new(0.01, -0.02, 1.0 + 0.03 - 9.8 * 25e-8 * 201.0 * 100.0)).norm() < 1e-12);
}

#[test]
fn angular_momentum_is_kept_in_the_air_to_first_order() {
    let drift_at = |step: f64| {
        let mut parts = passive(spiked_ends(4.0), 2.4e-8, smooth(0.3));
        parts.position = Some(Vec3::new(0.0, 0.0, 1.0));
        parts.gravity = 0.0;
        parts.angular = Vec3::new(20.0, 5.0, -8.0);
        parts.step = step;
        let trial = Trial::new(parts).unwrap();
        let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
        let momentum = |stepper: &Stepper| {
            let q = nalgebra::UnitQuaternion::new_unchecked(stepper.state().orientation);
            let r = q.to_rotation_matrix().into_inner();
            r * trial.robot().inertia() * r.transpose() * stepper.state().angular
        };
        let before = momentum(&stepper);
        run_checked(&mut stepper, &trial, |_, _| {});
        (momentum(&stepper) - before).norm() / before.norm()
    };
    let (coarse, fine) = (drift_at(4e-4), drift_at(2e-4));
    assert!(coarse < 0.02 && (coarse / fine - 2.0).abs() < 0.2, "{coarse:e} {fine:e}");
}

/// The midpoint keeps `C(ω⁺) I ω⁺`, and with it `|Iω|`, whatever the spin is: here half a turn in a step.
#[test]
fn the_midpoint_keeps_the_angular_momentum_of_a_body_that_tumbles_fast() {
    let mut parts = passive(curved(), 2.4e-8, smooth(0.3));
    parts.model.magnetic_torque = MagneticTorque::Midpoint;
    parts.position = Some(Vec3::new(0.0, 0.0, 1.0));
    parts.gravity = 0.0;
    parts.angular = Vec3::new(2000.0, 1500.0, -3000.0);
    parts.duration = 5.0;
    let trial = Trial::new(parts).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    let magnitude = |stepper: &Stepper| {
        let r = nalgebra::UnitQuaternion::new_unchecked(stepper.state().orientation).to_rotation_matrix();
        (trial.robot().inertia() * (r.inverse() * stepper.state().angular)).norm()
    };
    let before = magnitude(&stepper);
    for _ in 0..trial.steps() {
        stepper.advance();
    }
    assert!((magnitude(&stepper) / before - 1.0).abs() < 1e-8);
}

/// `p = -b E(Eu)/|Eu|`: a sliding and spinning body decelerates along its twist, weighed by the ellipsoid. The disc is
/// thin, so that friction does not shift the ECP away from below its centre.
#[test]
fn a_sliding_and_spinning_disc_loses_its_twist_by_the_ellipsoid() {
    let disc: Vec<[f64; 3]> = (0..48)
        .flat_map(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 48.0).sin_cos();
            [[2e-4 * cos, 2e-4 * sin, 5e-9], [2e-4 * cos, 2e-4 * sin, -5e-9]]
        })
        .collect();
    let mut parts = passive(Body::hull(&disc).unwrap(), 3e-8, smooth(0.4));
    parts.substrate.friction_ellipsoid = [1.0, 1.0, 1.5e-4];
    parts.linear = Vec3::new(0.03, 0.04, 0.0);
    parts.angular = Vec3::new(0.0, 0.0, 500.0);
    parts.step = 1e-6;
    parts.duration = 1e-6;
    let spin_inertia = parts.robot.inertia()[(2, 2)];
    let (_, velocity, spin) = end_of(parts.clone());
    let slip = Vec3::new(velocity.x, velocity.y, 1.5e-4 * spin.z).norm();
    let bound = 0.4 * 3e-8 * 9.8 * 1e-6;
    let expected = parts.linear.xy() - velocity.xy() * (bound / slip / 3e-8);
    assert!((velocity.xy() - expected).norm() < 1e-4 * bound / 3e-8);
    let slowed = 500.0 - bound * 1.5e-4 * 1.5e-4 * spin.z / slip / spin_inertia;
    assert!((spin.z - slowed).abs() < 1e-4 * (500.0 - slowed));
    assert!(velocity.z.abs() < 1e-15);
}

/// The field of a static vertical tilt test that lifts a cuboid: `V_m |E| B = (m g + F_elect) L/2`.
#[test]
fn a_cuboid_tips_over_at_the_torque_of_its_weight() {
    let (mass, moment) = (3.78e-8, 2.9e-11 * 15000.0);
    let threshold = (mass * 9.8 + 6.54e-7) * 4e-4 / moment;
    for (share, lifts) in [(0.999, false), (1.001, true)] {
        let mut parts = passive(cuboid(), mass, paper());
        parts.robot = Robot::new(std::sync::Arc::new(cuboid()), mass, Vec3::new(0.0, moment, 0.0)).unwrap();
        parts.field = Field::constant(threshold * share, Vec3::z()).unwrap();
        let trial = Trial::new(parts).unwrap();
        let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
        let mut lifted = false;
        run_checked(&mut stepper, &trial, |_, solution| lifted |= solution.patch.mode != ContactMode::Surface);
        assert_eq!(lifted, lifts, "at {share} of the threshold");
    }
}

#[test]
fn a_ball_rolls_without_slip_and_slides_where_friction_is_too_small() {
    let (radius, mass) = (2e-4, 3e-8);
    for (degrees, mu) in [(20f64, 0.3), (45.0, 0.1)] {
        let mut parts = passive(Body::ellipsoid([radius; 3]).unwrap(), mass, smooth(mu));
        parts.incline = degrees.to_radians();
        parts.step = 1e-4;
        let (_, velocity, spin) = end_of(parts);
        let (sin, cos) = degrees.to_radians().sin_cos();
        // A rolling ball accelerates with 5/7 g sin φ as long as that needs no more friction than μ: 2/7 tan φ < μ.
        let rolls = 2.0 / 7.0 * sin / cos < mu;
        let acceleration = if rolls { 5.0 / 7.0 * sin } else { sin - mu * cos };
        assert!((velocity.y / (-9.8 * acceleration * 0.1) - 1.0).abs() < 1e-6, "{}", velocity.y);
        if rolls {
            assert!((velocity.y + spin.x * radius).abs() < 1e-9 * velocity.y.abs());
        } else {
            assert!((spin.x / (2.5 * 9.8 * mu * cos * 0.1 / radius) - 1.0).abs() < 1e-6);
        }
    }
}

/// Two cycles after the first, which starts flat and not in the posture of a cycle.
#[test]
fn no_slip_speed_is_the_hull_s_perimeter_times_the_frequency() {
    let mut cases = vec![(pdms(spiked(0.0), 0.0, 0.0), 1.0), (pdms(spiked_ends(0.0), 0.0, 0.0), 1.0)];
    cases.extend([1.0, 5.0].map(|frequency| (cuboid_on_paper(0.01, frequency), frequency)));
    for (mut parts, frequency) in cases {
        parts.duration = 3.0 / frequency;
        let perimeter = parts.robot.body().hull_perimeter();
        let trial = Trial::new(parts).unwrap();
        let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
        let mut after_first = 0.0;
        run_checked(&mut stepper, &trial, |stepper, _| {
            if stepper.time() <= 1.0 / frequency + 1e-9 {
                after_first = stepper.state().position.y;
            }
        });
        let travelled = stepper.state().position.y - after_first;
        assert!((travelled / (2.0 * perimeter) - 1.0).abs() < 0.01, "{travelled} over {perimeter}");
    }
}

/// A box that slides fast stays on the plane, which convex contact models give up.
#[test]
fn a_sliding_box_is_not_lifted() {
    let mut parts = passive(cuboid(), 3.78e-8, smooth(0.5));
    parts.linear = Vec3::new(0.0, 6.0, 0.0);
    parts.orientation = Quaternion::new(0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt());
    let trial = Trial::new(parts).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    run_checked(&mut stepper, &trial, |stepper, solution| {
        assert!((stepper.state().position.z - 5e-5).abs() < 1e-9 * 8e-4);
        assert!(solution.normal > 0.0);
    });
}
