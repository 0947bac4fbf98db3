//! A pose, and what is read from it.

use crate::Camera;
use nalgebra::{UnitQuaternion, Vector3};

/// Where a body is, and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// m.
    pub position: Vector3<f64>,
    /// Body to substrate.
    pub orientation: UnitQuaternion<f64>,
}

impl Pose {
    /// The pose as a camera sees it, its origin at `(x, y, z)`.
    ///
    /// ```text
    /// (x, y) = (1 + s) R(ψ) (x, y) + (o_x, o_y),  z = z + o_z
    /// ```
    #[inline]
    pub fn through(&self, camera: &Camera, origin: [f64; 3]) -> Pose {
        let size = 1.0 + camera.scale;
        let turned = camera.turn * self.position;
        let position = Vector3::new(size * turned.x + origin[0], size * turned.y + origin[1], turned.z + origin[2]);
        Pose { position, orientation: camera.turn * self.orientation }
    }

    /// The body's `+y` axis in the substrate frame.
    #[inline]
    fn axis(&self) -> Vector3<f64> {
        self.orientation * Vector3::y()
    }

    /// The substrate's normal in the body frame.
    #[inline]
    pub fn upward(&self) -> Vector3<f64> {
        self.orientation.inverse_transform_vector(&Vector3::z())
    }

    /// The angle of the long axis above the substrate.
    #[inline]
    pub fn tilt(&self) -> f64 {
        self.axis().z.clamp(-1.0, 1.0).asin()
    }

    /// The angle of the long axis's projection from `+y` towards `-x`.
    #[inline]
    pub fn heading(&self) -> f64 {
        let axis = self.axis();
        (-axis.x).atan2(axis.y)
    }

    /// The rotation from this orientation to a measured one, as a vector in the body frame.
    #[inline]
    pub fn turn_to(&self, measured: &UnitQuaternion<f64>) -> Vector3<f64> {
        (self.orientation.inverse() * measured).scaled_axis()
    }
}
