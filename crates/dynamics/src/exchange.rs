//! Which support a step ends on: solve for one, see what is violated ([`crate::judgement`]), exchange it for a neighbour.
//!
//! Exchanging one violated pair at a time is principal pivoting (Murty 1974); where it cycles, every support is tried in
//! turn.

use crate::Vec3;
use crate::contact::downward;
use crate::judgement::{INSIDE, Verdict, judge};
use crate::predictor::{closest_contact, contact, other_starts};
use crate::reduced::{Evaluation, Reduced, Unknowns, solve};
use crate::step::Step;
use crate::warm::Warm;
use geometry::{Generator, Support};

const MAX_EXCHANGES: usize = 24;
/// The tilt (rad) from which a body is taken onto a curved rim.
const RIM_TILT: f64 = 1e-5;

/// The support that was found and its solution.
#[derive(Debug, Clone, Copy)]
pub struct Found {
    /// What touches after the step.
    pub support: Support,
    /// The reduced solution.
    pub at: Evaluation,
    /// Newton iterations over all supports that were tried.
    pub iterations: u32,
    /// Whether every condition holds.
    pub right: bool,
}

/// What is asked of the contact on a support.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// That it solves the reduced problem.
    Solution,
    /// Where nothing does: that it lacks only some of its friction.
    Closest,
}

/// The step's solution by exchanging supports from `warm`, or by trying all of them; if there is none, the closest.
pub fn search(step: &Step, warm: &Warm) -> Found {
    let mut iterations = 0;
    let exact = exchange(step, warm, Wanted::Solution, &mut iterations);
    if exact.right {
        return Found { iterations, ..exact };
    }
    if let Some(found) = try_all(step, warm, Wanted::Solution, &mut iterations) {
        return Found { iterations, ..found };
    }
    let closest = exchange(step, warm, Wanted::Closest, &mut iterations);
    let found = if closest.right { Some(closest) } else { try_all(step, warm, Wanted::Closest, &mut iterations) };
    Found { right: false, iterations, ..found.unwrap_or(exact) }
}

/// Exchanges supports from `warm` until one is right, or as far as that leads.
fn exchange(step: &Step, warm: &Warm, wanted: Wanted, iterations: &mut u32) -> Found {
    let mut visited = [Support::None; MAX_EXCHANGES];
    let mut support = warm.support;
    let mut start = warm.unknowns;
    let mut tried = 0;
    loop {
        visited[tried] = support;
        tried += 1;
        let reduced = solve_support(step, support, &start, &warm.support, wanted);
        *iterations += reduced.iterations;
        let found = Found { support, at: reduced.at, iterations: *iterations, right: false };
        if !reduced.converged {
            return found;
        }
        match judge(step, support, &reduced.at) {
            Verdict::Right => return Found { right: true, ..found },
            // The face is the better name for the same contact, unless the ECP is beyond it.
            Verdict::Flat(face) => {
                let flat = solve_support(
                    step,
                    Support::Face(face),
                    &fresh_start(step, Support::Face(face), &reduced.at),
                    &warm.support,
                    wanted,
                );
                *iterations += flat.iterations;
                let fits = flat.converged && matches!(judge(step, Support::Face(face), &flat.at), Verdict::Right);
                return if fits {
                    Found { support: Support::Face(face), at: flat.at, iterations: *iterations, right: true }
                } else {
                    Found { right: true, ..found }
                };
            }
            Verdict::Exchange(next) => {
                if tried == MAX_EXCHANGES || visited[..tried].contains(&next) {
                    return found;
                }
                start = fresh_start(step, next, &reduced.at);
                if let (Support::Face(_), Support::Point(generator)) = (support, next) {
                    start.angular += tilt_onto(step, generator, &reduced.at);
                }
                support = next;
            }
        }
    }
}

/// The first support of the body whose solution is right, each from several starts: a contact with friction may have more
/// than one solution.
fn try_all(step: &Step, warm: &Warm, wanted: Wanted, iterations: &mut u32) -> Option<Found> {
    let body = step.body;
    let points = (0..body.generators().len()).map(|g| Support::Point(g as u16));
    let lines = body.edges().iter().map(|edge| Support::Line(edge.generators.0, edge.generators.1));
    let faces = (0..body.faces().len()).map(|f| Support::Face(f as u16));
    for support in std::iter::once(Support::None).chain(faces).chain(lines).chain(points) {
        let moving = fresh(step, support);
        let still = Unknowns { angular: Vec3::zeros(), ..moving };
        let mut attempt = |start: &Unknowns| {
            let reduced = solve_support(step, support, start, &warm.support, wanted);
            *iterations += reduced.iterations;
            let right =
                reduced.converged && matches!(judge(step, support, &reduced.at), Verdict::Right | Verdict::Flat(_));
            right.then_some(Found { support, at: reduced.at, iterations: *iterations, right })
        };
        let found = attempt(&moving).or_else(|| attempt(&still)).or_else(|| match support {
            Support::None => None,
            _ => other_starts(step, support, &moving).iter().find_map(attempt),
        });
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Solves for `support`. In the air, `-p_a n` acts at the lowest point after the step: the one that the body hung by
/// before, if it stays the lowest, else the lowest that is consistent with itself.
fn solve_support(step: &Step, support: Support, start: &Unknowns, before: &Support, wanted: Wanted) -> Reduced {
    if support != Support::None {
        return match wanted {
            Wanted::Solution => contact(step, support, start),
            Wanted::Closest => closest_contact(step, support, start),
        };
    }
    if !step.pulls_at_ecp || step.adhesion == 0.0 {
        return solve(step, support, None, start);
    }
    let mut hang = match *before {
        Support::Point(g) | Support::Line(g, _) => g,
        Support::Face(face) => step.body.faces()[face as usize].generators[0],
        Support::None => step.body.lowest(&downward(&step.rotation)).0,
    };
    let mut reduced = solve(step, support, Some(hang), start);
    for _ in 0..4 {
        let (lowest, point) = step.body.lowest(&downward(&reduced.at.rotation));
        let drop = reduced.at.arm.z - (reduced.at.rotation * point).z;
        if !reduced.converged || lowest == hang || drop <= INSIDE * step.size {
            break;
        }
        hang = lowest;
        let again = solve(step, support, Some(hang), start);
        reduced = Reduced { iterations: reduced.iterations + again.iterations, ..again };
    }
    reduced
}

/// A start for a support that nothing is known about: the weight, spread evenly.
fn fresh(step: &Step, support: Support) -> Unknowns {
    let count = match support {
        Support::None => 0,
        Support::Point(_) => 1,
        Support::Line(..) => 2,
        Support::Face(_) => 3,
    };
    let mut start = Unknowns::at_rest();
    start.angular = step.state.angular;
    let share = (step.load.z.abs() + step.pull.z.abs()) / count.max(1) as f64;
    start.impulses[..count].fill(share);
    start
}

/// The start after an exchange: friction as it was, the normal impulse spread evenly over the new support.
fn fresh_start(step: &Step, next: Support, at: &Evaluation) -> Unknowns {
    let mut start = fresh(step, next);
    if at.normal > 0.0 {
        let total: f64 = start.impulses.iter().sum();
        if total > 0.0 {
            for impulse in &mut start.impulses {
                *impulse *= at.normal / total;
            }
        }
        start.friction = at.unknowns.friction;
    }
    start
}

/// A small spin onto the rim of a face, where the rim is curved: its lowest point follows the direction of the tilt, which a
/// flat face does not have. With `d` the horizontal normal of the surface that the ECP has left, `n × d` lowers that side.
fn tilt_onto(step: &Step, rim: u16, at: &Evaluation) -> Vec3 {
    if matches!(step.body.generators()[rim as usize], Generator::Vertex(_)) {
        return Vec3::zeros();
    }
    let point = at.rotation.transpose() * at.arm;
    let (left, _) = step.body.max_value(&point);
    let mut outward = at.rotation * step.body.surfaces()[left].gradient(&point);
    outward.z = 0.0;
    let length = outward.norm();
    if length > 0.0 { Vec3::z().cross(&outward) * (RIM_TILT / (length * step.h)) } else { Vec3::zeros() }
}
