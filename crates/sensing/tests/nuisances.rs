//! Derivatives against differences, and nuisances that were put in against those that are found.

use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use tumblers_sensing::{
    Angle, Camera, Channel, Column, LOCAL, Measured, Path, Pose, Seen, Tolerances, Whiten, compare,
};

const INTERVAL: f64 = 1e-2;
const NOISE_M: f64 = 1e-6;
const NOISE_RAD: f64 = 1e-3;

/// A body that goes along a curve, tumbles about its `x` and turns about `z`.
fn poses(turn: f64) -> Vec<[f64; 7]> {
    (0..200)
        .map(|n| {
            let t = n as f64 * INTERVAL;
            let (s, c) = (0.5 * (0.3 + 0.6 * t)).sin_cos();
            let (k, w) = (0.5 * turn * t).sin_cos();
            [3e-4 * (2.0 * t).sin(), 1e-3 * t, 1e-4, w * c, w * s, k * s, k * c]
        })
        .collect()
}

fn whiten(count: usize, sigma: f64) -> Whiten {
    let row = |r: usize| (0..count).map(|c| if r == c { 1.0 / sigma } else { 0.0 }).collect();
    Whiten::new((0..count).map(row)).unwrap()
}

/// What a sensor reads of a path every 20 ms, by coordinates and angles or by whole orientations.
fn measured(path: &Path, local: [f64; LOCAL], camera: &Camera, quaternions: bool) -> Measured {
    let times: Vec<f64> = (2..80).map(|n| 2e-2 * f64::from(n)).collect();
    let seen: Vec<Pose> =
        times.iter().map(|t| path.at(t + local[0]).through(camera, [local[1], local[2], local[3]])).collect();
    let place = |k: usize| Channel::Place(k, seen.iter().map(|pose| pose.position[k]).collect());
    let turned = |angle| Channel::Turn(angle, seen.iter().map(|pose| pose.orientation).collect());
    let mut channels = vec![(place(0), NOISE_M), (place(1), NOISE_M), (place(2), NOISE_M)];
    if quaternions {
        channels.extend([Angle::Tilt, Angle::Twist, Angle::Heading].map(|angle| (turned(angle), NOISE_RAD)));
    } else {
        channels.push((Channel::Tilt(seen.iter().map(Pose::tilt).collect()), NOISE_RAD));
        channels.push((Channel::Heading(TAU, seen.iter().map(Pose::heading).collect()), NOISE_RAD));
    }
    let columns: Vec<Column> = channels
        .into_iter()
        .map(|(channel, sigma)| Column { channel, times: times.clone(), whiten: whiten(times.len(), sigma) })
        .collect();
    let count: usize = columns.iter().map(|column| column.times.len()).sum();
    Measured::new(columns, vec![0.0; count], 1, 0, count).unwrap()
}

fn tolerances(trials: usize) -> Tolerances {
    let camera = [2f64.to_radians(), 5e-3];
    Tolerances {
        local_bounds: vec![[1e-2, 5e-5, 5e-5, 5e-5]; trials],
        local_sigmas: vec![[5.8e-3, 2.5e-5, 2.5e-5, 2.5e-5]; trials],
        shared_low: vec![-camera[0], -camera[1], -3.0],
        shared_high: vec![camera[0], camera[1], 3.0],
        shared_sigmas: vec![0.5 * camera[0], 0.5 * camera[1], 1.0],
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn derivatives_are_those_of_the_differences(
        clock in -5e-3..5e-3f64, x in -3e-5..3e-5f64, heading in -0.02..0.02f64, scale in -4e-3..4e-3f64,
        turn in -0.5..0.5f64, quaternions: bool,
    ) {
        let rows = poses(turn);
        let path = Path::new(INTERVAL, 0.0, &rows).unwrap();
        let trial = measured(&path, [1e-3, 1e-5, -1e-5, 2e-5], &Camera::new(0.01, 1e-3), quaternions);
        let local = [clock, x, -x, 0.5 * x];
        let wrong = |local: [f64; LOCAL], heading, scale| trial.whitened(&path, &[], &local, &[heading, scale, 0.0]);
        let here = wrong(local, heading, scale);
        let found = trial.linearised(&path, &[], &local, &Camera::new(heading, scale));
        // Left out are products of the heading or the scale with what they turn or stretch, at most their own 0.02; a
        // step of the clock that crosses a row meets the next slope, which differs by 2 rad/s in 10 ms, as much.
        for (k, step) in [5e-5, 1e-8, 1e-8, 1e-8, 1e-6, 1e-6].into_iter().enumerate() {
            let mut moved = local;
            let mut camera = [heading, scale];
            if k < LOCAL { moved[k] += step } else { camera[k - LOCAL] += step }
            let there = wrong(moved, camera[0], camera[1]);
            let most = found.iter().map(|row| row[k].abs()).fold(0.0, f64::max);
            for (row, (a, b)) in found.iter().zip(here.iter().zip(&there)) {
                prop_assert!((row[6] - a).abs() < 1e-9);
                prop_assert!(((b - a) / step - row[k]).abs() <= 0.021 * most + 1e-6, "{k}: {} {}", (b - a) / step, row[k]);
            }
        }
    }

    #[test]
    fn nuisances_that_were_put_in_are_found(
        clock in -8e-3..8e-3f64, x in -4e-5..4e-5f64, y in -4e-5..4e-5f64, z in -4e-5..4e-5f64,
        heading in -0.03..0.03f64, scale in -4e-3..4e-3f64, quaternions: bool,
    ) {
        let rows = [poses(0.2), poses(-0.3)];
        let paths = [Path::new(INTERVAL, 0.0, &rows[0]).unwrap(), Path::new(INTERVAL, 0.0, &rows[1]).unwrap()];
        let camera = Camera::new(heading, scale);
        let trials = paths.map(|path| measured(&path, [clock, x, y, z], &camera, quaternions));
        let run = || paths.map(|path| Seen { path: Some(path), outcomes: Vec::new() }).to_vec();
        let all = compare(&[&trials[0], &trials[1]], &[run(), run()], &tolerances(2), &[true; 2], 1.0, None, true).unwrap();
        prop_assert_eq!(&all[0], &all[1]);
        let found = &all[0];
        // Nothing is noisy here: what is left is what the priors hold back, in 400 draws at most half of these bounds.
        prop_assert!((found.nuisances.shared[0] - heading).abs() < 5.5e-6, "{:?}", found.nuisances);
        prop_assert!((found.nuisances.shared[1] - scale).abs() < 4.4e-5);
        for local in &found.nuisances.local {
            prop_assert!((local[0] - clock).abs() < 1.5e-5);
        }
        for wrong in found.wrong.iter().flatten() {
            let square = wrong.iter().map(|r| r * r).sum::<f64>() / wrong.len() as f64;
            prop_assert!(square < 4.6e-5, "{square}");
        }
    }
}

#[test]
fn an_outcome_has_the_weight_of_so_many_numbers() {
    // What is measured is 3 off, and a nominal number's being off moves it by 1: η = 3 w/(w + 1).
    let rows = poses(0.2);
    let path = Path::new(INTERVAL, 0.0, &rows).unwrap();
    let trial = Measured::new(Vec::new(), vec![1.0], 1, 1, 0).unwrap();
    let run = || vec![Seen { path: Some(path), outcomes: vec![[3.0, 0.0]] }];
    for weight in [1.0, 8.0] {
        let found = compare(&[&trial], &[run()], &tolerances(1), &[true], weight, None, true).unwrap();
        let off = found[0].nuisances.shared[2];
        assert!((off - 3.0 * weight / (weight + 1.0)).abs() < 1e-9, "{off}");
    }
    assert!(compare(&[&trial], &[run()], &tolerances(1), &[true], 0.0, None, true).is_err());
}

#[test]
fn a_trial_that_was_not_run_has_no_differences_and_moves_no_other() {
    let rows = poses(0.2);
    let path = Path::new(INTERVAL, 0.0, &rows).unwrap();
    let trial = measured(&path, [2e-3, 1e-5, 0.0, 0.0], &Camera::new(0.02, 2e-3), false);
    let ran = || Seen { path: Some(path), outcomes: Vec::new() };
    let missing = || Seen { path: None, outcomes: Vec::new() };
    let alone = compare(&[&trial], &[vec![ran()]], &tolerances(1), &[true], 1.0, None, true).unwrap();
    let beside =
        compare(&[&trial, &trial], &[vec![ran(), missing()]], &tolerances(2), &[true; 2], 1.0, None, true).unwrap();
    assert_eq!(beside[0].wrong[1], None);
    assert_eq!(beside[0].wrong[0], alone[0].wrong[0]);
    assert_eq!(beside[0].nuisances.shared, alone[0].nuisances.shared);
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let rows = poses(0.0);
    assert!(Path::new(INTERVAL, 0.0, &rows[..1]).is_err());
    assert!(Path::new(0.0, 0.0, &rows).is_err());
    assert!(Path::new(INTERVAL, f64::NAN, &rows).is_err());
    let path = Path::new(INTERVAL, 0.0, &rows).unwrap();
    let trial = measured(&path, [0.0; LOCAL], &Camera::new(0.0, 0.0), false);
    let run = vec![Seen { path: Some(path), outcomes: vec![[1.0, 0.0]] }];
    let error = compare(&[&trial], &[run], &tolerances(1), &[true], 1.0, None, true).unwrap_err();
    assert_eq!(error.to_string(), "outcomes: 1 found, 0 expected");
    assert!(compare(&[&trial], &[], &tolerances(2), &[true], 1.0, None, true).is_err());
    let mut negative = tolerances(1);
    negative.local_bounds[0][0] = -1e-3;
    assert!(compare(&[&trial], &[], &negative, &[true], 1.0, None, true).is_err());
}

#[test]
fn the_heading_of_an_axis_without_ends_is_the_same_after_half_a_turn() {
    let rows = poses(0.0);
    let pose = Path::new(INTERVAL, 0.0, &rows).unwrap().at(0.5);
    for (turn, expected) in [(TAU, [0.1, 0.1 - PI, 0.1]), (PI, [0.1; 3])] {
        for (more, wrong) in [0.0, PI, TAU].into_iter().zip(expected) {
            let heading = Channel::Heading(turn, vec![pose.heading() + 0.1 + more]);
            assert!((heading.wrong(0, &pose) - wrong * pose.tilt().cos()).abs() < 1e-12, "{turn} {more}");
        }
    }
}
