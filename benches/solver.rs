//! Time of a solve by the general solver, and of a small dense linear solve by two libraries.

use criterion::{Criterion, criterion_group, criterion_main};
use dynamics::SolverKind;
use faer::Mat;
use faer::prelude::Solve;
use geometry::ContactMode;
use mncp::{Problem, Settings, Solver};
use nalgebra::{SMatrix, SVector};
use tumblers_benches::{cuboid_on_paper, in_mode};

/// Kojima and Shindo's problem.
struct KojimaShindo;

impl Problem for KojimaShindo {
    fn equalities(&self) -> usize {
        0
    }

    fn pairs(&self) -> usize {
        4
    }

    fn residual(&self, z: &[f64], out: &mut [f64]) {
        let [a, b, c, d] = [z[0], z[1], z[2], z[3]];
        out[0] = 3.0 * a * a + 2.0 * a * b + 2.0 * b * b + c + 3.0 * d - 6.0;
        out[1] = 2.0 * a * a + a + b * b + 10.0 * c + 2.0 * d - 2.0;
        out[2] = 3.0 * a * a + a * b + 2.0 * b * b + 2.0 * c + 9.0 * d - 9.0;
        out[3] = a * a + 3.0 * b * b + 2.0 * c + 3.0 * d - 3.0;
    }

    fn jacobian(&self, z: &[f64], mut out: faer::MatMut<'_, f64>) {
        let (a, b) = (z[0], z[1]);
        let rows = [
            [6.0 * a + 2.0 * b, 2.0 * a + 4.0 * b, 1.0, 3.0],
            [4.0 * a + 1.0, 2.0 * b, 10.0, 2.0],
            [6.0 * a + b, a + 4.0 * b, 2.0, 9.0],
            [2.0 * a, 6.0 * b, 2.0, 3.0],
        ];
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                out[(i, j)] = *value;
            }
        }
    }
}

fn general(criterion: &mut Criterion) {
    let mut solver = Solver::new(0, 4, Settings::default()).expect("the default settings");
    criterion.bench_function("solve: Kojima and Shindo", |bencher| {
        bencher.iter(|| {
            let mut z = [1.0; 4];
            solver.solve(&KojimaShindo, &mut z).map(|solution| solution.residual)
        });
    });
    let trial = cuboid_on_paper(5.0);
    let start = in_mode(&trial, ContactMode::Line, 0.02).with_solver(SolverKind::General);
    criterion.bench_function("solve: an unreduced step in line contact", |bencher| {
        bencher.iter_batched_ref(
            || start.clone(),
            |stepper| stepper.advance().residual,
            criterion::BatchSize::SmallInput,
        );
    });
}

/// Factorise and solve a dense system of `N` unknowns.
fn linear<const N: usize>(criterion: &mut Criterion)
where
    nalgebra::Const<N>: nalgebra::DimMin<nalgebra::Const<N>, Output = nalgebra::Const<N>>,
{
    let mut group = criterion.benchmark_group(format!("dense solve, {N} unknowns"));
    let entry = |i: usize, j: usize| if i == j { 4.0 } else { ((i * 7 + j * 13) % 11) as f64 / 11.0 - 0.5 };
    let fixed = SMatrix::<f64, N, N>::from_fn(entry);
    let right = SVector::<f64, N>::from_fn(|i, _| 1.0 + i as f64);
    group.bench_function("nalgebra, fixed size", |bencher| bencher.iter(|| fixed.lu().solve(&right)));
    let dynamic = Mat::<f64>::from_fn(N, N, entry);
    let column = Mat::<f64>::from_fn(N, 1, |i, _| 1.0 + i as f64);
    group.bench_function("faer", |bencher| bencher.iter(|| dynamic.partial_piv_lu().solve(&column)));
    group.finish();
}

fn dense(criterion: &mut Criterion) {
    linear::<8>(criterion);
    linear::<9>(criterion);
    linear::<20>(criterion);
}

criterion_group!(benches, general, dense);
criterion_main!(benches);
