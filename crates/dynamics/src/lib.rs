//! Dynamics of a tumbling magnetic microrobot on a plane: what a step, a trial and a batch are.
//!
//! The equations, with the paper's symbols, are in `docs/model.md`. A step is a mixed nonlinear complementarity problem
//! ([`problem`]); [`reduced`] and [`exchange`] solve it fast, [`residual`] measures the solution in the unreduced
//! problem, and [`stepper`] advances the state.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod adhesion;
pub mod batch;
pub mod contact;
pub mod error;
pub mod exchange;
pub mod field;
pub mod friction;
pub mod general;
pub mod guide;
pub mod interlude;
pub mod judgement;
pub mod magnetics;
pub mod metrics;
pub mod model;
pub mod momentum;
pub mod predictor;
pub mod problem;
mod problem_jacobian;
pub mod recording;
pub mod reduced;
pub mod relief;
pub mod residual;
pub mod robot;
pub mod rollout;
pub mod rotation;
pub mod solution;
pub mod state;
pub mod step;
pub mod stepper;
pub mod substrate;
pub mod surroundings;
pub mod trial;
pub mod warm;

pub use adhesion::Adhesion;
pub use batch::{Outcome, rollouts, sweep};
pub use error::Invalid;
pub use field::Field;
pub use guide::Guide;
pub use interlude::Interlude;
pub use metrics::Metrics;
pub use model::{AdhesionActsAt, AdhesionEnters, MagneticTorque, Model};
pub use relief::Relief;
pub use robot::Robot;
pub use rollout::Rollout;
pub use solution::StepSolution;
pub use state::State;
pub use stepper::{SolverKind, Stepper};
pub use substrate::Substrate;
pub use surroundings::Surroundings;
pub use trial::Trial;

/// A vector of the substrate or of the body frame.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A linear map between such vectors.
pub type Mat3 = nalgebra::Matrix3<f64>;
