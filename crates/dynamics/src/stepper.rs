//! The stepper: solves one step after another and advances the state.

use crate::contact::{downward, of_generator};
use crate::exchange::{Found, search};
use crate::general::{General, REQUIRED};
use crate::reduced::Unknowns;
use crate::residual::Rows;
use crate::rotation::{advance, matrix};
use crate::solution::set_normal_cone;
use crate::step::Step;
use crate::warm::{Trail, Warm};
use crate::{Adhesion, State, StepSolution, Trial, Vec3};
use geometry::Support;

/// `h|ω⁺|` beyond which a step does not count as converged: the Cayley map has turned the body by a right angle.
const MOST_TURN: f64 = 2.0;

/// Which solver a step goes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolverKind {
    /// The reduced problem, held against the unreduced one, and the general solver only where that fails.
    Reduced,
    /// The reduced problem on its word where a support is right, and as `Reduced` where none is: for poses alone. The
    /// multipliers and the residual of a step on its word are NaN.
    Unverified,
    /// The unreduced problem, by the general solver alone.
    General,
}

/// A trial on its way.
#[derive(Clone)]
pub struct Stepper<'a> {
    trial: &'a Trial,
    kind: SolverKind,
    state: State,
    done: u64,
    adhesion: Adhesion,
    warm: Warm,
    trail: Trail,
    solution: StepSolution,
    rows: Rows,
    general: General,
}

impl<'a> Stepper<'a> {
    /// A stepper at the start of `trial`.
    pub fn new(trial: &'a Trial, kind: SolverKind) -> Self {
        let mut stepper = Self::from_state(trial, kind, *trial.initial(), 0, Adhesion::none(), trial.initial_support());
        stepper.solution.support = trial.initial_support();
        stepper.settle(trial.initial_support() != Support::None);
        let rotation = matrix(&stepper.state.orientation);
        stepper.solution.ecp = stepper.state.position + rotation * stepper.solution.patch.centroid;
        stepper
    }

    /// A stepper in `state` after `done` steps, whose last step left `adhesion` and ended on `support`.
    pub fn from_state(
        trial: &'a Trial,
        kind: SolverKind,
        state: State,
        done: u64,
        adhesion: Adhesion,
        support: Support,
    ) -> Self {
        let body = trial.robot().body();
        let mut solution = StepSolution::for_body(body);
        solution.linear = state.linear;
        solution.angular = state.angular;
        let unknowns = Unknowns { angular: state.angular, ..Unknowns::at_rest() };
        Self {
            trial,
            kind,
            state,
            done,
            adhesion,
            warm: Warm { support, unknowns },
            trail: Trail::none(),
            solution,
            rows: Rows::new(body.surfaces().len()),
            general: General::new(body),
        }
    }

    /// The same stepper with another solver for the steps to come.
    pub fn with_solver(self, kind: SolverKind) -> Self {
        Self { kind, ..self }
    }

    /// The state after the last step.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Whether every number of the state is finite.
    pub fn is_finite(&self) -> bool {
        let State { position, orientation, linear, angular } = &self.state;
        let vectors = [position, linear, angular];
        vectors.iter().all(|v| v.iter().all(|x| x.is_finite())) && orientation.coords.iter().all(|x| x.is_finite())
    }

    /// Whether the last step turned the body by so little that it shows which way.
    pub fn is_resolved(&self) -> bool {
        self.trial.step() * self.solution.angular.norm() <= MOST_TURN
    }

    /// The time that has passed, s.
    pub fn time(&self) -> f64 {
        self.done as f64 * self.trial.step()
    }

    /// The solution of the last step.
    pub fn solution(&self) -> &StepSolution {
        &self.solution
    }

    /// The adhesion that the next step will feel.
    pub fn adhesion(&self) -> &Adhesion {
        &self.adhesion
    }

    /// Solves the next step and advances the state by it.
    pub fn advance(&mut self) -> &StepSolution {
        let step = Step::new(self.trial.at(self.time()), &self.state, self.time(), &self.adhesion);
        match self.kind {
            SolverKind::Reduced | SolverKind::Unverified => self.solve_reduced(&step),
            SolverKind::General => {
                self.general.solve(&step, &self.warm, &mut self.rows, &mut self.solution);
                self.trail.end();
            }
        }
        let h = self.trial.step();
        let before = self.trial.guide().map(|guide| (guide.seen(&self.state), self.time()));
        self.solution.converged &= self.is_resolved();
        self.state.linear = self.solution.linear;
        self.state.angular = self.solution.angular;
        self.state.position += self.solution.linear * h;
        self.state.orientation = advance(&self.state.orientation, &self.solution.angular, h);
        self.done += 1;
        if let (Some(guide), Some((seen, start))) = (self.trial.guide(), before) {
            self.state.position.y += guide.shift([seen, guide.seen(&self.state)], [start, self.time()]);
        }
        self.warm.support = self.solution.support;
        self.warm.unknowns.angular = self.solution.angular;
        self.settle(self.solution.normal > 0.0);
        &self.solution
    }

    fn solve_reduced(&mut self, step: &Step) {
        if let Some(onward) = self.trail.onward(self.warm.support) {
            self.warm.unknowns = onward;
        }
        let found = search(step, &self.warm);
        let lowest = accept(step, &found, &mut self.solution);
        self.warm.unknowns = found.at.unknowns;
        self.solution.converged = if found.right && self.kind == SolverKind::Unverified {
            self.solution.leave_unverified();
            true
        } else {
            verify(step, &found, &lowest, &mut self.rows, &mut self.solution)
        };
        if self.solution.converged {
            self.trail.follow(found.support, &found.at.unknowns);
        } else {
            self.trail.end();
            self.solve_again(step);
        }
    }

    /// The general solver finds what touches where the search did not; the reduced problem then sharpens its solution.
    #[cold]
    fn solve_again(&mut self, step: &Step) {
        let mut other = self.solution.clone();
        self.general.solve(step, &self.warm, &mut self.rows, &mut other);
        let warm =
            Warm { support: other.support, unknowns: Unknowns { angular: other.angular, ..Unknowns::at_rest() } };
        let found = search(step, &warm);
        let mut sharpened = other.clone();
        let lowest = accept(step, &found, &mut sharpened);
        sharpened.converged = verify(step, &found, &lowest, &mut self.rows, &mut sharpened);
        sharpened.iterations += other.iterations;
        // What the search left is the closest contact; only a solution may replace it.
        if let Some(solution) = [sharpened, other].into_iter().find(|candidate| candidate.converged) {
            self.solution = solution;
        }
    }

    /// Finds what touches now, and the adhesion of the next step from it.
    fn settle(&mut self, touches: bool) {
        let body = self.trial.robot().body();
        let rotation = matrix(&self.state.orientation);
        let down = downward(&rotation);
        let support = if touches { self.solution.support } else { Support::None };
        self.solution.patch = body.patch(support, &down);
        self.adhesion = if touches {
            let centroid = self.state.position + rotation * self.solution.patch.centroid;
            // It is felt in the next step.
            let trial = self.trial.at(self.time());
            Adhesion::of_patch(trial.substrate(), &self.solution.patch, trial.step(), centroid)
        } else {
            Adhesion::none()
        };
    }
}

/// What [`accept`] finds of the pose after the step.
struct Lowest {
    /// `-n` in the body frame.
    down: Vec3,
    /// The lowest generator.
    generator: u16,
    /// The arm of the ECP: that of the lowest generator where nothing touches.
    arm: Vec3,
}

/// Every unknown of the unreduced problem from the reduced solution, but for the multipliers of the surfaces.
fn accept(step: &Step, found: &Found, solution: &mut StepSolution) -> Lowest {
    let at = &found.at;
    let body = step.body;
    let travelled = step.state.position + at.linear * step.h;
    solution.linear = at.linear;
    solution.angular = at.unknowns.angular;
    solution.support = found.support;
    solution.iterations = found.iterations;
    let down = downward(&at.rotation);
    let (generator, lowest_point) = body.lowest(&down);
    let arm = if found.support == Support::None && at.arm == Vec3::zeros() {
        of_generator(body, generator, &at.rotation)
    } else {
        at.arm
    };
    solution.ecp = travelled + arm;
    solution.ecp_substrate = Vec3::new(solution.ecp.x, solution.ecp.y, 0.0);
    if found.support == Support::None {
        solution.normal = 0.0;
        solution.friction = Vec3::zeros();
        solution.slip = Vec3::zeros();
        solution.sigma = 0.0;
    } else {
        solution.normal = step.normal_impulse(at.normal);
        solution.ecp_substrate.z = 0.0 - step.yielded(solution.normal);
        solution.ecp.z = solution.ecp_substrate.z;
        solution.friction = step.ellipsoid.component_mul(&at.unknowns.friction);
        solution.slip = at.slip;
        solution.sigma = if at.slips { step.ellipsoid.component_mul(&at.slip).norm() } else { 0.0 };
    }
    let depth = solution.ecp_substrate.z - (travelled.z + (at.rotation * lowest_point).z);
    solution.penetration = depth.max(0.0);
    Lowest { down, generator, arm }
}

/// Sets the multipliers of the surfaces and the residual, and returns whether both problems are solved.
fn verify(step: &Step, found: &Found, lowest: &Lowest, rows: &mut Rows, solution: &mut StepSolution) -> bool {
    let cone_of = if found.support == Support::None { Support::Point(lowest.generator) } else { found.support };
    set_normal_cone(step.body, cone_of, &(found.at.rotation.transpose() * lowest.arm), &lowest.down, solution);
    solution.residual = rows.residual(step, solution);
    found.right && solution.residual <= REQUIRED
}
