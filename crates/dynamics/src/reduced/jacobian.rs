//! The Jacobian of the reduced problem's rows.

use super::scales::Scales;
use super::{Evaluation, Rows, share, supported};
use crate::contact::turn_of_generator;
use crate::rotation::cayley_tangent;
use crate::step::Step;
use crate::{Mat3, Vec3};
use geometry::Support;
use nalgebra::{RowVector3, SMatrix};

impl<const N: usize> Rows<N> {
    /// The Jacobian of the rows, scaled.
    pub(super) fn jacobian(
        &self,
        step: &Step,
        support: Support,
        hang: Option<u16>,
        scales: &Scales<N>,
    ) -> SMatrix<f64, N, N> {
        let Evaluation { unknowns: x, rotation, normal, arm, .. } = &self.at;
        let count = Self::POINTS;
        let turn = cayley_tangent(&x.angular, 0.5 * step.h);
        let mut moment_by_angular =
            step.momentum.by_angular(&step.inertia, &x.angular) - step.torque.by_angular(&x.angular);
        let mut jacobian = SMatrix::<f64, N, N>::zeros();

        if let Some(friction) = &self.friction {
            let e = step.ellipsoid;
            let p = e.component_mul(&x.friction);
            let tangential = Vec3::new(p.x, p.y, 0.0);
            // How the points move with ω⁺, and r, whose r_z follows the height; h/m + c/h is the height's change with N.
            let turns = self.points.turns(step.body, support, rotation);
            let fall = step.h / step.mass + step.yielding;
            let mut arm_by_turn = Mat3::zeros();
            for (j, by_turn) in turns.iter().enumerate().take(count) {
                arm_by_turn += by_turn * share(x, *normal, j, scales);
            }
            arm_by_turn.set_row(2, &RowVector3::zeros());
            let arm_by_angular = arm_by_turn * turn;

            // u with ω⁺.
            let mut slip_by_angular = crossed(&x.angular, &arm_by_angular) - arm.cross_matrix();
            slip_by_angular.set_row(2, &RowVector3::new(0.0, 0.0, 1.0));
            let (by_friction, by_slip, by_bound) = friction.derivatives();
            let scaled_slip = with_columns_scaled(&by_slip, &e);
            let by_angular = scaled_slip * slip_by_angular * (scales.angular / scales.impulse);
            jacobian.fixed_view_mut::<3, 3>(3 + count, 0).copy_from(&by_angular);

            moment_by_angular += crossed(&tangential, &arm_by_angular);
            let (scaled_row, scaled_column) = (scales.angular / scales.length, scales.impulse / scales.moment);
            for (j, by_turn) in turns.iter().enumerate().take(count) {
                let (y, pj) = (self.points.y[j], x.impulses[j]);
                let y_by_angular = by_turn * turn;
                moment_by_angular += crossed(&Vec3::z(), &y_by_angular) * pj;
                let by_angular = y_by_angular.row(2) * scaled_row;
                jacobian.fixed_view_mut::<1, 3>(3 + j, 0).copy_from(&by_angular);
                for l in 0..count {
                    jacobian[(3 + j, 3 + l)] = fall * (scales.impulse / scales.length);
                }

                let mut arm_by_impulse = if supported(*normal, scales) { (y - arm) / *normal } else { Vec3::zeros() };
                arm_by_impulse.z = -fall;
                let moment_by_impulse = tangential.cross(&arm_by_impulse) - Vec3::new(y.y, -y.x, 0.0);
                jacobian.fixed_view_mut::<3, 1>(0, 3 + j).copy_from(&(moment_by_impulse * scaled_column));
                let moved = x.angular.cross(&arm_by_impulse);
                let by_impulse = scaled_slip * Vec3::new(moved.x, moved.y, 0.0) + by_bound * step.friction.slope();
                jacobian.fixed_view_mut::<3, 1>(3 + count, 3 + j).copy_from(&by_impulse);
            }

            // φ enters v through E φ / m, and the moment through r × (p_t, p_o, 0) + p_r n.
            let by_friction = by_friction + with_columns_scaled(&scaled_slip, &(Vec3::new(e.x, e.y, 0.0) / step.mass));
            jacobian.fixed_view_mut::<3, 3>(3 + count, 3 + count).copy_from(&by_friction);
            let lever = Mat3::from_columns(&[
                Vec3::new(0.0, -arm.z, arm.y) * (e.x * scaled_column),
                Vec3::new(arm.z, 0.0, -arm.x) * (e.y * scaled_column),
                Vec3::new(0.0, 0.0, -1.0) * (e.z * scaled_column),
            ]);
            jacobian.fixed_view_mut::<3, 3>(0, 3 + count).copy_from(&lever);
        } else if let Some(generator) = hang {
            let y_by_turn = turn_of_generator(step.body, generator, rotation, arm);
            moment_by_angular -= Vec3::z().cross_matrix() * y_by_turn * turn * step.adhesion;
        }
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&(moment_by_angular * (scales.angular / scales.moment)));
        jacobian
    }
}

/// `[a]ₓ M`, without the zeros of `[a]ₓ`.
#[inline]
fn crossed(a: &Vec3, matrix: &Mat3) -> Mat3 {
    let [x, y, z] = [0, 1, 2].map(|column| a.cross(&matrix.column(column)));
    Mat3::from_columns(&[x, y, z])
}

/// `M diag(by)`, without the zeros of `diag(by)`.
#[inline]
fn with_columns_scaled(matrix: &Mat3, by: &Vec3) -> Mat3 {
    Mat3::from_columns(&[matrix.column(0) * by.x, matrix.column(1) * by.y, matrix.column(2) * by.z])
}
