//! The solution of one step: every unknown of the paper's problem.

use crate::rotation::{advance, matrix};
use crate::{State, Vec3};
use geometry::{Body, Patch, Support};

/// `[V⁺; a1; a2; p_t; p_o; p_r]`, `[l; l_{m+1}; σ; p_n]` and what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct StepSolution {
    /// `v⁺`, m/s.
    pub linear: Vec3,
    /// `ω⁺`, rad/s.
    pub angular: Vec3,
    /// `a1`, `a2`: the equivalent contact point on the body and on the substrate, m.
    pub ecp: Vec3,
    /// `a2`, m.
    pub ecp_substrate: Vec3,
    /// `p_t`, `p_o` (N s) and `p_r` (N m s).
    pub friction: Vec3,
    /// `l_1..l_m`, NaN of a step that was not verified.
    pub multipliers: Vec<f64>,
    /// `l_{m+1}`, NaN of a step that was not verified.
    pub plane_multiplier: f64,
    /// `σ`.
    pub sigma: f64,
    /// `p_n`, N s.
    pub normal: f64,
    /// `k`, 0 of a step that was not verified.
    pub active: usize,
    /// `[W_t W_o W_r]ᵀV⁺`.
    pub slip: Vec3,
    /// What touches after the step.
    pub support: Support,
    /// How much of the real body that is.
    pub patch: Patch,
    /// The scaled natural residual of the unreduced problem, NaN of a step that was not verified.
    pub residual: f64,
    /// How far the body's lowest point is below the plane, m.
    pub penetration: f64,
    /// Newton iterations, over all supports that were tried.
    pub iterations: u32,
    /// Whether the residual is small enough, or the reduced problem's where the step was not verified, and the turn resolved.
    pub converged: bool,
}

impl StepSolution {
    /// Storage for the steps of `body`.
    pub fn for_body(body: &Body) -> Self {
        Self {
            linear: Vec3::zeros(),
            angular: Vec3::zeros(),
            ecp: Vec3::zeros(),
            ecp_substrate: Vec3::zeros(),
            friction: Vec3::zeros(),
            multipliers: vec![0.0; body.surfaces().len()],
            plane_multiplier: 0.0,
            sigma: 0.0,
            normal: 0.0,
            active: 0,
            slip: Vec3::zeros(),
            support: Support::None,
            patch: body.patch(Support::None, &-Vec3::z()),
            residual: 0.0,
            penetration: 0.0,
            iterations: 0,
            converged: true,
        }
    }
}

impl StepSolution {
    /// Takes the numbers of the unreduced problem alone from a step that was not held against it.
    pub fn leave_unverified(&mut self) {
        self.active = 0;
        self.multipliers.fill(f64::NAN);
        self.plane_multiplier = f64::NAN;
        self.residual = f64::NAN;
    }

    /// `∇f_i(a1)` of every surface after a step of length `h` that began in `state`, in the substrate frame.
    pub fn gradients(&self, body: &Body, state: &State, h: f64) -> Vec<Vec3> {
        let rotation = matrix(&advance(&state.orientation, &self.angular, h));
        let point = rotation.transpose() * (self.ecp - state.position - self.linear * h);
        body.surfaces().iter().map(|surface| rotation * surface.gradient(&point)).collect()
    }
}

/// Sets the multipliers of `solution` at its ECP, `point` in the body frame, from `Σ λ_i ∇f_i(a1) = -n`: with the paper's
/// index, `k = argmax λ`, `l_i = λ_i/λ_k`, `l_k = d λ_k`, `l_{m+1} = 1/λ_k`. `down` is `-n` in the body frame.
pub fn set_normal_cone(body: &Body, support: Support, point: &Vec3, down: &Vec3, solution: &mut StepSolution) {
    let multipliers = &mut solution.multipliers;
    body.multipliers(support, point, down, multipliers);
    let (active, greatest) =
        multipliers.iter().enumerate().fold((0, 0.0), |best, (i, l)| if *l > best.1 { (i, *l) } else { best });
    solution.active = active;
    solution.plane_multiplier = 1.0;
    if greatest > 0.0 {
        multipliers.iter_mut().for_each(|l| *l /= greatest);
        multipliers[active] = (solution.ecp.z - solution.ecp_substrate.z) * greatest;
        solution.plane_multiplier = 1.0 / greatest;
    }
}
