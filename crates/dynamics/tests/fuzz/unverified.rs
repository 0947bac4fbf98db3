//! Steps that take the reduced problem on its word against steps that hold it against the unreduced one.

use crate::case::{Case, TAME};
use crate::{FEW_POINTS, SEEDS_APART};
use geometry::Support;
use tumblers_dynamics::{SolverKind, State, Stepper};

const CASES: u64 = 400;
const STEPS: u64 = 60;
/// Of two generators that are nearly one the unreduced problem may be loose where the reduced one is not: solved again,
/// the step differs by no more than this, over its velocity.
const LOOSE: f64 = 1e-6;
/// Of a body without weight on a face another solution is as right where this one presses with less, over `m|v|`.
const NO_FORCE: f64 = 1e-12;
/// One step in so many may do either at most.
const STEPS_PER_LOOSE: u64 = 500;

fn bits(state: &State) -> Vec<u64> {
    let State { position, orientation, linear, angular } = state;
    let vectors = [position, linear, angular].into_iter().flatten();
    vectors.chain(orientation.coords.iter()).map(|x| x.to_bits()).collect()
}

/// As robots may be, from one state after another.
#[test]
fn what_is_taken_on_its_word_would_have_been_verified() {
    let seeds = (0..).map(|i| 7 * SEEDS_APART + i);
    let cases = seeds.filter_map(|seed| Some((seed, Case::new(seed, FEW_POINTS).ok()?)));
    let (mut taken, mut loose, mut steps) = (0, 0, 0);
    for (seed, case) in cases.filter(|(_, case)| case.wildness == TAME).take(CASES as usize) {
        let robot = case.trial.robot();
        let weightless = case.trial.load(None).norm() == 0.0;
        let mut verified = Stepper::new(&case.trial, SolverKind::Reduced);
        for step in 0..STEPS.min(case.trial.steps()) {
            let mut unverified = verified.clone().with_solver(SolverKind::Unverified);
            verified.advance();
            unverified.advance();
            let (word, held) = (unverified.solution(), verified.solution());
            steps += 1;
            if word.residual.is_nan() {
                taken += 1;
                assert!(word.plane_multiplier.is_nan() && word.multipliers.iter().all(|l| l.is_nan()));
            }
            if bits(unverified.state()) != bits(verified.state()) {
                loose += 1;
                let apart =
                    (word.linear - held.linear).norm() + robot.body().size() * (word.angular - held.angular).norm();
                let speed = held.linear.norm() + robot.body().size() * held.angular.norm();
                let on_a_face = matches!(word.support, Support::Face(_));
                let forceless = weightless && on_a_face && word.normal.abs() < NO_FORCE * robot.mass() * speed;
                assert!(forceless || apart < LOOSE * speed, "seed {seed}, step {step}: {apart} of {speed} m/s, {case}");
            }
            if !held.converged {
                // What the verified step calls no solution is called one on its word, where that is loose.
                loose += u64::from(word.converged);
                break;
            }
        }
    }
    assert!(100 * taken > 99 * steps, "{taken} of {steps} steps were taken on their word");
    assert!(STEPS_PER_LOOSE * loose <= steps, "{loose} of {steps} steps differ");
}

/// However wild: no number that is not finite without a word.
#[test]
fn wild_steps_on_their_word_stay_finite_or_say_so() {
    let seeds = (0..).map(|i| 8 * SEEDS_APART + i);
    for case in seeds.filter_map(|seed| Case::new(seed, FEW_POINTS).ok()).take(CASES as usize) {
        let mut stepper = Stepper::new(&case.trial, SolverKind::Unverified);
        for _ in 0..STEPS.min(case.trial.steps()) {
            let converged = stepper.advance().converged;
            assert!(stepper.is_finite() || !converged, "{case}");
            if !converged {
                break;
            }
        }
    }
}
