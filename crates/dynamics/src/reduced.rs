//! The reduced problem of a step, for a support that is taken as given.
//!
//! Unknowns `x = [ω⁺; p_1..p_k; φ]` with `φ = E⁻¹[p_t, p_o, p_r]`; `v⁺ = (m v + h F_ext + [p_t, p_o, N])/(m + hk)`;
//! `N = Σ p_j`:
//!
//! ```text
//! A:  ΔL(ω⁺) + h D ω⁺ - hT - Σ p_j y_j × n - r × (p_t, p_o, 0) - p_r n = 0
//! B:  q_z + h v⁺_z + δ + n·y_j = 0,   δ = c p_n/h                           j = 1..k
//! C:  φ - proj_{|·| ≤ μp̄} (φ - ρ E u) = 0
//! ```
//!
//! `ΔL` is the change of angular momentum ([`crate::momentum`]), `r = Σ p_j y_j / N`, and `r_z = -(q_z + h v⁺_z + δ)`
//! because the ECP is on the plane, which has yielded by `δ`. Without a support only A is left, and `-p_a n` acts at the
//! lowest point where adhesion acts at the ECP.

use crate::contact::ContactPoints;
use crate::friction::friction_rows;
use crate::rotation::{cayley, cayley_tangent};
use crate::step::Step;
use crate::{Mat3, Vec3};
use geometry::Support;
use nalgebra::{Const, DimMin, SMatrix, SVector};
use scales::Scales;

mod scales;

/// Scaled residual at which the reduced problem counts as solved. Rounding leaves about 1e-15.
const TOLERANCE: f64 = 1e-13;
/// Scaled residual that is still good where rounding stops Newton's method.
const ACCEPTABLE: f64 = 1e-11;
const MAX_ITERATIONS: u32 = 40;
const MAX_HALVINGS: u32 = 8;
/// `|N|/P` below which the ECP is taken at the middle of the support.
const NO_FORCE: f64 = 1e-14;

/// The unknowns of the reduced problem.
#[derive(Debug, Clone, Copy)]
pub struct Unknowns {
    /// `ω⁺`, rad/s.
    pub angular: Vec3,
    /// `p_j`, N s.
    pub impulses: [f64; 3],
    /// `φ = E⁻¹[p_t, p_o, p_r]`.
    pub friction: Vec3,
}

/// A point of the reduced problem with all that follows from its unknowns.
#[derive(Debug, Clone, Copy)]
pub struct Evaluation {
    /// `x`.
    pub unknowns: Unknowns,
    /// `v⁺`, m/s.
    pub linear: Vec3,
    /// `R⁺`.
    pub rotation: Mat3,
    /// Height of the centre of mass above the yielded plane after the step, m.
    pub height: f64,
    /// `N`.
    pub normal: f64,
    /// `r`.
    pub arm: Vec3,
    /// `u`.
    pub slip: Vec3,
    /// Whether the contact slips.
    pub slips: bool,
    /// Greatest scaled row.
    pub error: f64,
}

/// The solution for one support.
#[derive(Debug, Clone, Copy)]
pub struct Reduced {
    /// Where Newton ended.
    pub at: Evaluation,
    /// Newton steps.
    pub iterations: u32,
    /// Whether every scaled row is down to rounding.
    pub converged: bool,
}

/// Solves the reduced problem for `support` from `start`. `hang` is the generator at which `p_a` pulls on a body without
/// a support.
pub fn solve(step: &Step, support: Support, hang: Option<u16>, start: &Unknowns) -> Reduced {
    match support {
        Support::None => newton::<3>(step, support, hang, start),
        Support::Point(_) => newton::<7>(step, support, None, start),
        Support::Line(..) => newton::<8>(step, support, None, start),
        Support::Face(_) => newton::<9>(step, support, None, start),
    }
}

/// Semismooth Newton with step halving on the greatest scaled row.
fn newton<const N: usize>(step: &Step, support: Support, hang: Option<u16>, start: &Unknowns) -> Reduced
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let scales = Scales::<N>::new(step, start);
    let (mut at, mut rows, mut jacobian) = assemble::<N>(step, support, hang, start, &scales);
    let mut iterations = 0;
    while at.error > TOLERANCE && iterations < MAX_ITERATIONS {
        iterations += 1;
        let Some(direction) = jacobian.lu().solve(&rows) else { break };
        let mut length = 1.0;
        let mut next = assemble::<N>(step, support, hang, &at.unknowns.moved(&direction, length, &scales), &scales);
        for _ in 0..MAX_HALVINGS {
            if next.0.error < at.error {
                break;
            }
            length *= 0.5;
            next = assemble::<N>(step, support, hang, &at.unknowns.moved(&direction, length, &scales), &scales);
        }
        if !next.0.error.is_finite() || (next.0.error >= at.error && at.error <= ACCEPTABLE) {
            break;
        }
        (at, rows, jacobian) = next;
    }
    Reduced { at, iterations, converged: at.error <= ACCEPTABLE }
}

impl Unknowns {
    /// All zero.
    pub fn at_rest() -> Self {
        Self { angular: Vec3::zeros(), impulses: [0.0; 3], friction: Vec3::zeros() }
    }

    fn moved<const N: usize>(&self, direction: &SVector<f64, N>, length: f64, scales: &Scales<N>) -> Self {
        let mut next = *self;
        for i in 0..3 {
            next.angular[i] -= length * direction[i] * scales.angular;
        }
        let points = N.saturating_sub(6);
        for j in 0..points {
            next.impulses[j] -= length * direction[3 + j] * scales.impulse;
        }
        if points > 0 {
            for i in 0..3 {
                next.friction[i] -= length * direction[3 + points + i] * scales.impulse;
            }
        }
        next
    }
}

/// Rows A, B, C and their Jacobian at `x`, both scaled.
fn assemble<const N: usize>(
    step: &Step,
    support: Support,
    hang: Option<u16>,
    x: &Unknowns,
    scales: &Scales<N>,
) -> (Evaluation, SVector<f64, N>, SMatrix<f64, N, N>) {
    let half = 0.5 * step.h;
    let rotation = cayley(&(x.angular * half)) * step.rotation;
    let turn = cayley_tangent(&x.angular, half);
    let points = ContactPoints::new(step.body, support, &rotation);
    let count = points.count;

    let e = step.ellipsoid;
    let p = e.component_mul(&x.friction);
    let normal: f64 = x.impulses[..count].iter().sum();
    let mut linear = step.state.linear + (step.load + step.pull) / step.mass;
    if count > 0 {
        linear += Vec3::new(p.x, p.y, normal) / step.mass;
    }
    let (torque, torque_by_angular) = step.torque.impulse(&x.angular);
    let (change, change_by_angular) = step.momentum.change(&step.inertia, &x.angular);
    let mut moment = change - torque - step.pull_moment;
    let mut moment_by_angular = change_by_angular - torque_by_angular;

    let mut rows = SVector::<f64, N>::zeros();
    let mut jacobian = SMatrix::<f64, N, N>::zeros();
    let mut arm = Vec3::zeros();
    let mut slip = Vec3::zeros();
    let mut slips = false;
    let mut error: f64 = 0.0;
    let height;

    if count == 0 {
        if let Some(generator) = hang {
            let (y, y_by_turn) = ContactPoints::of_generator(step.body, generator, &rotation);
            linear.z -= step.adhesion / step.mass;
            // -p_a y × n, negated as a load.
            moment += y.cross(&Vec3::z()) * step.adhesion;
            moment_by_angular -= Vec3::z().cross_matrix() * y_by_turn * turn * step.adhesion;
            arm = y;
        }
        height = step.state.position.z + step.h * linear.z;
    } else {
        height = step.state.position.z + step.h * linear.z + step.yielded(step.normal_impulse(normal));
        let supported = normal.abs() > NO_FORCE * scales.load;
        // r and its derivatives; r_z follows the height, and h/m + c/h is its change with N.
        let mut arm_by_turn = Mat3::zeros();
        let mut arm_by_impulse = [Vec3::zeros(); 3];
        for j in 0..count {
            let share = if supported { x.impulses[j] / normal } else { 1.0 / count as f64 };
            arm += points.y[j] * share;
            arm_by_turn += points.turn[j] * share;
        }
        if supported {
            for (by, y) in arm_by_impulse.iter_mut().zip(&points.y[..count]) {
                *by = (y - arm) / normal;
            }
        }
        let fall = step.h / step.mass + step.yielding;
        arm.z = -height;
        arm_by_turn.set_row(2, &nalgebra::RowVector3::zeros());
        for by in &mut arm_by_impulse[..count] {
            by.z = -fall;
        }
        let arm_by_angular = arm_by_turn * turn;

        let tangential = Vec3::new(p.x, p.y, 0.0);
        moment -= arm.cross(&tangential);
        moment.z -= p.z;
        moment_by_angular += tangential.cross_matrix() * arm_by_angular;
        for j in 0..count {
            let (y, pj) = (points.y[j], x.impulses[j]);
            moment -= Vec3::new(y.y, -y.x, 0.0) * pj;
            moment_by_angular += Vec3::z().cross_matrix() * (points.turn[j] * turn) * pj;
            let by_impulse = tangential.cross(&arm_by_impulse[j]) - Vec3::new(y.y, -y.x, 0.0);
            let by_angular = (points.turn[j] * turn).row(2).into_owned();
            rows[3 + j] = (height + y.z) / scales.length;
            for i in 0..3 {
                jacobian[(i, 3 + j)] = by_impulse[i] * scales.impulse / scales.moment;
                jacobian[(3 + j, i)] = by_angular[i] * scales.angular / scales.length;
            }
            for l in 0..count {
                jacobian[(3 + j, 3 + l)] = fall * scales.impulse / scales.length;
            }
            error = error.max(rows[3 + j].abs());
        }

        // u = (v_x + ω_y r_z - ω_z r_y, v_y + ω_z r_x - ω_x r_z, ω_z)
        let w = x.angular;
        let surface = linear + w.cross(&arm);
        slip = Vec3::new(surface.x, surface.y, w.z);
        let mut slip_by_angular = w.cross_matrix() * arm_by_angular - arm.cross_matrix();
        slip_by_angular.set_row(2, &nalgebra::RowVector3::new(0.0, 0.0, 1.0));

        let bound = step.friction.of(step.bound_impulse(step.normal_impulse(normal)));
        let rho = step.mass;
        let friction = friction_rows(&x.friction, &e.component_mul(&slip), bound, rho);
        slips = friction.slips;
        let scaled_slip = friction.by_slip * Mat3::from_diagonal(&e);
        let by_angular = scaled_slip * slip_by_angular;
        for i in 0..3 {
            let row = 3 + count + i;
            rows[row] = friction.value[i] / scales.impulse;
            error = error.max(friction.value[i].abs() / scales.load);
            for j in 0..3 {
                jacobian[(row, j)] = by_angular[(i, j)] * scales.angular / scales.impulse;
            }
        }
        for (j, by) in arm_by_impulse[..count].iter().enumerate() {
            let moved = w.cross(by);
            let by_impulse = scaled_slip * Vec3::new(moved.x, moved.y, 0.0) + friction.by_bound * step.friction.slope();
            for i in 0..3 {
                jacobian[(3 + count + i, 3 + j)] = by_impulse[i];
            }
        }
        // φ enters v through E φ / m, and the moment through r × (p_t, p_o, 0) + p_r n.
        let by_friction =
            friction.by_friction + scaled_slip * Mat3::from_diagonal(&Vec3::new(e.x, e.y, 0.0)) / step.mass;
        let lever =
            [Vec3::new(0.0, -arm.z, arm.y) * e.x, Vec3::new(arm.z, 0.0, -arm.x) * e.y, Vec3::new(0.0, 0.0, -1.0) * e.z];
        for j in 0..3 {
            for i in 0..3 {
                jacobian[(3 + count + i, 3 + count + j)] = by_friction[(i, j)];
                jacobian[(i, 3 + count + j)] = lever[j][i] * scales.impulse / scales.moment;
            }
        }
    }

    for i in 0..3 {
        rows[i] = moment[i] / scales.moment;
        error = error.max(moment[i].abs() / (scales.load * step.size));
        for j in 0..3 {
            jacobian[(i, j)] = moment_by_angular[(i, j)] * scales.angular / scales.moment;
        }
    }
    let at = Evaluation { unknowns: *x, linear, rotation, height, normal, arm, slip, slips, error };
    (at, rows, jacobian)
}

#[cfg(test)]
mod tests;
