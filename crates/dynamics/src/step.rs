//! The data of one step: what is known before it is solved.

use crate::magnetics::TorqueLaw;
use crate::momentum::MomentumLaw;
use crate::rotation::matrix;
use crate::{Adhesion, AdhesionActsAt, AdhesionEnters, Mat3, State, Trial, Vec3};
use geometry::Body;

/// The radius `b` of the ball that holds `E⁻¹p`.
#[derive(Debug, Clone, Copy)]
pub enum FrictionBound {
    /// `b = μ p̄`.
    Coulomb(f64),
    /// `b` whatever the normal impulse is: Tresca's friction.
    Held(f64),
}

impl FrictionBound {
    /// `b` for `p̄`.
    #[inline]
    pub fn of(&self, impulse: f64) -> f64 {
        match self {
            Self::Coulomb(coefficient) => coefficient * impulse,
            Self::Held(bound) => *bound,
        }
    }

    /// `db/dp̄`.
    #[inline]
    pub fn slope(&self) -> f64 {
        match self {
            Self::Coulomb(coefficient) => *coefficient,
            Self::Held(_) => 0.0,
        }
    }
}

/// Everything that the step from `u` to `u+1` depends on.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// The shape.
    pub body: &'a Body,
    /// s.
    pub h: f64,
    /// `m + h k`, kg: translational drag takes `h k v⁺`, as a greater mass would.
    pub mass: f64,
    /// `ℓ`, the scale of lengths.
    pub size: f64,
    /// `R^u`.
    pub rotation: Mat3,
    /// `I^u` in the substrate frame.
    pub inertia: Mat3,
    /// At the start of the step, with the velocity `m v/(m + h k)`.
    pub state: State,
    /// `h F_ext`.
    pub load: Vec3,
    /// The change of angular momentum.
    pub momentum: MomentumLaw,
    /// The magnetic torque.
    pub torque: TorqueLaw,
    /// `E = diag(e_t, e_o, e_r)`.
    pub ellipsoid: Vec3,
    /// The radius of the friction ball.
    pub friction: FrictionBound,
    /// `p_a`.
    pub adhesion: f64,
    /// Whether `p_a` pulls at the ECP, so that `N = p_n - p_a`.
    pub pulls_at_ecp: bool,
    /// Whether `p_a` only raises the friction bound.
    pub raises_bound: bool,
    /// The impulse and moment of `p_a` at the centroid, zero where it acts at the ECP.
    pub pull: Vec3,
    /// N m s.
    pub pull_moment: Vec3,
    /// `c/h`: how far the plane yields per normal impulse, m/(N s).
    pub yielding: f64,
    /// `P` before the contact impulses are known.
    pub load_scale: f64,
}

impl<'a> Step<'a> {
    /// The step of `trial` that starts at time `t` in `state`.
    pub fn new(trial: &'a Trial, state: &State, t: f64, adhesion: &Adhesion) -> Self {
        let robot = trial.robot();
        let h = trial.step();
        let rotation = matrix(&state.orientation);
        let inertia = rotation * robot.inertia() * rotation.transpose();
        let model = trial.model();
        let normal = model.adhesion_enters == AdhesionEnters::Normal;
        let at_centroid = normal && model.adhesion_acts_at == AdhesionActsAt::PatchCentroid;
        let (pull, pull_moment) = if at_centroid && adhesion.impulse > 0.0 {
            let pull = Vec3::new(0.0, 0.0, -adhesion.impulse);
            (pull, (adhesion.centroid - state.position).cross(&pull))
        } else {
            (Vec3::zeros(), Vec3::zeros())
        };
        let moment = rotation * robot.moment();
        let drag = trial.surroundings().drag(&moment, state.position.z, robot.body().size());
        let (mut mass, mut start) = (robot.mass(), *state);
        if let Some((linear, _)) = drag
            && linear > 0.0
        {
            mass += h * linear;
            start.linear *= robot.mass() / mass;
        }
        let relief = trial.relief();
        // From the substrate's frame to that of the tangent plane.
        let tilt = (!relief.is_flat()).then(|| relief.tilt(state.position.y).transpose());
        let field = trial.field();
        let mut torque = match &tilt {
            None => TorqueLaw::new(model.magnetic_torque, |t| field.at(t), moment, &state.angular, t, h),
            Some(tilt) => TorqueLaw::new(model.magnetic_torque, |t| tilt * field.at(t), moment, &state.angular, t, h),
        };
        let mut load = trial.load(tilt.as_ref());
        if let Some((force, moment)) = trial.surroundings().wrench(t + 0.5 * h) {
            let turned = |v: Vec3| tilt.map_or(v, |tilt| tilt * v);
            load += turned(force);
            torque = torque.with_impulse(turned(moment) * h);
        }
        load *= h;
        let size = robot.body().size();
        let load_scale = mass * start.linear.norm()
            + (inertia * start.angular).norm() / size
            + load.norm()
            + torque.greatest() / size
            + adhesion.impulse;
        Self {
            body: robot.body(),
            h,
            mass,
            size,
            rotation,
            inertia,
            state: start,
            load,
            momentum: MomentumLaw::new(
                model.magnetic_torque,
                &inertia,
                &state.angular,
                h,
                drag.as_ref().map(|(_, angular)| angular),
            ),
            torque,
            ellipsoid: Vec3::from(trial.substrate().friction_ellipsoid),
            friction: FrictionBound::Coulomb(trial.substrate().friction_at(t + 0.5 * h)),
            adhesion: adhesion.impulse,
            pulls_at_ecp: normal && !at_centroid,
            raises_bound: !normal,
            pull,
            pull_moment,
            yielding: trial.substrate().compliance / h,
            load_scale,
        }
    }

    /// `δ`: how far the plane has yielded under the normal impulse `p_n`, m.
    #[inline]
    pub fn yielded(&self, normal: f64) -> f64 {
        self.yielding * normal
    }

    /// `p_n` of the normal impulse `N` at the ECP.
    #[inline]
    pub fn normal_impulse(&self, at_ecp: f64) -> f64 {
        if self.pulls_at_ecp { at_ecp + self.adhesion } else { at_ecp }
    }

    /// The impulse in the friction bound, `p̄ = p_n`, or `p_n + p_a` while `p_n > 0`.
    #[inline]
    pub fn bound_impulse(&self, normal: f64) -> f64 {
        if self.raises_bound && normal > 0.0 { normal + self.adhesion } else { normal }
    }
}
