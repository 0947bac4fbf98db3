//! A pose, and what is read from it.

use crate::Camera;

/// Where a body is, and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// m.
    pub position: [f64; 3],
    /// Unit quaternion `w, x, y, z`, body to substrate.
    pub orientation: [f64; 4],
}

impl Pose {
    /// The pose as a camera sees it that is turned about `+z` and scaled, its origin at `(x, y)`.
    ///
    /// ```text
    /// (x, y) = (1 + s) R(ψ) (x, y) + o
    /// ```
    #[inline]
    pub fn through(&self, camera: &Camera, origin: [f64; 2]) -> Pose {
        let [x, y, z] = self.position;
        let (size, turned) = (1.0 + camera.scale, &camera.turned);
        let position =
            [size * (turned.1 * x - turned.0 * y) + origin[0], size * (turned.0 * x + turned.1 * y) + origin[1], z];
        let [w, i, j, k] = self.orientation;
        let (s, c) = camera.half;
        Pose { position, orientation: [c * w - s * k, c * i - s * j, c * j + s * i, c * k + s * w] }
    }

    /// The body's `+y` axis in the substrate frame.
    #[inline]
    pub fn axis(&self) -> [f64; 3] {
        let [w, x, y, z] = self.orientation;
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)]
    }

    /// The substrate's normal in the body frame.
    #[inline]
    pub fn upward(&self) -> [f64; 3] {
        let [w, x, y, z] = self.orientation;
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]
    }

    /// The angle of the long axis above the substrate.
    #[inline]
    pub fn tilt(&self) -> f64 {
        self.axis()[2].clamp(-1.0, 1.0).asin()
    }

    /// The angle of the long axis's projection from `+y` towards `-x`.
    #[inline]
    pub fn heading(&self) -> f64 {
        let [x, y, _] = self.axis();
        (-x).atan2(y)
    }

    /// The rotation from this orientation to a measured one, as a vector in the body frame.
    #[inline]
    pub fn turn_to(&self, measured: &[f64; 4]) -> [f64; 3] {
        let ([w1, x1, y1, z1], [w2, x2, y2, z2]) = (self.orientation, *measured);
        let w = w1 * w2 + x1 * x2 + y1 * y2 + z1 * z2;
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        let v = [
            w1 * x2 - x1 * w2 - y1 * z2 + z1 * y2,
            w1 * y2 - y1 * w2 - z1 * x2 + x1 * z2,
            w1 * z2 - z1 * w2 - x1 * y2 + y1 * x2,
        ];
        let sine = v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let scale = if sine > 1e-12 { 2.0 * sine.atan2(w.abs()) / sine } else { 2.0 };
        v.map(|c| sign * c * scale)
    }
}
