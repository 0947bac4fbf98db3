//! Contacts that Newton's method does not find from the step before.
//!
//! With a large `e_r` the spin that a little friction stops is far from the one before the step, and the friction bound
//! `μp̄` couples it back to the normal impulses. With the bound held at `b` (Tresca's friction) the contact is a monotone
//! problem, followed without a fold as `b` grows from nothing. Coulomb's friction is a root of
//!
//! ```text
//! F(b) = b - μ p̄(b),     F(0) ≤ 0,     F(b) > 0 for large b
//! ```
//!
//! which is bracketed, halved, and sharpened by Newton's method on the reduced problem (the fixed point of Panagiotopoulos
//! 1975, as a root).
//!
//! Where adhesion enters friction only, `p̄` jumps by `p_a` at `p_n = 0`, and `F` may jump over zero: then the step has no
//! solution. What is left is the contact at the jump, which lacks nothing but some of its friction; [`closest_contact`]
//! gives it.

use crate::reduced::{Reduced, Unknowns, solve};
use crate::step::{FrictionBound, Step};
use geometry::Support;

/// The first bound is `2^-40` of the largest, where even an `e_r` of a thousand times the body's size does little.
const DOUBLINGS: i32 = 40;
/// The largest bound, over `P`: a stopped body needs about one.
const LARGEST: f64 = 64.0;
const HALVINGS: u32 = 50;
/// How many halvings lie between two tries to sharpen.
const SHARPEN_EVERY: u32 = 10;

/// The contact on `support`, or the closest to one that there is, with some of its friction missing.
pub fn closest_contact(step: &Step, support: Support, start: &Unknowns) -> Reduced {
    let found = contact(step, support, start);
    if found.converged { found } else { closest_root(step, support, LARGEST * step.load_scale(), start).0 }
}

/// Solves the contact on `support` from `start`, from the one that sticks whatever force it takes, or along growing bounds.
pub fn contact(step: &Step, support: Support, start: &Unknowns) -> Reduced {
    let direct = solve(step, support, None, start);
    if direct.converged {
        return direct;
    }
    let largest = LARGEST * step.load_scale();
    let stuck = with_bound(step, support, largest, start);
    let from_stuck = solve(step, support, None, &stuck.at.unknowns);
    let iterations = direct.iterations + stuck.iterations + from_stuck.iterations;
    let found = if from_stuck.converged { from_stuck } else { along_bounds(step, support, largest, start) };
    Reduced { iterations: iterations + found.iterations, ..found }
}

fn with_bound(step: &Step, support: Support, bound: f64, start: &Unknowns) -> Reduced {
    solve(&Step { friction: FrictionBound::Held(bound), ..*step }, support, None, start)
}

/// The first root of `F` as `b` grows, sharpened.
fn along_bounds(step: &Step, support: Support, largest: f64, start: &Unknowns) -> Reduced {
    let (low, sharp) = closest_root(step, support, largest, start);
    sharp.unwrap_or(Reduced { converged: false, ..low })
}

/// The contact just below the first root of `F`, and the root itself where Newton's method finds it from there.
fn closest_root(step: &Step, support: Support, largest: f64, start: &Unknowns) -> (Reduced, Option<Reduced>) {
    let excess =
        |bound: f64, at: &Reduced| bound - step.friction.of(step.bound_impulse(step.normal_impulse(at.at.normal)));
    let mut low = with_bound(step, support, 0.0, start);
    let mut low_bound = 0.0;
    let mut iterations = low.iterations;
    for doubling in (0..=DOUBLINGS).rev() {
        let mut high_bound = largest * 0.5f64.powi(doubling);
        let high = with_bound(step, support, high_bound, &low.at.unknowns);
        iterations += high.iterations;
        if !high.converged {
            break;
        }
        if excess(high_bound, &high) < 0.0 {
            (low, low_bound) = (high, high_bound);
            continue;
        }
        for halving in 1..=HALVINGS {
            let bound = 0.5 * (low_bound + high_bound);
            let middle = with_bound(step, support, bound, &low.at.unknowns);
            iterations += middle.iterations;
            if middle.converged && excess(bound, &middle) < 0.0 {
                (low, low_bound) = (middle, bound);
            } else {
                high_bound = bound;
            }
            if halving % SHARPEN_EVERY == 0 {
                let sharp = solve(step, support, None, &low.at.unknowns);
                iterations += sharp.iterations;
                if sharp.converged {
                    return (low, Some(Reduced { iterations, ..sharp }));
                }
            }
        }
        break;
    }
    (Reduced { iterations, ..low }, None)
}
