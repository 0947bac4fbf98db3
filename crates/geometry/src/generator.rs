use nalgebra::{Matrix3, Vector3};

/// Where along a curved generator its farthest point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    Inside,
    Low,
    High,
}

/// A circular arc in a plane `x = const`: `centre + radius (0, sin θ, cos θ)`, `|θ| ≤ half_angle`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Centre of the circle.
    pub centre: Vector3<f64>,
    /// Radius, in m.
    pub radius: f64,
    /// Half of the arc's angle, in radians, between 0 and π.
    pub half_angle: f64,
    sin_cos: (f64, f64),
}

/// The curve in which a drafted end plane cuts a cone: with `d = ξ tan φ` and `0 ≤ ξ ≤ W` the distance from the
/// nominal side plane, `origin + ξ e_x - d n + s t`, `s² = ρ² - 2 ρ d`, a parabola.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The cone's axis in the nominal side plane.
    pub origin: Vector3<f64>,
    /// Normal `n` of the end face's profile line, a unit vector with `n_x = 0`.
    pub normal: Vector3<f64>,
    /// Radial direction `t`, a unit vector with `t_x = 0`.
    pub radial: Vector3<f64>,
    /// The cone's nominal radius `ρ`, in m.
    pub radius: f64,
    /// `tan φ`, positive.
    pub slope: f64,
    /// Width `W`, in m.
    pub width: f64,
}

/// An ellipsoid with its axes along those of the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidGenerator {
    /// Semi-axes, in m.
    pub semi_axes: Vector3<f64>,
    /// Centre, in m.
    pub centre: Vector3<f64>,
}

/// One of the sets whose convex hull is the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Generator {
    /// A point.
    Vertex(Vector3<f64>),
    /// A circular arc.
    Arc(Arc),
    /// A drafted corner between a cone and a plane.
    Corner(Corner),
    /// An ellipsoid.
    Ellipsoid(EllipsoidGenerator),
}

/// Below this length of a unit direction's projection onto a curve's plane the direction is normal to the plane.
const NORMAL_TO_PLANE: f64 = 1e-14;

impl Arc {
    /// An arc about `+z`.
    pub fn new(centre: Vector3<f64>, radius: f64, half_angle: f64) -> Self {
        Self { centre, radius, half_angle, sin_cos: half_angle.sin_cos() }
    }

    /// The point at the angle `θ` from `+z` towards `+y`.
    pub fn point(&self, angle: f64) -> Vector3<f64> {
        let (sin, cos) = angle.sin_cos();
        self.centre + self.radius * Vector3::new(0.0, sin, cos)
    }

    #[inline]
    fn place(&self, direction: &Vector3<f64>) -> (Place, f64) {
        let length = (direction.y * direction.y + direction.z * direction.z).sqrt();
        if length > NORMAL_TO_PLANE && direction.z >= self.sin_cos.1 * length {
            (Place::Inside, length)
        } else if direction.y < 0.0 {
            (Place::Low, length)
        } else {
            (Place::High, length)
        }
    }

    #[inline]
    fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        let (place, length) = self.place(direction);
        let (sin, cos) = match place {
            Place::Inside => (direction.y / length, direction.z / length),
            Place::Low => (-self.sin_cos.0, self.sin_cos.1),
            Place::High => self.sin_cos,
        };
        self.centre + self.radius * Vector3::new(0.0, sin, cos)
    }

    fn support_derivative(&self, direction: &Vector3<f64>) -> Matrix3<f64> {
        let (Place::Inside, length) = self.place(direction) else {
            return Matrix3::zeros();
        };
        let (y, z) = (direction.y / length, direction.z / length);
        Matrix3::new(0.0, 0.0, 0.0, 0.0, z * z, -y * z, 0.0, -y * z, y * y) * (self.radius / length)
    }
}

impl Corner {
    /// The point at the distance `ξ` from the nominal side plane.
    pub fn point(&self, xi: f64) -> Vector3<f64> {
        let inset = xi * self.slope;
        let along = (self.radius * (self.radius - 2.0 * inset)).max(0.0).sqrt();
        self.origin + Vector3::new(xi, 0.0, 0.0) - inset * self.normal + along * self.radial
    }

    /// The farthest `ξ`. With `u` the direction and `k = u_x - tan φ u·n`, the height `k ξ + u·t s(ξ)` is stationary
    /// where `s = ρ tan φ u·t / k`; as `s` is concave that is its maximum where `u·t > 0`, else an end is farthest.
    #[inline]
    fn place(&self, direction: &Vector3<f64>) -> (Place, f64) {
        let across = direction.x - self.slope * self.normal.dot(direction);
        let radial = self.radial.dot(direction);
        if radial > 0.0 && across > 0.0 {
            let along = self.radius * self.slope * radial / across;
            let xi = (self.radius * self.radius - along * along) / (2.0 * self.radius * self.slope);
            if xi <= 0.0 {
                (Place::Low, 0.0)
            } else if xi >= self.width {
                (Place::High, self.width)
            } else {
                (Place::Inside, xi)
            }
        } else if (self.point(self.width) - self.point(0.0)).dot(direction) > 0.0 {
            (Place::High, self.width)
        } else {
            (Place::Low, 0.0)
        }
    }

    /// `∂ξ/∂u` from the stationarity above, times the tangent `∂p/∂ξ`.
    fn support_derivative(&self, direction: &Vector3<f64>) -> Matrix3<f64> {
        let (Place::Inside, _) = self.place(direction) else {
            return Matrix3::zeros();
        };
        let across_gradient = Vector3::x() - self.slope * self.normal;
        let across = across_gradient.dot(direction);
        let along = self.radius * self.slope * self.radial.dot(direction) / across;
        let along_gradient = (self.radius * self.slope * self.radial - along * across_gradient) / across;
        let xi_gradient = along_gradient * (-along / (self.radius * self.slope));
        let tangent = across_gradient - self.radial * (self.radius * self.slope / along);
        tangent * xi_gradient.transpose()
    }
}

impl EllipsoidGenerator {
    #[inline]
    fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        self.centre + self.about_centre(direction)
    }

    /// `s = A²u / ρ`, `ρ = |A u|`.
    #[inline]
    fn about_centre(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        let scaled = self.semi_axes.component_mul(direction);
        self.semi_axes.component_mul(&scaled) / scaled.norm()
    }

    /// `∂s/∂u = (A² - s sᵀ) / ρ`.
    fn support_derivative(&self, direction: &Vector3<f64>) -> Matrix3<f64> {
        let support = self.about_centre(direction);
        let squares = self.semi_axes.component_mul(&self.semi_axes);
        let length = self.semi_axes.component_mul(direction).norm();
        (Matrix3::from_diagonal(&squares) - support * support.transpose()) / length
    }
}

impl Generator {
    /// The farthest point in a unit direction of the body frame. A curve whose plane the direction is normal to gives
    /// one of its ends.
    #[inline]
    pub fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Generator::Vertex(point) => *point,
            Generator::Arc(arc) => arc.support(direction),
            Generator::Corner(corner) => corner.point(corner.place(direction).1),
            Generator::Ellipsoid(ellipsoid) => ellipsoid.support(direction),
        }
    }

    /// How far the generator reaches along a direction.
    #[inline]
    pub(crate) fn height(&self, direction: &Vector3<f64>) -> f64 {
        match self {
            Generator::Vertex(point) => point.dot(direction),
            curved => curved.support(direction).dot(direction),
        }
    }

    /// `∂support/∂direction`: zero for a vertex, at a curve's ends, and where the direction is normal to a curve's plane.
    pub fn support_derivative(&self, direction: &Vector3<f64>) -> Matrix3<f64> {
        match self {
            Generator::Vertex(_) => Matrix3::zeros(),
            Generator::Arc(arc) => arc.support_derivative(direction),
            Generator::Corner(corner) => corner.support_derivative(direction),
            Generator::Ellipsoid(ellipsoid) => ellipsoid.support_derivative(direction),
        }
    }

    #[inline]
    pub(crate) fn place(&self, direction: &Vector3<f64>) -> Place {
        match self {
            Generator::Arc(arc) => arc.place(direction).0,
            Generator::Corner(corner) => corner.place(direction).0,
            Generator::Vertex(_) | Generator::Ellipsoid(_) => Place::Inside,
        }
    }

    /// Distance from the origin of its farthest point; a corner's is that of its ends, and for an ellipsoid off the origin
    /// it is a bound.
    pub(crate) fn greatest_distance(&self) -> f64 {
        match self {
            Generator::Vertex(point) => point.norm(),
            Generator::Arc(arc) => {
                let outwards = Vector3::new(0.0, arc.centre.y, arc.centre.z);
                [arc.point(-arc.half_angle), arc.point(arc.half_angle), arc.support(&outwards)]
                    .map(|p| p.norm())
                    .into_iter()
                    .fold(0.0, f64::max)
            }
            Generator::Corner(corner) => corner.point(0.0).norm().max(corner.point(corner.width).norm()),
            Generator::Ellipsoid(ellipsoid) => ellipsoid.centre.norm() + ellipsoid.semi_axes.max(),
        }
    }

    /// The same generator after the body moved by `shift`.
    pub(crate) fn translated(&self, shift: &Vector3<f64>) -> Self {
        match *self {
            Generator::Vertex(point) => Generator::Vertex(point + shift),
            Generator::Arc(arc) => Generator::Arc(Arc { centre: arc.centre + shift, ..arc }),
            Generator::Corner(corner) => Generator::Corner(Corner { origin: corner.origin + shift, ..corner }),
            Generator::Ellipsoid(ellipsoid) => {
                Generator::Ellipsoid(EllipsoidGenerator { centre: ellipsoid.centre + shift, ..ellipsoid })
            }
        }
    }
}
