//! Fuzz of the step: random bodies, parameters over twelve orders of magnitude, fields, slopes, steps and starts.
//!
//! No panic, no number that is not finite, no step that fails without saying so, no energy from contact, no penetration:
//! see [`invariants`]. A small part runs always; `make fuzz` runs all of it. A failure says which seed it was; then
//! `TUMBLERS_FUZZ_CASE=<seed>` runs that case alone, and what is found becomes a test of its own in [`found`].

#[path = "../common/mod.rs"]
mod common;

mod case;
mod found;
mod invariants;
mod random;
mod shape;
mod unverified;

use case::{Case, TAME};
use invariants::{Came, Watch};
use rayon::prelude::*;
use std::env;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};
use tumblers_dynamics::{SolverKind, Stepper};

/// Seeds are taken in turn from a first one that is far from that of another run.
const SEEDS_APART: u64 = 1 << 40;
/// Cases between two looks at the number of steps; the same on any number of threads.
const AT_ONCE: u64 = 16;
/// A case that has failed to converge so often says nothing new and takes long: where no support is found from the step
/// before, every support and every surface is tried.
const ENOUGH_UNCONVERGED: u64 = 1;
/// Among many cases one may take no longer.
const ENOUGH_TIME: Duration = Duration::from_secs(3);
/// The most points of a hull, and fewer where the fuzz has to be quick.
const MOST_POINTS: usize = 60;
const FEW_POINTS: usize = 14;
/// Of the steps of robots as they may be, one in so many may have no solution: a quarter of the shapes are next to degenerate.
const TAME_PER_UNCONVERGED: u64 = 1000;
/// One case in so many may have steps that are loose; one in ninety has. Not one step in so many: a body that falls on
/// the same rim again and again has more than a hundred of them, half of those of two million steps.
const CASES_PER_LOOSE: u64 = 50;
const MOST_FAILURES: usize = 10;
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// What came of many steps.
#[derive(Debug, Default, Clone)]
struct Tally {
    cases: u64,
    refused: u64,
    steps: u64,
    unconverged: u64,
    diverged: u64,
    loose: u64,
    loose_cases: u64,
    tame_loose: u64,
    touching: u64,
    tame_steps: u64,
    tame_unconverged: u64,
    slowest: Duration,
    failures: Vec<String>,
}

impl Tally {
    fn and(mut self, other: Self) -> Self {
        self.cases += other.cases;
        self.refused += other.refused;
        self.steps += other.steps;
        self.unconverged += other.unconverged;
        self.diverged += other.diverged;
        self.loose += other.loose;
        self.loose_cases += other.loose_cases;
        self.tame_loose += other.tame_loose;
        self.touching += other.touching;
        self.tame_steps += other.tame_steps;
        self.tame_unconverged += other.tame_unconverged;
        self.slowest = self.slowest.max(other.slowest);
        self.failures.extend(other.failures);
        self
    }

    fn line(&self) -> String {
        format!(
            "fuzz: {} steps of {} cases ({} refused), {} touching, {} unconverged ({} of {} tame), {} diverged, \
             {} loose ({} of them tame, in {} cases), the slowest in {:.3} s, {} failures",
            self.steps,
            self.cases,
            self.refused,
            self.touching,
            self.unconverged,
            self.tame_unconverged,
            self.tame_steps,
            self.diverged,
            self.loose,
            self.tame_loose,
            self.loose_cases,
            self.slowest.as_secs_f64(),
            self.failures.len()
        )
    }
}

/// Runs the case of a seed; a failure is a line, with the seed and the case.
fn run(seed: u64, most_points: usize, longest: Duration) -> Tally {
    let mut tally = Tally { cases: 1, ..Tally::default() };
    let mut at = None;
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        let Ok(case) = Case::new(seed, most_points) else {
            tally.refused = 1;
            return Ok(());
        };
        let case = at.insert(case);
        let mut stepper = Stepper::new(&case.trial, SolverKind::Reduced);
        let mut watch = Watch::new(&case.trial);
        let since = Instant::now();
        while tally.steps < case.trial.steps() && tally.unconverged < ENOUGH_UNCONVERGED && since.elapsed() < longest {
            let begun = Instant::now();
            let came = watch.step(&mut stepper).map_err(|what| format!("step {}: {what}", tally.steps))?;
            tally.slowest = tally.slowest.max(begun.elapsed());
            tally.steps += 1;
            tally.touching += u64::from(stepper.solution().normal > 0.0);
            tally.loose += u64::from(came == Came::Loose);
            tally.unconverged += u64::from(matches!(came, Came::Unconverged | Came::Diverged));
            if came == Came::Diverged {
                tally.diverged += 1;
                break;
            }
        }
        if case.wildness == TAME {
            (tally.tame_steps, tally.tame_unconverged) = (tally.steps, tally.unconverged);
            tally.tame_loose = tally.loose;
        }
        tally.loose_cases = u64::from(tally.loose > 0);
        Ok(())
    }));
    let failure = match outcome {
        Ok(Ok(())) => None,
        Ok(Err(what)) => Some(what),
        Err(_) => Some(format!("step {}: a panic", tally.steps)),
    };
    tally.failures.extend(failure.map(|what| {
        let case = at.map_or_else(|| "no case".to_owned(), |case| case.to_string());
        format!("TUMBLERS_FUZZ_CASE={seed} TUMBLERS_FUZZ_POINTS={most_points}: {what}, in {case}")
    }));
    tally
}

/// Runs cases from the seed `first` on until `steps` steps are done, and fails with all that was found.
fn fuzz(first: u64, steps: u64, most_points: usize) {
    let begun = Instant::now();
    let mut due = begun + BETWEEN_LINES;
    let mut tally = Tally::default();
    let mut next = first.wrapping_mul(SEEDS_APART);
    while tally.steps < steps && tally.failures.len() < MOST_FAILURES {
        let seeds = next..next + AT_ONCE;
        let found: Vec<Tally> = seeds.into_par_iter().map(|seed| run(seed, most_points, ENOUGH_TIME)).collect();
        tally = found.into_iter().fold(tally, Tally::and);
        next += AT_ONCE;
        if Instant::now() >= due {
            due = Instant::now() + BETWEEN_LINES;
            tell(&format!("{} in {:.0} s", tally.line(), begun.elapsed().as_secs_f64()));
        }
    }
    if begun.elapsed() > BETWEEN_LINES {
        tell(&format!("{} in {:.0} s", tally.line(), begun.elapsed().as_secs_f64()));
    }
    assert!(tally.failures.is_empty(), "{}\n{}", tally.line(), tally.failures.join("\n"));
    // A fuzz that never touches the ground, or never converges, would find nothing.
    assert!(4 * tally.touching > tally.steps, "{}", tally.line());
    assert!(TAME_PER_UNCONVERGED * tally.tame_unconverged <= tally.tame_steps, "{}", tally.line());
    assert!(CASES_PER_LOOSE * tally.loose_cases <= tally.cases, "{}", tally.line());
}

/// On standard error past the test harness, which would keep it to the end.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn number(name: &str, default: u64) -> u64 {
    let Ok(text) = env::var(name) else { return default };
    text.parse().unwrap_or_else(|_| panic!("{name} is {text:?}, expected a whole number"))
}

#[test]
fn ten_thousand_random_steps_hold() {
    fuzz(0, 10_000, FEW_POINTS);
}

/// `TUMBLERS_FUZZ_STEPS` steps from `TUMBLERS_FUZZ_SEED`, or the one case of `TUMBLERS_FUZZ_CASE`.
#[test]
#[ignore = "ten million steps: make fuzz"]
fn random_steps_hold() {
    if env::var("TUMBLERS_FUZZ_CASE").is_ok() {
        let tally = run(
            number("TUMBLERS_FUZZ_CASE", 0),
            number("TUMBLERS_FUZZ_POINTS", MOST_POINTS as u64) as usize,
            Duration::MAX,
        );
        tell(&tally.line());
        assert!(tally.failures.is_empty(), "{}", tally.failures.join("\n"));
    } else {
        fuzz(number("TUMBLERS_FUZZ_SEED", 1), number("TUMBLERS_FUZZ_STEPS", 10_000_000), MOST_POINTS);
    }
}
