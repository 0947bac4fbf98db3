#![allow(dead_code)]

use faer::{Mat, MatMut};
use tumblers_mncp::{Problem, Settings, Solution, Solver};

/// A problem made of two functions.
pub struct Functions<R, J> {
    pub equalities: usize,
    pub pairs: usize,
    pub residual: R,
    pub jacobian: J,
}

impl<R: Fn(&[f64], &mut [f64]), J: Fn(&[f64], MatMut<'_, f64>)> Problem for Functions<R, J> {
    fn equalities(&self) -> usize {
        self.equalities
    }

    fn pairs(&self) -> usize {
        self.pairs
    }

    fn residual(&self, z: &[f64], out: &mut [f64]) {
        (self.residual)(z, out);
    }

    fn jacobian(&self, z: &[f64], out: MatMut<'_, f64>) {
        (self.jacobian)(z, out);
    }
}

/// A nonlinear complementarity problem, Jacobian by rows.
pub fn complementarity<const N: usize>(
    f: impl Fn(&[f64]) -> [f64; N],
    jacobian: impl Fn(&[f64]) -> [[f64; N]; N],
) -> impl Problem {
    mixed(0, f, jacobian)
}

/// A mixed problem of which the first rows are equations.
pub fn mixed<const N: usize>(
    equalities: usize,
    f: impl Fn(&[f64]) -> [f64; N],
    jacobian: impl Fn(&[f64]) -> [[f64; N]; N],
) -> impl Problem {
    Functions {
        equalities,
        pairs: N - equalities,
        residual: move |z: &[f64], out: &mut [f64]| out.copy_from_slice(&f(z)),
        jacobian: move |z: &[f64], mut out: MatMut<'_, f64>| {
            for (i, row) in jacobian(z).iter().enumerate() {
                for (j, entry) in row.iter().enumerate() {
                    out[(i, j)] = *entry;
                }
            }
        },
    }
}

/// `0 <= v ⟂ Mv + q >= 0`
pub fn linear(m: Mat<f64>, q: Vec<f64>) -> impl Problem {
    let matrix = m.clone();
    Functions {
        equalities: 0,
        pairs: q.len(),
        residual: move |z: &[f64], out: &mut [f64]| {
            out.copy_from_slice(&q);
            for (j, x) in z.iter().enumerate() {
                for (i, y) in out.iter_mut().enumerate() {
                    *y += m[(i, j)] * x;
                }
            }
        },
        jacobian: move |_: &[f64], mut out: MatMut<'_, f64>| out.copy_from(&matrix),
    }
}

/// The natural residual, written apart from the library's.
pub fn natural_residual(problem: &impl Problem, z: &[f64]) -> f64 {
    let mut values = vec![0.0; z.len()];
    problem.residual(z, &mut values);
    let natural = |i: usize| if i < problem.equalities() { values[i] } else { z[i].min(values[i]) };
    (0..z.len()).map(|i| natural(i).abs()).fold(0.0, f64::max)
}

/// The greatest relative difference between the Jacobian and central differences.
pub fn jacobian_error(problem: &impl Problem, z: &[f64]) -> f64 {
    let n = z.len();
    let mut exact = Mat::zeros(n, n);
    problem.jacobian(z, exact.as_mut());
    let (mut above, mut below) = (vec![0.0; n], vec![0.0; n]);
    let mut worst = 0.0_f64;
    for j in 0..n {
        let h = 1e-6 * z[j].abs().max(1.0);
        let mut x = z.to_vec();
        x[j] = z[j] + h;
        problem.residual(&x, &mut above);
        x[j] = z[j] - h;
        problem.residual(&x, &mut below);
        for i in 0..n {
            let difference = (above[i] - below[i]) / (2.0 * h);
            worst = worst.max((difference - exact[(i, j)]).abs() / exact[(i, j)].abs().max(1.0));
        }
    }
    worst
}

pub fn tight() -> Settings {
    Settings { tolerance: 1e-12, ..Settings::default() }
}

/// Solves to 1e-12, checks the residual apart from the solver, and returns the point.
pub fn solve_tightly(problem: &impl Problem, start: &[f64]) -> (Solution, Vec<f64>) {
    let mut solver = Solver::new(problem.equalities(), problem.pairs(), tight()).unwrap();
    let mut z = start.to_vec();
    let solution = solver.solve(problem, &mut z).unwrap();
    assert!(solution.status.is_solved(), "{solution:?} from {start:?}, {:?}", solver.statistics());
    assert!(natural_residual(problem, &z) <= 1e-12);
    assert_eq!(natural_residual(problem, &z), solution.residual);
    (solution, z)
}

pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}
