//! The reduced Jacobian against differences.

use super::*;
use crate::trial::TrialParts;
use crate::{
    Adhesion, AdhesionActsAt, AdhesionEnters, Field, MagneticTorque, Model, Relief, Robot, Stepper, Substrate,
    Surroundings, Trial,
};
use geometry::{Body, Draft, DraftModel};
use nalgebra::Quaternion;
use proptest::prelude::*;
use std::sync::Arc;

fn trial(shape: usize, magnetic_torque: MagneticTorque, mu: f64) -> Trial {
    let draft = Draft { angle_rad: 0.05, model: DraftModel::Geometric };
    let body = match shape {
        0 => Body::spiked(4e-4, 2e-4, 7.5e-5, 1.25e-4, 3.25e-4, draft),
        1 => Body::curved(1.25e-3, 1.1e-3, 0.4, 4e-4, draft),
        _ => Body::ellipsoid([1e-4, 2e-4, 1.5e-4]),
    };
    Trial::new(TrialParts {
        robot: Robot::new(Arc::new(body.unwrap()), 3e-8, Vec3::new(1e-8, 2e-7, 2e-8)).unwrap(),
        substrate: Substrate {
            friction_coefficient: mu,
            friction_drift: 0.0,
            friction_ellipsoid: [1.0, 0.7, 2e-4],
            adhesion: 20.0,
            electrostatic_force: 1e-7,
            line_contact_width: 5e-6,
            compliance: 4.0,
        },
        field: Field::rotating(0.02, 3.0, -Vec3::x(), Vec3::y()).unwrap(),
        model: Model {
            magnetic_torque,
            adhesion_acts_at: AdhesionActsAt::Ecp,
            adhesion_enters: AdhesionEnters::Normal,
        },
        relief: Relief::new(2e-3, &[1e-5], &[2e-5]).unwrap(),
        surroundings: Surroundings {
            translational_drag: 2e-5,
            rotational_drag: 1e-12,
            sheet_conductance: 1e8,
            ..Surroundings::none()
        },
        incline: 0.3,
        side_incline: 0.1,
        gravity: 9.8,
        duration: 1.0,
        step: 5e-4,
        position: None,
        orientation: Quaternion::new(0.9, 0.2, -0.3, 0.25),
        linear: Vec3::new(0.01, -0.02, 0.005),
        angular: Vec3::new(30.0, -10.0, 20.0),
    })
    .unwrap()
}

/// Rows at `x` and `x` moved along `d`, against the Jacobian: `F(x - e D d) = F(x) - e J d`.
fn check<const N: usize>(
    step: &Step,
    support: Support,
    hang: Option<u16>,
    x: &Unknowns,
    d: &[f64],
) -> Result<(), TestCaseError> {
    let scales = Scales::<N>::new(step, x);
    let direction = SVector::<f64, N>::from_column_slice(&d[..N]);
    let e = 1e-6;
    let rows = |length: f64| Rows::<N>::new(step, support, hang, &x.moved(&direction, length, &scales), &scales);
    let jacobian = rows(0.0).jacobian(step, support, hang, &scales);
    let (numeric, exact) = ((rows(-e).value - rows(e).value) / (2.0 * e), jacobian * direction);
    prop_assert!((numeric - exact).norm() < 1e-5 * (1.0 + exact.norm()), "{support:?}: {numeric} {exact}");
    Ok(())
}

proptest! {
    #[test]
    fn the_jacobian_is_the_derivative(
        shape in 0usize..3,
        when in 0usize..3,
        slides in any::<bool>(),
        d in prop::collection::vec(-1.0..1.0f64, 9),
        w in prop::array::uniform3(-60.0..60.0f64),
        p in prop::array::uniform3(0.1..1.0f64),
        phi in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let when = [MagneticTorque::StartOfStep, MagneticTorque::EndOfStep, MagneticTorque::Midpoint][when];
        let trial = trial(shape, when, if slides { 1e-3 } else { 1e6 });
        let stepper = Stepper::new(&trial, crate::SolverKind::Reduced);
        let adhesion = Adhesion { impulse: 1e-10, ..Adhesion::none() };
        let step = Step::new(&trial, stepper.state(), 0.05, &adhesion);
        let weight = step.load.norm();
        let x = Unknowns { angular: Vec3::from(w), impulses: p.map(|p| p * weight), friction: Vec3::from(phi) * weight };
        let body = trial.robot().body();
        check::<3>(&step, Support::None, Some(0), &x, &d)?;
        let last = (body.generators().len() - 1) as u16;
        check::<7>(&step, Support::Point(last), None, &x, &d)?;
        if let Some(edge) = body.edges().last() {
            check::<8>(&step, Support::Line(edge.generators.0, edge.generators.1), None, &x, &d)?;
            check::<9>(&step, Support::Face(0), None, &x, &d)?;
        }
    }
}
