//! Rotations by the Cayley map, which is what a normalised quaternion Euler step makes.

use crate::{Mat3, Vec3};
use nalgebra::Quaternion;

/// `Cay(s) = 1 + 2/(1+|s|²) ([s]ₓ + [s]ₓ²)`: the rotation of the quaternion `(1, s)/|(1, s)|`.
#[inline]
pub fn cayley(s: &Vec3) -> Mat3 {
    let k = 2.0 / (1.0 + s.norm_squared());
    let (x, y, z) = (s.x, s.y, s.z);
    Mat3::new(
        1.0 - k * (y * y + z * z),
        k * (x * y - z),
        k * (x * z + y),
        k * (x * y + z),
        1.0 - k * (x * x + z * z),
        k * (y * z - x),
        k * (x * z - y),
        k * (y * z + x),
        1.0 - k * (x * x + y * y),
    )
}

/// `dφ/dω` of `Cay(αω)`: `2α/(1+|s|²) (1 + [s]ₓ)` with `s = αω`, where `dφ` is the rotation vector of the change.
#[inline]
pub fn cayley_tangent(omega: &Vec3, alpha: f64) -> Mat3 {
    let s = omega * alpha;
    let k = 2.0 * alpha / (1.0 + s.norm_squared());
    Mat3::new(k, -k * s.z, k * s.y, k * s.z, k, -k * s.x, -k * s.y, k * s.x, k)
}

/// `Q⁺ = normalise(Q + (h/2) ω ∘ Q)`.
#[inline]
pub fn advance(orientation: &Quaternion<f64>, omega: &Vec3, h: f64) -> Quaternion<f64> {
    let s = omega * (0.5 * h);
    let q = Quaternion::new(1.0, s.x, s.y, s.z) * orientation;
    q / q.norm()
}

/// The rotation matrix of a unit quaternion.
#[inline]
pub fn matrix(q: &Quaternion<f64>) -> Mat3 {
    let (w, x, y, z) = (q.w, q.i, q.j, q.k);
    Mat3::new(
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn quaternion_step_is_the_cayley_map(w in prop::array::uniform3(-3.0..3.0f64), q in prop::array::uniform4(-1.0..1.0f64)) {
            let q = Quaternion::new(q[0] + 1.5, q[1], q[2], q[3]);
            let q = q / q.norm();
            let omega = Vec3::from(w);
            let direct = matrix(&advance(&q, &omega, 0.3));
            let mapped = cayley(&(omega * 0.15)) * matrix(&q);
            prop_assert!((direct - mapped).norm() < 1e-14);
        }

        #[test]
        fn tangent_is_the_derivative(w in prop::array::uniform3(-3.0..3.0f64), d in prop::array::uniform3(-1.0..1.0f64)) {
            let (omega, d, alpha, e) = (Vec3::from(w), Vec3::from(d), 0.4, 1e-6);
            let change = cayley(&((omega + d * e) * alpha)) - cayley(&((omega - d * e) * alpha));
            let spin = change * cayley(&(omega * alpha)).transpose() / (2.0 * e);
            let phi = Vec3::new(spin[(2, 1)], spin[(0, 2)], spin[(1, 0)]);
            prop_assert!((phi - cayley_tangent(&omega, alpha) * d).norm() < 1e-8);
        }
    }
}
