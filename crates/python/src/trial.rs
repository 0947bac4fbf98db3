//! `Trial`.

use crate::body::PyBody;
use crate::convert::{choose, quaternion, refused};
use crate::field::PyField;
use dynamics::{
    AdhesionActsAt, AdhesionEnters, Guide, Interlude, MagneticTorque, Model, Relief, Robot, Substrate, Surroundings,
    Trial, Vec3, trial::TrialParts,
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
        linear_velocity_m_per_s=[0.0; 3], angular_velocity_rad_per_s=[0.0; 3], side_incline_rad=0.0,
        compliance_m_per_N=0.0, relief_wavelength_m=2e-3, relief_cosine_m=vec![], relief_sine_m=vec![], force_N=[0.0; 3],
        torque_N_m=[0.0; 3], translational_drag_N_s_per_m=0.0, rotational_drag_N_m_s=0.0, sheet_conductance_S=0.0,
        wrench_time_s=vec![], wrench_N_N_m=vec![], friction_drift_per_s=0.0))]
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
        side_incline_rad: f64,
        compliance_m_per_N: f64,
        relief_wavelength_m: f64,
        relief_cosine_m: Vec<f64>,
        relief_sine_m: Vec<f64>,
        force_N: [f64; 3],
        torque_N_m: [f64; 3],
        translational_drag_N_s_per_m: f64,
        rotational_drag_N_m_s: f64,
        sheet_conductance_S: f64,
        wrench_time_s: Vec<f64>,
        wrench_N_N_m: Vec<[f64; 6]>,
        friction_drift_per_s: f64,
    ) -> PyResult<Self> {
        let robot = Robot::new(body.0.clone(), mass_kg, magnetic_moment_A_m2.into()).map_err(refused)?;
        let substrate = Substrate {
            friction_coefficient,
            friction_drift: friction_drift_per_s,
            friction_ellipsoid,
            adhesion: adhesion_N_per_m2,
            electrostatic_force: electrostatic_force_N,
            line_contact_width: line_contact_width_m,
            compliance: compliance_m_per_N,
        };
        let wrench = |w: [f64; 6]| (Vec3::new(w[0], w[1], w[2]), Vec3::new(w[3], w[4], w[5]));
        let surroundings = Surroundings {
            force: force_N.into(),
            torque: torque_N_m.into(),
            translational_drag: translational_drag_N_s_per_m,
            rotational_drag: rotational_drag_N_m_s,
            sheet_conductance: sheet_conductance_S,
            times: wrench_time_s.into(),
            wrenches: wrench_N_N_m.into_iter().map(wrench).collect(),
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
            relief: Relief::new(relief_wavelength_m, &relief_cosine_m, &relief_sine_m).map_err(refused)?,
            surroundings,
            incline: incline_rad,
            side_incline: side_incline_rad,
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

    #[pyo3(signature = (time_s, y_m, point_m, rate_per_s))]
    fn guided(&self, time_s: Vec<f64>, y_m: Vec<f64>, point_m: [f64; 3], rate_per_s: f64) -> PyResult<Self> {
        let guide = Guide::new(&time_s, &y_m, Vec3::from(point_m), rate_per_s).map_err(refused)?;
        Ok(Self(self.0.clone().guided(guide)))
    }

    #[pyo3(signature = (other, edges_s))]
    fn with_interlude(&self, other: &Self, edges_s: Vec<f64>) -> PyResult<Self> {
        let interlude = Interlude::new(other.0.clone(), &edges_s).map_err(refused)?;
        self.0.clone().with_interlude(interlude).map(Self).map_err(refused)
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
