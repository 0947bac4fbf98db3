//! Least squares within bounds, of what all trials share and of what is each trial's own.
//!
//! The changes `c` of what all share and `l_t` of each trial's own minimise
//!
//! ```text
//! ½ cᵀ N c + nᵀ c + Σ_t (½ l_tᵀ H_t l_t + (h_t + B_t c)ᵀ l_t)
//! ```
//!
//! within their bounds, by the method of active sets (Nocedal and Wright 2006, 16.5): what is held at a bound counts as
//! known, what is free of a trial's own is eliminated, what leaves its bounds is held, and of what is held in vain the
//! one that gains most is freed. Where `N` has a trial's part no more, its own follow what the others say.

use crate::SensingError;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3xX, Vector3};

/// Rounds after which the last step is kept as it is, within its bounds.
const ROUNDS: usize = 40;
/// A gain of the objective that frees nothing: far below what the objective, a few squares of sigmas, is judged by.
const GAIN: f64 = 1e-9;

/// A range of a change, and whether it is held at an end.
#[derive(Debug, Clone, Copy)]
struct Limited {
    low: f64,
    high: f64,
    held: Option<f64>,
}

impl Limited {
    fn new([low, high]: [f64; 2]) -> Self {
        Self { low, high, held: (low >= high).then_some(low) }
    }

    /// Hold a change that has left its range, and return whether it had.
    fn catch(&mut self, change: f64) -> bool {
        let slack = 1e-12 * (self.high - self.low);
        if self.held.is_some() || (self.low - slack..=self.high + slack).contains(&change) {
            return false;
        }
        self.held = Some(change.clamp(self.low, self.high));
        true
    }

    /// What the objective gains, to first order, across the range of a change that is held at the wrong end.
    fn gain(&self, slope: f64) -> f64 {
        match self.held {
            Some(end) if self.low < self.high => (self.high - self.low) * if end > self.low { slope } else { -slope },
            _ => 0.0,
        }
    }
}

/// A trial's own.
pub(crate) struct Block {
    /// `H`, `B` and `h`.
    pub own: Matrix3<f64>,
    pub by_shared: Matrix3xX<f64>,
    pub slope: Vector3<f64>,
    /// Bounds of the change.
    pub bounds: [[f64; 2]; 3],
    /// Whether the trial has a say in what all share.
    pub counted: bool,
}

/// A block whose free changes are eliminated: `l = -inverse (slope + by_shared c)`, those that are held included.
struct Eliminated {
    inverse: Matrix3<f64>,
    by_shared: Matrix3xX<f64>,
    slope: Vector3<f64>,
    held: Vector3<f64>,
}

impl Block {
    fn eliminated(&self, limits: &[Limited; 3]) -> Option<Eliminated> {
        let held = Vector3::from_fn(|k, _| limits[k].held.unwrap_or(0.0));
        let (mut own, mut by_shared, mut slope) = (self.own, self.by_shared.clone(), self.slope + self.own * held);
        for (k, _) in limits.iter().enumerate().filter(|(_, limit)| limit.held.is_some()) {
            own.row_mut(k).fill(0.0);
            own.column_mut(k).fill(0.0);
            own[(k, k)] = 1.0;
            by_shared.row_mut(k).fill(0.0);
            slope[k] = -held[k];
        }
        Some(Eliminated { inverse: own.cholesky()?.inverse(), by_shared, slope, held })
    }
}

/// The changes of what all share and of each trial's own.
pub(crate) type Step = (DVector<f64>, Vec<Option<Vector3<f64>>>);

/// The least of the objective, with `N`, `n` and the bounds of what all share.
pub(crate) fn least(
    blocks: &[Option<Block>],
    normal: &DMatrix<f64>,
    slope: &DVector<f64>,
    bounds: &[[f64; 2]],
) -> Result<Step, SensingError> {
    let mut shared: Vec<Limited> = bounds.iter().map(|ends| Limited::new(*ends)).collect();
    let mut own: Vec<[Limited; 3]> =
        blocks.iter().map(|block| block.as_ref().map_or([[0.0; 2]; 3], |b| b.bounds).map(Limited::new)).collect();
    for _ in 0..ROUNDS {
        let step = at_these(blocks, normal, slope, &shared, &own)?;
        let mut left = false;
        for (limit, change) in shared.iter_mut().zip(step.0.iter()) {
            left |= limit.catch(*change);
        }
        for (limits, changes) in own.iter_mut().zip(&step.1) {
            let Some(changes) = changes else { continue };
            for (limit, change) in limits.iter_mut().zip(changes.iter()) {
                left |= limit.catch(*change);
            }
        }
        if !left && !freed(blocks, normal, slope, &step, &mut shared, &mut own) {
            return Ok(step);
        }
    }
    let (mut change, mut moved) = at_these(blocks, normal, slope, &shared, &own)?;
    for (value, limit) in change.iter_mut().zip(&shared) {
        *value = value.clamp(limit.low, limit.high);
    }
    for (changes, limits) in moved.iter_mut().zip(&own) {
        for (value, limit) in changes.iter_mut().flat_map(|changes| changes.iter_mut()).zip(limits) {
            *value = value.clamp(limit.low, limit.high);
        }
    }
    Ok((change, moved))
}

/// The least with what is held where it is, and no bound on the rest.
fn at_these(
    blocks: &[Option<Block>],
    normal: &DMatrix<f64>,
    slope: &DVector<f64>,
    shared: &[Limited],
    own: &[[Limited; 3]],
) -> Result<Step, SensingError> {
    let (mut normal, mut right) = (normal.clone(), -slope);
    let mut parts = Vec::with_capacity(blocks.len());
    for (i, (block, limits)) in blocks.iter().zip(own).enumerate() {
        let Some(block) = block else {
            parts.push(None);
            continue;
        };
        let part = block.eliminated(limits).ok_or(SensingError::Singular { trial: i })?;
        if block.counted {
            let reduced = part.by_shared.transpose() * part.inverse;
            normal -= &reduced * &part.by_shared;
            right -= block.by_shared.transpose() * part.held - reduced * part.slope;
        }
        parts.push(Some(part));
    }
    for (k, end) in shared.iter().enumerate().filter_map(|(k, limit)| limit.held.map(|end| (k, end))) {
        right -= normal.column(k) * end;
        normal.row_mut(k).fill(0.0);
        normal.column_mut(k).fill(0.0);
        normal[(k, k)] = 1.0;
        right[k] = end;
    }
    let change = normal.lu().solve(&right).ok_or(SensingError::SharedSingular)?;
    let moved = parts.iter().map(|part| part.as_ref().map(|p| -p.inverse * (p.slope + &p.by_shared * &change)));
    let moved = moved.collect();
    Ok((change, moved))
}

/// Free the one that is held in vain and gains most, and return whether there was one.
fn freed(
    blocks: &[Option<Block>],
    normal: &DMatrix<f64>,
    slope: &DVector<f64>,
    (change, moved): &Step,
    shared: &mut [Limited],
    own: &mut [[Limited; 3]],
) -> bool {
    let mut by_shared = slope + normal * change;
    let mut best: Option<(f64, &mut Limited)> = None;
    let mut consider = |limit, slope| {
        let limit: &mut Limited = limit;
        let gain = limit.gain(slope);
        if gain > best.as_ref().map_or(GAIN, |(most, _)| *most) {
            best = Some((gain, limit));
        }
    };
    for ((block, limits), changes) in blocks.iter().zip(own).zip(moved) {
        let (Some(block), Some(changes)) = (block, changes) else { continue };
        let slopes = block.slope + block.own * changes + &block.by_shared * change;
        for (limit, slope) in limits.iter_mut().zip(slopes.iter()) {
            consider(limit, *slope);
        }
        if block.counted {
            by_shared += block.by_shared.transpose() * changes;
        }
    }
    for (limit, slope) in shared.iter_mut().zip(by_shared.iter()) {
        consider(limit, *slope);
    }
    best.map(|(_, limit)| limit.held = None).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn definite(values: &[f64], n: usize) -> DMatrix<f64> {
        let root = DMatrix::from_row_slice(n, n, values);
        &root * root.transpose() + DMatrix::identity(n, n)
    }

    fn objective(blocks: &[Option<Block>], normal: &DMatrix<f64>, slope: &DVector<f64>, step: &Step) -> f64 {
        let (c, moved) = step;
        let own = blocks.iter().zip(moved).filter_map(|(block, l)| block.as_ref().zip(l.as_ref()));
        let own = own.map(|(b, l)| 0.5 * l.dot(&(b.own * l)) + l.dot(&(b.slope + &b.by_shared * c)));
        0.5 * c.dot(&(normal * c)) + slope.dot(c) + own.sum::<f64>()
    }

    proptest! {
        // Convex: where no coordinate alone can lower it and the box is kept, a smooth objective is at its least.
        #[test]
        fn no_change_of_one_number_within_its_bounds_lowers_the_objective(
            whole in prop::collection::vec(-2.0..2.0, 64),
            slopes in prop::collection::vec(-5.0..5.0, 8),
            ends in prop::collection::vec((0.0..1.0, 0.0..1.0), 8),
        ) {
            // Two shared numbers and two trials, of one definite matrix, in which the trials have nothing in common.
            let mut whole = definite(&whole, 8);
            whole.view_mut((2, 5), (3, 3)).fill(0.0);
            whole.view_mut((5, 2), (3, 3)).fill(0.0);
            whole += DMatrix::identity(8, 8) * 40.0;
            let bounds: Vec<[f64; 2]> = ends.iter().map(|(low, high)| [-low * 0.1, high * 0.1]).collect();
            let block = |at: usize| Some(Block {
                own: whole.fixed_view::<3, 3>(at, at).into_owned(),
                by_shared: Matrix3xX::from_fn(2, |r, k| whole[(at + r, k)]),
                slope: Vector3::from_fn(|r, _| slopes[at + r]),
                bounds: [bounds[at], bounds[at + 1], bounds[at + 2]],
                counted: true,
            });
            let blocks = [block(2), None, block(5)];
            let (normal, slope) = (whole.view((0, 0), (2, 2)).into_owned(), DVector::from_column_slice(&slopes[..2]));
            let step = least(&blocks, &normal, &slope, &bounds[..2]).unwrap();
            let here = objective(&blocks, &normal, &slope, &step);
            let all: Vec<f64> = step.0.iter().chain(step.1.iter().flatten().flat_map(|l| l.iter())).copied().collect();
            for (k, value) in all.iter().enumerate() {
                // The slack of the bounds.
                prop_assert!((bounds[k][0] - 1e-12..=bounds[k][1] + 1e-12).contains(value));
                for other in [bounds[k][0], bounds[k][1], value - 1e-5, value + 1e-5] {
                    let mut moved = step.clone();
                    let other = other.clamp(bounds[k][0], bounds[k][1]);
                    match k {
                        0 | 1 => moved.0[k] = other,
                        _ => moved.1[if k < 5 { 0 } else { 2 }].as_mut().unwrap()[(k - 2) % 3] = other,
                    }
                    // Rounding, and what frees nothing.
                    prop_assert!(objective(&blocks, &normal, &slope, &moved) >= here - 2.0 * GAIN);
                }
            }
        }
    }

    #[test]
    fn what_is_shared_and_held_leaves_the_rest_to_the_trial_s_own() {
        // One column for both: held at 0, the shared number leaves the trial's own to follow.
        let block = Block {
            own: Matrix3::from_diagonal(&Vector3::new(10_000.0, 1.0, 1.0)),
            by_shared: Matrix3xX::from_column_slice(&[-7_100.0, 0.0, 0.0]),
            slope: Vector3::new(3_500.0, 0.0, 0.0),
            bounds: [[-1.0, 1.0]; 3],
            counted: true,
        };
        let (normal, slope) = (DMatrix::from_element(1, 1, 10_083.0), DVector::from_element(1, 4_970.0));
        let (shared, own) = least(&[Some(block)], &normal, &slope, &[[0.0, 1.0]]).unwrap();
        assert_eq!(shared[0], 0.0);
        approx(own[0].unwrap()[0], -0.35);
    }

    fn approx(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}
