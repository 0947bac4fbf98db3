//! `Trial`.

use crate::body::PyBody;
use crate::convert::{choose, quaternion, refused};
use crate::field::PyField;
use dynamics::{
    AdhesionActsAt, AdhesionEnters, MagneticTorque, Model, Robot, Substrate, Trial, Vec3, trial::TrialParts,
};
use pyo3::prelude::*;

#[pyclass(name = "Trial", module = "tumblers._core", frozen)]
pub struct PyTrial(pub Trial);

#[pymethods]
impl PyTrial {
    #[new]
    #[pyo3(signature = (*, body, mass_kg, magnetic_moment_A_m2, friction_coefficient, friction_ellipsoid,
        adhesion_N_per_m2, electrostatic_force_N, line_contact_width_m, field, incline_rad, gravity_m_per_s2,
        duration_s, step_s, magnetic_torque, adhesion_acts_at, adhesion_enters, position_m=None, orientation=None,
        linear_velocity_m_per_s=[0.0; 3], angular_velocity_rad_per_s=[0.0; 3]))]
    #[allow(clippy::too_many_arguments)] // one keyword for each number of a scenario
    fn new(
        body: &PyBody,
        mass_kg: f64,
        magnetic_moment_A_m2: [f64; 3],
        friction_coefficient: f64,
        friction_ellipsoid: [f64; 3],
        adhesion_N_per_m2: f64,
        electrostatic_force_N: f64,
        line_contact_width_m: f64,
        field: &PyField,
        incline_rad: f64,
        gravity_m_per_s2: f64,
        duration_s: f64,
        step_s: f64,
        magnetic_torque: &str,
        adhesion_acts_at: &str,
        adhesion_enters: &str,
        position_m: Option<[f64; 3]>,
        orientation: Option<[f64; 4]>,
        linear_velocity_m_per_s: [f64; 3],
        angular_velocity_rad_per_s: [f64; 3],
    ) -> PyResult<Self> {
        let robot = Robot::new(body.0.clone(), mass_kg, magnetic_moment_A_m2.into()).map_err(refused)?;
        let substrate = Substrate {
            friction_coefficient,
            friction_ellipsoid,
            adhesion: adhesion_N_per_m2,
            electrostatic_force: electrostatic_force_N,
            line_contact_width: line_contact_width_m,
        };
        let model = Model {
            magnetic_torque: choose(
                "magnetic_torque",
                magnetic_torque,
                &[
                    ("end_of_step", MagneticTorque::EndOfStep),
                    ("start_of_step", MagneticTorque::StartOfStep),
                    ("midpoint", MagneticTorque::Midpoint),
                ],
            )?,
            adhesion_acts_at: choose(
                "adhesion_acts_at",
                adhesion_acts_at,
                &[("ecp", AdhesionActsAt::Ecp), ("patch_centroid", AdhesionActsAt::PatchCentroid)],
            )?,
            adhesion_enters: choose(
                "adhesion_enters",
                adhesion_enters,
                &[("normal", AdhesionEnters::Normal), ("friction_only", AdhesionEnters::FrictionOnly)],
            )?,
        };
        let parts = TrialParts {
            robot,
            substrate,
            field: field.0.clone(),
            model,
            incline: incline_rad,
            gravity: gravity_m_per_s2,
            duration: duration_s,
            step: step_s,
            position: position_m.map(Vec3::from),
            orientation: quaternion(orientation.unwrap_or([1.0, 0.0, 0.0, 0.0])),
            linear: linear_velocity_m_per_s.into(),
            angular: angular_velocity_rad_per_s.into(),
        };
        Trial::new(parts).map(Self).map_err(refused)
    }

    #[getter]
    fn stability_bound_s(&self) -> f64 {
        self.0.robot().stability_bound(self.0.field().greatest_strength())
    }

    #[getter]
    fn steps(&self) -> u64 {
        self.0.steps()
    }
}
