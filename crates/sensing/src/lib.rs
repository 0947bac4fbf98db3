//! What a sensor reads from a path, and what of the difference to what it did read is the sensor's own.
//!
//! A path is looked up (`path`), seen by a camera (`pose`, `camera`), compared with a trial's measurements and whitened by
//! their noise (`channel`, `whiten`, `measured`), and the nuisances that all trials of a dataset share are fitted
//! (`nuisances`, `bounded`, `comparison`). The equations stand in these files; plain NumPy has them once more as the specification: the
//! channels in `python/tumblers/diagnosis/gap/reading.py`, the fit in `tests/parity/nuisances.py`.
//!
//! Lengths are in m, times in s, angles in rad.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod bounded;
mod camera;
mod channel;
mod comparison;
mod error;
mod looks;
mod loss;
mod measured;
mod nuisances;
mod path;
mod pose;
mod seen;
mod tolerances;
mod whiten;

pub use camera::Camera;
pub use channel::{Angle, Channel};
pub use comparison::{Compared, compare};
pub use error::SensingError;
pub use loss::{FAR, HUBER};
pub use measured::{CLOCK_STEP, Column, LOCAL, Measured};
pub use nuisances::Nuisances;
pub use path::{END_ROWS, Path};
pub use pose::Pose;
pub use seen::Seen;
pub use tolerances::Tolerances;
pub use whiten::Whiten;
