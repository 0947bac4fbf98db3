//! The Fischer–Burmeister function and its smoothing,
//!
//! ```text
//! φ_ε(a, b) = a + b - sqrt(a² + b² + 2ε),     φ = φ_0,
//! ```
//!
//! with the sign for which `φ > 0` where both arguments are positive. `φ(a, b) = 0` exactly where `0 <= a ⟂ b >= 0`
//! (Fischer 1992), and `φ_ε(a, b) = 0` exactly where `a, b > 0`, `ab = ε` (Kanzow, *Some noninterior continuation
//! methods for linear complementarity problems*, SIAM J. Matrix Anal. Appl. 17, 1996).

/// `sqrt(a² + b² + 2ε)`
fn radius(a: f64, b: f64, smoothing: f64) -> f64 {
    if smoothing > 0.0 { a.hypot(b).hypot((2.0 * smoothing).sqrt()) } else { a.hypot(b) }
}

/// `φ_ε(a, b)`.
///
/// Where `a + b > 0` the sum is taken from `(a + b)² - r² = 2(ab - ε)`, which does not cancel:
/// `φ_ε = 2(ab - ε) / (a + b + r)`.
pub fn value(a: f64, b: f64, smoothing: f64) -> f64 {
    let r = radius(a, b, smoothing);
    let sum = a + b;
    if sum > 0.0 { 2.0 * (a * (b / (sum + r)) - smoothing / (sum + r)) } else { sum - r }
}

/// `(∂φ_ε/∂a, ∂φ_ε/∂b) = (1 - a/r, 1 - b/r)`, `r = sqrt(a² + b² + 2ε)`; `None` where `r = 0`.
pub fn gradient(a: f64, b: f64, smoothing: f64) -> Option<(f64, f64)> {
    let r = radius(a, b, smoothing);
    (r > 0.0).then(|| (1.0 - a / r, 1.0 - b / r))
}

/// The limit of the gradient of `φ` at `(0, 0)` along `(da, db) ≠ 0`,
///
/// ```text
/// (1 - da/s, 1 - db/s),     s = sqrt(da² + db²).
/// ```
///
/// With one vector `w` for all pairs, `da = w_i` and `db = ∇f_iᵀw`, the rows make up an element of the B-subdifferential
/// of `Φ` (De Luca, Facchinei, Kanzow 1996). Here `w` is 1 on every pair at `(0, 0)` and 0 elsewhere.
pub fn gradient_at_origin(da: f64, db: f64) -> (f64, f64) {
    let s = da.hypot(db);
    (1.0 - da / s, 1.0 - db / s)
}
