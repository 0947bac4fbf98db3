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

use crate::contact::{ContactPoints, of_generator};
use crate::friction::FrictionRows;
use crate::rotation::cayley;
use crate::step::Step;
use crate::{Mat3, Vec3};
use elimination::Factors;
use geometry::Support;
use nalgebra::SVector;
use scales::Scales;

mod elimination;
mod jacobian;
mod scales;

/// Scaled residual at which the reduced problem counts as solved.
const TOLERANCE: f64 = 1e-14;
/// What rounding leaves of it. A start that has more is sharpened, so that what carries it on never feeds on its own errors.
const ROUNDING: f64 = 1e-15;
/// Scaled residual that is still good where rounding stops Newton's method.
const ACCEPTABLE: f64 = 1e-11;
const MAX_ITERATIONS: u32 = 40;
const MAX_HALVINGS: u32 = 8;
/// `|N|/P` below which the ECP is taken at the middle of the support.
const NO_FORCE: f64 = 1e-14;
/// Over its scale, an unknown that is zero. Each iteration takes one that has to vanish down by many orders, and processors are
/// slow with what is left below 1e-308.
const NOTHING: f64 = 1e-100;

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

/// Semismooth Newton with step halving on the greatest scaled row. Where one more fall by the ratio of the last is enough, the
/// Jacobian serves once more: so near to the solution it hardly changes.
fn newton<const N: usize>(step: &Step, support: Support, hang: Option<u16>, start: &Unknowns) -> Reduced {
    let scales = Scales::<N>::new(step, start);
    let mut here = Rows::<N>::new(step, support, hang, start, &scales);
    let mut kept: Option<Factors<N>> = None;
    let mut iterations = 0;
    let mut enough = ROUNDING;
    while here.at.error > enough && iterations < MAX_ITERATIONS {
        iterations += 1;
        let old = kept.is_some();
        let Some(factors) = kept.take().or_else(|| Factors::of(&here.jacobian(step, support, hang, &scales))) else {
            break;
        };
        let direction = factors.solve(&here.value);
        let rows_after = |length: f64| {
            Rows::<N>::new(step, support, hang, &here.at.unknowns.moved(&direction, length, &scales), &scales)
        };
        let mut length = 1.0;
        let mut next = rows_after(length);
        let falls = |next: &Rows<N>| next.at.error < here.at.error;
        if old && !falls(&next) {
            continue;
        }
        if here.at.error <= TOLERANCE && !falls(&next) {
            break;
        }
        for _ in 0..MAX_HALVINGS {
            if falls(&next) {
                break;
            }
            length *= 0.5;
            next = rows_after(length);
        }
        if !next.at.error.is_finite() || (next.at.error >= here.at.error && here.at.error <= ACCEPTABLE) {
            break;
        }
        if next.at.error * (next.at.error / here.at.error) <= ROUNDING {
            kept = Some(factors);
        }
        here = next;
        enough = TOLERANCE;
    }
    Reduced { at: here.at, iterations, converged: here.at.error <= ACCEPTABLE }
}

impl Unknowns {
    /// All zero.
    pub fn at_rest() -> Self {
        Self { angular: Vec3::zeros(), impulses: [0.0; 3], friction: Vec3::zeros() }
    }

    fn moved<const N: usize>(&self, direction: &SVector<f64, N>, length: f64, scales: &Scales<N>) -> Self {
        let after = |value: f64, i: usize, scale: f64| {
            let next = value - length * direction[i] * scale;
            // What is no number stays none, and the rows show it.
            if next.abs() > NOTHING * scale { next } else { 0.0 * next }
        };
        let mut next = *self;
        for i in 0..3 {
            next.angular[i] = after(self.angular[i], i, scales.angular);
        }
        let points = N.saturating_sub(6);
        for j in 0..points {
            next.impulses[j] = after(self.impulses[j], 3 + j, scales.impulse);
        }
        if points > 0 {
            for i in 0..3 {
                next.friction[i] = after(self.friction[i], 3 + points + i, scales.impulse);
            }
        }
        next
    }
}

/// Rows A, B, C at a point, scaled, and what their Jacobian takes from them.
struct Rows<const N: usize> {
    at: Evaluation,
    value: SVector<f64, N>,
    points: ContactPoints,
    friction: Option<FrictionRows>,
}

impl<const N: usize> Rows<N> {
    /// `k`, the number of impulses.
    const POINTS: usize = N.saturating_sub(6);

    /// The rows at `x`.
    fn new(step: &Step, support: Support, hang: Option<u16>, x: &Unknowns, scales: &Scales<N>) -> Self {
        let turn = cayley(&(x.angular * (0.5 * step.h)));
        let rotation = turn * step.rotation;
        let points = ContactPoints::new(step.body, support, &rotation);
        let count = Self::POINTS;

        let e = step.ellipsoid;
        let p = e.component_mul(&x.friction);
        let normal: f64 = x.impulses[..count].iter().sum();
        let mut linear = step.state.linear + (step.load + step.pull) / step.mass;
        let change = step.momentum.change(&step.inertia, &x.angular);
        let mut moment = change - step.torque.impulse_after(&turn, &x.angular) - step.pull_moment;

        let mut value = SVector::<f64, N>::zeros();
        let mut arm = Vec3::zeros();
        let mut slip = Vec3::zeros();
        let mut friction = None;
        let mut error: f64 = 0.0;
        let height;

        if count == 0 {
            if let Some(generator) = hang {
                arm = of_generator(step.body, generator, &rotation);
                linear.z -= step.adhesion / step.mass;
                // -p_a y × n, negated as a load.
                moment += arm.cross(&Vec3::z()) * step.adhesion;
            }
            height = step.state.position.z + step.h * linear.z;
        } else {
            linear += Vec3::new(p.x, p.y, normal) / step.mass;
            height = step.state.position.z + step.h * linear.z + step.yielded(step.normal_impulse(normal));
            for j in 0..count {
                arm += points.y[j] * share(x, normal, j, scales);
            }
            arm.z = -height;

            moment -= arm.cross(&Vec3::new(p.x, p.y, 0.0));
            moment.z -= p.z;
            for j in 0..count {
                let y = points.y[j];
                moment -= Vec3::new(y.y, -y.x, 0.0) * x.impulses[j];
                value[3 + j] = (height + y.z) / scales.length;
                error = error.max(value[3 + j].abs());
            }

            // u = (v_x + ω_y r_z - ω_z r_y, v_y + ω_z r_x - ω_x r_z, ω_z)
            let surface = linear + x.angular.cross(&arm);
            slip = Vec3::new(surface.x, surface.y, x.angular.z);
            let bound = step.friction.of(step.bound_impulse(step.normal_impulse(normal)));
            let rows = FrictionRows::new(&x.friction, &e.component_mul(&slip), bound, step.mass);
            value.fixed_rows_mut::<3>(3 + count).copy_from(&(rows.value * (1.0 / scales.impulse)));
            error = error.max(rows.value.amax() / scales.load);
            friction = Some(rows);
        }

        value.fixed_rows_mut::<3>(0).copy_from(&(moment * (1.0 / scales.moment)));
        error = error.max(moment.amax() / (scales.load * step.size));
        // `max` passes over NaN, and a point without numbers would count as solved.
        if value.iter().any(|row| row.is_nan()) {
            error = f64::INFINITY;
        }
        let slips = friction.as_ref().is_some_and(FrictionRows::slips);
        let at = Evaluation { unknowns: *x, linear, rotation, height, normal, arm, slip, slips, error };
        Self { at, value, points, friction }
    }
}

/// Whether there is a normal impulse to share out.
#[inline]
fn supported<const N: usize>(normal: f64, scales: &Scales<N>) -> bool {
    normal.abs() > NO_FORCE * scales.load
}

/// The weight of `y_j` in `r`.
#[inline]
fn share<const N: usize>(x: &Unknowns, normal: f64, j: usize, scales: &Scales<N>) -> f64 {
    if supported(normal, scales) { x.impulses[j] / normal } else { 1.0 / Rows::<N>::POINTS as f64 }
}

#[cfg(test)]
mod tests;
