//! What a sensor reads from a path, and what of the difference to what it did read is the sensor's own.
//!
//! A path is looked up (`path`), seen by a camera (`pose`), compared with a trial's measurements and whitened by their noise (`channel`, `whiten`,
//! `measured`), and the nuisances that all trials of a dataset share are fitted (`nuisances`). The equations are in
//! `docs/diagnosis.md`; the plain NumPy of `tests/parity/nuisances.py` is the specification.
//!
//! Lengths are in m, times in s, angles in rad.

#![warn(missing_docs)]

mod channel;
mod error;
mod loss;
mod measured;
mod nuisances;
mod path;
mod pose;
mod whiten;

pub use channel::{Angle, Channel};
pub use error::SensingError;
pub use loss::{FAR, HUBER};
pub use measured::{CLOCK_STEP, Column, Measured};
pub use nuisances::{Camera, Compared, Nuisances, Seen, Tolerances, compare};
pub use path::Path;
pub use pose::Pose;
pub use whiten::Whiten;
