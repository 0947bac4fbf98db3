//! Runs in which another trial takes over for a while.

mod common;

use common::*;
use nalgebra::UnitQuaternion;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{Adhesion, Interlude, Invalid, Relief, Robot, SolverKind, State, Stepper, Substrate, Trial};

/// The states after every step.
fn states(trial: &Trial) -> Vec<State> {
    let mut stepper = Stepper::new(trial, SolverKind::Reduced);
    (0..trial.steps())
        .map(|_| {
            stepper.advance();
            *stepper.state()
        })
        .collect()
}

/// Two trials of one body, the second on a substrate that holds on more, in a weaker field.
fn both() -> (TrialParts, TrialParts) {
    let parts = cuboid_on_paper(0.01, 10.0);
    let substrate = Substrate { adhesion: 30.0, electrostatic_force: 1e-6, ..parts.substrate };
    // The robot's clone shares its body.
    let other = TrialParts { substrate, field: rotating(0.004, 10.0), ..parts.clone() };
    (parts, other)
}

fn with(parts: TrialParts, other: TrialParts, edges: &[f64]) -> Result<Trial, Invalid> {
    Trial::new(parts)?.with_interlude(Interlude::new(Trial::new(other)?, edges)?)
}

#[test]
fn where_the_same_takes_over_nothing_changes() {
    let (parts, _) = both();
    let alone = states(&Trial::new(parts.clone()).unwrap());
    assert_eq!(states(&with(parts.clone(), parts, &[0.01, 0.05]).unwrap()), alone);
}

#[test]
fn without_an_edge_nothing_takes_over_and_from_an_edge_at_the_start_all_is_the_others() {
    let (parts, other) = both();
    let alone = [&parts, &other].map(|parts| states(&Trial::new(parts.clone()).unwrap()));
    assert_ne!(alone[0], alone[1]);
    assert_eq!(states(&with(parts.clone(), other.clone(), &[]).unwrap()), alone[0]);
    assert_eq!(states(&with(parts, other, &[0.0]).unwrap()), alone[1]);
}

/// The moment is among what another trial brings along.
#[test]
fn a_weaker_moment_takes_over_too() {
    let (parts, _) = both();
    let robot = Robot::new(parts.robot.shared_body().clone(), parts.robot.mass(), 0.2 * parts.robot.moment()).unwrap();
    let weaker = TrialParts { robot, ..parts.clone() };
    let alone = states(&Trial::new(weaker.clone()).unwrap());
    assert_ne!(states(&Trial::new(parts.clone()).unwrap()), alone);
    assert_eq!(states(&with(parts, weaker, &[0.0]).unwrap()), alone);
}

/// Steps of either trial, one stepper after another, as a walk makes them.
#[test]
fn each_step_is_of_the_trial_in_whose_time_it_begins() {
    let (parts, other) = both();
    let (here, there) = (Trial::new(parts.clone()).unwrap(), Trial::new(other.clone()).unwrap());
    let h = parts.step;
    // Within a step, at its beginning, and open at the end.
    let edges = [10.4 * h, 30.0 * h, 45.0 * h];
    let within = |step: u64| (11..30).contains(&step) || step >= 45;
    let found = states(&with(parts, other, &edges).unwrap());

    let first = Stepper::new(&here, SolverKind::Reduced);
    let (mut state, mut adhesion, mut support) = (*first.state(), *first.adhesion(), here.initial_support());
    for step in 0..here.steps() {
        let trial = if within(step) { &there } else { &here };
        let mut one = Stepper::from_state(trial, SolverKind::Reduced, state, step, adhesion, support);
        one.advance();
        (state, support) = (*one.state(), one.solution().support);
        let next = if within(step + 1) { &there } else { &here };
        // The adhesion that the next step feels is that of the trial which makes it.
        let patch = &one.solution().patch;
        let centroid = state.position + UnitQuaternion::new_unchecked(state.orientation) * patch.centroid;
        let touches = one.solution().normal > 0.0;
        adhesion = if touches { Adhesion::of_patch(next.substrate(), patch, h, centroid) } else { Adhesion::none() };
        let off = (found[step as usize].position - state.position).norm();
        assert!(off < 1e-12, "{step}: {off}");
    }
}

#[test]
fn an_interlude_that_cannot_be_is_refused() {
    let (parts, other) = both();
    let refused = |other: TrialParts, edges: &[f64]| with(parts.clone(), other, edges).unwrap_err();
    assert_eq!(refused(other.clone(), &[0.1, 0.1]), Invalid::EdgeOrder { row: 2, found: 0.1, before: 0.1 });
    assert!(matches!(refused(other.clone(), &[f64::NAN]), Invalid::NotFinite { name: "edges_s", .. }));
    let slower = TrialParts { step: 0.5 * other.step, ..other.clone() };
    assert_eq!(refused(slower, &[0.1]), Invalid::OtherTrial { what: "step_s" });
    let relief = Relief::new(2e-3, &[1e-6], &[0.0]).unwrap();
    let rough = TrialParts { relief, ..other.clone() };
    assert_eq!(refused(rough, &[0.1]), Invalid::OtherTrial { what: "relief" });
    let nested = with(other.clone(), other.clone(), &[0.0]).unwrap();
    let twice = Trial::new(parts.clone()).unwrap().with_interlude(Interlude::new(nested, &[0.0]).unwrap());
    assert_eq!(twice.unwrap_err(), Invalid::NotAlone);
    let robot = Robot::new(std::sync::Arc::new(spiked(0.0)), other.robot.mass(), *other.robot.moment()).unwrap();
    assert_eq!(refused(TrialParts { robot, ..other }, &[0.1]), Invalid::OtherTrial { what: "body" });
}
