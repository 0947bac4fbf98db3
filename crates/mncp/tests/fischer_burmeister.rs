//! `φ_ε(a, b) = a + b - sqrt(a² + b² + 2ε)` and its gradient.

use proptest::prelude::*;
use tumblers_mncp::fischer_burmeister::{gradient, gradient_at_origin, value};

#[test]
fn vanishes_exactly_on_the_complementary_pairs() {
    for (a, b) in [(0.0, 0.0), (3.0, 0.0), (0.0, 1e300), (1e-300, 0.0)] {
        assert_eq!(value(a, b, 0.0), 0.0);
    }
    assert!(value(1.0, 1.0, 0.0) > 0.0);
    assert!(value(-1.0, 0.0, 0.0) < 0.0);
    assert!(value(-1.0, 5.0, 0.0) < 0.0);
    assert!(value(2.0, 0.5, 1.0).abs() < 1e-16);
}

/// `φ(a, b) = b - b²/2a + ...` for `b << a`, of which the sum as it stands keeps no digit.
#[test]
fn keeps_its_digits_where_the_sum_cancels() {
    let phi = value(1e8, 1e-10, 0.0);
    assert!((phi / 1e-10 - 1.0).abs() < 1e-15, "{phi}");
}

#[test]
fn has_no_gradient_at_the_origin_but_limits() {
    assert_eq!(gradient(0.0, 0.0, 0.0), None);
    assert_eq!(gradient(0.0, 0.0, 0.5), Some((1.0, 1.0)));
    let (da, db) = gradient_at_origin(3.0, -4.0);
    let near = gradient(3e-9, -4e-9, 0.0).unwrap();
    assert!((da - near.0).abs() < 1e-15 && (db - near.1).abs() < 1e-15);
    assert!(((1.0 - da).hypot(1.0 - db) - 1.0).abs() < 1e-15);
}

fn argument() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..10.0, -1e-3..1e-3]
}

proptest! {
    #[test]
    fn gradient_is_the_slope(a in argument(), b in argument(), smoothing in prop_oneof![Just(0.0), 1e-4..1.0]) {
        let r = (a * a + b * b + 2.0 * smoothing).sqrt();
        prop_assume!(r > 1e-5);
        let h = 1e-4 * r;
        let (da, db) = gradient(a, b, smoothing).unwrap();
        let slope_a = (value(a + h, b, smoothing) - value(a - h, b, smoothing)) / (2.0 * h);
        let slope_b = (value(a, b + h, smoothing) - value(a, b - h, smoothing)) / (2.0 * h);
        prop_assert!((slope_a - da).abs() < 1e-7 && (slope_b - db).abs() < 1e-7);
        prop_assert!((1.0 - da).hypot(1.0 - db) <= 1.0 + 1e-15);
    }

    /// `(2 - √2) |min(a, b)| <= |φ(a, b)| <= (2 + √2) |min(a, b)|` (Tseng, J. Optim. Theory Appl. 89, 1996).
    #[test]
    fn is_equivalent_to_the_natural_residual(a in argument(), b in argument()) {
        let (phi, natural) = (value(a, b, 0.0).abs(), a.min(b).abs());
        prop_assert!(phi >= (2.0 - 2_f64.sqrt()) * natural * (1.0 - 1e-12));
        prop_assert!(phi <= (2.0 + 2_f64.sqrt()) * natural * (1.0 + 1e-12));
    }
}
