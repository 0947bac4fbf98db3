//! Huber's loss of whitened differences, and how much a trial's track counts.
//!
//! ```text
//! ρ(r) = r² up to |r| = H, 2 H|r| - H² beyond,    w = 1/(1 + mean square/κ)
//! ```

/// `H`, where the loss turns from square to linear, in sigmas.
pub const HUBER: f64 = 4.0;
/// `κ`: a track whose mean square is beyond it counts by its logarithm.
pub const FAR: f64 = 3.0;

/// `ρ(r)`.
#[inline]
pub fn huber(r: f64) -> f64 {
    let size = r.abs();
    if size <= HUBER { size * size } else { 2.0 * HUBER * size - HUBER * HUBER }
}

/// The weight of a track of `count` numbers whose differences lose `lost`: less where the model is far from it.
pub fn weight(lost: f64, count: usize) -> f64 {
    if count == 0 { 1.0 } else { 1.0 / (1.0 + lost / (FAR * count as f64)) }
}
