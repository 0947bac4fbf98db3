//! Time of a step, by contact mode, and Newton iterations per step.

use criterion::{Criterion, criterion_group, criterion_main};
use dynamics::{SolverKind, Stepper, Trial};
use geometry::ContactMode;
use tumblers_benches::{Shape, cuboid_in_the_air, cuboid_on_paper, in_mode, pdms};

/// One step again and again from copies of the same state; making the copy is not part of the time.
fn by_contact_mode(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    let cuboid = cuboid_on_paper(5.0);
    let flying = cuboid_in_the_air(5.0);
    let drafted = pdms(Shape::Spiked, 4.0, 10.0, 0.0);
    let cases = [
        ("airborne", &flying, ContactMode::Airborne),
        ("point", &drafted, ContactMode::Point),
        ("line", &cuboid, ContactMode::Line),
        ("surface", &cuboid, ContactMode::Surface),
    ];
    for (name, trial, mode) in cases {
        let start = in_mode(trial, mode, 0.02);
        eprintln!("{name}: {} Newton iterations", start.clone().advance().iterations);
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(
                || start.clone(),
                |stepper| stepper.advance().residual,
                criterion::BatchSize::SmallInput,
            );
        });
    }
    group.finish();
}

/// A whole run of 2000 steps, transitions included, verified and as the rollouts of a diagnosis have it.
fn whole_runs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("run of 2000 steps");
    let trials = [
        ("cuboid on paper, 5 Hz", cuboid_on_paper(5.0)),
        ("spiked, draft 4°, θ1 10°", pdms(Shape::Spiked, 4.0, 10.0, 0.0)),
        ("spiked ends, draft 4°, θ1 10°", pdms(Shape::SpikedEnds, 4.0, 10.0, 0.0)),
    ];
    for (name, trial) in &trials {
        eprintln!("{name}: {:.3} Newton iterations a step", iterations_per_step(trial));
        for (kind, how) in [(SolverKind::Reduced, "verified"), (SolverKind::Unverified, "unverified")] {
            group.bench_function(format!("{name}, {how}"), |bencher| {
                bencher.iter(|| {
                    let mut stepper = Stepper::new(trial, kind);
                    for _ in 0..trial.steps() {
                        stepper.advance();
                    }
                    stepper.state().position.y
                });
            });
        }
    }
    group.finish();
}

fn iterations_per_step(trial: &Trial) -> f64 {
    let mut stepper = Stepper::new(trial, SolverKind::Reduced);
    let total: u32 = (0..trial.steps()).map(|_| stepper.advance().iterations).sum();
    f64::from(total) / trial.steps() as f64
}

criterion_group!(benches, by_contact_mode, whole_runs);
criterion_main!(benches);
