//! Derivatives of the friction map and of the magnetic torque, against differences, and what the friction map is for.

use nalgebra::Matrix3;
use proptest::prelude::*;
use tumblers_dynamics::friction::FrictionRows;
use tumblers_dynamics::magnetics::TorqueLaw;
use tumblers_dynamics::rotation::cayley;
use tumblers_dynamics::{Field, MagneticTorque, Vec3};

proptest! {
    #[test]
    fn the_torque_s_derivative(
        w in prop::array::uniform3(-500.0..500.0f64),
        d in prop::array::uniform3(-1.0..1.0f64),
        m in prop::array::uniform3(-1e-6..1e-6f64),
        when in 0usize..3,
    ) {
        let when = [MagneticTorque::StartOfStep, MagneticTorque::EndOfStep, MagneticTorque::Midpoint][when];
        let field = Field::rotating(0.02, 5.0, -Vec3::x(), Vec3::y()).unwrap();
        let rotation = cayley(&Vec3::new(0.3, -0.2, 0.5));
        let moment = rotation * Vec3::from(m);
        let law = TorqueLaw::new(when, |t| field.at(t), moment, &Vec3::new(5.0, 3.0, -2.0), 0.07, 5e-4);
        let (w, d, e) = (Vec3::from(w), Vec3::from(d), 1e-2);
        let (up, down) = (law.impulse(&(w + d * e)), law.impulse(&(w - d * e)));
        let (exact, numeric) = (law.by_angular(&w) * d, (up - down) / (2.0 * e));
        prop_assert!((exact - numeric).norm() < 1e-6 * (1e-15 + law.greatest() * 5e-4));
        prop_assert!(law.impulse(&w).norm() <= law.greatest() * (1.0 + 1e-12));
    }

    #[test]
    fn the_friction_map_s_derivative(
        f in prop::array::uniform3(-2.0..2.0f64),
        s in prop::array::uniform3(-2.0..2.0f64),
        d in prop::array::uniform3(-1.0..1.0f64),
        bound in 0.1..2.0f64,
        rho in 0.1..3.0f64,
    ) {
        let (f, s, d, e) = (Vec3::from(f), Vec3::from(s), Vec3::from(d), 1e-6);
        prop_assume!(((f - s * rho).norm() - bound).abs() > 1e-3);
        let (by_friction, by_slip, by_bound) = FrictionRows::new(&f, &s, bound, rho).derivatives();
        let along = |by: Matrix3<f64>, up: Vec3, down: Vec3| ((up - down) / (2.0 * e) - by * d).norm();
        let value = |f: Vec3, s: Vec3, b: f64| FrictionRows::new(&f, &s, b, rho).value;
        prop_assert!(along(by_friction, value(f + d * e, s, bound), value(f - d * e, s, bound)) < 1e-7);
        prop_assert!(along(by_slip, value(f, s + d * e, bound), value(f, s - d * e, bound)) < 1e-7);
        let numeric = (value(f, s, bound + e) - value(f, s, bound - e)) / (2.0 * e);
        prop_assert!((numeric - by_bound).norm() < 1e-7);
    }

    /// A slip has one friction that dissipates most: `φ = -b ν/|ν|`; there the rows vanish, for any `ρ`.
    #[test]
    fn the_rows_vanish_at_maximum_dissipation(s in prop::array::uniform3(-2.0..2.0f64), bound in 0.1..2.0f64, rho in 0.1..3.0f64) {
        let slip = Vec3::from(s);
        prop_assume!(slip.norm() > 1e-3);
        let most = -slip * (bound / slip.norm());
        prop_assert!(FrictionRows::new(&most, &slip, bound, rho).value.norm() < 1e-12);
        let stuck = most * 0.5;
        prop_assert!(FrictionRows::new(&stuck, &Vec3::zeros(), bound, rho).value.norm() == 0.0);
        prop_assert!(FrictionRows::new(&stuck, &slip, bound, rho).value.norm() > 1e-6);
    }
}

#[test]
fn the_field_turns_from_its_first_direction_about_its_axis() {
    let field = Field::rotating(0.02, 2.0, -Vec3::x(), Vec3::y()).unwrap();
    assert!((field.at(0.0) - Vec3::new(0.0, 0.02, 0.0)).norm() < 1e-15);
    assert!((field.at(0.125) - Vec3::new(0.0, 0.0, -0.02)).norm() < 1e-15);
    let table = Field::table(&[0.0, 1.0], &[Vec3::zeros(), Vec3::new(0.0, 0.0, 0.04)]).unwrap();
    assert!((table.at(0.25) - Vec3::new(0.0, 0.0, 0.01)).norm() < 1e-15);
    assert!(table.covers(1.1).is_err());
}
