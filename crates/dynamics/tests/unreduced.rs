//! The reduced solution solves the paper's unreduced problem, and that problem's Jacobian is right.

mod common;

use common::*;
use faer::Mat;
use geometry::Body;
use mncp::Problem;
use proptest::prelude::*;
use tumblers_dynamics::problem::StepProblem;
use tumblers_dynamics::step::Step;
use tumblers_dynamics::trial::TrialParts;
use tumblers_dynamics::{AdhesionActsAt, AdhesionEnters, Field, MagneticTorque, SolverKind, Stepper, Trial, Vec3};

fn suite() -> Vec<TrialParts> {
    let mut suite = vec![];
    for torque in [MagneticTorque::StartOfStep, MagneticTorque::EndOfStep, MagneticTorque::Midpoint] {
        for frequency in [1.0, 10.0, 15.0] {
            let mut parts = cuboid_on_paper(0.01, frequency);
            parts.model.magnetic_torque = torque;
            parts.duration = 1.2 / frequency;
            suite.push(parts);
        }
    }
    for degrees in [15f64, 45.0, 60.0] {
        let mut parts = cuboid_on_paper(0.02, 1.0);
        (parts.incline, parts.duration) = (degrees.to_radians(), 1.0);
        suite.push(parts);
    }
    for (body, theta2) in [(spiked(4.0), 0.0), (spiked_ends(4.0), 50.0), (spiked(12.0), 200.0), (curved(), 30.0)] {
        for acts_at in [AdhesionActsAt::Ecp, AdhesionActsAt::PatchCentroid] {
            for enters in [AdhesionEnters::Normal, AdhesionEnters::FrictionOnly] {
                let mut parts = pdms(body.clone(), 10.0, theta2);
                (parts.model.adhesion_acts_at, parts.model.adhesion_enters) = (acts_at, enters);
                parts.duration = 1.0;
                suite.push(parts);
            }
        }
    }
    // A hull, an ellipsoid, strips, other fields, small and unequal ellipsoids, starts in the air and in motion.
    let hull = [[2e-4, 0.0, 0.0], [-1e-4, 3e-4, 0.0], [-1.5e-4, -2e-4, 1e-4], [0.0, 0.0, -1.5e-4], [0.0, 1e-4, 1.8e-4]];
    let bodies = [Body::hull(&hull).unwrap(), Body::ellipsoid([1e-4, 2e-4, 1.5e-4]).unwrap(), curved()];
    for (i, body) in bodies.into_iter().enumerate() {
        let table = [(0.0, Vec3::y()), (0.4, -Vec3::z()), (0.8, Vec3::new(0.3, -1.0, 0.0)), (1.2, Vec3::z())];
        let (times, fields): (Vec<f64>, Vec<Vec3>) = table.iter().map(|(t, b)| (*t, b * 0.01)).unzip();
        for field in [Field::table(&times, &fields).unwrap(), Field::constant(0.02, Vec3::z()).unwrap()] {
            let mut parts = pdms(body.clone(), 10.0, 40.0);
            parts.field = field;
            parts.substrate.friction_ellipsoid = [[1.0, 0.6, 1e-4], [0.8, 1.0, 1e-5], [1.0, 1.0, 0.1]][i];
            parts.substrate.line_contact_width = 6e-6;
            parts.position = Some(Vec3::new(0.0, 0.0, 1.5e-3));
            parts.angular = Vec3::new(-20.0, 15.0, 30.0);
            parts.duration = 1.0;
            suite.push(parts);
        }
    }
    for parts in [cuboid_on_paper(0.01, 5.0), pdms(spiked(4.0), 10.0, 0.0), pdms(curved(), 10.0, 30.0)] {
        for torque in [MagneticTorque::EndOfStep, MagneticTorque::Midpoint] {
            let mut parts = disturbed(parts.clone());
            parts.model.magnetic_torque = torque;
            suite.push(parts);
        }
    }
    suite
}

#[test]
fn every_step_of_the_suite_solves_the_unreduced_problem() {
    for parts in suite() {
        let trial = Trial::new(parts).unwrap();
        let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
        run_checked(&mut stepper, &trial, |stepper, solution| {
            let e = trial.substrate().friction_ellipsoid;
            let bound = trial.substrate().friction_at(stepper.time() - 0.5 * trial.step()) * solution.normal;
            let friction = solution.friction.component_div(&Vec3::from(e));
            if trial.model().adhesion_enters == AdhesionEnters::Normal {
                assert!(friction.norm() <= bound * (1.0 + 1e-9) + 1e-22, "outside the ellipsoid");
            }
            assert!(solution.friction.dot(&solution.slip) <= 1e-22, "friction feeds the motion");
            assert!((stepper.state().orientation.norm() - 1.0).abs() < 1e-14);
        });
    }
}

/// Where `p_n = 0` the friction impulse enters the paper's problem only by its square, so that a residual of 1e-10 leaves
/// it open by 1e-5 of `P`: hence the tolerance of the velocities.
#[test]
fn the_general_solver_makes_the_same_steps() {
    let on_incline = TrialParts { incline: 0.5, ..cuboid_on_paper(0.02, 5.0) };
    let plain = [cuboid_on_paper(0.01, 5.0), on_incline, pdms(spiked(4.0), 10.0, 0.0), pdms(curved(), 10.0, 0.0)];
    for mut parts in
        plain.into_iter().chain([disturbed(cuboid_on_paper(0.01, 1.0)), disturbed(pdms(curved(), 10.0, 0.0))])
    {
        parts.duration = 0.1;
        let trial = Trial::new(parts).unwrap();
        let size = trial.robot().body().size();
        let mut fast = Stepper::new(&trial, SolverKind::Reduced);
        let mut greatest: f64 = 0.0;
        for step in 0..trial.steps() {
            let (state, support) = (*fast.state(), fast.solution().support);
            let mut general = Stepper::from_state(&trial, SolverKind::General, state, step, *fast.adhesion(), support);
            let load = Step::new(&trial, &state, fast.time(), fast.adhesion()).load_scale / trial.robot().mass();
            let (a, b) = (fast.advance(), general.advance());
            assert!(b.converged, "step {step}: {:e}", b.residual);
            let scale = a.linear.norm() + size * a.angular.norm() + load;
            let apart = (a.linear - b.linear).norm() + size * (a.angular - b.angular).norm();
            greatest = greatest.max(apart / scale);
        }
        assert!(greatest < 1e-4, "{greatest:e}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn the_jacobian_is_the_derivative(case in 0usize..6, seed in prop::collection::vec(-0.5..0.5f64, 40), active in 0usize..6) {
        let parts = [
            cuboid_on_paper(0.01, 5.0), pdms(spiked(4.0), 10.0, 20.0), pdms(curved(), 10.0, 70.0), pdms(spiked_ends(9.0), 5.0, 0.0),
            disturbed(cuboid_on_paper(0.01, 5.0)), disturbed(pdms(curved(), 10.0, 70.0)),
        ][case].clone();
        let trial = Trial::new(parts).unwrap();
        let stepper = Stepper::new(&trial, SolverKind::Reduced);
        let step = Step::new(&trial, stepper.state(), 0.01, stepper.adhesion());
        let problem = StepProblem::new(&step, active.min(trial.robot().body().surfaces().len() - 1));
        let n = problem.equalities() + problem.pairs();
        let z: Vec<f64> = (0..n).map(|i| seed[i] + if i + 1 == n { 1.0 } else { 0.0 }).collect();
        let mut jacobian = Mat::zeros(n, n);
        problem.jacobian(&z, jacobian.as_mut());
        let rows = |z: &[f64]| {
            let mut out = vec![0.0; n];
            problem.residual(z, &mut out);
            out
        };
        let e = 1e-6;
        for j in 0..n {
            let (mut up, mut down) = (z.clone(), z.clone());
            up[j] += e;
            down[j] -= e;
            // The greatest f_i may change within the difference.
            let kinked = problem.greatest_surface(&up) != problem.greatest_surface(&down);
            let (up, down) = (rows(&up), rows(&down));
            for i in 0..n {
                let numeric = (up[i] - down[i]) / (2.0 * e);
                let kink = kinked && i + 1 == n;
                let scale = 1.0 + numeric.abs();
                prop_assert!(kink || (numeric - jacobian[(i, j)]).abs() < 1e-5 * scale, "row {i} column {j}: {numeric} {}", jacobian[(i, j)]);
            }
        }
    }
}
