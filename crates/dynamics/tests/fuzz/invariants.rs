//! What must hold of every step, from its state before and after and from what it says of itself.
//!
//! The formulas are those of `docs/model.md`, written again from the poses and impulses alone: nothing of how the step was
//! solved is taken from it.

use geometry::Body;
use tumblers_dynamics::residual::Rows;
use tumblers_dynamics::rotation::matrix;
use tumblers_dynamics::step::Step;
use tumblers_dynamics::{Mat3, State, StepSolution, Stepper, Trial, Vec3};

/// The residual of a step that says that it has converged.
const REQUIRED: f64 = 1e-10;
/// `h|ω⁺|` of a step that says that it has converged.
const MOST_TURN: f64 = 2.0;
/// Over the body's size: penetration, and how far the ECP may be outside the body.
const DEPTH: f64 = 1e-9;
/// Over `P U`, `P`: the power and the impulse of a contact that gives none. The rows are exact to 1e-10 of `P` and of `U`.
const NOTHING: f64 = 1e-8;
/// Numbers of the size of `z` are rounded to this part of it, a few times in a step.
const ROUNDING: f64 = 1e-14;

/// What came of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Came {
    /// A solution.
    Converged,
    /// A solution whose friction is farther outside its ellipsoid than rounding. The residual has `ξ` there, a square, so
    /// that 1e-10 of it is 1e-5 of `P`; the reduced problem is exact, but the general solver uses that.
    Loose,
    /// No solution, and the step says so.
    Unconverged,
    /// Numbers that are finite no more, and the step says that it has not converged.
    Diverged,
}

/// Looks on while a stepper goes through a trial.
pub struct Watch<'a> {
    trial: &'a Trial,
    rows: Rows,
    /// `δ` after the last step, m.
    yielded: f64,
}

impl<'a> Watch<'a> {
    pub fn new(trial: &'a Trial) -> Self {
        Self { trial, rows: Rows::new(trial.robot().body().surfaces().len()), yielded: 0.0 }
    }

    /// Makes the next step and holds it against what must hold, or says what does not.
    pub fn step(&mut self, stepper: &mut Stepper<'a>) -> Result<Came, String> {
        let (before, adhesion, time) = (*stepper.state(), *stepper.adhesion(), stepper.time());
        let solution = stepper.advance().clone();
        let step = Step::new(self.trial, &before, time, &adhesion);
        if !solution.converged {
            self.yielded = step.yielded(solution.normal);
            return Ok(if stepper.is_finite() { Came::Unconverged } else { Came::Diverged });
        }
        if !stepper.is_finite() || !is_finite(&solution) {
            return Err("numbers that are not finite in a step that says that it has converged".to_owned());
        }
        let residual = self.rows.residual(&step, &solution);
        if residual > REQUIRED || residual != solution.residual {
            return Err(format!("a residual of {residual:e} where the step says {:e}", solution.residual));
        }
        let turn = step.h * solution.angular.norm();
        if turn > MOST_TURN {
            return Err(format!("a turn of {turn} in a step that says that it has converged"));
        }
        let after = stepper.state();
        let unit = after.orientation.norm();
        if (unit - 1.0).abs() > 1e-12 {
            return Err(format!("a quaternion of length {unit}"));
        }
        let seen = Seen::new(&step, &solution, after, self.yielded);
        self.yielded = seen.yielded;
        seen.no_penetration()?;
        seen.contact_at_the_body()?;
        seen.friction_in_its_ellipsoid()?;
        seen.no_energy_from_contact()?;
        Ok(if seen.outside_ellipsoid() > NOTHING * seen.load { Came::Loose } else { Came::Converged })
    }
}

fn is_finite(solution: &StepSolution) -> bool {
    let vectors = [&solution.ecp, &solution.ecp_substrate, &solution.friction, &solution.slip];
    let numbers = [solution.normal, solution.sigma, solution.penetration, solution.plane_multiplier, solution.residual];
    vectors.iter().all(|v| v.iter().all(|x| x.is_finite()))
        && numbers.iter().chain(&solution.multipliers).all(|x| x.is_finite())
}

/// A converged step seen from outside.
struct Seen<'a> {
    step: &'a Step<'a>,
    solution: &'a StepSolution,
    /// `R⁺`.
    rotation: Mat3,
    /// `δ` before and after, m.
    yielded_before: f64,
    yielded: f64,
    /// The lowest points of the body before and after, m.
    lowest_before: f64,
    lowest: f64,
    /// `r = a1 - q⁺`, m.
    arm: Vec3,
    /// `P`, N s.
    load: f64,
    /// What rounding may make of a height, m.
    slack: f64,
}

impl<'a> Seen<'a> {
    fn new(step: &'a Step<'a>, solution: &'a StepSolution, after: &State, yielded_before: f64) -> Self {
        let rotation = matrix(&after.orientation);
        let yielded = step.yielding * solution.normal;
        let before = &step.state;
        let load = step.mass * before.linear.norm()
            + (step.inertia * before.angular).norm() / step.size
            + step.load.norm()
            + step.torque.greatest() / step.size
            + step.adhesion
            + solution.normal.abs()
            + solution.friction.xy().abs().sum();
        let heights = before.position.z.abs() + step.h * after.linear.z.abs() + yielded.abs() + yielded_before.abs();
        Self {
            step,
            solution,
            rotation,
            yielded_before,
            yielded,
            lowest_before: lowest(step.body, &before.position, &step.rotation),
            lowest: lowest(step.body, &after.position, &rotation),
            arm: solution.ecp - after.position,
            load,
            slack: DEPTH * step.size + ROUNDING * heights,
        }
    }

    /// No point of the body is below the plane, where that has yielded to.
    fn no_penetration(&self) -> Result<(), String> {
        let depth = -self.yielded - self.lowest;
        if depth > self.slack {
            return Err(format!(
                "penetration by {:e} of the size, said to be {:e} m",
                depth / self.step.size,
                self.solution.penetration
            ));
        }
        Ok(())
    }

    /// `p_n ≥ 0`; and where it is more than nothing, the ECP is a point of the body, and the body's lowest.
    fn contact_at_the_body(&self) -> Result<(), String> {
        let normal = self.solution.normal;
        if normal < -REQUIRED * self.load {
            return Err(format!("p_n is {:e} of P", normal / self.load));
        }
        if normal <= REQUIRED * self.load {
            return Ok(());
        }
        let gap = self.lowest + self.yielded;
        if gap.abs() > self.slack {
            return Err(format!("p_n is {:e} of P across a gap of {:e} m", normal / self.load, gap));
        }
        let outside = self.step.body.max_value(&(self.rotation.transpose() * self.arm)).1;
        if outside > self.slack {
            return Err(format!("the ECP is {:e} of the size outside the body", outside / self.step.size));
        }
        Ok(())
    }

    /// How far `√((p_t/e_t)² + (p_o/e_o)² + (p_r/e_r)²)` is beyond `μ p̄`, N s.
    fn outside_ellipsoid(&self) -> f64 {
        let bound = self.step.friction.of(self.step.bound_impulse(self.solution.normal.max(0.0)));
        self.solution.friction.component_div(&self.step.ellipsoid).norm() - bound
    }

    /// `(p_t/e_t)² + (p_o/e_o)² + (p_r/e_r)² ≤ (μ p̄)²`, to `1e-10 P²`.
    fn friction_in_its_ellipsoid(&self) -> Result<(), String> {
        let length = self.solution.friction.component_div(&self.step.ellipsoid).norm();
        let bound = length - self.outside_ellipsoid();
        if length > bound.hypot(REQUIRED.sqrt() * self.load) * (1.0 + REQUIRED) {
            return Err(format!(
                "friction of {:e} of P in an ellipsoid of {:e}",
                length / self.load,
                bound / self.load
            ));
        }
        Ok(())
    }

    /// Contact takes energy or leaves it: the work of `p_n` on the way of the point that it acts on, less what the yielding
    /// plane stores, and the work of friction on the slip, which is asked by itself too.
    ///
    /// A material point is moved by `h (v⁺ + ω⁺ × (y + y⁺)/2)` with the Cayley map, from `y` to `y⁺ = r`. It was in the body,
    /// which was nowhere below the plane, and is now on it: `p_n` pushes against its way.
    fn no_energy_from_contact(&self) -> Result<(), String> {
        let Self { step, solution, .. } = self;
        let surface = solution.linear + solution.angular.cross(&self.arm);
        let slip = Vec3::new(surface.x, surface.y, solution.angular.z);
        let speed = solution.linear.norm() + step.size * solution.angular.norm() + self.load / step.mass;
        let scaled = step.ellipsoid.component_mul(&slip).norm();
        let friction = solution.friction.dot(&slip);
        let power = self.load * speed.max(scaled);
        // What is outside the ellipsoid is asked for by itself.
        if friction > NOTHING * power + self.outside_ellipsoid().max(0.0) * scaled {
            return Err(format!("friction gives {:e} of P U", friction / power));
        }
        let start = step.state.position.z + (step.rotation * (self.rotation.transpose() * self.arm)).z;
        let way = -self.yielded - start;
        // What the plane gives back: ½ c (λ² - λ⁺²) = (δ² - δ⁺²)/(2c), of which p_n = h δ⁺/c takes p_n/h ((δ² - δ⁺²)/(2δ⁺)).
        let given_back = if self.yielded > 0.0 {
            (self.yielded_before.powi(2) - self.yielded.powi(2)) / (2.0 * self.yielded)
        } else {
            0.0
        };
        // A step without a solution may have left the body under the plane, from where this one raises it.
        let buried = (-self.yielded_before - self.lowest_before).max(0.0);
        if solution.normal > 0.0 && way > given_back + buried + self.slack {
            return Err(format!("p_n lifts its point by {:e} of the size", (way - given_back) / step.size));
        }
        Ok(())
    }
}

/// The height of the lowest point of `body` at a pose.
fn lowest(body: &Body, position: &Vec3, rotation: &Mat3) -> f64 {
    let down = -rotation.row(2).transpose();
    let reach = |generator: &geometry::Generator| (rotation * generator.support(&down)).z;
    position.z + body.generators().iter().map(reach).fold(f64::INFINITY, f64::min)
}
