//! What was measured in one trial, in units of its noise.

use crate::looks::Looks;
use crate::{Camera, Channel, Path, Pose, SensingError, Whiten};

/// Between two looks at a path from which the derivative by the clock is taken, s.
pub const CLOCK_STEP: f64 = 2e-4;
/// Shares of a clock's tolerance that are tried first, and what a frame counts at most then, in sigmas.
const CLOCKS: [f64; 7] = [-0.9, -0.6, -0.3, 0.0, 0.3, 0.6, 0.9];
const OUTLIER: f64 = 6.0;
/// How far apart those are, in shares.
const APART: f64 = 0.3;
/// How far apart they may be, s: of few frames a cycle all are far off by a clock that is not near the right one.
const FARTHEST_APART: f64 = 5e-3;
/// So many times as many are tried at most, and others between the best and its neighbours then.
const MOST_SETS: usize = 9;

/// One channel, in the frames in which it was not lost.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What was measured.
    pub channel: Channel,
    /// When, by the sensor's clock, s.
    pub times: Vec<f64>,
    /// Its noise.
    pub whiten: Whiten,
}

/// One trial's measurements that are compared, with their noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    columns: Vec<Column>,
    /// Whitened change with each nominal number moved by its tolerance, row after row; numbers of a row.
    tolerance: Vec<f64>,
    shared: usize,
    outcomes: usize,
    whole: usize,
    /// By column the whitened change with a shift of all its numbers, for the places that a shift of the origin moves.
    shifts: Vec<Vec<f64>>,
}

/// How many nuisances are a trial's own: its clock, and its origin in `x`, `y` and `z`.
pub const LOCAL: usize = 4;

/// Derivatives by the clock, the origin `(x, y, z)`, the camera's heading and scale, and the difference.
pub type Row = [f64; 7];

impl Measured {
    /// Measurements of the columns' numbers, then of `outcomes` scaled ones.
    ///
    /// `tolerance` has `shared` numbers for each of all these, `whole` is how many numbers the whole track has, of which the
    /// columns may be the beginning.
    pub fn new(
        columns: Vec<Column>,
        tolerance: Vec<f64>,
        shared: usize,
        outcomes: usize,
        whole: usize,
    ) -> Result<Self, SensingError> {
        for column in &columns {
            SensingError::same("times", column.times.len(), column.channel.frames())?;
            SensingError::same("a whitening matrix", column.whiten.count(), column.channel.frames())?;
        }
        if shared == 0 {
            return Err(SensingError::Number { what: "how many numbers all trials share", found: 0.0 });
        }
        let tracked: usize = columns.iter().map(|column| column.times.len()).sum();
        SensingError::same("tolerance", tolerance.len(), (tracked + outcomes) * shared)?;
        let shifts = columns.iter().map(shift).collect();
        Ok(Self { columns, tolerance, shared, outcomes, whole, shifts })
    }

    /// How many numbers of a track are compared.
    pub fn tracked(&self) -> usize {
        self.columns.iter().map(|column| column.times.len()).sum()
    }

    /// How many outcomes are compared.
    pub fn outcomes(&self) -> usize {
        self.outcomes
    }

    /// How many nominal numbers may be off.
    pub fn shared(&self) -> usize {
        self.shared
    }

    /// How many numbers the whole track has.
    pub fn whole(&self) -> usize {
        self.whole
    }

    /// By number, its change with each nominal number.
    pub fn tolerance(&self) -> impl Iterator<Item = &[f64]> {
        self.tolerance.chunks_exact(self.shared)
    }

    /// The whitened differences: of the columns, then of the outcomes, `[constant, by the camera's scale]` each.
    ///
    /// `shared` has the camera's heading and scale, then how far the nominal numbers are off.
    pub fn whitened(&self, path: &Path, outcomes: &[[f64; 2]], local: &[f64; LOCAL], shared: &[f64]) -> Vec<f64> {
        let (camera, origin) = (Camera::new(shared[0], shared[1]), [local[1], local[2], local[3]]);
        let mut rows: Vec<[f64; 1]> = Vec::with_capacity(self.tracked() + self.outcomes);
        let mut looks: Looks<'_, Pose> = Looks::new();
        for column in &self.columns {
            let seen = looks.at(&column.times, |time| path.at(time + local[0]).through(&camera, origin));
            let wrong: Vec<[f64; 1]> =
                seen.iter().enumerate().map(|(n, seen)| [column.channel.wrong(n, seen)]).collect();
            column.whiten.apply(&wrong, &mut rows);
        }
        rows.extend(outcomes.iter().map(|line| [line[0] + line[1] * shared[1]]));
        let off = &shared[Camera::COUNT..];
        rows.iter().zip(self.tolerance()).map(|(row, by)| row[0] - dot(by, off)).collect()
    }

    /// The whitened differences with their derivatives by the sensor's nuisances, the nominal numbers as they are.
    pub fn linearised(&self, path: &Path, outcomes: &[[f64; 2]], local: &[f64; LOCAL], camera: &Camera) -> Vec<Row> {
        let mut rows = Vec::with_capacity(self.tracked() + self.outcomes);
        let origin = [local[1], local[2], local[3]];
        let mut looks: Looks<'_, [Pose; 3]> = Looks::new();
        for column in &self.columns {
            let seen = looks.at(&column.times, |time| {
                let pose = path.at(time + local[0]);
                let later = path.at(time + CLOCK_STEP + local[0]);
                [pose, pose.through(camera, origin), later.through(camera, origin)]
            });
            let raw: Vec<Row> = seen
                .iter()
                .enumerate()
                .map(|(n, [pose, now, later])| {
                    let (wrong, then) = (column.channel.wrong(n, now), column.channel.wrong(n, later));
                    let [x, y, z, heading, scale] = column.channel.by_sensor(pose);
                    [(then - wrong) / CLOCK_STEP, x, y, z, heading, scale, wrong]
                })
                .collect();
            column.whiten.apply(&raw, &mut rows);
        }
        rows.extend(outcomes.iter().map(|line| [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, line[0] + line[1] * camera.scale]));
        rows
    }

    /// The best of some offsets of the clock: a body that snaps over makes several minima.
    pub fn clock(&self, path: &Path, bound: f64, sigmas: &[f64; LOCAL]) -> f64 {
        if bound == 0.0 || self.columns.iter().all(|column| column.times.is_empty()) {
            return 0.0;
        }
        // An odd number, so that 0 is among them.
        let sets = ((APART * bound / FARTHEST_APART).ceil() as usize).clamp(1, MOST_SETS) | 1;
        let mut best = (f64::INFINITY, 0.0);
        let mut look = |clocks: [f64; 7]| {
            for (loss, clock) in self.clock_losses(path, &clocks, sigmas).into_iter().zip(clocks) {
                if loss < best.0 {
                    best = (loss, clock);
                }
            }
            best.1
        };
        let mut clock = 0.0;
        for set in 0..sets {
            let aside = APART * (set as f64 - 0.5 * (sets as f64 - 1.0)) / sets as f64;
            clock = look(CLOCKS.map(|share| (share + aside) * bound));
        }
        if sets > 1 {
            let apart = APART * bound / sets as f64;
            clock = look(CLOCKS.map(|share| (clock + share * apart).clamp(-bound, bound)));
        }
        clock
    }

    fn clock_losses(&self, path: &Path, clocks: &[f64; 7], sigmas: &[f64; LOCAL]) -> [f64; 7] {
        let mut losses = clocks.map(|clock| (clock / sigmas[0]).powi(2));
        let perfect = Camera::new(0.0, 0.0);
        let mut looks: Looks<'_, [Pose; 7]> = Looks::new();
        for (column, shift) in self.columns.iter().zip(&self.shifts) {
            let seen =
                looks.at(&column.times, |time| clocks.map(|clock| path.at(time + clock).through(&perfect, [0.0; 3])));
            let wrong: Vec<[f64; 7]> = seen
                .iter()
                .enumerate()
                .map(|(n, poses)| std::array::from_fn(|k| column.channel.wrong(n, &poses[k])))
                .collect();
            let mut rows = Vec::with_capacity(wrong.len());
            column.whiten.apply(&wrong, &mut rows);
            // What a shift of the origin cannot explain.
            let along: [f64; 7] = match column.channel {
                Channel::Place(axis, _) => {
                    let weight = dot(shift, shift) + sigmas[1 + axis].powi(-2);
                    std::array::from_fn(|k| shift.iter().zip(&rows).map(|(s, row)| s * row[k]).sum::<f64>() / weight)
                }
                _ => [0.0; 7],
            };
            for (n, row) in rows.iter().enumerate() {
                let by = shift.get(n).copied().unwrap_or(0.0);
                for k in 0..losses.len() {
                    losses[k] += (row[k] - by * along[k]).powi(2).min(OUTLIER * OUTLIER);
                }
            }
        }
        losses
    }
}

/// The whitened change of a column with a shift of all its numbers; none where the origin does not move it.
fn shift(column: &Column) -> Vec<f64> {
    if !matches!(column.channel, Channel::Place(..)) {
        return Vec::new();
    }
    let mut rows = Vec::with_capacity(column.times.len());
    column.whiten.apply(&vec![[1.0]; column.times.len()], &mut rows);
    rows.into_iter().map(|[sum]| sum).collect()
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
