//! Linear complementarity problems `0 <= v ⟂ Mv + q >= 0`.

mod common;

use common::{distance, linear, natural_residual, solve_tightly};
use faer::Mat;
use proptest::prelude::*;
use tumblers_mncp::{Problem, Settings, Solver};

fn matrix(rows: &[&[f64]]) -> Mat<f64> {
    Mat::from_fn(rows.len(), rows.len(), |i, j| rows[i][j])
}

/// `v = (1, 0)`, `w = (0, 0)`: the second pair is biactive.
#[test]
fn degenerate_pair() {
    let problem = linear(matrix(&[&[2.0, 1.0], &[1.0, 2.0]]), vec![-2.0, -1.0]);
    for start in [[0.0, 0.0], [1.0, 1.0], [-3.0, 7.0], [50.0, -50.0], [1.0, 1e-9]] {
        let (_, z) = solve_tightly(&problem, &start);
        assert!(distance(&z, &[1.0, 0.0]) < 1e-11, "{z:?}");
    }
}

/// Every pair is biactive at the solution 0, which is also a kink of every row.
#[test]
fn wholly_degenerate() {
    let problem = linear(matrix(&[&[1.0, 2.0, 2.0], &[0.0, 1.0, 2.0], &[0.0, 0.0, 1.0]]), vec![0.0; 3]);
    for start in [[0.0; 3], [1.0; 3], [-5.0, 3.0, 2.0], [0.0, 0.0, 1.0]] {
        let (_, z) = solve_tightly(&problem, &start);
        assert!(distance(&z, &[0.0; 3]) < 1e-10, "{z:?}");
    }
}

/// The solutions are the segment `v1 + v2 = 1`, and `M` is singular.
#[test]
fn a_segment_of_solutions() {
    let problem = linear(matrix(&[&[1.0, 1.0], &[1.0, 1.0]]), vec![-1.0, -1.0]);
    for start in [[0.0, 0.0], [3.0, 3.0], [-1.0, 2.0], [0.0, 5.0]] {
        let (_, z) = solve_tightly(&problem, &start);
        assert!((z[0] + z[1] - 1.0).abs() < 1e-11 && z[0] > -1e-11 && z[1] > -1e-11, "{z:?}");
    }
}

/// Murty's problem, on which Lemke's algorithm takes 2^n pivots: `M` upper triangular with 1 on and 2 above the
/// diagonal, `q = -1`, solution `(0, ..., 0, 1)`.
#[test]
fn murty() {
    let n = 40;
    let m = Mat::from_fn(n, n, |i, j| if i == j { 1.0 } else { 2.0 * f64::from(u8::from(j > i)) });
    let mut solution = vec![0.0; n];
    solution[n - 1] = 1.0;
    for start in [0.0, 1.0, 10.0] {
        let (_, z) = solve_tightly(&linear(m.clone(), vec![-1.0; n]), &vec![start; n]);
        assert!(distance(&z, &solution) < 1e-10, "{z:?}");
    }
}

/// The membrane over an obstacle: `0 <= u - ψ ⟂ -Δu - f >= 0` on the unit square, `u = 0` on its edge, by five-point
/// differences. Compared with projected Gauss–Seidel (Cryer, SIAM J. Control 9, 1971).
#[test]
fn obstacle() {
    let side = 12;
    let (n, h) = (side * side, 1.0 / (side as f64 + 1.0));
    let place = |k: usize| (((k % side) as f64 + 1.0) * h, ((k / side) as f64 + 1.0) * h);
    let obstacle: Vec<f64> =
        (0..n).map(place).map(|(x, y)| 0.3 - 2.0 * ((x - 0.5).powi(2) + (y - 0.4).powi(2))).collect();
    let laplacian = Mat::from_fn(n, n, |i, j| {
        let (dx, dy) = ((i % side).abs_diff(j % side), (i / side).abs_diff(j / side));
        match dx + dy {
            0 => 4.0,
            1 => -1.0,
            _ => 0.0,
        }
    });
    let load = -0.5 * h * h;
    let row = |u: &[f64], i: usize| (0..n).map(|j| laplacian[(i, j)] * u[j]).sum::<f64>() - load;

    let mut relaxed: Vec<f64> = obstacle.iter().map(|o| o.max(0.0)).collect();
    for _ in 0..2000 {
        for i in 0..n {
            relaxed[i] = obstacle[i].max(relaxed[i] - row(&relaxed, i) / 4.0);
        }
    }

    let q: Vec<f64> = (0..n).map(|i| row(&obstacle, i)).collect();
    let (solution, v) = solve_tightly(&linear(laplacian.clone(), q), &vec![0.0; n]);
    let u: Vec<f64> = v.iter().zip(&obstacle).map(|(v, o)| v + o).collect();
    assert!(distance(&u, &relaxed) < 1e-10, "{}", distance(&u, &relaxed));
    let touching = v.iter().filter(|v| v.abs() < 1e-9).count();
    assert!(touching > 5 && touching < n / 2, "{touching}");
    assert!(solution.iterations < 30, "{solution:?}");
}

/// `M = AAᵀ/n + (S - Sᵀ) + μI`, strongly monotone and not symmetric.
fn strongly_monotone() -> impl Strategy<Value = (Mat<f64>, Vec<f64>, Vec<f64>)> {
    (1_usize..=12).prop_flat_map(|n| {
        let entries = prop::collection::vec(-1.0..1.0, n * n);
        let vector = prop::collection::vec(-10.0..10.0, n);
        (entries.clone(), entries, 0.01..1.0, vector.clone(), vector).prop_map(move |(a, s, mu, q, start)| {
            let square = |i: usize, j: usize| (0..n).map(|k| a[i * n + k] * a[j * n + k]).sum::<f64>() / n as f64;
            let skew = |i: usize, j: usize| s[i * n + j] - s[j * n + i];
            let shift = |i: usize, j: usize| if i == j { mu } else { 0.0 };
            (Mat::from_fn(n, n, |i, j| square(i, j) + skew(i, j) + shift(i, j)), q, start)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn strongly_monotone_problems_are_solved((m, q, start) in strongly_monotone()) {
        let problem = linear(m, q);
        let settings = Settings { tolerance: 1e-10, smoothing: false, ..Settings::default() };
        let mut solver = Solver::new(0, problem.pairs(), settings).unwrap();
        let mut z = start;
        let solution = solver.solve(&problem, &mut z).unwrap();
        prop_assert!(solution.status.is_solved(), "{:?}", solution);
        prop_assert!(natural_residual(&problem, &z) <= 1e-10);
    }

    /// A solution `v*`, `w*` of which every third pair is biactive is prescribed by `q = w* - Mv*`; it is unique.
    #[test]
    fn degenerate_monotone_problems_are_solved((m, v, start) in strongly_monotone()) {
        let n = v.len();
        let v: Vec<f64> = v.iter().enumerate().map(|(i, v)| if i % 3 == 0 { v.abs() } else { 0.0 }).collect();
        let w = |i: usize| if i % 3 == 1 { 1.0 } else { 0.0 };
        let q = (0..n).map(|i| w(i) - (0..n).map(|j| m[(i, j)] * v[j]).sum::<f64>()).collect();
        let (_, z) = solve_tightly(&linear(m, q), &start);
        prop_assert!(distance(&z, &v) < 1e-8, "{:?} {:?}", z, v);
    }
}
