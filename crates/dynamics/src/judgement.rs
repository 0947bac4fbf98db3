//! Whether a support is right, and what it is exchanged for where it is not.
//!
//! A support is right when
//!
//! ```text
//! p_n ≥ 0,    the ECP lies inside the support,    n·y ≥ -q⁺_z for every point of the body.
//! ```
//!
//! These are the inequalities of the unreduced problem's complementarity pairs.

use crate::Vec3;
use crate::contact::{ContactPoints, downward};
use crate::reduced::Evaluation;
use crate::step::Step;
use geometry::{Body, Support};

/// How far, over `ℓ`, a point may be below the plane or outside its support: rounding, not physics.
pub const INSIDE: f64 = 1e-12;
/// How negative, over `P`, `p_n` may be.
const NO_PULL: f64 = 1e-13;

/// What becomes of a support.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every condition holds.
    Right,
    /// Right, but for a face that lies flat beside it.
    Flat(u16),
    /// A condition fails, and names the support to try next.
    Exchange(Support),
}

/// Holds `support`'s solution against the conditions, and names the exchange where one fails.
pub fn judge(step: &Step, support: Support, at: &Evaluation) -> Verdict {
    let body = step.body;
    let slack = INSIDE * step.size;
    if support != Support::None {
        let pull = -step.normal_impulse(at.normal);
        if pull > NO_PULL * step.load_scale {
            return Verdict::Exchange(Support::None);
        }
        if let Some(next) = left_support(body, support, at, slack) {
            return Verdict::Exchange(next);
        }
    }
    match deepest(body, at) {
        Some((generator, depth)) if depth > slack => Verdict::Exchange(extended(body, support, generator, at)),
        _ => flat_face(body, support, at, slack).map_or(Verdict::Right, Verdict::Flat),
    }
}

/// The face on which a body lies flat, to rounding, that was taken for a point or a line: after a level landing, say, or a
/// line between two corners of a face that no edge joins.
fn flat_face(body: &Body, support: Support, at: &Evaluation, slack: f64) -> Option<u16> {
    let (one, other) = match support {
        Support::None | Support::Face(_) => return None,
        Support::Point(g) => (g, g),
        Support::Line(g, h) => (g, h),
    };
    let lies = |face: &&u16| {
        let anchors = &body.faces()[**face as usize].anchors;
        body.face_touches(**face, other)
            && anchors.iter().all(|anchor| (at.height + (at.rotation * anchor).z).abs() <= slack)
    };
    body.faces_of(one).iter().find(lies).copied()
}

/// The neighbour that the body turns onto, if the ECP has left `support` by more than `slack`: the one that the ECP has moved
/// to, or the opposite one where adhesion pulls more than the plane pushes, `N < 0`. From the edge that the ECP has passed
/// a push is too weak to hold the other side down, but a pull is too weak to hold this side down.
fn left_support(body: &Body, support: Support, at: &Evaluation, slack: f64) -> Option<Support> {
    match support {
        Support::None | Support::Point(_) => None,
        Support::Line(g, h) => {
            let points = ContactPoints::new(body, support, &at.rotation);
            let length = (points.y[1] - points.y[0]).norm();
            let share = at.unknowns.impulses[0] / at.normal;
            let (passed, other) = if share * length < -slack {
                (h, g)
            } else if (share - 1.0) * length > slack {
                (g, h)
            } else {
                return None;
            };
            Some(Support::Point(if at.normal < 0.0 { other } else { passed }))
        }
        Support::Face(face) => {
            let point = at.rotation.transpose() * at.arm;
            let mut passed = (slack, None);
            for (surface, next) in &body.faces()[face as usize].neighbours {
                let outside = body.surfaces()[*surface as usize].value(&point);
                if outside > passed.0 {
                    passed = (outside, Some(*next));
                }
            }
            let next = passed.1?;
            // Where the ray meets no boundary, there is none but the one that was passed.
            Some(if at.normal < 0.0 { opposite(body, face, &point).unwrap_or(next) } else { next })
        }
    }
}

/// The boundary by which the ray from `point`, outside a face, through the face's middle leaves it. The middle is that of its
/// area, which lies inside whatever pulls; a curved boundary is taken as it lies beside the middle.
fn opposite(body: &Body, face: u16, point: &Vec3) -> Option<Support> {
    let face = &body.faces()[face as usize];
    let middle = face.area_centroid;
    let way = middle - point;
    let (mut first, mut boundary) = (f64::INFINITY, None);
    for (surface, next) in &face.neighbours {
        let surface = &body.surfaces()[*surface as usize];
        let rate = surface.gradient(&middle).dot(&way);
        let share = -surface.value(&middle) / rate;
        if rate > 0.0 && share < first {
            (first, boundary) = (share, Some(*next));
        }
    }
    boundary
}

/// The generator that is deepest below the plane.
fn deepest(body: &Body, at: &Evaluation) -> Option<(u16, f64)> {
    let (generator, point) = body.lowest(&downward(&at.rotation));
    let depth = -(at.height + (at.rotation * point).z);
    depth.is_finite().then_some((generator, depth))
}

/// `support` with the penetrating `generator` added, or what is left of it where the two share no feature.
fn extended(body: &Body, support: Support, generator: u16, at: &Evaluation) -> Support {
    let line = |g: u16, h: u16| if g < h { Support::Line(g, h) } else { Support::Line(h, g) };
    match support {
        Support::None | Support::Face(_) => Support::Point(generator),
        Support::Point(g) if g == generator => Support::Point(g),
        Support::Point(g) => line(g, generator),
        Support::Line(g, h) => match body.face_through(g, h, generator) {
            Some(face) => Support::Face(face),
            None => {
                let keep = if at.unknowns.impulses[0].abs() >= at.unknowns.impulses[1].abs() { g } else { h };
                if keep == generator { Support::Point(generator) } else { line(keep, generator) }
            }
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mat3;
    use geometry::Draft;

    #[test]
    fn the_opposite_edge_is_the_one_that_the_ray_through_the_middle_leaves_by() {
        // Four times as long as wide: from beside a long edge, not in its middle, an end is the farthest.
        let body = Body::cuboid(4e-3, 1e-3, 1e-3, Draft::NONE).unwrap();
        let beside = Vec3::new(0.8e-3, 0.6e-3, -0.5e-3);
        let face = body.faces().iter().position(|face| (face.area_centroid.z + 0.5e-3).abs() < 1e-9).unwrap();
        let Some(Support::Line(g, h)) = opposite(&body, face as u16, &beside) else { panic!("no edge") };
        let ends = ContactPoints::new(&body, Support::Line(g, h), &Mat3::identity()).y;
        assert!(ends[..2].iter().all(|end| (end.x + 0.5e-3).abs() < 1e-9), "{ends:?}");
    }
}
