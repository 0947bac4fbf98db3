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
    if found.converged { found } else { root(step, support, Ladder::Up, start).0 }
}

/// Solves the contact on `support` from `start`, from the one that sticks whatever force it takes, or along growing bounds.
pub fn contact(step: &Step, support: Support, start: &Unknowns) -> Reduced {
    let direct = solve(step, support, None, start);
    if direct.converged {
        return direct;
    }
    let largest = LARGEST * step.load_scale;
    let stuck = with_bound(step, support, largest, start);
    let from_stuck = solve(step, support, None, &stuck.at.unknowns);
    let iterations = direct.iterations + stuck.iterations + from_stuck.iterations;
    let found = if from_stuck.converged { from_stuck } else { along_bounds(step, support, start) };
    Reduced { iterations: iterations + found.iterations, ..found }
}

/// Starts from which Newton's method may find other solutions on `support`: near the root of `F` with the least friction,
/// and near the one with the most.
pub fn other_starts(step: &Step, support: Support, start: &Unknowns) -> [Unknowns; 2] {
    [Ladder::Up, Ladder::Down].map(|ladder| {
        let (near, sharp) = root(step, support, ladder, start);
        sharp.unwrap_or(near).at.unknowns
    })
}

fn with_bound(step: &Step, support: Support, bound: f64, start: &Unknowns) -> Reduced {
    solve(&Step { friction: FrictionBound::Held(bound), ..*step }, support, None, start)
}

/// The first root of `F` as `b` grows, sharpened.
fn along_bounds(step: &Step, support: Support, start: &Unknowns) -> Reduced {
    let (near, sharp) = root(step, support, Ladder::Up, start);
    sharp.unwrap_or(Reduced { converged: false, ..near })
}

/// The way that the bounds are gone through: doubled from nothing, or halved from the largest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ladder {
    Up,
    Down,
}

/// The contact just before the first root of `F` on the way, and the root itself where Newton's method finds it from
/// there.
fn root(step: &Step, support: Support, ladder: Ladder, start: &Unknowns) -> (Reduced, Option<Reduced>) {
    let largest = LARGEST * step.load_scale;
    let up = ladder == Ladder::Up;
    let excess =
        |bound: f64, at: &Reduced| bound - step.friction.of(step.bound_impulse(step.normal_impulse(at.at.normal)));
    let mut near_bound = if up { 0.0 } else { largest };
    let mut near = with_bound(step, support, near_bound, start);
    let mut iterations = near.iterations;
    for rung in 0..=DOUBLINGS {
        let halvings = if up { DOUBLINGS - rung } else { rung };
        let mut far_bound = largest * 0.5f64.powi(halvings);
        let far = with_bound(step, support, far_bound, &near.at.unknowns);
        iterations += far.iterations;
        if !far.converged {
            break;
        }
        if (excess(far_bound, &far) < 0.0) == up {
            (near, near_bound) = (far, far_bound);
            continue;
        }
        for halving in 1..=HALVINGS {
            let bound = 0.5 * (near_bound + far_bound);
            let middle = with_bound(step, support, bound, &near.at.unknowns);
            iterations += middle.iterations;
            if middle.converged && (excess(bound, &middle) < 0.0) == up {
                (near, near_bound) = (middle, bound);
            } else {
                far_bound = bound;
            }
            if halving % SHARPEN_EVERY == 0 {
                let sharp = solve(step, support, None, &near.at.unknowns);
                iterations += sharp.iterations;
                if sharp.converged {
                    return (near, Some(Reduced { iterations, ..sharp }));
                }
            }
        }
        break;
    }
    (Reduced { iterations, ..near }, None)
}
