//! The scaled natural residual of a step in the unreduced problem (`docs/model.md`).
//!
//! ```text
//! P = m|v| + |Iω|/ℓ + h|F_ext| + h|T|/ℓ + p_a + |N| + |p_t| + |p_o|        U = |v⁺| + ℓ|ω⁺| + P/(m + hk)
//! ```

use crate::StepSolution;
use crate::problem::{ACTIVE, FREE, StepProblem};
use crate::step::Step;

/// Storage for the rows of the unreduced problem of one body.
#[derive(Debug, Clone)]
pub struct Rows {
    point: Vec<f64>,
    rows: Vec<f64>,
}

impl Rows {
    /// Storage for a body with `surfaces` surfaces.
    pub fn new(surfaces: usize) -> Self {
        let count = FREE + surfaces + 2;
        Self { point: vec![0.0; count], rows: vec![0.0; count] }
    }

    /// The greatest scaled row of `solution`.
    pub fn residual(&mut self, step: &Step, solution: &StepSolution) -> f64 {
        let problem = StepProblem::new(step, solution.active);
        problem.write(solution, &mut self.point);
        problem.rows(&self.point, &mut self.rows);
        let (z, out) = (&self.point, &self.rows);
        let (plane, slip, normal) = problem.last_slots();

        let at_ecp = if step.pulls_at_ecp { solution.normal - step.adhesion } else { solution.normal };
        let load = step.mass * step.state.linear.norm()
            + (step.inertia * step.state.angular).norm() / step.size
            + step.load.norm()
            + step.torque.impulse(&solution.angular).norm() / step.size
            + step.adhesion
            + at_ecp.abs()
            + solution.friction.xy().abs().sum();
        let speed = solution.linear.norm() + step.size * solution.angular.norm() + load / step.mass;
        // P and U in the problem's own units.
        let p = load / problem.impulse_unit();
        let u = speed / problem.velocity_unit();
        if p == 0.0 {
            return out.iter().fold(0.0, |worst: f64, row| worst.max(row.abs()));
        }
        let sigma = z[slip];
        let mut worst: f64 = 0.0;
        let mut hold = |value: f64| worst = if value.is_nan() { f64::INFINITY } else { worst.max(value.abs()) };
        hold(greatest(&out[0..6]) / p);
        hold(greatest(&out[6..9]));
        hold(greatest(&out[9..12]) / z[plane].max(f64::MIN_POSITIVE));
        hold(greatest(&out[12..15]) / (p * u.max(sigma)));
        // The row that makes k active, and the pairs of every l; l_k is among them, as in the paper.
        hold(out[ACTIVE]);
        for (multiplier, row) in z[ACTIVE..=plane].iter().zip(&out[ACTIVE..=plane]) {
            hold(multiplier.min(*row));
        }
        hold((sigma / u).min(out[slip] / (p * p)));
        hold((z[normal] / p).min(out[normal]));
        worst
    }
}

/// The greatest magnitude, infinite where a number is none. Rows that are over one scale are divided together by this.
#[inline]
fn greatest(rows: &[f64]) -> f64 {
    let worst = rows.iter().fold(0.0, |worst: f64, row| if row.abs() > worst { row.abs() } else { worst });
    if rows.iter().sum::<f64>().is_nan() { f64::INFINITY } else { worst }
}
