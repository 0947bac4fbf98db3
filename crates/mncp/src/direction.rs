use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use crate::Settings;
use crate::linear::Lu;
use crate::linearisation::Linearisation;
use crate::merit::{Point, dot, norm};

/// How a direction `d` was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// `H d = -Φ`
    Newton,
    /// `(HᵀH + λI) d = -HᵀΦ`, `λ = c |Φ|`
    LevenbergMarquardt,
    /// `d = -α ∇Ψ`, `α = |∇Ψ|² / |H∇Ψ|²`
    Gradient,
}

impl Direction {
    /// Every kind, in the order in which they are tried.
    pub const ALL: [Direction; 3] = [Direction::Newton, Direction::LevenbergMarquardt, Direction::Gradient];
}

/// Storage for the directions.
pub(crate) struct Directions {
    pub vector: Vec<f64>,
    image: Vec<f64>,
    normal: Mat<f64>,
    lu: Lu,
}

impl Directions {
    pub fn new(n: usize) -> Self {
        let mut normal = Mat::zeros(n, n);
        let identity = Mat::<f64>::identity(n, n);
        matmul(normal.as_mut(), Accum::Replace, identity.transpose(), identity.as_ref(), 1.0, Par::Seq);
        Self { vector: vec![0.0; n], image: vec![0.0; n], normal, lu: Lu::new(n) }
    }

    /// Writes the direction and returns its slope `∇Ψᵀd`; `None` where it is no direction of descent,
    ///
    /// ```text
    /// ∇Ψᵀd <= -θ |∇Ψ| |d|,     and for Newton's ∇Ψᵀd = -|Φ|² to within a half,
    /// ```
    ///
    /// the second of which fails where `H` is singular to working precision.
    pub fn find(&mut self, kind: Direction, at: &Linearisation, point: &Point, settings: &Settings) -> Option<f64> {
        match kind {
            Direction::Newton => self.newton(at, point),
            Direction::LevenbergMarquardt => self.levenberg_marquardt(at, point, settings.levenberg_marquardt),
            Direction::Gradient => self.gradient(at),
        }
        let slope = dot(&at.gradient, &self.vector);
        let (length, steepness) = (norm(&self.vector), norm(&at.gradient));
        let descends = length.is_finite() && slope < 0.0 && slope <= -settings.descent * steepness * length;
        let solves = kind != Direction::Newton || slope <= -point.merit;
        (descends && solves).then_some(slope)
    }

    fn newton(&mut self, at: &Linearisation, point: &Point) {
        assign(&mut self.vector, &point.phi, -1.0);
        self.lu.solve(at.matrix.as_ref(), &mut self.vector);
    }

    /// `λ = c |Φ|` keeps the fast local convergence at singular solutions with a local error bound (Fan & Yuan, *On the
    /// quadratic convergence of the Levenberg–Marquardt method without nonsingularity assumption*, Computing 74, 2005).
    /// A few units of rounding of `|H|²` keep the sum regular.
    fn levenberg_marquardt(&mut self, at: &Linearisation, point: &Point, factor: f64) {
        let h = at.matrix.as_ref();
        matmul(self.normal.as_mut(), Accum::Replace, h.transpose(), h, 1.0, Par::Seq);
        let lambda = factor * norm(&point.phi) + 4.0 * f64::EPSILON * at.norm * at.norm;
        for i in 0..self.vector.len() {
            self.normal[(i, i)] += lambda;
        }
        assign(&mut self.vector, &at.gradient, -1.0);
        self.lu.solve(self.normal.as_ref(), &mut self.vector);
    }

    /// `α` minimises the linear model `½|Φ - αH∇Ψ|²`.
    fn gradient(&mut self, at: &Linearisation) {
        self.image.fill(0.0);
        for (j, slope) in at.gradient.iter().enumerate() {
            for (image, entry) in self.image.iter_mut().zip(at.matrix.col_as_slice(j)) {
                *image += entry * slope;
            }
        }
        let alpha = dot(&at.gradient, &at.gradient) / dot(&self.image, &self.image);
        assign(&mut self.vector, &at.gradient, -alpha);
    }
}

fn assign(to: &mut [f64], from: &[f64], factor: f64) {
    for (x, y) in to.iter_mut().zip(from) {
        *x = factor * y;
    }
}
