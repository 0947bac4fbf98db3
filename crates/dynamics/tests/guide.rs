//! Runs that are drawn to where a body was seen.

mod common;

use common::*;
use nalgebra::UnitQuaternion;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{Guide, Invalid, SolverKind, State, Stepper, Trial, Vec3};

const STEP: f64 = 5e-4;

fn in_the_air() -> TrialParts {
    TrialParts {
        position: Some(Vec3::new(0.0, 0.0, 0.01)),
        gravity: 0.0,
        duration: 0.01,
        ..passive(cuboid(), 3.78e-8, smooth(0.3))
    }
}

fn end_of(trial: &Trial) -> Stepper<'_> {
    let mut stepper = Stepper::new(trial, SolverKind::Reduced);
    for _ in 0..trial.steps() {
        stepper.advance();
    }
    stepper
}

/// `y(t_k) = ŷ + (y(0) - ŷ) e^(-γ (t_k - t_0))`, and nothing else moves.
#[test]
fn what_rests_is_drawn_to_its_guide() {
    for (place, rate) in [(1e-3, 1.0), (-4e-4, 20.0), (2e-5, 100.0)] {
        // Not at the ends of steps.
        let times = [0.0, 0.0012, 0.0047, 0.0081];
        let guide = Guide::new(&times, &[place; 4], Vec3::zeros(), rate).unwrap();
        let trial = Trial::new(in_the_air()).unwrap().guided(guide);
        let stepper = end_of(&trial);
        let expected = -place * (-rate * 0.0081_f64).exp_m1();
        let position = stepper.state().position;
        // Rounding, once a frame.
        assert!((position.y - expected).abs() < 200.0 * f64::EPSILON * place.abs(), "{} {}", position.y, expected);
        assert_eq!((position.x, position.z), (0.0, 0.01));
        assert_eq!(stepper.state().linear, Vec3::zeros());
    }
}

/// A model that is right is drawn nowhere.
#[test]
fn along_its_own_way_a_run_is_what_it_is_without_a_guide() {
    let trial = Trial::new(cuboid_on_paper(0.01, 10.0)).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    let (mut times, mut places) = (vec![0.0], vec![stepper.state().position.y]);
    for _ in 0..trial.steps() {
        stepper.advance();
        times.push(stepper.time());
        places.push(stepper.state().position.y);
    }
    assert!(places.iter().any(|y| y.abs() > 1e-4), "it moves");
    let guided = trial.clone().guided(Guide::new(&times, &places, Vec3::zeros(), 50.0).unwrap());
    let end = *end_of(&guided).state();
    assert!((end.position - stepper.state().position).norm() < 1e-12);
    assert!((end.orientation.coords - stepper.state().orientation.coords).norm() < 1e-12);
}

/// The same for a point that goes round the centre of mass.
#[test]
fn a_point_beside_the_centre_of_mass_is_drawn_along_its_own_way() {
    let point = Vec3::new(0.0, 1.5e-4, -6e-5);
    let trial = Trial::new(cuboid_on_paper(0.01, 10.0)).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    let seen = |state: &State| state.position.y + (UnitQuaternion::new_unchecked(state.orientation) * point).y;
    let (mut times, mut places) = (vec![0.0], vec![seen(stepper.state())]);
    for _ in 0..trial.steps() {
        stepper.advance();
        times.push(stepper.time());
        places.push(seen(stepper.state()));
    }
    let free = *stepper.state();
    let off = |guide| (end_of(&trial.clone().guided(guide)).state().position - free.position).norm();
    assert!(off(Guide::new(&times, &places, point, 50.0).unwrap()) < 1e-12);
    assert!(off(Guide::new(&times, &places, Vec3::zeros(), 50.0).unwrap()) > 1e-5);
}

#[test]
fn a_body_is_drawn_at_each_frame_by_as_much_as_time_has_passed_since_the_last() {
    let guide = Guide::new(&[1.0, 2.0, 4.0, 4.0 + 0.1 * STEP], &[7.0, 1.0, 5.0, -1.0], Vec3::zeros(), 0.5).unwrap();
    let at = |t: f64| guide.shift([0.0, 0.0], [t - STEP, t]);
    // Nothing at the first frame, between frames and after the last.
    for t in [0.5, 1.0, 1.5, 3.9, 4.0 + 2.0 * STEP, 9.0] {
        assert_eq!(at(t), 0.0, "{t}");
    }
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    near(at(2.0), 1.0 - (-0.5_f64).exp());
    near(at(4.0), 5.0 * (1.0 - (-1.0_f64).exp()));
    // Of two in one step the last.
    near(at(4.0 + 0.5 * STEP), (-0.05 * STEP).exp() - 1.0);
    // A frame within a step: there the point had gone a quarter of its way, to where it was seen.
    near(guide.shift([0.5, 2.5], [2.0 - 0.25 * STEP, 2.0 + 0.75 * STEP]), 0.0);
}

#[test]
fn a_guide_that_leads_nowhere_is_refused() {
    let refused =
        |times: &[f64], places: &[f64], rate: f64| Guide::new(times, places, Vec3::zeros(), rate).unwrap_err();
    assert_eq!(refused(&[0.0], &[0.0], 0.0), Invalid::NotPositive { name: "rate_per_s", found: 0.0 });
    assert_eq!(refused(&[], &[], 1.0), Invalid::NoGuide);
    assert_eq!(refused(&[0.0], &[], 1.0), Invalid::Lengths { name: "y_m", found: 0, expected: 1 });
    assert_eq!(refused(&[0.0, 0.0], &[0.0, 0.0], 1.0), Invalid::GuideOrder { row: 2, found: 0.0, before: 0.0 });
    assert!(matches!(refused(&[0.0], &[f64::NAN], 1.0), Invalid::NotFinite { name: "y_m", .. }));
    let beside = Guide::new(&[0.0], &[0.0], Vec3::new(0.0, f64::NAN, 0.0), 1.0);
    assert!(matches!(beside.unwrap_err(), Invalid::NotFinite { name: "point_m", .. }));
}
