//! The Jacobian of the unreduced problem's rows, in the units of [`StepProblem`].
//!
//! With `dφ = (dφ/dω) dω⁺`, `dr = da1 - h dv⁺` and `K_i = R ∇²f_i Rᵀ`:
//!
//! ```text
//! d(∇f_i) = K_i dr + (K_i [r]ₓ - [∇f_i]ₓ) dφ
//! d f_i   = ∇f_i · dr - (r × ∇f_i) · dφ
//! d u     = dv⁺ + ω⁺ × dr - r × dω⁺     (t, o),     dω_z (r)
//! ```

use crate::problem::{ACTIVE, StepProblem, slip};
use crate::rotation::cayley_tangent;
use crate::{Mat3, Vec3};
use faer::MatMut;
use nalgebra::RowVector3;

impl StepProblem<'_> {
    /// The Jacobian of [`Self::rows`].
    pub fn jacobian_of_rows(&self, z: &[f64], mut out: MatMut<'_, f64>) {
        let (m, step) = (self.surfaces(), self.step);
        let at = self.point(z);
        let impulse = self.impulse_unit();
        let units = self.friction_units();
        let (plane, sigma, normal) = self.last_slots();
        out.fill(0.0);
        let mut put = |row: usize, column: usize, block: &Mat3| {
            for i in 0..3 {
                for j in 0..3 {
                    out[(row + i, column + j)] += block[(i, j)];
                }
            }
        };
        let turn = cayley_tangent(&at.angular, 0.5 * step.h) / self.angular_scale();
        // ∂(h v⁺)/∂v⁺ in units.
        let travel = step.h / self.angular_scale();
        let arm = at.arm / step.size;
        let contact = Vec3::new(at.friction.x, at.friction.y, self.at_ecp(at.normal)) / impulse;

        put(0, 0, &Mat3::identity());
        let torque = step.torque.by_angular(&at.angular);
        let change = step.momentum.by_angular(&step.inertia, &at.angular);
        put(3, 3, &((change - torque) / (impulse * step.size * self.angular_scale())));
        put(3, 6, &contact.cross_matrix());
        put(3, 0, &(-contact.cross_matrix() * travel));

        let k = z[ACTIVE];
        let cone = self.normal_cone(z, &at);
        let mut by_arm = Mat3::zeros();
        let mut by_turn = Mat3::zeros();
        for i in 0..m {
            let weight = self.weight(i, z);
            if weight == 0.0 {
                continue;
            }
            let hessian = step.body.surfaces()[i].hessian(&at.body_arm) * step.size;
            let curvature = at.rotation * hessian * at.rotation.transpose();
            let gradient = self.gradient(i, &at, &at.body_arm);
            by_arm += curvature * weight;
            by_turn += (curvature * arm.cross_matrix() - gradient.cross_matrix()) * weight;
        }
        put(6, 6, &(Mat3::identity() + by_arm * k));
        put(6, 9, &-Mat3::identity());
        put(6, 0, &(-by_arm * (k * travel)));
        put(6, 3, &(by_turn * turn * k));
        put(9, 6, &by_arm);
        put(9, 0, &(-by_arm * travel));
        put(9, 3, &(by_turn * turn));

        let e = step.ellipsoid;
        let bound = step.friction.of(step.bound_impulse(at.normal)) / impulse;
        let angular = at.angular * self.angular_scale();
        let mut slip_by_arm = angular.cross_matrix();
        let mut slip_by_linear = Mat3::identity() - slip_by_arm * travel;
        let mut slip_by_angular = -arm.cross_matrix();
        slip_by_arm.set_row(2, &RowVector3::zeros());
        slip_by_linear.set_row(2, &RowVector3::zeros());
        slip_by_angular.set_row(2, &RowVector3::new(0.0, 0.0, 1.0 / step.size));
        let scale = Mat3::from_diagonal(&(e * bound));
        put(12, 0, &(scale * slip_by_linear));
        put(12, 3, &(scale * slip_by_angular));
        put(12, 6, &(scale * slip_by_arm));
        put(12, 12, &Mat3::from_diagonal_element(z[sigma]));

        let slip = slip(&at) / self.velocity_unit();
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        for i in 0..3 {
            // p_t, p_o, p_r in the momentum rows.
            let unit = units[i] / impulse;
            if i < 2 {
                out[(i, 12 + i)] -= unit;
                let lever = arm.cross(&axes[i]) * unit;
                for j in 0..3 {
                    out[(3 + j, 12 + i)] -= lever[j];
                }
            } else {
                out[(5, 14)] -= unit / step.size;
            }
            let lever = arm.cross(&Vec3::z());
            out[(3 + i, normal)] -= lever[i];
            out[(6 + i, ACTIVE)] += cone[i];
            out[(12 + i, sigma)] += z[12 + i];
            out[(12 + i, normal)] += e[i] * slip[i] * step.friction.slope();
            out[(sigma, 12 + i)] -= 2.0 * z[12 + i];
        }
        out[(2, normal)] -= 1.0;
        out[(11, plane)] += 1.0;
        for i in 0..m {
            let gradient = self.gradient(i, &at, &at.body_arm);
            if i != self.active {
                for j in 0..3 {
                    out[(6 + j, self.slot(i))] += gradient[j] * k;
                    out[(9 + j, self.slot(i))] += gradient[j];
                }
            }
            put_value_row(&mut out, (self.slot(i), 6), &(-gradient), &arm, &turn, travel);
        }
        out[(plane, 11)] -= 1.0;
        out[(plane, normal)] -= step.yielding * impulse / step.size;
        out[(sigma, normal)] += 2.0 * bound * step.friction.slope();
        let (surface, _) = self.greatest(&at);
        let gradient = self.gradient(surface, &at, &at.body_arm_substrate);
        put_value_row(&mut out, (normal, 9), &gradient, &(at.arm_substrate / step.size), &turn, travel);
    }
}

/// `∂f(Rᵀ(a - q⁺))` for the gradient `∇f`: by `a` `∇f`, by `v⁺` `-h ∇f`, by `ω⁺` `-(r × ∇f)ᵀ dφ/dω`. `place` is the row,
/// and the column of `a`.
fn put_value_row(
    out: &mut MatMut<'_, f64>,
    place: (usize, usize),
    gradient: &Vec3,
    arm: &Vec3,
    turn: &Mat3,
    travel: f64,
) {
    let by_angular = -arm.cross(gradient).transpose() * turn;
    for j in 0..3 {
        out[(place.0, place.1 + j)] += gradient[j];
        out[(place.0, j)] -= gradient[j] * travel;
        out[(place.0, 3 + j)] += by_angular[j];
    }
}
