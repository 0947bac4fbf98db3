//! The points of a support and how they move as the body turns.

use crate::{Mat3, Vec3};
use geometry::{Body, Support};

/// Points `y_j = R⁺ s_j` relative to the centre of mass, in the substrate frame.
#[derive(Debug, Clone, Copy)]
pub struct ContactPoints {
    /// How many points there are, at most three.
    pub count: usize,
    /// `y_j`, m.
    pub y: [Vec3; 3],
    /// `dy_j/dφ`.
    pub turn: [Mat3; 3],
}

impl ContactPoints {
    /// The points of `support` on `body` turned by `rotation`.
    ///
    /// A vertex or an anchor has `dy = dφ × y`. The lowest point of an arc or ellipsoid moves in the body too: with
    /// `s(d)` the farthest point along `d = -Rᵀn`, `dy = dφ × y - R s'(d) Rᵀ [n]ₓ dφ`.
    #[inline]
    pub fn new(body: &Body, support: Support, rotation: &Mat3) -> Self {
        let mut points = Self { count: 0, y: [Vec3::zeros(); 3], turn: [Mat3::zeros(); 3] };
        match support {
            Support::None => {}
            Support::Point(g) => points.push_generator(body, g, rotation),
            Support::Line(g, h) => {
                points.push_generator(body, g, rotation);
                points.push_generator(body, h, rotation);
            }
            Support::Face(face) => {
                for anchor in &body.faces()[face as usize].anchors {
                    let y = rotation * anchor;
                    points.push(y, -y.cross_matrix());
                }
            }
        }
        points
    }

    /// The lowest point of one generator.
    #[inline]
    pub fn of_generator(body: &Body, generator: u16, rotation: &Mat3) -> (Vec3, Mat3) {
        let direction = downward(rotation);
        let generator = &body.generators()[generator as usize];
        let y = rotation * generator.support(&direction);
        let slide = rotation * generator.support_derivative(&direction) * rotation.transpose();
        (y, -y.cross_matrix() - slide * Vec3::z().cross_matrix())
    }

    fn push_generator(&mut self, body: &Body, generator: u16, rotation: &Mat3) {
        let (y, turn) = Self::of_generator(body, generator, rotation);
        self.push(y, turn);
    }

    fn push(&mut self, y: Vec3, turn: Mat3) {
        self.y[self.count] = y;
        self.turn[self.count] = turn;
        self.count += 1;
    }
}

/// `-Rᵀn`: the direction into the substrate, in the body frame.
#[inline]
pub fn downward(rotation: &Mat3) -> Vec3 {
    -rotation.row(2).transpose()
}
