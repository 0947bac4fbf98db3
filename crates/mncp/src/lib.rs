//! Mixed nonlinear complementarity problems: find `u` (free) and `v` with
//!
//! ```text
//! 0 = g(u, v),     0 <= v ⟂ f(u, v) >= 0.
//! ```
//!
//! Every pair is rewritten with the Fischer–Burmeister function `φ(a, b) = a + b - sqrt(a² + b²)`, which vanishes
//! exactly where `0 <= a ⟂ b >= 0`, and the square system `Φ(z) = [g; φ(v, f)] = 0` of `z = [u; v]` is solved by a
//! semismooth Newton method that is globalised by the merit function `Ψ = ½|Φ|²`.
//!
//! - A. Fischer, *A special Newton-type optimization method*, Optimization 24 (1992).
//! - T. De Luca, F. Facchinei, C. Kanzow, *A semismooth equation approach to the solution of nonlinear complementarity
//!   problems*, Mathematical Programming 75 (1996).
//! - F. Facchinei, J.-S. Pang, *Finite-Dimensional Variational Inequalities and Complementarity Problems*, Springer
//!   (2003), chapter 9.
//!
//! ```
//! use faer::MatMut;
//! use tumblers_mncp::{Problem, Settings, Solver};
//!
//! /// 0 = u - v,  0 <= v ⟂ u + v - 2 >= 0
//! struct Line;
//!
//! impl Problem for Line {
//!     fn equalities(&self) -> usize {
//!         1
//!     }
//!     fn pairs(&self) -> usize {
//!         1
//!     }
//!     fn residual(&self, z: &[f64], out: &mut [f64]) {
//!         out[0] = z[0] - z[1];
//!         out[1] = z[0] + z[1] - 2.0;
//!     }
//!     fn jacobian(&self, _: &[f64], mut out: MatMut<'_, f64>) {
//!         out[(0, 0)] = 1.0;
//!         out[(0, 1)] = -1.0;
//!         out[(1, 0)] = 1.0;
//!         out[(1, 1)] = 1.0;
//!     }
//! }
//!
//! let mut solver = Solver::new(1, 1, Settings::default())?;
//! let mut z = [0.0, 0.0];
//! let solution = solver.solve(&Line, &mut z)?;
//! assert!(solution.status.is_solved());
//! assert!((z[0] - 1.0).abs() < 1e-10 && (z[1] - 1.0).abs() < 1e-10);
//! # Ok::<(), tumblers_mncp::Error>(())
//! ```

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod direction;
mod error;
pub mod fischer_burmeister;
mod line_search;
mod linear;
mod linearisation;
mod merit;
mod newton;
mod problem;
mod settings;
mod solution;
mod statistics;
mod status;

pub use direction::Direction;
pub use error::Error;
pub use newton::Solver;
pub use problem::Problem;
pub use settings::Settings;
pub use solution::Solution;
pub use statistics::{Iteration, Statistics};
pub use status::Status;
