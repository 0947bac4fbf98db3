use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector3;

use crate::body::Parts;
use crate::generator::EllipsoidGenerator;
use crate::mass_properties::MassProperties;
use crate::normal_cone::{NormalCone, SurfaceSet};
use crate::{Body, EllipsoidSurface, Generator, GeometryError, Surface};

const MERIDIANS: usize = 24;
const PARALLELS: usize = 12;

impl Body {
    /// A uniform ellipsoid of the given semi-axes along `x`, `y` and `z`.
    pub fn ellipsoid(semi_axes: [f64; 3]) -> Result<Self, GeometryError> {
        for (name, value) in ["semi-axis x", "semi-axis y", "semi-axis z"].into_iter().zip(semi_axes) {
            GeometryError::positive(name, value)?;
        }
        let (semi_axes, centre) = (Vector3::from(semi_axes), Vector3::zeros());
        let parts = Parts {
            surfaces: vec![Surface::Ellipsoid(EllipsoidSurface { semi_axes, centre })],
            generators: vec![Generator::Ellipsoid(EllipsoidGenerator { semi_axes, centre })],
            faces: Vec::new(),
            edges: Vec::new(),
            point_cones: vec![NormalCone::Curved([SurfaceSet::new(&[0]); 3])],
            edge_cones: Vec::new(),
            mass_properties: MassProperties::of_ellipsoid(&semi_axes),
            hull_perimeter: ellipse_perimeter(semi_axes.y, semi_axes.z),
            outline: outline(&semi_axes),
        };
        Ok(parts.in_place())
    }
}

/// `2π/M(a, b) (a² - Σ 2^(n-1) c_n²)`, with the arithmetic–geometric mean `M`, `c_0² = a² - b²` and
/// `c_(n+1) = (a_n - b_n)/2`.
fn ellipse_perimeter(p: f64, q: f64) -> f64 {
    let (mut a, mut b) = (p.max(q), p.min(q));
    let mut rest = a * a - 0.5 * (a * a - b * b);
    let mut power = 1.0;
    for _ in 0..16 {
        let c = 0.5 * (a - b);
        rest -= power * c * c;
        power *= 2.0;
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    2.0 * PI / a * rest
}

fn outline(semi_axes: &Vector3<f64>) -> Vec<Vec<Vector3<f64>>> {
    let point = |meridian: usize, parallel: usize| {
        let longitude = 2.0 * PI * (meridian % MERIDIANS) as f64 / MERIDIANS as f64;
        let latitude = PI * parallel as f64 / PARALLELS as f64 - FRAC_PI_2;
        let (sin, cos) = latitude.sin_cos();
        semi_axes.component_mul(&Vector3::new(cos * longitude.cos(), cos * longitude.sin(), sin))
    };
    (0..MERIDIANS)
        .flat_map(|m| (0..PARALLELS).map(move |p| (m, p)))
        .map(|(m, p)| match p {
            0 => vec![point(m, 0), point(m + 1, 1), point(m, 1)],
            p if p + 1 == PARALLELS => vec![point(m, p), point(m + 1, p), point(m, p + 1)],
            p => vec![point(m, p), point(m + 1, p), point(m + 1, p + 1), point(m, p + 1)],
        })
        .collect()
}
