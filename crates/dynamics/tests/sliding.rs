//! Sliding without lift, friction inside its one ellipsoid, and no creep below the friction angle.

mod common;

use common::*;
use geometry::Body;
use nalgebra::{Quaternion, UnitQuaternion};
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{MagneticTorque, SolverKind, Stepper, Trial, Vec3};

/// Over the body's size: what sliding may lift, and creeping may move, it by.
const STAYS: f64 = 1e-9;
/// Over `μ p̄`: how far rounding may leave the friction outside the ellipsoid. A step is solved to 1e-11 of its load.
const ON_ELLIPSOID: f64 = 1e-9;
const SPEED: f64 = 6.0;
const MU: f64 = 0.5;

/// A box that slides at 6 m/s along `heading` (rad), itself turned by `turn` (rad), until well after it has stopped.
fn sliding(scale: f64, step: f64, heading: f64, turn: f64) -> TrialParts {
    let body = Body::cuboid(8e-4 * scale, 4e-4 * scale, 1e-4 * scale, draft(0.0)).unwrap();
    let mut parts = passive(body, 3.78e-8 * scale.powi(3), smooth(MU));
    parts.linear = Vec3::new(heading.cos(), heading.sin(), 0.0) * SPEED;
    parts.orientation = *UnitQuaternion::from_axis_angle(&Vec3::z_axis(), turn).quaternion();
    parts.step = step;
    parts.duration = 1.1 * SPEED / (MU * parts.gravity);
    parts
}

/// A convex relaxation of the contact (Anitescu 2006) asks for `v_z ≥ μ|v_t|` while the box slides, and lifts it by
/// `h μ |v|`: 3 cm in the steps of 10 ms below, 1.5 mm in those of the microrobots.
#[test]
fn a_box_at_six_metres_per_second_stays_on_the_plane_until_it_stands() {
    for (scale, step) in [(1.0, 5e-4), (1e3, 1e-2)] {
        for (heading, turn) in [(0.5f64, 0.5f64), (0.0, 0.0), (1.3, 0.2), (-2.5, 0.9)] {
            let trial = Trial::new(sliding(scale, step, heading, turn)).unwrap();
            let (size, lift) = (trial.robot().body().size(), step * MU * SPEED);
            let height = trial.initial().position.z;
            let weight = trial.robot().mass() * 9.8 * step;
            let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
            run_checked(&mut stepper, &trial, |stepper, solution| {
                let raised = (stepper.state().position.z - height).abs();
                assert!(raised <= STAYS * size, "raised by {raised:e} m at {} s", stepper.time());
                assert!(
                    (solution.normal / weight - 1.0).abs() < 1e-9,
                    "p_n is {:e} of the weight",
                    solution.normal / weight
                );
            });
            // The friction that brakes it is μ m g: v²/(2 μ g), and h v/2 less for the step's end velocity.
            let way = SPEED * SPEED / (2.0 * MU * 9.8) - 0.5 * step * SPEED;
            let slid = stepper.state().position.xy().norm();
            assert!((slid - way).abs() < step * MU * 9.8 * step, "slid {slid} m of {way} m");
            assert!(stepper.state().linear.norm() < 1e-9 && stepper.state().angular.norm() < 1e-6);
            assert!(lift > 1e3 * STAYS * size, "the bound would not see the lift of a convex model");
        }
    }
}

/// `(p_t/e_t)² + (p_o/e_o)² + (p_r/e_r)² ≤ (μ p̄)²`: one ellipsoid for force and moment, neither a pyramid nor a cone for
/// each. While the contact slips the friction is on it, so that the bound is not met by too little of it.
#[test]
fn friction_stays_inside_the_one_ellipsoid_and_is_on_it_while_the_contact_slips() {
    let ellipsoids = [[1.0, 1.0, 0.1], [1.0, 0.4, 1.5e-4], [0.3, 1.0, 2e-4]];
    let mut slipping = 0;
    for ellipsoid in ellipsoids {
        for torque in [MagneticTorque::StartOfStep, MagneticTorque::EndOfStep, MagneticTorque::Midpoint] {
            let mut sliding_and_spinning = sliding(1.0, 5e-4, 0.7, 0.3);
            sliding_and_spinning.angular = Vec3::new(0.0, 0.0, 900.0);
            sliding_and_spinning.duration = 0.5;
            let mut adhering = pdms(spiked(4.0), 10.0, 30.0);
            adhering.duration = 0.5;
            for mut parts in [sliding_and_spinning, adhering, cuboid_on_paper(0.01, 5.0)] {
                parts.substrate.friction_ellipsoid = ellipsoid;
                parts.model.magnetic_torque = torque;
                if torque == MagneticTorque::StartOfStep {
                    parts.step = 5e-5;
                    parts.duration = 0.1;
                }
                let trial = Trial::new(parts).unwrap();
                let (mu, e) = (trial.substrate().friction_coefficient, Vec3::from(ellipsoid));
                let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
                run_checked(&mut stepper, &trial, |_, solution| {
                    let (length, bound) = (solution.friction.component_div(&e).norm(), mu * solution.normal);
                    assert!(
                        length <= bound * (1.0 + ON_ELLIPSOID),
                        "{length:e} N s outside the ellipsoid of {bound:e} N s"
                    );
                    if solution.sigma > 1e-6 && solution.normal > 0.0 {
                        slipping += 1;
                        assert!(length >= bound * (1.0 - 1e-6), "{length:e} N s inside the ellipsoid of {bound:e} N s");
                    }
                });
            }
        }
    }
    assert!(slipping > 1000, "only {slipping} steps slipped");
}

/// `v(t) = v₀ - μ g (t + k t²/2)`, which steps that take the friction in their middle follow exactly, as long as there is
/// any: with `k = -1/s` none is left after a second, and the box slides on.
#[test]
fn friction_that_drifts_brakes_a_box_as_its_integral_says() {
    for (drift, until) in [(0.8, 0.5f64), (-0.5, 0.9), (-1.0, 1.5)] {
        let mut parts = sliding(1.0, 5e-4, 0.5, 0.5);
        parts.substrate.friction_drift = drift;
        parts.duration = until;
        let trial = Trial::new(parts).unwrap();
        let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
        run_checked(&mut stepper, &trial, |_, _| ());
        let braked = if drift * until < -1.0 { 0.5 / -drift } else { until + 0.5 * drift * until * until };
        let speed = SPEED - MU * 9.8 * braked;
        let found = stepper.state().linear.norm();
        assert!((found - speed).abs() < 1e-9 * SPEED, "{found} m/s after {until} s with {drift} per s, not {speed}");
    }
}

/// Regularised friction creeps with a speed that follows the load; a step that is solved does not.
#[test]
fn nothing_creeps_below_the_friction_angle_in_a_hundred_thousand_steps() {
    const STEPS: u64 = 100_000;
    /// Bodies with a draft or a spike first come to lie on a face, and stop slowly this close to the friction angle.
    const SETTLING: u64 = 20_000;
    // The slope as a share of the friction angle, and the direction in which it falls, from -y towards -x.
    for (share, falls) in [(0.5f64, 0.0f64), (0.999, 0.0), (0.999, 0.9)] {
        for body in [cuboid(), spiked_ends(4.0), spiked(0.0)] {
            let mut parts = passive(body, 3.78e-8, smooth(MU));
            // Sliding asks for μ² < tan² φ + tan² σ/cos² φ.
            let tangent = (share * MU.atan()).tan();
            parts.incline = (tangent * falls.cos()).atan();
            parts.side_incline = (tangent * falls.sin() * parts.incline.cos()).atan();
            parts.orientation = Quaternion::new(1.0, 0.0, 0.0, 0.3);
            parts.step = 1e-3;
            parts.duration = parts.step * (SETTLING + STEPS) as f64;
            let trial = Trial::new(parts).unwrap();
            let size = trial.robot().body().size();
            let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
            let (mut done, mut settled) = (0, *trial.initial());
            run_checked(&mut stepper, &trial, |stepper, _| {
                done += 1;
                if done == SETTLING {
                    settled = *stepper.state();
                }
            });
            assert_eq!(done, SETTLING + STEPS);
            let crept = (stepper.state().position - settled.position).norm();
            let turned = (stepper.state().orientation.coords - settled.orientation.coords).norm();
            assert!(crept <= STAYS * size, "crept {crept:e} m at {share} of the friction angle");
            assert!(turned <= STAYS, "turned by {turned:e} at {share} of the friction angle");
        }
    }
}
