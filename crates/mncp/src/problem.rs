use faer::MatMut;

/// A mixed nonlinear complementarity problem: find `z = [u; v]` with
///
/// ```text
/// 0 = g(u, v),     0 <= v ⟂ f(u, v) >= 0.
/// ```
///
/// The iterates may leave `v >= 0`, so `g` and `f` should be defined around it. Where they are not, a NaN or an infinity
/// makes the line search shorten its step.
pub trait Problem {
    /// `n_e`: the number of equations `g`, and of free unknowns `u`.
    fn equalities(&self) -> usize;

    /// `n_c`: the number of complementarity pairs `0 <= v_i ⟂ f_i >= 0`.
    fn pairs(&self) -> usize;

    /// Writes `out = [g(z); f(z)]`, of length `n = n_e + n_c`.
    fn residual(&self, z: &[f64], out: &mut [f64]);

    /// Writes `out_ij = ∂[g; f]_i / ∂z_j`. `out` is n by n and comes filled with zeros.
    fn jacobian(&self, z: &[f64], out: MatMut<'_, f64>);
}
