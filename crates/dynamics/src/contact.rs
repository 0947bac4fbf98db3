//! The points of a support and how they move as the body turns.

use crate::{Mat3, Vec3};
use geometry::{Body, Generator, Support};

/// Points `y_j = R⁺ s_j` relative to the centre of mass, in the substrate frame.
#[derive(Debug, Clone, Copy)]
pub struct ContactPoints {
    /// How many points there are, at most three.
    pub count: usize,
    /// `y_j`, m.
    pub y: [Vec3; 3],
}

impl ContactPoints {
    /// The points of `support` on `body` turned by `rotation`.
    #[inline]
    pub fn new(body: &Body, support: Support, rotation: &Mat3) -> Self {
        let none = Vec3::zeros();
        match support {
            Support::None => Self { count: 0, y: [none; 3] },
            Support::Point(g) => Self { count: 1, y: [of_generator(body, g, rotation), none, none] },
            Support::Line(g, h) => {
                Self { count: 2, y: [of_generator(body, g, rotation), of_generator(body, h, rotation), none] }
            }
            Support::Face(face) => {
                Self { count: 3, y: body.faces()[face as usize].anchors.map(|anchor| rotation * anchor) }
            }
        }
    }

    /// `dy_j/dφ` of every point of `support`.
    #[inline]
    pub fn turns(&self, body: &Body, support: Support, rotation: &Mat3) -> [Mat3; 3] {
        let none = Mat3::zeros();
        let y = &self.y;
        match support {
            Support::None => [none; 3],
            Support::Point(g) => [turn_of_generator(body, g, rotation, &y[0]), none, none],
            Support::Line(g, h) => {
                [turn_of_generator(body, g, rotation, &y[0]), turn_of_generator(body, h, rotation, &y[1]), none]
            }
            Support::Face(_) => y.map(|y| -y.cross_matrix()),
        }
    }
}

/// `y`: the lowest point of one generator.
#[inline]
pub fn of_generator(body: &Body, generator: u16, rotation: &Mat3) -> Vec3 {
    rotation * body.generators()[generator as usize].support(&downward(rotation))
}

/// `dy/dφ` of the lowest point `y` of one generator.
///
/// A vertex or an anchor has `dy = dφ × y`. The lowest point of an arc or ellipsoid moves in the body too: with `s(d)` the
/// farthest point along `d = -Rᵀn`, `dy = dφ × y - R s'(d) Rᵀ [n]ₓ dφ`.
#[inline]
pub fn turn_of_generator(body: &Body, generator: u16, rotation: &Mat3, y: &Vec3) -> Mat3 {
    match &body.generators()[generator as usize] {
        Generator::Vertex(_) => -y.cross_matrix(),
        curved => {
            let slide = rotation * curved.support_derivative(&downward(rotation)) * rotation.transpose();
            -y.cross_matrix() - slide * Vec3::z().cross_matrix()
        }
    }
}

/// `-Rᵀn`: the direction into the substrate, in the body frame.
#[inline]
pub fn downward(rotation: &Mat3) -> Vec3 {
    -rotation.row(2).transpose()
}
