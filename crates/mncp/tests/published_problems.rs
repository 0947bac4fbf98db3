//! Published complementarity problems with known solutions.

mod common;

use common::{complementarity, distance, jacobian_error, mixed, solve_tightly};
use tumblers_mncp::Problem;

/// `√6/2`
const ROOT: f64 = 1.224_744_871_391_589;

/// Kojima & Shindo, J. Oper. Res. Soc. Japan 29 (1986).
fn kojima_shindo() -> impl Problem {
    complementarity(
        |z| {
            let [a, b, c, d] = [z[0], z[1], z[2], z[3]];
            [
                3.0 * a * a + 2.0 * a * b + 2.0 * b * b + c + 3.0 * d - 6.0,
                2.0 * a * a + a + b * b + 10.0 * c + 2.0 * d - 2.0,
                3.0 * a * a + a * b + 2.0 * b * b + 2.0 * c + 9.0 * d - 9.0,
                a * a + 3.0 * b * b + 2.0 * c + 3.0 * d - 3.0,
            ]
        },
        |z| {
            let [a, b] = [z[0], z[1]];
            [
                [6.0 * a + 2.0 * b, 2.0 * a + 4.0 * b, 1.0, 3.0],
                [4.0 * a + 1.0, 2.0 * b, 10.0, 2.0],
                [6.0 * a + b, a + 4.0 * b, 2.0, 9.0],
                [2.0 * a, 6.0 * b, 2.0, 3.0],
            ]
        },
    )
}

/// Josephy, *Newton's method for generalized equations*, MRC report 1965 (1979).
fn josephy() -> impl Problem {
    complementarity(
        |z| {
            let [a, b, c, d] = [z[0], z[1], z[2], z[3]];
            [
                3.0 * a * a + 2.0 * a * b + 2.0 * b * b + c + 3.0 * d - 6.0,
                2.0 * a * a + a + b * b + 3.0 * c + 2.0 * d - 2.0,
                3.0 * a * a + a * b + 2.0 * b * b + 2.0 * c + 3.0 * d - 1.0,
                a * a + 3.0 * b * b + 2.0 * c + 3.0 * d - 3.0,
            ]
        },
        |z| {
            let [a, b] = [z[0], z[1]];
            [
                [6.0 * a + 2.0 * b, 2.0 * a + 4.0 * b, 1.0, 3.0],
                [4.0 * a + 1.0, 2.0 * b, 3.0, 2.0],
                [6.0 * a + b, a + 4.0 * b, 2.0, 3.0],
                [2.0 * a, 6.0 * b, 2.0, 3.0],
            ]
        },
    )
}

/// The starts that are customary for both.
const STARTS: [[f64; 4]; 8] = [
    [0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 1.0, 1.0],
    [100.0, 100.0, 100.0, 100.0],
    [1.0, 0.0, 1.0, 0.0],
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 1.0, 0.0],
    [1.25, 0.0, 0.0, 0.5],
    [-1.0, -1.0, -1.0, -1.0],
];

#[test]
fn kojima_shindo_reaches_both_solutions() {
    let degenerate = [ROOT, 0.0, 0.0, 0.5];
    let regular = [1.0, 0.0, 3.0, 0.0];
    let mut met = [false; 2];
    for start in STARTS.iter().chain(&[[1.0, 0.0, 2.5, 0.0]]) {
        assert!(jacobian_error(&kojima_shindo(), start) < 1e-7);
        let (_, z) = solve_tightly(&kojima_shindo(), start);
        let hit = [distance(&z, &degenerate) < 1e-6, distance(&z, &regular) < 1e-10];
        assert!(hit[0] || hit[1], "{z:?}");
        met = [met[0] || hit[0], met[1] || hit[1]];
    }
    assert_eq!(met, [true; 2]);
}

#[test]
fn josephy_reaches_its_solution() {
    for start in STARTS {
        assert!(jacobian_error(&josephy(), &start) < 1e-7);
        let (_, z) = solve_tightly(&josephy(), &start);
        assert!(distance(&z, &[ROOT, 0.0, 0.0, 0.5]) < 1e-11, "{z:?}");
    }
}

/// Firm `i` of an oligopoly maximises `q_i p(Q) - C_i(q_i)` with `C_i' = c_i + (q_i/L_i)^{1/β_i}` and
/// `p(Q) = 5000^{1/γ} Q^{-1/γ}`, `Q = Σ q_j`:
///
/// ```text
/// 0 <= q_i ⟂ C_i'(q_i) - p(Q) - q_i p'(Q) >= 0
/// ```
///
/// Murphy, Sherali, Soyster, Mathematical Programming 24 (1982); Harker, Management Science 30 (1984).
fn nash_cournot<const N: usize>(c: [f64; N], l: [f64; N], beta: [f64; N], gamma: f64) -> impl Problem {
    let price = move |q: &[f64]| {
        let total: f64 = q.iter().sum();
        let p = (5000.0 / total).powf(1.0 / gamma);
        (p, -p / (gamma * total), (1.0 + gamma) * p / (gamma * total).powi(2))
    };
    complementarity(
        move |q| -> [f64; N] {
            let (p, slope, _) = price(q);
            std::array::from_fn(|i| c[i] + (q[i] / l[i]).powf(1.0 / beta[i]) - p - q[i] * slope)
        },
        move |q| -> [[f64; N]; N] {
            let (_, slope, curvature) = price(q);
            std::array::from_fn(|i| {
                let own = (q[i] / l[i]).powf(1.0 / beta[i]) / (beta[i] * q[i]) - slope;
                std::array::from_fn(|j| f64::from(u8::from(i == j)) * own - slope - q[i] * curvature)
            })
        },
    )
}

#[test]
fn nash_cournot_with_five_firms() {
    let problem = nash_cournot([10.0, 8.0, 6.0, 4.0, 2.0], [5.0; 5], [1.2, 1.1, 1.0, 0.9, 0.8], 1.1);
    for start in [1.0, 10.0, 100.0] {
        let start = [start; 5];
        assert!(jacobian_error(&problem, &start) < 1e-6);
        let (_, z) = solve_tightly(&problem, &start);
        assert!(distance(&z, &[36.9325, 41.8181, 43.7066, 42.6592, 39.1790]) < 1e-4, "{z:?}");
    }
}

#[test]
fn nash_cournot_with_ten_firms() {
    let problem = nash_cournot(
        [5.0, 3.0, 8.0, 5.0, 1.0, 3.0, 7.0, 4.0, 6.0, 3.0],
        [0.1; 10],
        [1.2, 1.0, 0.9, 0.6, 1.5, 1.0, 0.7, 1.1, 0.95, 0.75],
        1.2,
    );
    let published = [7.4415, 4.0979, 2.5906, 0.9354, 17.9490, 4.0979, 1.3048, 5.5902, 3.2220, 1.6772];
    for start in [1.0, 10.0] {
        let (_, z) = solve_tightly(&problem, &[start; 10]);
        assert!(distance(&z, &published) < 3e-4, "{z:?}");
    }
}

/// A Walrasian equilibrium with the solutions `(λ, 0, 0, 0)`, `0 <= λ <= 3`. Mathiesen, Mathematical Programming 37
/// (1987); Pang & Gabriel, Mathematical Programming 60 (1993).
#[test]
fn mathiesen_reaches_its_solution_set() {
    let problem = complementarity(
        |z| {
            let [a, b, c, d] = [z[0], z[1], z[2], z[3]];
            [-b + c + d, a - (4.5 * c + 2.7 * d) / (b + 1.0), 5.0 - a - (0.5 * c + 0.3 * d) / (c + 1.0), 3.0 - a]
        },
        |z| {
            let [b, c, d] = [z[1], z[2], z[3]];
            let (s, t) = (b + 1.0, c + 1.0);
            [
                [0.0, -1.0, 1.0, 1.0],
                [1.0, (4.5 * c + 2.7 * d) / (s * s), -4.5 / s, -2.7 / s],
                [-1.0, 0.0, (0.3 * d - 0.5) / (t * t), -0.3 / t],
                [-1.0, 0.0, 0.0, 0.0],
            ]
        },
    );
    for start in [[1.0, 1.0, 1.0, 1.0], [5.0, 5.0, 5.0, 5.0], [10.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]] {
        assert!(jacobian_error(&problem, &start) < 1e-7);
        let (_, z) = solve_tightly(&problem, &start);
        assert!((-1e-9..=3.0 + 1e-9).contains(&z[0]), "{z:?}");
        assert!(distance(&z[1..], &[0.0; 3]) < 1e-5, "{z:?}");
    }
}

/// `min x1 x4 (x1 + x2 + x3) + x3` with `x1 x2 x3 x4 >= 25`, `|x|² = 40`, `1 <= x <= 5`, by its conditions of Karush,
/// Kuhn and Tucker: 5 equations in `(x, y)` and 9 pairs of multipliers and slacks. Problem 71 of Hock & Schittkowski,
/// *Test Examples for Nonlinear Programming Codes* (1981).
#[test]
fn hock_schittkowski_71_by_its_optimality_conditions() {
    let problem = mixed(
        5,
        |z| {
            let (x, y, s) = (&z[..4], z[4], z[5]);
            let (lower, upper) = (&z[6..10], &z[10..14]);
            let objective =
                [x[3] * (2.0 * x[0] + x[1] + x[2]), x[0] * x[3], x[0] * x[3] + 1.0, x[0] * (x[0] + x[1] + x[2])];
            let product = [x[1] * x[2] * x[3], x[0] * x[2] * x[3], x[0] * x[1] * x[3], x[0] * x[1] * x[2]];
            let mut out = [0.0; 14];
            for i in 0..4 {
                out[i] = objective[i] + 2.0 * y * x[i] - s * product[i] - lower[i] + upper[i];
                out[6 + i] = x[i] - 1.0;
                out[10 + i] = 5.0 - x[i];
            }
            out[4] = x.iter().map(|x| x * x).sum::<f64>() - 40.0;
            out[5] = x.iter().product::<f64>() - 25.0;
            out
        },
        |z| {
            let (x, y, s) = (&z[..4], z[4], z[5]);
            let [a, b, c, d] = [x[0], x[1], x[2], x[3]];
            let objective =
                [[2.0 * d, d, d, 2.0 * a + b + c], [d, 0.0, 0.0, a], [d, 0.0, 0.0, a], [2.0 * a + b + c, a, a, 0.0]];
            let product = [
                [0.0, c * d, b * d, b * c],
                [c * d, 0.0, a * d, a * c],
                [b * d, a * d, 0.0, a * b],
                [b * c, a * c, a * b, 0.0],
            ];
            let slope = [b * c * d, a * c * d, a * b * d, a * b * c];
            let mut out = [[0.0; 14]; 14];
            for i in 0..4 {
                for j in 0..4 {
                    out[i][j] = objective[i][j] - s * product[i][j];
                }
                out[i][i] += 2.0 * y;
                out[i][4] = 2.0 * x[i];
                out[i][5] = -slope[i];
                out[i][6 + i] = -1.0;
                out[i][10 + i] = 1.0;
                out[4][i] = 2.0 * x[i];
                out[5][i] = slope[i];
                out[6 + i][i] = 1.0;
                out[10 + i][i] = -1.0;
            }
            out
        },
    );
    let mut start = [0.0; 14];
    start[..4].copy_from_slice(&[1.0, 5.0, 5.0, 1.0]);
    assert!(jacobian_error(&problem, &start) < 1e-7);
    let (_, z) = solve_tightly(&problem, &start);
    assert!(distance(&z[..4], &[1.0, 4.742_999_4, 3.821_150_3, 1.379_408_2]) < 1e-6, "{z:?}");
}

/// `min 9 - 8x1 - 6x2 - 4x3 + 2x1² + 2x2² + x3² + 2x1x2 + 2x1x3` with `x1 + x2 + 2x3 = 3`, `x >= 0`: the inequality of
/// problem 35 of Hock & Schittkowski (Beale), which is active at its solution `(4/3, 7/9, 4/9)` with multiplier 2/9, as
/// an equation with a free multiplier.
#[test]
fn beale_as_a_mixed_problem() {
    let q = [[4.0, 2.0, 2.0], [2.0, 4.0, 0.0], [2.0, 0.0, 2.0]];
    let (c, a) = ([-8.0, -6.0, -4.0], [1.0, 1.0, 2.0]);
    let problem = mixed(
        1,
        move |z| {
            let x = &z[1..];
            let row = |i: usize| c[i] + z[0] * a[i] + (0..3).map(|j| q[i][j] * x[j]).sum::<f64>();
            [a[0] * x[0] + a[1] * x[1] + a[2] * x[2] - 3.0, row(0), row(1), row(2)]
        },
        move |_| {
            let row = |i: usize| [a[i], q[i][0], q[i][1], q[i][2]];
            [[0.0, a[0], a[1], a[2]], row(0), row(1), row(2)]
        },
    );
    for start in [[0.0; 4], [-10.0, 50.0, 50.0, 50.0]] {
        let (_, z) = solve_tightly(&problem, &start);
        assert!(distance(&z, &[2.0 / 9.0, 4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0]) < 1e-11, "{z:?}");
    }
}
