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
    /// 2003, section 9.1). `Ψ` is continuously differentiable although `Φ` is not, and `∇Ψ = HᵀΦ` for every `H`.
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

#[cfg(test)]
mod tests {
    use faer::MatMut;
    use proptest::prelude::*;

    use super::*;

    /// `g = u² v1 - v2`, `f1 = v1 (1 + v2) - u`, `f2 = v2³ + 2 v1 + u - 1`; at `(0, 0, 1)` only pair 1 is at the kink.
    struct Cubic;

    impl Problem for Cubic {
        fn equalities(&self) -> usize {
            1
        }

        fn pairs(&self) -> usize {
            2
        }

        fn residual(&self, z: &[f64], out: &mut [f64]) {
            out[0] = z[0] * z[0] * z[1] - z[2];
            out[1] = z[1] * (1.0 + z[2]) - z[0];
            out[2] = z[2].powi(3) + 2.0 * z[1] + z[0] - 1.0;
        }

        fn jacobian(&self, z: &[f64], mut out: MatMut<'_, f64>) {
            let rows =
                [[2.0 * z[0] * z[1], z[0] * z[0], -1.0], [-1.0, 1.0 + z[2], z[1]], [1.0, 2.0, 3.0 * z[2] * z[2]]];
            for (i, row) in rows.iter().enumerate() {
                for (j, entry) in row.iter().enumerate() {
                    out[(i, j)] = *entry;
                }
            }
        }
    }

    fn at(z: [f64; 3], smoothing: f64) -> (Point, Linearisation) {
        let mut point = Point::new(1, 2);
        point.z.copy_from_slice(&z);
        point.evaluate(&Cubic, smoothing);
        let mut linearisation = Linearisation::new(1, 2);
        linearisation.evaluate(&Cubic, &point, smoothing);
        (point, linearisation)
    }

    #[test]
    fn kink_is_the_limit_along_w() {
        let (_, kink) = at([0.0, 0.0, 1.0], 0.0);
        let (_, near) = at([0.0, 1e-8, 1.0], 0.0);
        for j in 0..3 {
            for i in 0..3 {
                assert!((kink.matrix[(i, j)] - near.matrix[(i, j)]).abs() < 1e-7, "{i} {j}");
            }
        }
    }

    proptest! {
        /// `H` against differences of `Φ_ε`, `HᵀΦ` against differences of `Ψ_ε`.
        #[test]
        fn is_the_slope(z in prop::array::uniform3(-2.0..2.0), smoothing in prop_oneof![Just(0.0), 1e-3..1.0]) {
            let (point, exact) = at(z, smoothing);
            prop_assume!((1..3).all(|i| point.z[i].hypot(point.values[i]) > 1e-2));
            let h = 1e-6;
            for j in 0..3 {
                let shifted = |by: f64| {
                    let mut x = z;
                    x[j] += by;
                    at(x, smoothing).0
                };
                let (above, below) = (shifted(h), shifted(-h));
                for i in 0..3 {
                    let slope = (above.phi[i] - below.phi[i]) / (2.0 * h);
                    prop_assert!((slope - exact.matrix[(i, j)]).abs() < 1e-5, "{} {}", i, j);
                }
                let slope = (above.merit - below.merit) / (2.0 * h);
                prop_assert!((slope - exact.gradient[j]).abs() < 1e-5 * (1.0 + exact.gradient[j].abs()));
            }
        }
    }
}
