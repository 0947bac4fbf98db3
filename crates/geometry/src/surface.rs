use nalgebra::{Matrix3, Vector3};

/// A half-space `f(ζ) = n · ζ - c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Unit outward normal `n`.
    pub normal: Vector3<f64>,
    /// Offset `c`, in m.
    pub offset: f64,
}

/// A cone about an axis along `x`: `f(ζ) = cos φ (hypot(y - y0, z - z0) - ρ0 + (x - x0) tan φ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Where along the axis the radius is `ρ0`.
    pub x0: f64,
    /// The axis's `y`.
    pub y0: f64,
    /// The axis's `z`.
    pub z0: f64,
    /// Radius `ρ0` at `x0`, in m.
    pub radius: f64,
    /// Half angle `φ` of the cone, in radians; a cylinder where it is zero.
    pub draft: f64,
}

/// An ellipsoid `f(ζ) = (b/2) (Σ (ζ_k - c_k)²/A_k² - 1)`, `b = min A`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidSurface {
    /// Semi-axes `A`, in m.
    pub semi_axes: Vector3<f64>,
    /// Centre `c`, in m.
    pub centre: Vector3<f64>,
}

/// One of the functions `f_i` whose `f_i ≤ 0` make up the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// A flat face.
    HalfSpace(HalfSpace),
    /// A cylinder or a cone.
    Cone(Cone),
    /// An ellipsoid.
    Ellipsoid(EllipsoidSurface),
}

impl Surface {
    /// `f(ζ)`, in m.
    #[inline]
    pub fn value(&self, point: &Vector3<f64>) -> f64 {
        match self {
            Surface::HalfSpace(s) => s.normal.dot(point) - s.offset,
            Surface::Cone(s) => {
                let (y, z) = (point.y - s.y0, point.z - s.z0);
                let (sin, cos) = s.draft.sin_cos();
                cos * ((y * y + z * z).sqrt() - s.radius) + sin * (point.x - s.x0)
            }
            Surface::Ellipsoid(s) => {
                let scaled = (point - s.centre).component_div(&s.semi_axes);
                0.5 * s.semi_axes.min() * (scaled.norm_squared() - 1.0)
            }
        }
    }

    /// `∇f(ζ)`: a unit vector for half-spaces and cones. On a cone's axis the radial part is zero.
    #[inline]
    pub fn gradient(&self, point: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Surface::HalfSpace(s) => s.normal,
            Surface::Cone(s) => {
                let (y, z) = (point.y - s.y0, point.z - s.z0);
                let radius = (y * y + z * z).sqrt();
                let (sin, cos) = s.draft.sin_cos();
                let radial = if radius > 0.0 { cos / radius } else { 0.0 };
                Vector3::new(sin, radial * y, radial * z)
            }
            Surface::Ellipsoid(s) => {
                let squares = s.semi_axes.component_mul(&s.semi_axes);
                s.semi_axes.min() * (point - s.centre).component_div(&squares)
            }
        }
    }

    /// `∂²f/∂ζ²(ζ)`: for a cone `cos φ (1 - e eᵀ)/r` in the profile plane, with `r e` the vector from its axis (zero on
    /// the axis).
    pub fn hessian(&self, point: &Vector3<f64>) -> Matrix3<f64> {
        match self {
            Surface::HalfSpace(_) => Matrix3::zeros(),
            Surface::Cone(s) => {
                let (y, z) = (point.y - s.y0, point.z - s.z0);
                let square = y * y + z * z;
                if square == 0.0 {
                    return Matrix3::zeros();
                }
                let scale = s.draft.cos() / (square * square.sqrt());
                Matrix3::new(0.0, 0.0, 0.0, 0.0, z * z, -y * z, 0.0, -y * z, y * y) * scale
            }
            Surface::Ellipsoid(s) => {
                let squares = s.semi_axes.component_mul(&s.semi_axes);
                Matrix3::from_diagonal(&squares.map(|a| s.semi_axes.min() / a))
            }
        }
    }

    /// The same surface after the body moved by `shift`.
    pub(crate) fn translated(&self, shift: &Vector3<f64>) -> Self {
        match *self {
            Surface::HalfSpace(s) => Surface::HalfSpace(HalfSpace { offset: s.offset + s.normal.dot(shift), ..s }),
            Surface::Cone(s) => Surface::Cone(Cone { x0: s.x0 + shift.x, y0: s.y0 + shift.y, z0: s.z0 + shift.z, ..s }),
            Surface::Ellipsoid(s) => Surface::Ellipsoid(EllipsoidSurface { centre: s.centre + shift, ..s }),
        }
    }
}
