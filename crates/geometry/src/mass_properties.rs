use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use crate::parry_math;

/// Volume, centre, and inertia per unit mass about the centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MassProperties {
    pub volume: f64,
    pub centre: Vector3<f64>,
    pub unit_inertia: Matrix3<f64>,
}

/// Moments of a section in a plane `x = const`: `∫dA`, `∫(y, z)dA`, `∫(y², yz, z²)dA`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SectionMoments {
    pub area: f64,
    pub first: [f64; 2],
    pub second: [f64; 3],
}

const NODES: usize = 24;

impl MassProperties {
    /// Of the uniform solid inside a closed mesh of outward polygons. The polygons need not be convex: the fans of
    /// signed triangles add up.
    pub fn of_polygons(vertices: &[Vector3<f64>], polygons: &[Vec<u16>]) -> Self {
        let size = vertices.iter().map(|v| v.amax()).fold(0.0, f64::max);
        let scaled: Vec<Vector3<f64>> = vertices.iter().map(|v| v / size).collect();
        let triangles: Vec<[u32; 3]> =
            polygons.iter().flat_map(|p| p[1..].windows(2).map(|w| [p[0].into(), w[0].into(), w[1].into()])).collect();
        let (volume, centre, inertia) = parry_math::solid_moments(&scaled, &triangles);
        Self { volume: volume * size.powi(3), centre: centre * size, unit_inertia: inertia * (size * size / volume) }
    }

    /// Of the uniform solid whose sections at `-W/2 ≤ x ≤ W/2` have the given moments: with `⟨·⟩` the mean over the
    /// volume and `ζ` the place, `S = ⟨ζζᵀ⟩ - ⟨ζ⟩⟨ζ⟩ᵀ` and `I = tr S - S`.
    pub fn of_sections(width: f64, section: impl Fn(f64) -> SectionMoments) -> Self {
        let mut volume = 0.0;
        let mut first = Vector3::zeros();
        let mut second = Matrix3::zeros();
        for (x, weight) in gauss_legendre(-0.5 * width, 0.5 * width) {
            let SectionMoments { area, first: [y, z], second: [yy, yz, zz] } = section(x);
            volume += weight * area;
            first += weight * Vector3::new(x * area, y, z);
            second += weight * Matrix3::new(x * x * area, x * y, x * z, x * y, yy, yz, x * z, yz, zz);
        }
        let centre = first / volume;
        let spread = second / volume - centre * centre.transpose();
        Self { volume, centre, unit_inertia: Matrix3::identity() * spread.trace() - spread }
    }

    /// Of a uniform ellipsoid: `V = 4π/3 ABC`, `I_xx = (B² + C²)/5`.
    pub fn of_ellipsoid(semi_axes: &Vector3<f64>) -> Self {
        let squares = semi_axes.component_mul(semi_axes);
        Self {
            volume: 4.0 / 3.0 * PI * semi_axes.product(),
            centre: Vector3::zeros(),
            unit_inertia: Matrix3::from_diagonal(&squares.map(|s| (squares.sum() - s) / 5.0)),
        }
    }
}

/// Nodes and weights of Gauss–Legendre quadrature between two numbers: the roots of `P_n`, by Newton's method from
/// `cos(π (i + ¾)/(n + ½))`, and `w = 2 / ((1 - t²) P_n'(t)²)`.
pub(crate) fn gauss_legendre(low: f64, high: f64) -> impl Iterator<Item = (f64, f64)> {
    let half = 0.5 * (high - low);
    (0..NODES).map(move |i| {
        let mut t = (PI * (i as f64 + 0.75) / (NODES as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut p, mut last) = (t, 1.0);
            for k in 2..=NODES {
                let k = k as f64;
                (p, last) = (((2.0 * k - 1.0) * t * p - (k - 1.0) * last) / k, p);
            }
            slope = NODES as f64 * (t * p - last) / (t * t - 1.0);
            t -= p / slope;
        }
        (low + half * (1.0 + t), half * 2.0 / ((1.0 - t * t) * slope * slope))
    })
}
