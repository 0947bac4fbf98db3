//! Time of the paper's 592-case sweep on one thread and on all.

use criterion::{Criterion, criterion_group, criterion_main};
use dynamics::batch::{Control, sweep};
use tumblers_benches::{Shape, grid};

fn sweeps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("592 cases of 2000 steps");
    group.sample_size(10);
    for (name, shape) in [("spiked", Shape::Spiked), ("spiked ends", Shape::SpikedEnds)] {
        let trials = grid(shape);
        for (threads, label) in [(1, "1 thread"), (0, "all threads")] {
            group.bench_function(format!("{name}, {label}"), |bencher| {
                bencher.iter(|| sweep(&trials, threads, &Control::default()));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, sweeps);
criterion_main!(benches);
