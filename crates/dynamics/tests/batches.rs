//! Batches: the same bits for any number of threads, the poses that a recording has but for the sign of the quaternions, and a
//! stop that is heard.

mod common;

use common::*;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;
use tumblers_dynamics::batch::{Control, Outcome, Until, rollouts, sweep};
use tumblers_dynamics::recording::record;
use tumblers_dynamics::rollout::Rollout;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{Metrics, SolverKind, Stepper, Trial, Vec3};

fn trials() -> Vec<Trial> {
    (0..12).map(|i| Trial::new(pdms(spiked(f64::from(i)), 10.0, 30.0 * f64::from(i))).unwrap()).collect()
}

fn bits(outcome: &Outcome<Metrics>) -> [u64; 5] {
    let Outcome::Done(Metrics { twist, drift, speed, max_residual, newton_iterations, .. }) = outcome else {
        panic!("{outcome:?}")
    };
    [twist.to_bits(), drift.to_bits(), speed.to_bits(), max_residual.to_bits(), *newton_iterations]
}

#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let trials = trials();
    let run = |threads| -> Vec<_> { sweep(&trials, threads, &Control::default()).unwrap().iter().map(bits).collect() };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(4));
}

#[test]
fn a_stopped_batch_says_so() {
    let control = Control::default();
    control.stop.store(true, Ordering::Relaxed);
    let outcomes = sweep(&trials(), 2, &control).unwrap();
    assert!(outcomes.iter().all(|outcome| *outcome == Outcome::Stopped));
    assert_eq!(control.finished.load(Ordering::Relaxed), outcomes.len());
}

/// Robots on the level and with every term that the paper does not have, and how often their poses are kept.
fn walks() -> (Vec<Trial>, Vec<u64>) {
    let parts = [
        cuboid_on_paper(0.01, 5.0),
        disturbed(cuboid_on_paper(0.01, 2.0)),
        pdms(spiked(2.0), 10.0, 90.0),
        disturbed(pdms(spiked_ends(0.0), 0.0, 0.0)),
    ];
    (parts.into_iter().map(|parts| Trial::new(parts).unwrap()).collect(), vec![1, 7, 4, 200])
}

fn walked(outcomes: Vec<Outcome<Rollout>>) -> Vec<Rollout> {
    let done = outcomes.into_iter().map(|outcome| match outcome {
        Outcome::Done(rollout) => rollout,
        other => panic!("{other:?}"),
    });
    done.collect()
}

fn pose_bits(position: &[[f64; 3]], orientation: &[[f64; 4]]) -> Vec<u64> {
    position.iter().flatten().chain(orientation.iter().flatten()).map(|x| x.to_bits()).collect()
}

#[test]
fn a_rollout_has_the_poses_of_a_recording() {
    let (trials, every) = walks();
    let rollouts =
        walked(rollouts(&trials, &every, Until::End, SolverKind::Unverified, 2, &Control::default()).unwrap());
    for ((trial, every), rollout) in trials.iter().zip(every).zip(rollouts) {
        let (recording, _) = record(trial, SolverKind::Reduced, every, |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(rollout.time, recording.time);
        assert_eq!(rollout.contact_mode, recording.contact_mode);
        assert_eq!(
            pose_bits(&rollout.position, &rollout.orientation),
            pose_bits(&recording.position, &recording.orientation)
        );
        assert_eq!(rollout.unconverged_steps, 0);
    }
}

#[test]
fn a_run_of_steps_on_their_word_has_the_same_poses_and_no_residual() {
    let (trials, every) = walks();
    let run = |kind| walked(rollouts(&trials, &every, Until::End, kind, 2, &Control::default()).unwrap());
    assert_eq!(run(SolverKind::Unverified), run(SolverKind::Reduced));
    for trial in &trials {
        let recorded = |kind| record(trial, kind, 1, |_| ControlFlow::Continue(())).unwrap();
        let ((word, word_metrics), (held, held_metrics)) =
            (recorded(SolverKind::Unverified), recorded(SolverKind::Reduced));
        assert_eq!(word.position, held.position);
        assert!(word.residual[1..].iter().all(|residual| residual.is_nan()));
        // However many steps follow.
        assert!(word_metrics.max_residual.is_nan());
        assert!(held_metrics.max_residual <= 1e-10);
        assert_eq!(word_metrics.speed, held_metrics.speed);
    }
}

#[test]
fn the_poses_do_not_depend_on_the_threads() {
    let (trials, every) = walks();
    let run = |threads| -> Vec<_> {
        let rollouts = walked(
            rollouts(&trials, &every, Until::End, SolverKind::Unverified, threads, &Control::default()).unwrap(),
        );
        rollouts.iter().map(|rollout| pose_bits(&rollout.position, &rollout.orientation)).collect()
    };
    assert_eq!(run(1), run(4));
}

#[test]
fn the_rows_of_a_rollout_have_one_sign_however_far_the_body_turns_between_them() {
    let trial = Trial::new(TrialParts { duration: 0.3, ..cuboid_on_paper(0.01, 10.0) }).unwrap();
    // 0.6 of a turn.
    let every = 120;
    let (recording, _) = record(&trial, SolverKind::Reduced, every, |_| ControlFlow::Continue(())).unwrap();
    let control = Control::default();
    let rollout =
        walked(rollouts(&[trial], &[every], Until::End, SolverKind::Unverified, 1, &control).unwrap()).remove(0);
    let alike = |rows: &[[f64; 4]]| -> Vec<bool> {
        rows.windows(2).map(|pair| (0..4).map(|i| pair[0][i] * pair[1][i]).sum::<f64>() >= 0.0).collect()
    };
    assert!(alike(&recording.orientation).contains(&false));
    assert!(!alike(&rollout.orientation).contains(&false));
    for (row, recorded) in rollout.orientation.iter().zip(&recording.orientation) {
        assert!(row == recorded || row.map(|x| -x) == *recorded);
    }
}

#[test]
fn outcomes_are_in_the_order_of_their_trials_however_long_they_are() {
    let durations = [0.02, 0.1, 0.05];
    let trials = durations.map(|duration| Trial::new(TrialParts { duration, ..cuboid_on_paper(0.01, 5.0) }).unwrap());
    for threads in [1, 3] {
        let control = Control::default();
        let found = walked(rollouts(&trials, &[1; 3], Until::End, SolverKind::Unverified, threads, &control).unwrap());
        assert_eq!(found.iter().map(|rollout| rollout.time.len()).collect::<Vec<_>>(), [41, 201, 101]);
    }
}

#[test]
fn a_diverging_trial_leaves_what_was_finite() {
    let mut parts = cuboid_on_paper(0.01, 5.0);
    // From the second half on a force that no velocity can hold.
    parts.surroundings.times = std::sync::Arc::new([0.05]);
    parts.surroundings.wrenches = std::sync::Arc::new([(Vec3::new(0.0, 0.0, 1e305), Vec3::zeros())]);
    let trial = Trial::new(parts).unwrap();
    let rollout =
        walked(rollouts(&[trial], &[1], Until::End, SolverKind::Unverified, 1, &Control::default()).unwrap()).remove(0);
    let rows = rollout.time.len();
    assert!((100..200).contains(&rows), "{rows} rows");
    assert!(rollout.position.iter().flatten().all(|x| x.is_finite()));
    assert!(rollout.orientation.iter().flatten().all(|x| x.is_finite()));
    assert_eq!([rollout.position.len(), rollout.orientation.len(), rollout.contact_mode.len()], [rows; 3]);
}

#[test]
fn a_rollout_ends_where_a_step_does_not_show_the_spin() {
    let mut parts = cuboid_on_paper(0.01, 5.0);
    // From the second half on a moment that soon turns it by more than a right angle in a step.
    parts.surroundings.times = std::sync::Arc::new([0.05]);
    parts.surroundings.wrenches = std::sync::Arc::new([(Vec3::zeros(), Vec3::new(0.0, 0.0, 1e-3))]);
    let trial = Trial::new(parts).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    let resolved = (0..trial.steps()).take_while(|_| {
        stepper.advance();
        stepper.is_resolved()
    });
    let rows = 1 + resolved.count();
    assert!((100..200).contains(&rows), "{rows} rows");
    let seen = |until| {
        walked(
            rollouts(std::slice::from_ref(&trial), &[1], until, SolverKind::Unverified, 1, &Control::default())
                .unwrap(),
        )
        .remove(0)
    };
    let (whole, ended) = (seen(Until::End), seen(Until::Unresolved));
    assert_eq!([whole.time.len(), ended.time.len()], [trial.steps() as usize + 1, rows]);
    assert_eq!(
        pose_bits(&ended.position, &ended.orientation),
        pose_bits(&whole.position[..rows], &whole.orientation[..rows])
    );
}

#[test]
fn stopped_rollouts_say_so() {
    let (trials, every) = walks();
    let control = Control::default();
    control.stop.store(true, Ordering::Relaxed);
    let outcomes = rollouts(&trials, &every, Until::End, SolverKind::Unverified, 2, &control).unwrap();
    assert!(outcomes.iter().all(|outcome| *outcome == Outcome::Stopped));
}
