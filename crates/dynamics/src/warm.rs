//! Where a step starts its search.
//!
//! A body that stays on its support moves smoothly, and so do the unknowns. Along the steps on one support they are carried
//! on as a polynomial in time, by Newton's backward differences `∇xᵘ = xᵘ - xᵘ⁻¹`, `∇²xᵘ = ∇xᵘ - ∇xᵘ⁻¹`, ...:
//!
//! ```text
//! x^{u+1} ≈ xᵘ + ∇xᵘ + ∇²xᵘ + ∇³xᵘ + ∇⁴xᵘ
//! ```

use crate::Vec3;
use crate::reduced::Unknowns;
use geometry::Support;
use nalgebra::SVector;

/// The degree of the polynomial. Every degree more takes iterations off; from here on they are few.
const DEGREE: usize = 4;
/// How many first steps on a support tell nothing about the next: the impulses of a landing are those of no other step.
const LANDING: usize = 2;

/// What a step starts from.
#[derive(Debug, Clone, Copy)]
pub struct Warm {
    /// What touched in the step before.
    pub support: Support,
    /// A guess of the unknowns.
    pub unknowns: Unknowns,
}

/// The last steps, as far as they were on one support.
#[derive(Debug, Clone)]
pub struct Trail {
    support: Support,
    /// How many steps there were.
    steps: usize,
    /// `x`, `∇x`, `∇²x`, ... of the last step.
    differences: [SVector<f64, 9>; DEGREE + 1],
}

impl Trail {
    /// No steps.
    pub fn none() -> Self {
        Self { support: Support::None, steps: 0, differences: [SVector::zeros(); DEGREE + 1] }
    }

    /// Takes note of a step that ended on `support`.
    pub fn follow(&mut self, support: Support, unknowns: &Unknowns) {
        if support != self.support {
            self.end();
        }
        self.support = support;
        self.steps += 1;
        let mut next = numbers(unknowns);
        for difference in &mut self.differences {
            let before = std::mem::replace(difference, next);
            next -= before;
        }
    }

    /// Forgets all steps.
    pub fn end(&mut self) {
        self.steps = 0;
    }

    /// The unknowns of the next step on `support`, where the steps before foretell them.
    pub fn onward(&self, support: Support) -> Option<Unknowns> {
        let known = self.steps.saturating_sub(LANDING);
        if known < 2 || support != self.support {
            return None;
        }
        Some(unknowns(&self.differences[..known.min(DEGREE + 1)].iter().sum()))
    }
}

fn numbers(x: &Unknowns) -> SVector<f64, 9> {
    let (w, p, f) = (&x.angular, &x.impulses, &x.friction);
    SVector::from([w.x, w.y, w.z, p[0], p[1], p[2], f.x, f.y, f.z])
}

fn unknowns(x: &SVector<f64, 9>) -> Unknowns {
    Unknowns {
        angular: Vec3::new(x[0], x[1], x[2]),
        impulses: [x[3], x[4], x[5]],
        friction: Vec3::new(x[6], x[7], x[8]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `t⁴ - 3t² + n` in the n-th unknown: whole numbers, so that nothing is rounded.
    fn at(t: i32) -> Unknowns {
        let t = f64::from(t);
        unknowns(&SVector::from_fn(|n, _| t.powi(4) - 3.0 * t * t + n as f64))
    }

    #[test]
    fn a_polynomial_of_the_degree_is_carried_on_exactly_after_the_landing() {
        let mut trail = Trail::none();
        let line = Support::Line(1, 2);
        for impact in 0..LANDING {
            trail.follow(line, &at(1000 * impact as i32 + 777));
        }
        for t in 0..=DEGREE as i32 {
            trail.follow(line, &at(t));
        }
        let next = trail.onward(line).expect("enough steps");
        assert_eq!(numbers(&next), numbers(&at(DEGREE as i32 + 1)));
    }

    #[test]
    fn too_few_steps_and_another_support_foretell_nothing() {
        let mut trail = Trail::none();
        for t in 0..=LANDING as i32 {
            assert!(trail.onward(Support::Point(3)).is_none());
            trail.follow(Support::Point(3), &at(t));
        }
        assert!(trail.onward(Support::Point(3)).is_none());
        trail.follow(Support::Point(3), &at(9));
        assert!(trail.onward(Support::Point(3)).is_some());
        assert!(trail.onward(Support::Point(4)).is_none());
        trail.follow(Support::None, &at(9));
        assert!(trail.onward(Support::None).is_none());
    }
}
