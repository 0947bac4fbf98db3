//! Supports that a step exchanges, where adhesion pulls more than the plane pushes.

mod common;

use common::*;
use geometry::Support;
use tumblers_dynamics::{Field, MagneticTorque, Model, SolverKind, Stepper, Trial, Vec3};

/// A static field turns it onto a steep face, which sticks to a plane that yields: it bounces, and rocks from one edge of the
/// face to the other. Where the ECP has left the face over one edge and is pulled, the body turns about the other one. The
/// edge that was passed led back to the face, and every support was tried in every sixth step, 2000 iterations each.
#[test]
fn a_body_that_is_pulled_more_than_pushed_turns_about_the_far_edge() {
    let mut parts = pdms(spiked_ends(0.0), 0.0, 0.0);
    parts.field = Field::constant(1.46e-3, Vec3::new(0.0, 0.535, 0.845)).unwrap();
    parts.substrate.compliance = 4.03;
    parts.model = Model { magnetic_torque: MagneticTorque::Midpoint, ..MODEL };
    (parts.step, parts.duration) = (1.25e-4, 0.2);
    let trial = Trial::new(parts).unwrap();
    let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
    let (mut most, mut rocked, mut before) = (0, 0, Support::None);
    run_checked(&mut stepper, &trial, |_, solution| {
        most = most.max(solution.iterations);
        rocked += u32::from(matches!((before, solution.support), (Support::Face(_), Support::Line(..))));
        before = solution.support;
    });
    // 173 times, and 15 iterations at most; to try every support takes thousands.
    assert!(rocked > 50, "it rocked {rocked} times");
    assert!(most < 50, "a step took {most} iterations");
}
