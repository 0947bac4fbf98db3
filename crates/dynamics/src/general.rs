//! A step by the general solver, without any guess of what touches.
//!
//! The unreduced problem goes to `mncp` as it stands. The index `k` of an active constraint has to be chosen before:
//! the surfaces are tried in the order of how far they face the substrate.

use crate::contact::downward;
use crate::exchange::Warm;
use crate::problem::{FREE, StepProblem};
use crate::residual::Rows;
use crate::rotation::cayley;
use crate::step::Step;
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
        self.surfaces() + 3
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

impl General {
    pub fn new(body: &Body) -> Self {
        let surfaces = body.surfaces().len();
        let settings = Settings { tolerance: REQUIRED * 1e-2, ..Settings::default() };
        let solver = Solver::new(FREE, surfaces + 3, settings).expect("the settings above are in their ranges");
        Self {
            solver,
            point: vec![0.0; FREE + surfaces + 3],
            order: vec![(0.0, 0); surfaces],
            best: StepSolution::for_body(body),
        }
    }

    /// The best solution over the choices of `k`; the first that reaches the required residual ends the search.
    pub fn solve(&mut self, step: &Step, warm: &Warm, rows: &mut Rows, solution: &mut StepSolution) {
        self.rank_surfaces(step);
        let mut iterations = 0;
        self.best.residual = f64::INFINITY;
        'search: for touching in [warm.support != Support::None, warm.support == Support::None] {
            for i in 0..self.order.len() {
                let problem = StepProblem::new(step, self.order[i].1);
                self.start(&problem, touching, solution);
                // The start has the right length and is finite, which is all that the solver asks of it.
                let Ok(solved) = self.solver.solve(&problem, &mut self.point) else { continue };
                iterations += solved.iterations as u32;
                problem.read(&self.point, solution);
                solution.residual = rows.residual(step, solution);
                if solution.residual < self.best.residual {
                    self.best.clone_from(solution);
                }
                if self.best.residual <= REQUIRED {
                    break 'search;
                }
            }
        }
        solution.clone_from(&self.best);
        solution.iterations = iterations;
        solution.converged = solution.residual <= REQUIRED;
        read_support(step, solution);
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

    /// The velocity as it was, the lowest point as the ECP, the weight as the normal impulse.
    fn start(&mut self, problem: &StepProblem, touching: bool, solution: &mut StepSolution) {
        let step = problem.step;
        let (_, lowest) = step.body.lowest(&downward(&step.rotation));
        let ecp = step.state.position + step.rotation * lowest;
        solution.linear = if touching { step.state.linear } else { step.state.linear + step.load / step.mass };
        solution.angular = step.state.angular;
        solution.ecp = ecp;
        solution.ecp_substrate = Vec3::new(ecp.x, ecp.y, 0.0);
        solution.friction = Vec3::zeros();
        solution.multipliers.fill(0.0);
        solution.multipliers[problem.active] = ecp.z.max(0.0);
        solution.plane_multiplier = 1.0;
        solution.sigma = 0.0;
        solution.normal = if touching { step.normal_impulse(step.load.z.abs()) } else { 0.0 };
        problem.write(solution, &mut self.point);
    }
}

/// What touches in a solution of the unreduced problem.
fn read_support(step: &Step, solution: &mut StepSolution) {
    let rotation = cayley(&(solution.angular * (0.5 * step.h))) * step.rotation;
    let down = downward(&rotation);
    let (_, lowest) = step.body.lowest(&down);
    let height = step.state.position.z + step.h * solution.linear.z + (rotation * lowest).z;
    solution.penetration = (-height).max(0.0);
    let touches = solution.normal > REQUIRED * step.load_scale();
    solution.support = if touches { step.body.touching(&down, TOGETHER * step.size) } else { Support::None };
}
