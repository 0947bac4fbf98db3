//! Steps that take the reduced problem on its word against steps that hold it against the unreduced one.

use crate::case::{Case, TAME};
use crate::{FEW_POINTS, SEEDS_APART};
use tumblers_dynamics::{SolverKind, State, Stepper};

const CASES: u64 = 400;
const STEPS: u64 = 60;
/// Of two generators that are nearly one the unreduced problem may be loose where the reduced one is not: solved again,
/// the step differs by no more than this, over its velocity.
const LOOSE: f64 = 1e-6;
/// Of a body without weight that slides on a face with no force, over `m|v|`, another solution is as right.
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
        let size = case.trial.robot().body().size();
        let mut verified = Stepper::new(&case.trial, SolverKind::Reduced);
        for step in 0..STEPS.min(case.trial.steps()) {
            let mut unverified = verified.clone().with_solver(SolverKind::Unverified);
            let converged = verified.advance().converged;
            unverified.advance();
            let solution = unverified.solution();
            steps += 1;
            if solution.residual.is_nan() {
                taken += 1;
                assert!(solution.plane_multiplier.is_nan() && solution.multipliers.iter().all(|l| l.is_nan()));
            }
            if bits(unverified.state()) != bits(verified.state()) {
                loose += 1;
                let (one, other) = (unverified.state(), verified.state());
                let apart = (one.linear - other.linear).norm() + size * (one.angular - other.angular).norm();
                let speed = other.linear.norm() + size * other.angular.norm();
                let forceless = solution.normal.abs() < NO_FORCE * case.trial.robot().mass() * speed;
                assert!(forceless || apart < LOOSE * speed, "seed {seed}, step {step}: {apart} of {speed} m/s, {case}");
            }
            if !converged || !solution.converged {
                break;
            }
        }
    }
    assert!(100 * taken > 99 * steps, "{taken} of {steps} steps were taken on their word");
    assert!(STEPS_PER_LOOSE * loose <= steps, "{loose} of {steps} steps differ");
}
