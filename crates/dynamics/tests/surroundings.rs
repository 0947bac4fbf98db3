//! What the paper does not have: drags, forces, slopes, a relief, a plane that yields, a centre of mass off the middle.

mod common;

use common::*;
use geometry::Body;
use nalgebra::Matrix3;
use proptest::prelude::*;
use std::sync::Arc;
use tumblers_dynamics::rotation::matrix;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{Field, Relief, Robot, SolverKind, State, Stepper, Surroundings, Trial, Vec3};

const MASS: f64 = 3.78e-8;

fn end_of(parts: TrialParts) -> State {
    let trial = Trial::new(parts).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    run_checked(&mut stepper, &trial, |_, _| {});
    *stepper.state()
}

fn in_the_air(body: Body) -> TrialParts {
    TrialParts { position: Some(Vec3::new(0.0, 0.0, 0.01)), gravity: 0.0, ..passive(body, MASS, smooth(0.3)) }
}

/// `v⁺ = v/(1 + hk/m)`.
#[test]
fn drag_slows_a_body_in_the_air() {
    let (k, start) = (2e-6, Vec3::new(0.1, -0.2, 0.3));
    let mut parts = in_the_air(cuboid());
    parts.surroundings.translational_drag = k;
    parts.linear = start;
    let end = end_of(parts);
    let factor = (1.0 + 5e-4 * k / MASS).powi(-200);
    assert!((end.linear - start * factor).norm() < 1e-13, "{}", end.linear);
    assert!(factor < 0.01);
}

#[test]
fn drag_slows_a_ball_that_spins() {
    let (drag, start) = (1e-14, Vec3::new(30.0, -20.0, 50.0));
    let mut parts = in_the_air(Body::ellipsoid([1e-4; 3]).unwrap());
    parts.surroundings.rotational_drag = drag;
    parts.angular = start;
    let inertia = parts.robot.inertia()[(0, 0)];
    let factor = (1.0 + 5e-4 * drag / inertia).powi(-200);
    assert!((end_of(parts).angular - start * factor).norm() < 1e-10);
    assert!(factor < 0.01);
}

/// The images of a vertical moment resist what turns it, `2 κ M²/2` at most, and not a spin about itself.
#[test]
fn a_sheet_resists_the_turning_of_the_moment() {
    let (s, m, z) = (3e7, 4e-7, 2e-4);
    let sheet = Surroundings { sheet_conductance: s, ..Surroundings::none() };
    let (linear, angular) = sheet.drag(&Vec3::new(0.0, 0.0, m), z, 4e-4).unwrap();
    let square = (4e-7 * std::f64::consts::PI).powi(2) * s * m * m / std::f64::consts::PI;
    assert!((linear / (3.0 * square / (128.0 * z.powi(4))) - 1.0).abs() < 1e-12);
    let across = square / (64.0 * z * z);
    assert!((angular - Matrix3::from_diagonal(&Vec3::new(across, across, 0.0))).norm() < 1e-12 * across);
}

proptest! {
    #[test]
    fn a_sheet_never_drives(m in prop::array::uniform3(-1e-6..1e-6f64), z in 0.0..1e-3f64) {
        let sheet = Surroundings { sheet_conductance: 1e7, ..Surroundings::none() };
        let (linear, angular) = sheet.drag(&Vec3::from(m), z, 4e-4).unwrap();
        let eigenvalues = angular.symmetric_eigenvalues();
        prop_assert!(linear >= 0.0 && linear.is_finite());
        prop_assert!(eigenvalues.min() >= -1e-14 * eigenvalues.max() && eigenvalues.max().is_finite());
        prop_assert!((angular - angular.transpose()).norm() <= 1e-15 * angular.norm());
    }
}

#[test]
fn a_plane_that_yields_lets_a_resting_body_sink() {
    for compliance in [0.5, 20.0] {
        let mut parts = passive(cuboid(), MASS, paper());
        parts.substrate.compliance = compliance;
        parts.duration = 1.0;
        let sunk = 5e-5 - end_of(parts).position.z;
        let expected = compliance * (MASS * 9.8 + 6.54e-7 + 1.19 * 8e-4 * 4e-4);
        // Adhesion raises p_n as much as it pulls at the same point.
        assert!((sunk / expected - 1.0).abs() < 1e-9, "{sunk:e} {expected:e}");
    }
}

#[test]
fn a_side_slope_slides_above_the_friction_angle_only() {
    let on_slope = |degrees: f64| {
        let mut parts = passive(cuboid(), MASS, smooth(0.3));
        parts.side_incline = degrees.to_radians();
        end_of(parts)
    };
    assert!(on_slope(16.6).position.xy().norm() < 1e-15);
    let (sin, cos) = 25f64.to_radians().sin_cos();
    let down = on_slope(25.0);
    assert!((down.linear.x / (-9.8 * (sin - 0.3 * cos) * 0.1) - 1.0).abs() < 1e-9);
    assert!(down.linear.y.abs() < 1e-12);
}

#[test]
fn two_slopes_make_one() {
    let mut parts = in_the_air(cuboid());
    parts.position = Some(Vec3::z());
    (parts.gravity, parts.incline, parts.side_incline) = (9.8, 0.4, -0.3);
    let fallen = end_of(parts).linear;
    assert!((fallen.norm() - 0.98).abs() < 1e-12);
    let expected = Vec3::new(0.3f64.sin(), -0.4f64.sin() * 0.3f64.cos(), -0.4f64.cos() * 0.3f64.cos()) * 0.98;
    assert!((fallen - expected).norm() < 1e-12);
}

/// A row acts from its time to that of the next: here 20 ms, 30 ms, and 40 ms to the end, with 10 ms before.
#[test]
fn forces_and_torques_act_in_their_time() {
    let mut parts = in_the_air(Body::ellipsoid([1e-4; 3]).unwrap());
    let inertia = parts.robot.inertia()[(0, 0)];
    let (force, torque) = (Vec3::x() * 1e-7, Vec3::z() * 1e-13);
    parts.surroundings.force = Vec3::y() * 2e-7;
    parts.surroundings.torque = Vec3::x() * 3e-14;
    parts.surroundings.times = Arc::new([0.01, 0.03, 0.06]);
    parts.surroundings.wrenches = Arc::new([(force, torque), (-2.0 * force, Vec3::zeros()), (Vec3::zeros(), -torque)]);
    let end = end_of(parts);
    let pushed = force * (0.02 - 0.06) + Vec3::y() * 2e-8;
    assert!((end.linear * MASS - pushed).norm() < 1e-12 * pushed.norm());
    let spun = torque * (0.02 - 0.04) + Vec3::x() * 3e-15;
    assert!((end.angular * inertia - spun).norm() < 1e-9 * spun.norm());
}

/// Where the waves are very long, a relief is a slope.
#[test]
fn a_long_wave_is_a_slope() {
    let (slope, wavelength) = (25f64.to_radians().tan(), 1e4);
    let mut parts = passive(cuboid(), MASS, smooth(0.3));
    let mut sloping = parts.clone();
    sloping.relief = Relief::new(wavelength, &[0.0], &[slope * wavelength / std::f64::consts::TAU]).unwrap();
    parts.incline = 25f64.to_radians();
    let (flat, state) = (end_of(parts), end_of(sloping.clone()));
    assert!((flat.position - state.position).norm() < 1e-9 * flat.position.norm());
    let trial = Trial::new(sloping).unwrap();
    let (position, orientation) = trial.seen(&state);
    assert!((position.z - state.position.z - slope * state.position.y).abs() < 1e-9);
    let along = matrix(&orientation) * Vec3::y();
    assert!((along.z / along.y - slope).abs() < 1e-9);
}

#[test]
fn the_slope_is_the_height_s_derivative() {
    let relief = Relief::new(2e-3, &[1e-5, -4e-6, 2e-6], &[-2e-5, 3e-6, 1e-6]).unwrap();
    assert!(relief.height(0.0) == 0.0);
    for i in -20..20 {
        let (y, e) = (f64::from(i) * 1.7e-4, 1e-8);
        let numeric = (relief.height(y + e) - relief.height(y - e)) / (2.0 * e);
        assert!((numeric - relief.slope(y)).abs() < 1e-7);
    }
    assert!(Relief::new(2e-3, &[0.0], &[0.0]).unwrap().is_flat());
}

#[test]
fn a_field_on_an_ellipse() {
    let (strength, ratio, phase) = (0.02, 0.8, 0.3f64);
    let field = rotating(strength, 2.0).with_quadrature(ratio, phase).unwrap();
    let mut greatest: f64 = 0.0;
    for i in 0..2000 {
        let t = f64::from(i) * 2.5e-4;
        let angle = 4.0 * std::f64::consts::PI * t;
        let expected = Vec3::y() * angle.cos() - Vec3::z() * (ratio * (angle + phase).sin());
        assert!((field.at(t) - expected * strength).norm() < 1e-15);
        greatest = greatest.max(field.at(t).norm());
    }
    assert!((field.greatest_strength() / greatest - 1.0).abs() < 1e-5);
    let constant = Field::constant(0.01, Vec3::z()).unwrap().with_quadrature(ratio, phase).unwrap();
    assert!(constant.at(1.0) == Vec3::z() * 0.01);
}

/// The contact carries the weight below the centre of mass.
#[test]
fn a_body_stands_on_the_point_below_its_centre_of_mass() {
    for body in [cuboid(), curved(), Body::ellipsoid([1e-4, 2e-4, 1.5e-4]).unwrap()] {
        let centre = Vec3::new(0.0, 0.0, -1e-5);
        let moved = body.with_center_of_mass(centre.into()).unwrap();
        assert!(moved.unit_inertia() == body.unit_inertia());
        let (up, high) = (body.lowest(&-Vec3::z()).1, moved.lowest(&-Vec3::z()).1);
        assert!((up - high - centre).norm() < 1e-18);
        assert!((body.max_value(&centre).1 - moved.max_value(&Vec3::zeros()).1).abs() < 1e-18);
    }
    let body = cuboid().with_center_of_mass([1e-5, 1.5e-4, 1e-5]).unwrap();
    let trial = Trial::new(passive(body, MASS, smooth(0.3))).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    run_checked(&mut stepper, &trial, |stepper, solution| {
        assert!((solution.ecp.xy() - stepper.state().position.xy()).norm() < 1e-12);
    });
    assert!((stepper.state().position.z - 6e-5).abs() < 1e-15);
    assert!(cuboid().with_center_of_mass([0.0, 0.0, 5e-5]).is_err());
    assert!(cuboid().with_center_of_mass([f64::NAN, 0.0, 0.0]).is_err());
}

#[test]
fn what_makes_no_sense_is_refused() {
    let refused = |change: fn(&mut TrialParts)| {
        let mut parts = in_the_air(cuboid());
        change(&mut parts);
        Trial::new(parts).unwrap_err().to_string()
    };
    let zero = (Vec3::zeros(), Vec3::zeros());
    assert!(refused(|p| p.substrate.compliance = -1.0).starts_with("compliance_m_per_N is -1"));
    assert!(refused(|p| p.substrate.friction_drift = f64::NAN).starts_with("friction_drift_per_s"));
    assert!(refused(|p| p.side_incline = f64::NAN).starts_with("side_incline_deg"));
    assert!(refused(|p| p.surroundings.force.x = f64::INFINITY).starts_with("force_N"));
    assert!(refused(|p| p.surroundings.translational_drag = -1.0).starts_with("translational_drag_N_s_per_m"));
    assert!(refused(|p| p.surroundings.rotational_drag = -1.0).starts_with("rotational_drag_N_m_s"));
    assert!(refused(|p| p.surroundings.sheet_conductance = -1.0).starts_with("sheet_conductance_S"));
    assert!(refused(|p| p.surroundings.times = Arc::new([0.0])).starts_with("wrench_N_N_m has 0 entries"));
    let mut parts = in_the_air(cuboid());
    parts.surroundings.times = Arc::new([0.1, 0.1]);
    parts.surroundings.wrenches = Arc::new([zero, zero]);
    assert!(Trial::new(parts).unwrap_err().to_string().starts_with("row 2 of wrench_time_s"));
    assert!(Relief::new(0.0, &[], &[]).is_err() && Relief::new(1.0, &[0.1], &[]).is_err());
    assert!(Relief::new(1.0, &[f64::NAN], &[0.0]).is_err());
    assert!(rotating(0.01, 1.0).with_quadrature(-0.1, 0.0).is_err());
    assert!(rotating(0.01, 1.0).with_quadrature(1.0, f64::NAN).is_err());
    let robot = Robot::new(Arc::new(cuboid()), MASS, Vec3::zeros()).unwrap();
    assert!(robot.stability_bound(0.0).is_infinite());
}
