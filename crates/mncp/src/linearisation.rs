use faer::Mat;

use crate::merit::{Point, dot};
use crate::{Problem, fischer_burmeister};

/// An element `H` of the generalised Jacobian of `Φ_ε`, and `∇Ψ_ε = HᵀΦ_ε`.
#[derive(Clone, Debug)]
pub(crate) struct Linearisation {
    pub matrix: Mat<f64>,
    pub gradient: Vec<f64>,
    /// `|H|`, Frobenius
    pub norm: f64,
    equalities: usize,
    /// The rows' `(∂φ/∂a, ∂φ/∂b)`
    weights: Vec<(f64, f64)>,
}

impl Linearisation {
    pub fn new(equalities: usize, pairs: usize) -> Self {
        let n = equalities + pairs;
        Self { matrix: Mat::zeros(n, n), gradient: vec![0.0; n], norm: 0.0, equalities, weights: vec![(0.0, 1.0); n] }
    }

    /// ```text
    /// H = D_a [0 0; 0 I] + D_b J,     J = ∂[g; f]/∂z,
    /// ```
    ///
    /// with `(D_a, D_b)_i = ∂φ_ε(v_i, f_i)` in the rows of the pairs and `(0, 1)` in those of `g` (Facchinei & Pang
    /// 2003, proposition 9.1.4). `Ψ` is continuously differentiable although `Φ` is not, and `∇Ψ = HᵀΦ` for every `H`.
    pub fn evaluate(&mut self, problem: &impl Problem, point: &Point, smoothing: f64) {
        let n = point.z.len();
        self.matrix.fill(0.0);
        problem.jacobian(&point.z, self.matrix.as_mut());
        for i in self.equalities..n {
            self.weights[i] = fischer_burmeister::gradient(point.z[i], point.values[i], smoothing)
                .unwrap_or_else(|| fischer_burmeister::gradient_at_origin(1.0, self.slope_along_kinks(i, point)));
        }
        let mut square = 0.0;
        for j in 0..n {
            let column = self.matrix.col_as_slice_mut(j);
            for (entry, weight) in column.iter_mut().zip(&self.weights) {
                *entry *= weight.1;
            }
            column[j] += self.weights[j].0;
            square += dot(column, column);
            self.gradient[j] = dot(column, &point.phi);
        }
        self.norm = square.sqrt();
    }

    /// `∇f_iᵀw`, `w` the indicator of the pairs at `(0, 0)`
    fn slope_along_kinks(&self, i: usize, point: &Point) -> f64 {
        let row = self.matrix.row(i);
        (self.equalities..point.z.len()).filter(|&j| point.is_at_kink(j)).map(|j| row[j]).sum()
    }

    /// Whether `H` and `∇Ψ` are finite.
    pub fn is_finite(&self) -> bool {
        self.norm.is_finite() && dot(&self.gradient, &self.gradient).is_finite()
    }
}
