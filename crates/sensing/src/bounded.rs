//! Least squares within bounds, of what all trials share and of what is each trial's own.
//!
//! The changes `c` of what all share and `l_t` of each trial's own minimise
//!
//! ```text
//! ½ cᵀ N c + nᵀ c + Σ_t (½ l_tᵀ H_t l_t + (h_t + B_t c)ᵀ l_t)
//! ```
//!
//! within their bounds, by block principal pivoting (Portugal, Júdice and Vicente 1994): what is held at a bound counts as
//! known, what is free of a trial's own is eliminated; then all that is wrong changes sides at once, what left its bounds
//! and what is held in vain, as long as there is less and less of it, else one alone, so that it ends. A trial that does
//! not count follows what the others say.

use crate::SensingError;
use crate::measured::LOCAL;
use nalgebra::{DMatrix, DVector, Matrix4, Matrix4xX, Vector4};

/// Rounds for each number, after which what is wrong still is clamped: some ten in all are usual.
const ROUNDS: usize = 20;
/// Rounds that all that is wrong may go on changing sides while it does not grow less.
const PATIENCE: usize = 3;
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

    /// Where a change should be held instead, by its value and the objective's slope there; None where it is right.
    fn mended(&self, change: f64, slope: f64) -> Option<Option<f64>> {
        let range = self.high - self.low;
        match self.held {
            // To first order, what the objective gains across the range of a change that is held at the wrong end.
            Some(end) => {
                let gain = range * if end > self.low { slope } else { -slope };
                (range > 0.0 && gain > GAIN).then_some(None)
            }
            None => {
                let slack = 1e-12 * range;
                let inside = (self.low - slack..=self.high + slack).contains(&change);
                (!inside).then(|| Some(change.max(self.low).min(self.high)))
            }
        }
    }
}

/// A trial's own.
pub(crate) struct Block {
    /// `H`, `B` and `h`.
    pub own: Matrix4<f64>,
    pub by_shared: Matrix4xX<f64>,
    pub slope: Vector4<f64>,
    /// Bounds of the change.
    pub bounds: [[f64; 2]; LOCAL],
    /// Whether the trial has a say in what all share.
    pub counted: bool,
}

/// A block whose free changes are eliminated: `l = -inverse (slope + by_shared c)`, those that are held included.
struct Eliminated {
    inverse: Matrix4<f64>,
    by_shared: Matrix4xX<f64>,
    slope: Vector4<f64>,
    held: Vector4<f64>,
}

impl Block {
    fn eliminated(&self, limits: &[Limited; LOCAL]) -> Option<Eliminated> {
        let held = Vector4::from_fn(|k, _| limits[k].held.unwrap_or(0.0));
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
pub(crate) type Step = (DVector<f64>, Vec<Option<Vector4<f64>>>);

/// The least of the objective, with `N`, `n` and the bounds of what all share.
pub(crate) fn least(
    blocks: &[Option<Block>],
    normal: &DMatrix<f64>,
    slope: &DVector<f64>,
    bounds: &[[f64; 2]],
) -> Result<Step, SensingError> {
    let mut shared: Vec<Limited> = bounds.iter().map(|ends| Limited::new(*ends)).collect();
    let mut own: Vec<[Limited; LOCAL]> =
        blocks.iter().map(|block| block.as_ref().map_or([[0.0; 2]; LOCAL], |b| b.bounds).map(Limited::new)).collect();
    let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
    for _ in 0..ROUNDS * (shared.len() + LOCAL * own.len()) {
        let step = at_these(blocks, normal, slope, &shared, &own)?;
        let mut wrong = wrong(blocks, normal, slope, &step, &mut shared, &mut own);
        let Some((last, end)) = wrong.pop() else { return Ok(step) };
        last.held = end;
        let less = wrong.len() < fewest;
        if less || patience > 0 {
            for (limit, end) in wrong.iter_mut() {
                limit.held = *end;
            }
        }
        (fewest, patience) = if less { (wrong.len(), PATIENCE) } else { (fewest, patience.saturating_sub(1)) };
    }
    let (mut change, mut moved) = at_these(blocks, normal, slope, &shared, &own)?;
    for (value, limit) in change.iter_mut().zip(&shared) {
        *value = value.max(limit.low).min(limit.high);
    }
    for (changes, limits) in moved.iter_mut().zip(&own) {
        for (value, limit) in changes.iter_mut().flat_map(|changes| changes.iter_mut()).zip(limits) {
            *value = value.max(limit.low).min(limit.high);
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
    own: &[[Limited; LOCAL]],
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
    if !change.iter().all(|value| value.is_finite()) {
        return Err(SensingError::SharedSingular);
    }
    let moved = parts.iter().map(|part| part.as_ref().map(|p| -p.inverse * (p.slope + &p.by_shared * &change)));
    let moved = moved.collect();
    Ok((change, moved))
}

/// What is on the wrong side, and where it should be held instead.
fn wrong<'a>(
    blocks: &[Option<Block>],
    normal: &DMatrix<f64>,
    slope: &DVector<f64>,
    (change, moved): &Step,
    shared: &'a mut [Limited],
    own: &'a mut [[Limited; LOCAL]],
) -> Vec<(&'a mut Limited, Option<f64>)> {
    let mut by_shared = slope + normal * change;
    let mut found = Vec::new();
    for ((block, limits), changes) in blocks.iter().zip(own).zip(moved) {
        let (Some(block), Some(changes)) = (block, changes) else { continue };
        let slopes = block.slope + block.own * changes + &block.by_shared * change;
        for ((limit, change), slope) in limits.iter_mut().zip(changes.iter()).zip(slopes.iter()) {
            if let Some(end) = limit.mended(*change, *slope) {
                found.push((limit, end));
            }
        }
        if block.counted {
            by_shared += block.by_shared.transpose() * changes;
        }
    }
    for ((limit, change), slope) in shared.iter_mut().zip(change.iter()).zip(by_shared.iter()) {
        if let Some(end) = limit.mended(*change, *slope) {
            found.push((limit, end));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn objective(blocks: &[Option<Block>], normal: &DMatrix<f64>, slope: &DVector<f64>, step: &Step) -> f64 {
        let (c, moved) = step;
        let own = blocks.iter().zip(moved).filter_map(|(block, l)| block.as_ref().zip(l.as_ref()));
        let own = own.map(|(b, l)| 0.5 * l.dot(&(b.own * l)) + l.dot(&(b.slope + &b.by_shared * c)));
        0.5 * c.dot(&(normal * c)) + slope.dot(c) + own.sum::<f64>()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        // Convex: where no coordinate alone can lower it and the box is kept, a smooth objective is at its least.
        #[test]
        fn no_change_of_one_number_within_its_bounds_lowers_the_objective(
            trials in 1_usize..40,
            alike in 0.0..1.0_f64,
            tight in 0.01..3.0_f64,
            values in prop::collection::vec(-1.0..1.0_f64, 40 * 7 * 7),
        ) {
            // Two shared numbers; seven numbers measured in each trial, all columns more or less alike, as those of a clock,
            // an origin and a scale are on a straight path. Every fifth trial has no say, every seventh no path.
            let mut normal = DMatrix::identity(2, 2) * 0.1;
            let mut slope = DVector::zeros(2);
            let mut blocks = Vec::new();
            for t in 0..trials {
                let value = |row: usize, k: usize| values[(t * 7 + row) * 7 + k];
                let a = DMatrix::from_fn(7, 6, |row, k| alike * value(row, 0) + (1.0 - alike) * value(row, k));
                let wrong = DVector::from_fn(7, |row, _| 5.0 * value(row, 6));
                let (own, common) = (a.columns(2, LOCAL), a.columns(0, 2));
                let counted = t % 5 != 4;
                if counted && t % 7 != 6 {
                    normal += common.transpose() * common;
                    slope += common.transpose() * &wrong;
                }
                let held = if t % 3 == 2 { 0.0 } else { tight };
                blocks.push((t % 7 != 6).then(|| Block {
                    own: (own.transpose() * own).fixed_view::<LOCAL, LOCAL>(0, 0) + Matrix4::identity() * 0.1,
                    by_shared: (own.transpose() * common).fixed_rows::<LOCAL>(0).into_owned(),
                    slope: (own.transpose() * &wrong).fixed_rows::<LOCAL>(0).into_owned(),
                    bounds: [[-tight, 0.5 * tight], [-held, held], [-0.3 * tight, tight], [-tight, tight]],
                    counted,
                }));
            }
            let bounds = [[0.0, tight], [-tight, tight]];
            let step = least(&blocks, &normal, &slope, &bounds).unwrap();
            // What has no say in what is shared is at its least for that.
            let part = |step: &Step, counted: bool| {
                let kept: Vec<_> = step.1.iter().zip(&blocks).map(|(l, b)| b.as_ref().filter(|b| b.counted == counted).and(*l)).collect();
                let shared = if counted { 1.0 } else { 0.0 };
                objective(&blocks, &(&normal * shared), &(&slope * shared), &(step.0.clone(), kept))
            };
            let here = [part(&step, true), part(&step, false)];
            let no_less = |moved: &Step, counted: bool| part(moved, counted) >= here[usize::from(!counted)] - 4.0 * GAIN;
            for (k, [low, high]) in bounds.into_iter().enumerate() {
                prop_assert!((low - 1e-9..=high + 1e-9).contains(&step.0[k]));
                for other in [low, high, step.0[k] - 1e-4, step.0[k] + 1e-4] {
                    let mut moved = step.clone();
                    moved.0[k] = other.clamp(low, high);
                    prop_assert!(no_less(&moved, true), "shared {k}");
                }
            }
            for (t, block) in blocks.iter().enumerate() {
                let Some(block) = block else { continue };
                for k in 0..LOCAL {
                    let ([low, high], value) = (block.bounds[k], step.1[t].unwrap()[k]);
                    prop_assert!((low - 1e-9..=high + 1e-9).contains(&value));
                    for other in [low, high, value - 1e-4, value + 1e-4] {
                        let mut moved = step.clone();
                        moved.1[t].as_mut().unwrap()[k] = other.clamp(low, high);
                        prop_assert!(no_less(&moved, block.counted), "trial {t}, {k}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_shared_and_held_leaves_the_rest_to_the_trial_s_own() {
        // One column for both: held at 0, the shared number leaves the trial's own to follow.
        let block = Block {
            own: Matrix4::from_diagonal(&Vector4::new(10_000.0, 1.0, 1.0, 1.0)),
            by_shared: Matrix4xX::from_column_slice(&[-7_100.0, 0.0, 0.0, 0.0]),
            slope: Vector4::new(3_500.0, 0.0, 0.0, 0.0),
            bounds: [[-1.0, 1.0]; LOCAL],
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
