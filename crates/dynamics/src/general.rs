//! A step by the general solver, without any guess of what touches.
//!
//! The unreduced problem goes to `mncp` as it stands. The index `k` of an active constraint has to be chosen before:
//! the surfaces are tried in the order of how far they face the substrate.

use crate::contact::{ContactPoints, downward};
use crate::problem::{FREE, StepProblem};
use crate::residual::Rows;
use crate::rotation::cayley;
use crate::solution::set_normal_cone;
use crate::step::Step;
use crate::warm::Warm;
use crate::{StepSolution, Vec3};
use faer::MatMut;
use geometry::{Body, Support};
use mncp::{Problem, Settings, Solver};

/// Scaled natural residual that a step must reach.
pub const REQUIRED: f64 = 1e-10;
/// How far apart, over `ℓ`, points may be that touch together, when a support is read off a solution.
const TOGETHER: f64 = 1e-7;

impl Problem for StepProblem<'_> {
    fn equalities(&self) -> usize {
        FREE
    }

    fn pairs(&self) -> usize {
        self.surfaces() + 2
    }

    fn residual(&self, z: &[f64], out: &mut [f64]) {
        self.rows(z, out);
    }

    fn jacobian(&self, z: &[f64], out: MatMut<'_, f64>) {
        self.jacobian_of_rows(z, out);
    }
}

/// The general solver and its storage for one body.
pub struct General {
    solver: Solver,
    point: Vec<f64>,
    order: Vec<(f64, usize)>,
    best: StepSolution,
}

impl Clone for General {
    /// New storage of the same size: what a solve leaves in it is of no use to the next.
    fn clone(&self) -> Self {
        Self::with(self.best.clone())
    }
}

impl General {
    /// The solver for the steps of `body`.
    pub fn new(body: &Body) -> Self {
        Self::with(StepSolution::for_body(body))
    }

    fn with(best: StepSolution) -> Self {
        let surfaces = best.multipliers.len();
        let settings = Settings { tolerance: REQUIRED * 1e-2, ..Settings::default() };
        let solver = Solver::new(FREE, surfaces + 2, settings).expect("the settings above are in their ranges");
        Self { solver, point: vec![0.0; FREE + surfaces + 2], order: vec![(0.0, 0); surfaces], best }
    }

    /// The best solution over the starts; the first that reaches the required residual ends the search. The starts are the
    /// contact of the step before, then every choice of `k` with and without a normal impulse.
    pub fn solve(&mut self, step: &Step, warm: &Warm, rows: &mut Rows, solution: &mut StepSolution) {
        self.rank_surfaces(step);
        self.best.residual = f64::INFINITY;
        let touched = warm.support != Support::None;
        start_on(step, warm.support, touched, solution);
        let mut iterations = self.attempt(step, rows, solution);
        for touching in [touched, !touched] {
            for i in 0..self.order.len() {
                if self.best.residual <= REQUIRED {
                    break;
                }
                start_on(step, Support::None, touching, solution);
                solution.multipliers.fill(0.0);
                solution.active = self.order[i].1;
                iterations += self.attempt(step, rows, solution);
            }
        }
        solution.clone_from(&self.best);
        solution.iterations = iterations;
        solution.converged = solution.residual <= REQUIRED;
        read_support(step, solution);
    }

    /// Solves from `solution` and keeps the result where it is the best so far.
    fn attempt(&mut self, step: &Step, rows: &mut Rows, solution: &mut StepSolution) -> u32 {
        let problem = StepProblem::new(step, solution.active);
        problem.write(solution, &mut self.point);
        // The start has the right length and is finite, which is all that the solver asks of it.
        let Ok(solved) = self.solver.solve(&problem, &mut self.point) else { return 0 };
        problem.read(&self.point, solution);
        solution.residual = rows.residual(step, solution);
        if solution.residual < self.best.residual {
            self.best.clone_from(solution);
        }
        solved.iterations as u32
    }

    /// Orders the surfaces by how far they face the substrate at the start of the step.
    fn rank_surfaces(&mut self, step: &Step) {
        let down = downward(&step.rotation);
        let (_, lowest) = step.body.lowest(&down);
        for (i, (surface, slot)) in step.body.surfaces().iter().zip(&mut self.order).enumerate() {
            // A surface away from the lowest point cannot be active; within the body's size it may become so.
            *slot = (surface.gradient(&lowest).dot(&down) + surface.value(&lowest) / step.size, i);
        }
        self.order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    }
}

/// A start: the velocity as it was, the middle of `support` (or the lowest point) as the ECP, the normal cone there, and
/// the weight as the normal impulse of a body that is `touching`.
fn start_on(step: &Step, support: Support, touching: bool, solution: &mut StepSolution) {
    let body = step.body;
    let down = downward(&step.rotation);
    let (lowest, lowest_point) = body.lowest(&down);
    let points = ContactPoints::new(body, support, &step.rotation);
    let (support, arm) = if points.count > 0 {
        (support, points.y[..points.count].iter().sum::<Vec3>() / points.count as f64)
    } else {
        (Support::Point(lowest), step.rotation * lowest_point)
    };
    let ecp = step.state.position + arm;
    solution.linear = if touching { step.state.linear } else { step.state.linear + step.load / step.mass };
    solution.angular = step.state.angular;
    solution.ecp = ecp;
    solution.normal = if touching { step.normal_impulse(step.load.z.abs()) } else { 0.0 };
    solution.ecp_substrate = Vec3::new(ecp.x, ecp.y, 0.0 - step.yielded(solution.normal));
    set_friction(step, &arm, solution);
    let rotation = step.rotation;
    set_normal_cone(body, support, &(rotation.transpose() * arm), &down, solution);
}

/// The friction of the start: `p = -μp̄ E²u/σ`, `σ = |Eu|`, for the slip of the step before.
fn set_friction(step: &Step, arm: &Vec3, solution: &mut StepSolution) {
    let surface = step.state.linear + step.state.angular.cross(arm);
    let slip = step.ellipsoid.component_mul(&Vec3::new(surface.x, surface.y, step.state.angular.z));
    let bound = step.friction.of(step.bound_impulse(solution.normal));
    let sigma = slip.norm();
    // Below rounding of the speeds the contact sticks.
    let slips = sigma > 1e-9 * (solution.linear.norm() + step.size * solution.angular.norm());
    solution.sigma = if slips { sigma } else { 0.0 };
    solution.friction = if slips { step.ellipsoid.component_mul(&slip) * (-bound / sigma) } else { Vec3::zeros() };
}

/// What touches in a solution of the unreduced problem.
fn read_support(step: &Step, solution: &mut StepSolution) {
    let rotation = cayley(&(solution.angular * (0.5 * step.h))) * step.rotation;
    let down = downward(&rotation);
    let (_, lowest) = step.body.lowest(&down);
    let height = step.state.position.z + step.h * solution.linear.z + (rotation * lowest).z;
    solution.penetration = (-height - step.yielded(solution.normal)).max(0.0);
    let touches = solution.normal > REQUIRED * step.load_scale;
    solution.support = if touches { step.body.touching(&down, TOGETHER * step.size) } else { Support::None };
}
