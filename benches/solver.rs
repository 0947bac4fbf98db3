//! Time of a solve by the general solver, and of a small dense linear solve by two libraries.

use criterion::{Criterion, criterion_group, criterion_main};
use dynamics::SolverKind;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::{Mat, Par};
use geometry::ContactMode;
use mncp::{Problem, Settings, Solver};
use nalgebra::{SMatrix, SVector};
use std::hint::black_box;
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
    group.bench_function("nalgebra, fixed size", |bencher| {
        bencher.iter(|| black_box(fixed).lu().solve(&black_box(right)))
    });
    let dynamic = Mat::<f64>::from_fn(N, N, entry);
    let column: Vec<f64> = (0..N).map(|i| 1.0 + i as f64).collect();
    let (mut factors, mut solution) = (dynamic.clone(), column.clone());
    let (mut forward, mut inverse) = ([0usize; N], [0usize; N]);
    let mut scratch = MemBuffer::new(StackReq::any_of(&[
        factor::lu_in_place_scratch::<usize, f64>(N, N, Par::Seq, Default::default()),
        solve::solve_in_place_scratch::<usize, f64>(N, 1, Par::Seq),
    ]));
    group.bench_function("faer, in place", |bencher| {
        bencher.iter(|| {
            let stack = MemStack::new(&mut scratch);
            factors.copy_from(black_box(&dynamic));
            solution.copy_from_slice(black_box(&column));
            let (lu, order) = (factors.as_mut(), Default::default());
            let (_, rows) = factor::lu_in_place(lu, &mut forward, &mut inverse, Par::Seq, stack, order);
            let right = faer::MatMut::from_column_major_slice_mut(&mut solution, N, 1);
            solve::solve_in_place(factors.as_ref(), factors.as_ref(), rows, right, Par::Seq, stack);
        });
    });
    group.finish();
}

fn dense(criterion: &mut Criterion) {
    linear::<8>(criterion);
    linear::<9>(criterion);
    linear::<20>(criterion);
}

criterion_group!(benches, general, dense);
criterion_main!(benches);
