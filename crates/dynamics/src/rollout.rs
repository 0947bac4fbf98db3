//! The poses of a run as a camera would see them: what a fit compares with a track.

use crate::{Stepper, Trial};
use nalgebra::Quaternion;

/// The poses of a run, and what touched.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rollout {
    /// s.
    pub time: Vec<f64>,
    /// Centre of mass, m.
    pub position: Vec<[f64; 3]>,
    /// `w, x, y, z`, of one sign along the run: neighbours can be averaged.
    pub orientation: Vec<[f64; 4]>,
    /// 0 airborne, 1 point, 2 line, 3 surface.
    pub contact_mode: Vec<i8>,
    /// Steps that did not converge.
    pub unconverged_steps: u64,
}

impl Rollout {
    /// Storage for `rows` poses.
    pub fn with_rows(rows: u64) -> Self {
        let rows = rows as usize;
        Self {
            time: Vec::with_capacity(rows),
            position: Vec::with_capacity(rows),
            orientation: Vec::with_capacity(rows),
            contact_mode: Vec::with_capacity(rows),
            unconverged_steps: 0,
        }
    }

    /// Appends the pose of `stepper`, which runs `trial`.
    pub fn push(&mut self, trial: &Trial, stepper: &Stepper) {
        let (position, mut q) = trial.seen(stepper.state());
        let before = self.orientation.last().map_or(q, |&[w, i, j, k]| Quaternion::new(w, i, j, k));
        if before.dot(&q) < 0.0 {
            q = -q;
        }
        self.time.push(stepper.time());
        self.position.push(position.into());
        self.orientation.push([q.w, q.i, q.j, q.k]);
        self.contact_mode.push(stepper.solution().patch.mode as i8);
    }
}
