//! What acts on the robot beside gravity, the field and the substrate.

use crate::error::{Invalid, finite, not_negative};
use crate::{Mat3, Vec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// `μ0`, N/A².
const VACUUM_PERMEABILITY: f64 = 4e-7 * PI;
/// Over `ℓ`: the height at which the eddy currents' drag stops growing.
const LOWEST: f64 = 0.01;

/// A generalized force: force (N) and torque about the centre of mass (N m), substrate frame.
pub type Wrench = (Vec3, Vec3);

/// Constant and tabulated forces, and drags.
#[derive(Debug, Clone)]
pub struct Surroundings {
    /// N.
    pub force: Vec3,
    /// N m.
    pub torque: Vec3,
    /// `k`, N s/m.
    pub translational_drag: f64,
    /// N m s.
    pub rotational_drag: f64,
    /// Conductance `S` of a thin conducting sheet at `z = 0`, S.
    pub sheet_conductance: f64,
    /// When each of `wrenches` begins to act, s; increasing.
    pub times: Arc<[f64]>,
    /// Each acts to the time of the next, the last to the end.
    pub wrenches: Arc<[Wrench]>,
}

/// The drag of a step: `k`, N s/m, and the matrix of torque per angular velocity, N m s.
pub type Drag = (f64, Mat3);

impl Surroundings {
    /// Nothing.
    pub fn none() -> Self {
        Self {
            force: Vec3::zeros(),
            torque: Vec3::zeros(),
            translational_drag: 0.0,
            rotational_drag: 0.0,
            sheet_conductance: 0.0,
            times: Arc::new([]),
            wrenches: Arc::new([]),
        }
    }

    /// Refuses the first number that makes no sense.
    pub fn check(&self) -> Result<(), Invalid> {
        for component in self.force.iter() {
            finite("force_N", *component)?;
        }
        for component in self.torque.iter() {
            finite("torque_N_m", *component)?;
        }
        not_negative("translational_drag_N_s_per_m", self.translational_drag)?;
        not_negative("rotational_drag_N_m_s", self.rotational_drag)?;
        not_negative("sheet_conductance_S", self.sheet_conductance)?;
        if self.times.len() != self.wrenches.len() {
            return Err(Invalid::Lengths {
                name: "wrench_N_N_m",
                found: self.wrenches.len(),
                expected: self.times.len(),
            });
        }
        for (row, (time, (force, torque))) in self.times.iter().zip(self.wrenches.iter()).enumerate() {
            finite("wrench_time_s", *time)?;
            if row > 0 && *time <= self.times[row - 1] {
                return Err(Invalid::WrenchOrder { row: row + 1, found: *time, before: self.times[row - 1] });
            }
            for component in force.iter().chain(torque.iter()) {
                finite("wrench_N_N_m", *component)?;
            }
        }
        Ok(())
    }

    /// What acts at the time `t`, or `None` where nothing ever does.
    #[inline]
    pub fn wrench(&self, t: f64) -> Option<Wrench> {
        if self.times.is_empty() && self.force == Vec3::zeros() && self.torque == Vec3::zeros() {
            return None;
        }
        let begun = self.times.partition_point(|time| *time <= t);
        let (force, torque) = if begun == 0 { (Vec3::zeros(), Vec3::zeros()) } else { self.wrenches[begun - 1] };
        Some((self.force + force, self.torque + torque))
    }

    /// The drag on a body of `size` with the magnetic moment `M` (substrate frame) at the height `z`, or `None` where
    /// nothing drags.
    ///
    /// Eddy currents in a thin sheet are images that recede from it with `2/(μ0 S)`. Far below that speed (Reitz 1970,
    /// J. Appl. Phys. 41, 2067)
    ///
    /// ```text
    /// D = κ [M]ₓ G [M]ₓᵀ,   κ = μ0² S/(32π z²),   G = diag(1/2, 1/2, 1),   k = 3 μ0² S (M_z² + (M_x² + M_y²)/2)/(128π z⁴)
    /// ```
    #[inline]
    pub fn drag(&self, moment: &Vec3, z: f64, size: f64) -> Option<Drag> {
        if self.translational_drag == 0.0 && self.rotational_drag == 0.0 && self.sheet_conductance == 0.0 {
            return None;
        }
        let z = z.max(LOWEST * size);
        let squared = VACUUM_PERMEABILITY * VACUUM_PERMEABILITY * self.sheet_conductance / (PI * z * z);
        let cross = moment.cross_matrix();
        let images = Mat3::from_diagonal(&Vec3::new(0.5, 0.5, 1.0));
        let eddy = cross * images * cross.transpose() * (squared / 32.0);
        let square = moment.z * moment.z + 0.5 * moment.xy().norm_squared();
        let linear = self.translational_drag + 3.0 * squared * square / (128.0 * z * z);
        Some((linear, Mat3::from_diagonal_element(self.rotational_drag) + eddy))
    }
}
