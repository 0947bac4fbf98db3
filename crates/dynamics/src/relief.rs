//! The heights of a substrate that is not flat, in waves that are long beside the body.
//!
//! ```text
//! h(y) = Σ_k c_k (cos(2π(k+1)y/λ) - 1) + s_k sin(2π(k+1)y/λ)
//! ```
//!
//! The body touches the tangent plane at its place, and a step is solved in the frame of that plane, which is turned by
//! `β = atan h'(y)` about `x`.

use crate::error::{Invalid, finite, positive};
use crate::rotation::advance;
use crate::{Mat3, State, Vec3};
use nalgebra::Quaternion;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A height map along `y`; without amplitudes it is flat.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    wave_number: f64,
    /// `c_k`, `s_k`, m.
    amplitudes: Arc<[(f64, f64)]>,
}

impl Relief {
    /// A flat substrate.
    pub fn flat() -> Self {
        Self { wave_number: 0.0, amplitudes: Arc::new([]) }
    }

    /// Waves of the length `wavelength` (m) and its fractions, with amplitudes in m.
    pub fn new(wavelength: f64, cosine: &[f64], sine: &[f64]) -> Result<Self, Invalid> {
        positive("wavelength_m", wavelength)?;
        if cosine.len() != sine.len() {
            return Err(Invalid::Lengths { name: "sine_m", found: sine.len(), expected: cosine.len() });
        }
        for amplitude in cosine {
            finite("cosine_m", *amplitude)?;
        }
        for amplitude in sine {
            finite("sine_m", *amplitude)?;
        }
        let flat = cosine.iter().chain(sine).all(|amplitude| *amplitude == 0.0);
        let amplitudes = if flat { Vec::new() } else { cosine.iter().copied().zip(sine.iter().copied()).collect() };
        Ok(Self { wave_number: TAU / wavelength, amplitudes: amplitudes.into() })
    }

    /// Whether the height is zero everywhere.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.amplitudes.is_empty()
    }

    /// `h(y)`, m.
    pub fn height(&self, y: f64) -> f64 {
        let wave = |(k, (c, s)): (usize, &(f64, f64))| {
            let (sin, cos) = ((k + 1) as f64 * self.wave_number * y).sin_cos();
            c * (cos - 1.0) + s * sin
        };
        self.amplitudes.iter().enumerate().map(wave).sum()
    }

    /// `h'(y)`.
    pub fn slope(&self, y: f64) -> f64 {
        let wave = |(k, (c, s)): (usize, &(f64, f64))| {
            let number = (k + 1) as f64 * self.wave_number;
            let (sin, cos) = (number * y).sin_cos();
            number * (s * cos - c * sin)
        };
        self.amplitudes.iter().enumerate().map(wave).sum()
    }

    /// `R_x(β)` at `y`: from the frame of the tangent plane to that of the substrate.
    pub fn tilt(&self, y: f64) -> Mat3 {
        let slope = self.slope(y);
        let cos = 1.0 / 1.0_f64.hypot(slope);
        let sin = slope * cos;
        Mat3::new(1.0, 0.0, 0.0, 0.0, cos, -sin, 0.0, sin, cos)
    }

    /// The pose of `state` as it is seen from outside: turned by `R_x(β)` and raised by `h`.
    pub fn seen(&self, state: &State) -> (Vec3, Quaternion<f64>) {
        if self.is_flat() {
            return (state.position, state.orientation);
        }
        let y = state.position.y;
        // A step of the pose with s = tan(β/2) turns by β.
        let half = (0.5 * self.slope(y).atan()).tan();
        let orientation = advance(&state.orientation, &Vec3::new(2.0 * half, 0.0, 0.0), 1.0);
        (state.position + Vec3::new(0.0, 0.0, self.height(y)), orientation)
    }
}
