//! What the fuzz has found, each a test of its own.

use super::common::{cuboid, pdms, run_checked, spiked};
use super::{MOST_POINTS, run};
use geometry::{Body, Support};
use nalgebra::Quaternion;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Duration;
use tumblers_dynamics::reduced::{Unknowns, solve};
use tumblers_dynamics::step::Step;
use tumblers_dynamics::{Adhesion, Robot, SolverKind, Stepper, Trial, Vec3};

/// The greatest of the scaled rows passed over NaN, so that a point without numbers had an error of zero, was taken for the
/// solution, and every step after it started from it.
#[test]
fn a_point_without_numbers_is_no_solution() {
    let trial = Trial::new(pdms(spiked(0.0), 0.0, 0.0)).unwrap();
    let step = Step::new(&trial, trial.initial(), 0.0, &Adhesion::none());
    let nan = Vec3::from_element(f64::NAN);
    for support in [Support::None, Support::Point(0), Support::Line(0, 1), Support::Face(0)] {
        let starts = [
            Unknowns { angular: nan, ..Unknowns::at_rest() },
            Unknowns { impulses: nan.into(), ..Unknowns::at_rest() },
            Unknowns { friction: nan, ..Unknowns::at_rest() },
        ];
        // In the air there are neither impulses nor friction.
        for start in &starts[..if support == Support::None { 1 } else { 3 }] {
            assert!(!solve(&step, support, None, start).converged, "{support:?} from {start:?}");
        }
    }
}

/// The normals of a flat body's many faces are close together, and so is the determinant of any three to zero: they were
/// left out of the normal cones, and nearly every step without a face on the ground counted as unconverged, after every
/// surface had been tried.
#[test]
fn a_flat_hull_of_many_faces_tumbles_like_any_other() {
    for thickness in [1e-2, 1e-4, 1e-5] {
        let rim = (0..7).map(|i| (TAU * f64::from(i) / 7.0).sin_cos()).map(|(sin, cos)| [2e-4 * sin, 2e-4 * cos, 0.0]);
        let peaks = [[0.0, 0.0, 1.0], [6e-5, 2e-5, 0.9], [0.0, 0.0, -1.0], [-5e-5, 4e-5, -0.9]];
        let points: Vec<_> = rim.chain(peaks.map(|[x, y, z]| [x, y, 2e-4 * thickness * z])).collect();
        let body = Body::hull(&points).unwrap();
        let mut parts = pdms(cuboid(), 10.0, 30.0);
        parts.robot = Robot::new(Arc::new(body), 2e-9, Vec3::new(0.0, 1e-9, 1e-10)).unwrap();
        parts.substrate.adhesion = 0.0;
        parts.orientation = Quaternion::new(0.9, 0.3, 0.2, 0.1);
        parts.duration = 0.5;
        let trial = Trial::new(parts).unwrap();
        run_checked(&mut Stepper::new(&trial, SolverKind::Reduced), &trial, |_, _| {});
    }
}

/// A flat body that falls on its rim again and again, for whose every landing the general solver is asked, so that several of
/// its steps are loose, and were more than a hundred when it was found: more than a bound of one in ten thousand steps left
/// for a million of all others. What is counted is cases; each of these steps keeps its friction in the ellipsoid to 1e-10 of
/// the square.
#[test]
fn a_case_with_many_loose_steps_is_one_case() {
    let tally = run(1_099_511_627_785, MOST_POINTS, Duration::MAX);
    assert!(tally.failures.is_empty(), "{}", tally.failures.join("\n"));
    assert!(tally.loose_cases <= 1, "{}", tally.line());
    // It lands, or nothing was asked; and more than one of its steps is loose still.
    assert!(tally.touching > 100 && tally.loose > 1, "{}", tally.line());
}
