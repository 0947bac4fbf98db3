//! The choices that the paper leaves open.

/// When in the step the magnetic torque is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MagneticTorque {
    /// The paper's equation, `T(R, t)`.
    StartOfStep,
    /// `T(R⁺, t + h)`.
    EndOfStep,
    /// The mean of the torques in the middle of the last step and of this one.
    Midpoint,
}

/// Where the adhesive force acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AdhesionActsAt {
    /// At the equivalent contact point, the paper's equation.
    Ecp,
    /// At the centroid of the patch that touched in the step before.
    PatchCentroid,
}

/// What the adhesive force enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AdhesionEnters {
    /// The balance of normal forces, the paper's equation.
    Normal,
    /// The bound of the friction force only.
    FrictionOnly,
}

/// The model's switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Model {
    /// When the torque is taken.
    pub magnetic_torque: MagneticTorque,
    /// Where adhesion acts.
    pub adhesion_acts_at: AdhesionActsAt,
    /// What adhesion enters.
    pub adhesion_enters: AdhesionEnters,
}
