"""Diagnoses made by hand, as real ones look."""

from __future__ import annotations

from typing import Any

import numpy as np

from tumblers import Cuboid, Model, Robot, RotatingField, StaticField, Substrate
from tumblers.dataset import Dataset, LabTrial, Outcome, Sensor, Track
from tumblers.diagnosis.diagnosis import Diagnosis
from tumblers.diagnosis.result import (
    EffectEstimate,
    Gap,
    HeatMap,
    Interval,
    MissingWrench,
    NextTrial,
    Overlay,
    RankedHypothesis,
    Region,
    TrialFloor,
    WrenchMean,
)
from tumblers.effects.catalogue import CATALOGUE

FREQUENCIES = (1.0, 3.0, 5.0, 8.0, 10.0, 12.0, 15.0)
NAN = float("nan")


def rolled(frequency: float) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Return times, and a tumbling robot as measured, nominal and explained, in the units of an overlay."""
    noise = np.random.default_rng(int(frequency))
    time = np.arange(0.0, 1.0, 1.0 / 60.0)
    phase = 2.0 * np.pi * frequency * time
    push = 4e-3 * max(frequency - 8.0, 0.0) / 7.0
    nominal = {
        "x": np.zeros_like(time),
        "y": 1.8e-3 * (frequency * time - np.sin(2.0 * phase) / (4.0 * np.pi)),
        "z": 2.2e-4 - 1.7e-4 * np.cos(2.0 * phase),
        "tilt": 45.0 * np.sin(2.0 * phase),
        "heading": np.zeros_like(time),
    }
    explained = {**nominal, "y": nominal["y"] + push * time}
    measured = {
        name: values + noise.normal(0.0, 1.0 if name in ("tilt", "heading") else 8e-6, time.size)
        for name, values in explained.items()
    }
    for values in measured.values():
        values[20:26] = NAN
    return time, measured, nominal, explained


def lab(title: str = "cuboid on paper, spring batch", tracks: bool = True) -> Dataset:
    trials = []
    for frequency in FREQUENCIES:
        time, measured, _, _ = rolled(frequency)
        channels = {"x_m": measured["x"], "y_m": measured["y"], "z_m": measured["z"]}
        channels |= {"tilt_deg": measured["tilt"], "heading_deg": measured["heading"]}
        trials.append(
            LabTrial(
                id=f"f{frequency:02.0f}",
                field=RotatingField(strength_T=0.010, frequency_Hz=frequency),
                duration_s=1.0,
                track=Track(time_s=time, channels=channels) if tracks else None,
                outcome=None if tracks else Outcome(climbs=True),
            )
        )
    trials.append(
        LabTrial(
            id="slope30",
            field=RotatingField(strength_T=0.020, frequency_Hz=1.0),
            duration_s=4.0,
            incline_deg=30.0,
            outcome=Outcome(climbs=True),
        )
    )
    trials.append(
        LabTrial(
            id="tilt05",
            field=StaticField(strength_T=0.005, direction=(0.0, 0.0, 1.0)),
            duration_s=1.0,
            outcome=Outcome(tilt_deg=38.5, sigma_deg=1.0),
        )
    )
    return Dataset(
        robot=Robot(
            shape=Cuboid(length_m=8e-4, width_m=4e-4, height_m=1e-4),
            mass_kg=3.78e-8,
            magnetic_volume_m3=2.9e-11,
            magnetization_A_per_m=15000.0,
            magnetization_axis=(0.0, 1.0, 0.0),
        ),
        substrate=Substrate(friction_coefficient=0.3, adhesion_N_per_m2=1.19, electrostatic_force_N=6.54e-7),
        sensor=Sensor(position_noise_m=8e-6, angle_noise_deg=1.0),
        trials=tuple(trials),
        title=title,
    )


# The effects that are ranked first.
LIKELIER = ("stray_field_gradient", "viscous_drag", "substrate_tilt", "friction_coefficient")


def wrench() -> MissingWrench:
    prior = np.array([3e-7, 3e-7, 3e-7, 1.3e-9, 1.3e-9, 1.3e-9])

    def averages(labels: list[str], push: list[float]) -> dict[str, WrenchMean]:
        found = {}
        for i, (label, f) in enumerate(zip(labels, push, strict=True)):
            sigma = prior * np.array([0.15, 0.05, 0.9, 0.2, 0.95, 0.2])
            value = np.array([1e-9 * (i - 2), f, -2e-9, 2e-11 * (3 - i), 0.0, 1e-11 * i])
            found[label] = WrenchMean(value, sigma, prior)
        return found

    eighths = [f"{45 * i} to {45 * i + 45}°" for i in range(8)]
    n = 4
    return MissingWrench(
        trials=("f12", "f12", "f15", "f15"),
        start_s=np.array([0.0, 0.5] * 2),
        end_s=np.array([0.5, 1.0] * 2),
        wrench=np.tile([0.0, 1.2e-7, 0.0, 0.0, 0.0, 0.0], (n, 1)),
        sigma=np.tile(0.2 * prior, (n, 1)),
        prior_sigma=np.tile(prior, (n, 1)),
        by_phase=averages(eighths, [1e-7, 1.1e-7, 0.9e-7, 1.2e-7, 1e-7, 1.05e-7, 0.95e-7, 1e-7]),
        by_mode=averages(["airborne", "line", "surface"], [1.3e-7, 0.8e-7, 0.1e-7]),
        by_place=averages(["0 to 8 mm", "8 to 16 mm", "16 to 24 mm"], [1e-7, 1.1e-7, 1.0e-7]),
        by_frequency=averages(["10 Hz", "12 Hz", "15 Hz"], [3e-8, 1.2e-7, 2.4e-7]),
    )


def made(**changes: Any) -> Diagnosis:
    """Return a diagnosis as of a robot that a stray gradient pulls along +y above 12 Hz."""
    data = lab()
    ids = [trial.id for trial in data.trials]
    gradient = CATALOGUE["stray_field_gradient"]
    estimates = {
        "gradient_T_per_m[0]": Interval(0.0004, -0.003, 0.004),
        "gradient_T_per_m[1]": Interval(0.0482, 0.0441, 0.0522),
        "gradient_T_per_m[2]": Interval(0.01, -0.09, 0.11, identified=False),
        "frequency_exponent": Interval(2.1, 1.7, 2.6),
    }
    overlays = []
    for trial, frequency in zip(data.trials, FREQUENCIES, strict=False):
        time, measured, nominal, explained = rolled(frequency)
        overlays.append(Overlay(trial.id, time, measured, nominal, explained, {}))
    nothing = np.empty(0)
    overlays.append(Overlay("slope30", nothing, {}, {}, {}, {"climbed_share": (1.0, -85.1, 0.97)}))
    overlays.append(Overlay("tilt05", nothing, {}, {}, {}, {"tilt_deg": (38.5, 38.1, 38.2)}))
    before = [1.1, 0.9, 1.0, 1.3, 9.0, 18.0, 34.0, 4.0, 0.5]
    by_trial = {trial: (gap + 0.2, gap, min(gap, 1.2)) for trial, gap in zip(ids, before, strict=True)}
    values = np.outer(before, [0.4, 1.0, 0.7, 0.6, 0.5])
    values[7:, :] = NAN
    values[7, 1] = 4.0
    parts: dict[str, Any] = {
        "dataset": data,
        "model": Model(),
        "verdict": "explained",
        "effects": (EffectEstimate("stray_field_gradient", 0.97, estimates, ("viscous_drag",)),),
        "chosen": (gradient.from_vector([interval.estimate for interval in estimates.values()]),),
        "ranking": (
            RankedHypothesis(("stray_field_gradient",), 0.91, 812.0, 1.02, 1.1, 0.93),
            RankedHypothesis(("stray_field_gradient", "substrate_tilt"), 0.06, 809.2, 1.0, 1.2, 0.92),
            RankedHypothesis(("viscous_drag",), 0.03, 808.0, 1.4, 2.9, 0.8),
            RankedHypothesis(("substrate_tilt",), 0.0, 420.0, 7.9, 9.9, 0.41),
            RankedHypothesis(("friction_coefficient",), 0.0, 130.0, 11.1, None, None),
            *(RankedHypothesis((name,), 0.0, 90.0, 12.0, None, None) for name in CATALOGUE if name not in LIKELIER),
            RankedHypothesis((), 0.0, 0.0, 15.8, 15.8, 0.0),
        ),
        "gap": Gap(1.0, 16.2, 15.8, 1.1, Interval(0.93, 0.90, 0.95), tuple(ids), by_trial),
        "failings": (),
        "where": (
            Region("frequency_Hz", 0.81, low=12.0, high=15.0, sigmas=21.0),
            Region("channel", 0.74, value="y", sigmas=19.0),
            Region("trial", 0.55, value="f15", sigmas=34.0),
            Region("trial", 0.26, value="f12", sigmas=18.0),
            Region("missing_force", 0.7, value="y", sigmas=12.0),
            Region("position_y_m", 0.4, low=0.008, high=0.024, sigmas=8.0),
            Region("cycle_phase_deg", 0.3, low=90.0, high=180.0, sigmas=8.0),
        ),
        "next_trials": (
            NextTrial(
                "separates stray_field_gradient from viscous_drag: the one is faster, the other slower",
                {
                    "incline_deg": 0.0,
                    "duration_s": 2.0,
                    "field": {"kind": "rotating", "strength_T": 0.02, "frequency_Hz": 15.0},
                },
                0.82,
                {
                    "stray_field_gradient": {"mean_speed_m_per_s": (0.0312, 0.0004), "climbs": (0.97, 0.02)},
                    "viscous_drag": {"mean_speed_m_per_s": (0.0265, 0.0011), "climbs": (0.1, 0.02)},
                },
            ),
        ),
        "ruled_out": {"substrate_tilt": "f01", "friction_coefficient": "f01", "field_rolloff": "tilt05"},
        "heat_maps": (
            HeatMap("Trial and channel", "trial", "channel", tuple(ids), ("x", "y", "z", "tilt", "heading"), values),
            HeatMap(
                "Frequency and phase of the cycle",
                "frequency",
                "phase",
                tuple(f"{f:g} Hz" for f in FREQUENCIES),
                tuple(f"{45 * i}–{45 * i + 45}°" for i in range(8)),
                np.outer(before[:7], np.linspace(0.6, 1.4, 8)),
            ),
            HeatMap(
                "Contact and channel",
                "contact",
                "channel",
                ("airborne", "point", "line", "surface"),
                ("x", "y", "z"),
                np.array([[1.0, 4.0, 1.1], [NAN, NAN, NAN], [0.9, 2.5, 1.0], [0.8, 1.2, 0.9]]),
            ),
        ),
        "tracked_point": "body_centre",
        "z_origin_tolerance_m": 0.0,
        "missing_wrench": wrench(),
        "overlays": tuple(overlays),
        "floors": tuple(
            TrialFloor(t.id, 2.5e-4, 0.12, 0.3, *((60, 6, 290) if t.track is not None else (0, 0, 1)))
            for t in data.trials
        ),
        "assumptions": (
            "The sensor's noise is white, with the standard deviations that the dataset states.",
            "The nominal mass, magnetization and friction are right to within 0.5 %.",
        ),
        "seed": 0,
        "seconds": 84.0,
        "version": "0.2.0",
    }
    return Diagnosis(**{**parts, **changes})


def small(**changes: Any) -> Diagnosis:
    """Return `made` with few figures, which take the most time."""
    known = made()
    few = {"overlays": known.overlays[:1], "missing_wrench": None, "heat_maps": known.heat_maps[:1]}
    return made(**{**few, **changes})


def no_gap() -> Diagnosis:
    gap = Gap(1.0, 1.02, 1.01, 1.01, Interval(NAN, NAN, NAN), ("f01",), {"f01": (1.02, 1.01, 1.01)})
    return made(
        verdict="no_gap",
        effects=(),
        chosen=(),
        ranking=(RankedHypothesis((), 0.99, 0.0, 1.0, 1.01, None),),
        gap=gap,
        where=(),
        next_trials=(),
        ruled_out={},
        heat_maps=(),
        missing_wrench=None,
        overlays=(),
    )


def outcomes_only() -> Diagnosis:
    """Return a diagnosis of outcomes that leave two effects tied, with what could not be measured as NaN."""
    data = lab(tracks=False)
    nothing = np.empty(0)
    overlays = tuple(Overlay(t.id, nothing, {}, {}, {}, {"climbed_share": (1.0, 0.0, NAN)}) for t in data.trials)
    return made(
        dataset=data,
        effects=(
            EffectEstimate(
                "friction_coefficient",
                0.5,
                {"factor": Interval(1.2, NAN, NAN, False), "drift_per_s": Interval(0.0, NAN, NAN, False)},
                ("x",),
            ),
        ),
        chosen=(CATALOGUE["friction_coefficient"].from_vector([1.2, 0.0]),),
        gap=Gap(NAN, 3.0, NAN, NAN, Interval(NAN, NAN, NAN), (), {"slope30": (3.0, NAN, NAN)}),
        heat_maps=(HeatMap("empty", "a", "b", ("r",), ("c",), np.array([[NAN]])),),
        missing_wrench=None,
        overlays=overlays,
        floors=tuple(TrialFloor(t.id, 1e-4, NAN, NAN, 0, 0, 1) for t in data.trials),
    )
