use crate::{Problem, fischer_burmeister};

/// A point `z` with `[g; f]`, `Φ_ε = [g; φ_ε(v, f)]` and what is measured on them.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub z: Vec<f64>,
    /// `[g(z); f(z)]`
    pub values: Vec<f64>,
    /// `Φ_ε(z)`
    pub phi: Vec<f64>,
    /// `Ψ_ε = ½|Φ_ε|²`
    pub merit: f64,
    /// `max(|g|_∞, |min(v, f)|_∞)`
    pub residual: f64,
    equalities: usize,
}

impl Point {
    pub fn new(equalities: usize, pairs: usize) -> Self {
        let zeros = vec![0.0; equalities + pairs];
        Self { z: zeros.clone(), values: zeros.clone(), phi: zeros, merit: 0.0, residual: 0.0, equalities }
    }

    /// Evaluates `[g; f]` at `z` and measures it.
    pub fn evaluate(&mut self, problem: &impl Problem, smoothing: f64) {
        problem.residual(&self.z, &mut self.values);
        self.measure(smoothing);
    }

    /// `Φ_ε`, `Ψ_ε` and the natural residual from the values of `g` and `f`.
    pub fn measure(&mut self, smoothing: f64) {
        let mut residual = 0.0_f64;
        for i in 0..self.z.len() {
            let (v, f) = (self.z[i], self.values[i]);
            let (phi, natural) =
                if i < self.equalities { (f, f) } else { (fischer_burmeister::value(v, f, smoothing), v.min(f)) };
            self.phi[i] = phi;
            residual = residual.max(natural.abs());
        }
        self.merit = 0.5 * dot(&self.phi, &self.phi);
        self.residual = if self.merit.is_finite() { residual } else { f64::NAN };
    }

    /// Whether `Ψ_ε`, hence every entry of `g` and `f`, is finite.
    pub fn is_finite(&self) -> bool {
        self.merit.is_finite()
    }

    /// Whether pair `i` sits at `(v, f) = (0, 0)`, where `φ` has no gradient.
    pub fn is_at_kink(&self, i: usize) -> bool {
        i >= self.equalities && self.z[i] == 0.0 && self.values[i] == 0.0
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
