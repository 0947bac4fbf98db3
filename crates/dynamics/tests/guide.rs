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

/// `y(t) = ŷ + (y(0) - ŷ) e^(-γt)`, and nothing else moves.
#[test]
fn what_rests_is_drawn_to_its_guide() {
    for (place, rate) in [(1e-3, 1.0), (-4e-4, 20.0), (2e-5, 100.0)] {
        let guide = Guide::new(&[0.0, 1.0], &[place, place], Vec3::zeros(), rate).unwrap();
        let trial = Trial::new(in_the_air()).unwrap().guided(guide);
        let stepper = end_of(&trial);
        let expected = -place * (-rate * stepper.time()).exp_m1();
        let position = stepper.state().position;
        // Rounding, once a step.
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
fn between_its_rows_a_guide_is_linear_and_where_nothing_was_seen_there_is_none() {
    let nan = f64::NAN;
    let guide =
        Guide::new(&[1.0, 2.0, 4.0, 5.0, 6.0, 7.0], &[0.0, 1.0, -1.0, nan, 3.0, 4.0], Vec3::zeros(), 1.0).unwrap();
    for (t, place) in [(1.0, 0.0), (1.5, 0.5), (2.0, 1.0), (3.0, 0.0), (4.0, -1.0), (6.0, 3.0), (6.5, 3.5), (7.0, 4.0)]
    {
        assert_eq!(guide.at(t), Some(place), "{t}");
    }
    for t in [0.0, 4.5, 5.0, 5.5, 7.5] {
        assert_eq!(guide.at(t), None, "{t}");
    }
    let state = *Trial::new(in_the_air()).unwrap().initial();
    assert!((guide.shift(&state, 2.0, STEP) - (1.0 - (-STEP).exp())).abs() < 1e-15);
    assert_eq!(guide.shift(&state, 4.5, STEP), 0.0);
}

#[test]
fn a_guide_that_leads_nowhere_is_refused() {
    let refused =
        |times: &[f64], places: &[f64], rate: f64| Guide::new(times, places, Vec3::zeros(), rate).unwrap_err();
    assert_eq!(refused(&[0.0], &[0.0], 0.0), Invalid::NotPositive { name: "rate_per_s", found: 0.0 });
    assert_eq!(refused(&[], &[], 1.0), Invalid::NoGuide);
    assert_eq!(refused(&[0.0], &[], 1.0), Invalid::Lengths { name: "y_m", found: 0, expected: 1 });
    assert_eq!(refused(&[0.0, 0.0], &[0.0, 0.0], 1.0), Invalid::GuideOrder { row: 2, found: 0.0, before: 0.0 });
    assert!(matches!(refused(&[0.0], &[f64::INFINITY], 1.0), Invalid::NotFinite { name: "y_m", .. }));
    let beside = Guide::new(&[0.0], &[0.0], Vec3::new(0.0, f64::NAN, 0.0), 1.0);
    assert!(matches!(beside.unwrap_err(), Invalid::NotFinite { name: "point_m", .. }));
}
