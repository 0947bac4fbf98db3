//! The paper's mixed nonlinear complementarity problem of one step, unreduced.
//!
//! Unknowns `z = [v⁺; ω⁺; a1; a2; p_t; p_o; p_r; l_k | l_i, i≠k; l_{m+1}; σ; p_n]`, with `C_F = ∇f_k + Σ_{i≠k} l_i ∇f_i` at
//! `a1`, `r = a1 - q⁺`, `u = [W_t W_o W_r]ᵀV⁺`:
//!
//! ```text
//! 0 = m (v⁺ - v) + h k v⁺ - [p_t, p_o, N] - h F_ext
//! 0 = ΔL(ω⁺) + h D ω⁺ - hT - r × [p_t, p_o, N] - p_r n
//! 0 = a1 - a2 + l_k C_F
//! 0 = C_F + l_{m+1} n
//! 0 = μ e_j² p̄ u_j + p_j σ                      j = t, o, r
//! 0 = -f_k(a1)
//! 0 ≤ l_i     ⊥ -f_i(a1) ≥ 0                    i ≠ k
//! 0 ≤ l_{m+1} ⊥ -g(a2) ≥ 0
//! 0 ≤ σ       ⊥ (μ p̄)² - Σ (p_j/e_j)² ≥ 0
//! 0 ≤ p_n     ⊥ max_i f_i(a2) ≥ 0
//! ```
//!
//! `g(a) = a_z + δ` with the plane yielded by `δ = c p_n/h`.
//!
//! The paper pairs `l_k ≥ 0` with `-f_k(a1) ≥ 0` too, although `k` is active by its definition. As a pair it lets `a1 = a2`
//! lie below the surface `k`, with `l_k = 0`: the body sinks in. `f_k = 0` excludes that, and `l_k ≥ 0` follows from the last
//! pair.
//!
//! Impulses are in units of the load `P` that is known before the step, velocities of `P/m`, lengths of `ℓ`; `p_t`,
//! `p_o`, `p_r` also of `e_t`, `e_o`, `e_r`, so that the friction rows are alike.

use crate::rotation::cayley;
use crate::step::Step;
use crate::{Mat3, StepSolution, Vec3};
use std::cmp::Ordering;

/// Equality rows and free unknowns, `l_k` the last of them.
pub const FREE: usize = 16;
/// Where `l_k` and the row of `f_k` are.
pub(crate) const ACTIVE: usize = FREE - 1;

/// The unreduced problem of a step for the active index `k`.
#[derive(Debug, Clone, Copy)]
pub struct StepProblem<'a> {
    /// The data of the step.
    pub step: &'a Step<'a>,
    /// `k`.
    pub active: usize,
}

/// `z` as vectors, in SI units.
pub(crate) struct Point {
    pub linear: Vec3,
    pub angular: Vec3,
    pub ecp: Vec3,
    pub ecp_substrate: Vec3,
    pub friction: Vec3,
    pub sigma: f64,
    pub normal: f64,
    pub rotation: Mat3,
    /// `a1 - q⁺`, `a2 - q⁺`.
    pub arm: Vec3,
    pub arm_substrate: Vec3,
    /// The same in the body frame.
    pub body_arm: Vec3,
    pub body_arm_substrate: Vec3,
}

impl<'a> StepProblem<'a> {
    /// The problem of `step` for the active index `active`.
    pub fn new(step: &'a Step<'a>, active: usize) -> Self {
        Self { step, active }
    }

    /// `m`, the number of surfaces.
    pub fn surfaces(&self) -> usize {
        self.step.body.surfaces().len()
    }

    /// Where `l_i` and the row of `f_i` are.
    #[inline]
    pub fn slot(&self, surface: usize) -> usize {
        match surface.cmp(&self.active) {
            Ordering::Less => FREE + surface,
            Ordering::Equal => ACTIVE,
            Ordering::Greater => ACTIVE + surface,
        }
    }

    /// Where `l_{m+1}`, `σ` and `p_n` and their rows are.
    #[inline]
    pub fn last_slots(&self) -> (usize, usize, usize) {
        let first = ACTIVE + self.surfaces();
        (first, first + 1, first + 2)
    }

    /// `P`, or `m ℓ/h` for a body on which nothing acts.
    pub fn impulse_unit(&self) -> f64 {
        let load = self.step.load_scale;
        if load > 0.0 { load } else { self.step.mass * self.step.size / self.step.h }
    }

    /// `P/m`.
    pub fn velocity_unit(&self) -> f64 {
        self.impulse_unit() / self.step.mass
    }

    /// `ℓ` over the unit of velocities: from angular velocities to numbers.
    pub(crate) fn angular_scale(&self) -> f64 {
        self.step.size / self.velocity_unit()
    }

    /// The impulse units of `p_t`, `p_o`, `p_r`.
    pub(crate) fn friction_units(&self) -> Vec3 {
        self.step.ellipsoid * self.impulse_unit()
    }

    /// Writes `solution` as `z`.
    pub fn write(&self, solution: &StepSolution, z: &mut [f64]) {
        let (m, step) = (self.surfaces(), self.step);
        let (velocity, impulse) = (self.velocity_unit(), self.impulse_unit());
        let friction = solution.friction.component_div(&self.friction_units());
        for i in 0..3 {
            z[i] = solution.linear[i] / velocity;
            z[3 + i] = solution.angular[i] * self.angular_scale();
            z[6 + i] = (solution.ecp[i] - step.state.position[i]) / step.size;
            z[9 + i] = (solution.ecp_substrate[i] - step.state.position[i]) / step.size;
            z[12 + i] = friction[i];
        }
        for i in 0..m {
            z[self.slot(i)] = solution.multipliers[i];
        }
        z[ACTIVE] /= step.size;
        let (plane, sigma, normal) = self.last_slots();
        z[plane] = solution.plane_multiplier;
        z[sigma] = solution.sigma / velocity;
        z[normal] = solution.normal / impulse;
    }

    /// Reads `z` into `solution`.
    pub fn read(&self, z: &[f64], solution: &mut StepSolution) {
        let m = self.surfaces();
        let point = self.point(z);
        solution.linear = point.linear;
        solution.angular = point.angular;
        solution.ecp = point.ecp;
        solution.ecp_substrate = point.ecp_substrate;
        solution.friction = point.friction;
        for i in 0..m {
            solution.multipliers[i] = z[self.slot(i)];
        }
        solution.multipliers[self.active] *= self.step.size;
        solution.plane_multiplier = z[self.last_slots().0];
        solution.sigma = point.sigma;
        solution.normal = point.normal;
        solution.active = self.active;
        solution.slip = slip(&point);
    }

    pub(crate) fn point(&self, z: &[f64]) -> Point {
        let step = self.step;
        let (_, sigma, normal) = self.last_slots();
        let vector = |at: usize| Vec3::new(z[at], z[at + 1], z[at + 2]);
        let (linear, angular) = (vector(0) * self.velocity_unit(), vector(3) / self.angular_scale());
        let (ecp, ecp_substrate) = (vector(6) * step.size, vector(9) * step.size);
        let travel = linear * step.h;
        let rotation = cayley(&(angular * (0.5 * step.h))) * step.rotation;
        let (arm, arm_substrate) = (ecp - travel, ecp_substrate - travel);
        Point {
            linear,
            angular,
            ecp: ecp + step.state.position,
            ecp_substrate: ecp_substrate + step.state.position,
            friction: vector(12).component_mul(&self.friction_units()),
            sigma: z[sigma] * self.velocity_unit(),
            normal: z[normal] * self.impulse_unit(),
            rotation,
            arm,
            arm_substrate,
            body_arm: rotation.tr_mul(&arm),
            body_arm_substrate: rotation.tr_mul(&arm_substrate),
        }
    }

    /// `N` at the ECP for `p_n`.
    pub(crate) fn at_ecp(&self, normal: f64) -> f64 {
        if self.step.pulls_at_ecp { normal - self.step.adhesion } else { normal }
    }

    /// `∇f_i` in the substrate frame, at `body_arm` from the centre of mass in the body frame.
    pub(crate) fn gradient(&self, surface: usize, point: &Point, body_arm: &Vec3) -> Vec3 {
        point.rotation * self.step.body.surfaces()[surface].gradient(body_arm)
    }

    /// The weight of `∇f_i` in `C_F`.
    pub(crate) fn weight(&self, surface: usize, z: &[f64]) -> f64 {
        if surface == self.active { 1.0 } else { z[self.slot(surface)] }
    }

    pub(crate) fn normal_cone(&self, z: &[f64], point: &Point) -> Vec3 {
        (0..self.surfaces())
            .filter(|i| self.weight(*i, z) != 0.0)
            .map(|i| self.gradient(i, point, &point.body_arm) * self.weight(i, z))
            .sum()
    }

    /// Equality rows, then the right-hand sides of the complementarity pairs.
    pub fn rows(&self, z: &[f64], out: &mut [f64]) {
        let step = self.step;
        let at = self.point(z);
        let impulse = self.impulse_unit();
        let (plane_slot, sigma_slot, normal_slot) = self.last_slots();
        let contact = Vec3::new(at.friction.x, at.friction.y, self.at_ecp(at.normal));
        let force = (at.linear - step.state.linear) * step.mass - contact - step.load - step.pull;
        let torque = step.torque.impulse(&at.angular);
        let change = step.momentum.change(&step.inertia, &at.angular);
        let mut moment = change - torque - at.arm.cross(&contact) - step.pull_moment;
        moment.z -= at.friction.z;

        let cone = self.normal_cone(z, &at);
        let apart = (at.arm - at.arm_substrate) / step.size + cone * z[ACTIVE];
        let opposed = cone + Vec3::z() * z[plane_slot];

        let bound = step.friction.of(step.bound_impulse(at.normal)) / impulse;
        let slip = slip(&at) / self.velocity_unit();
        let (e, sigma) = (step.ellipsoid, z[sigma_slot]);
        for i in 0..3 {
            out[i] = force[i] / impulse;
            out[3 + i] = moment[i] / (impulse * step.size);
            out[6 + i] = apart[i];
            out[9 + i] = opposed[i];
            out[12 + i] = e[i] * slip[i] * bound + z[12 + i] * sigma;
        }
        for (i, surface) in step.body.surfaces().iter().enumerate() {
            out[self.slot(i)] = -surface.value(&at.body_arm) / step.size;
        }
        out[plane_slot] = -(at.ecp_substrate.z + step.yielded(at.normal)) / step.size;
        out[sigma_slot] = bound * bound - z[12] * z[12] - z[13] * z[13] - z[14] * z[14];
        out[normal_slot] = self.greatest(&at).1 / step.size;
    }

    /// The index of the greatest `f_i(a2)` at `z`.
    pub fn greatest_surface(&self, z: &[f64]) -> usize {
        self.greatest(&self.point(z)).0
    }

    /// The index and value of `max_i f_i(a2)`.
    pub(crate) fn greatest(&self, point: &Point) -> (usize, f64) {
        self.step.body.max_value(&point.body_arm_substrate)
    }
}

/// `u = [W_t W_o W_r]ᵀV⁺`.
pub(crate) fn slip(at: &Point) -> Vec3 {
    let surface = at.linear + at.angular.cross(&at.arm);
    Vec3::new(surface.x, surface.y, at.angular.z)
}
