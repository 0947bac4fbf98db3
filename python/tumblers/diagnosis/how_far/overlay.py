"""Measurement, nominal model and explained model of each trial, side by side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..fitting.fitter import Fitter
from ..gap.comparison import Comparison
from ..gap.job import Job
from ..gap.pose import Path, body_axis, heading_of, tilt_of
from ..gap.reading import seen_by
from ..result import Overlay
from ..what.contender import Contender
from .held_out import HeldOut

__all__ = ["overlays"]

Floats = NDArray[np.float64]

# Of an axis that stands, so that what its heading may be has an end.
_LEAST_COSINE = 0.02


def overlays(fitter: Fitter, nominal: HeldOut, chosen: HeldOut, contender: Contender) -> tuple[Overlay, ...]:
    """Return what was measured and foretold in each trial, by fits that have not seen it.

    Parameters
    ----------
    fitter
        Of the dataset.
    nominal, chosen
        Of the nominal model and of the chosen hypothesis, on trials left out.
    contender
        The chosen hypothesis.
    """
    comparison = fitter.comparison
    jobs = []
    for i, point in enumerate(chosen.points):
        effects = () if contender.fit is None or point is None else contender.fit.hypothesis.effects(point)
        jobs.append(Job(i, effects))
    explained = comparison.simulator.run(jobs)
    made = []
    for i, reader in enumerate(comparison.readers):
        before, after = comparison.nominal_paths[i], explained[i]
        if before is None or after is None:
            continue
        seen = reader.observed
        measured: dict[str, Floats] = dict(seen.values)
        if seen.orientation is not None:
            axis = body_axis(seen.orientation)
            measured |= {"tilt": tilt_of(axis), "heading": heading_of(axis)}
        lines = [_read(comparison, i, path, held) for path, held in ((before, nominal), (after, chosen))]
        outcome = seen.outcome
        noted = {
            "climbed_share": None if outcome is None or outcome.climbs is None else float(outcome.climbs),
            "mean_speed_m_per_s": None if outcome is None else outcome.mean_speed_m_per_s,
            "tilt_deg": None if outcome is None else outcome.tilt_deg,
        }
        foretold = reader.read_outcomes(before), reader.read_outcomes(after)
        made.append(
            Overlay(
                trial=seen.id,
                time_s=seen.time_s,
                measured={name: _shown(name, values, seen.heading_turn) for name, values in measured.items()},
                nominal={name: lines[0][name] for name in measured},
                explained={name: lines[1][name] for name in measured},
                outcomes={
                    kind: (value, foretold[0][kind], foretold[1][kind])
                    for kind, value in noted.items()
                    if value is not None
                },
                heading_turn_deg=float(np.degrees(seen.heading_turn)),
                noise={name: _spread(name, comparison.floors[i].deviation(name), lines[1]) for name in measured},
            )
        )
    return tuple(made)


def _shown(name: str, values: Floats, heading_turn: float) -> Floats:
    if name == "heading":
        # Within half of what it comes back to itself after.
        return np.degrees(values - heading_turn * np.rint(values / heading_turn))
    return np.degrees(values) if name == "tilt" else values


def _spread(name: str, deviation: Floats, line: dict[str, Floats]) -> Floats:
    """Return one standard deviation as it is shown: of an axis that stands upright the heading is anything."""
    if name == "heading":
        upright = np.maximum(np.cos(np.radians(line["tilt"])), _LEAST_COSINE)
        return np.asarray(np.degrees(deviation / upright))
    return np.degrees(deviation) if name == "tilt" else deviation


def _read(comparison: Comparison, trial: int, path: Path, held: HeldOut) -> dict[str, Floats]:
    """Return what a model says by channel, its nuisances and the nominal numbers' being off in it."""
    residual, floor = held.residuals[trial], comparison.floors[trial]
    seen = comparison.readers[trial].observed
    position, orientation = seen_by(path, seen.time_s, residual.local[trial], residual.camera)
    axis = body_axis(orientation)
    read = dict(zip("xyz", position.T, strict=True)) | {"tilt": tilt_of(axis), "heading": heading_of(axis)}
    for name in floor.valid:
        # Of an axis that stands upright a heading is off by anything.
        if name in read and name != "heading":
            shift = floor.shift(name, residual.tolerance)
            found = np.isfinite(shift)
            if found.any():
                read[name] = read[name] + np.interp(seen.time_s, seen.time_s[found], shift[found])
    return {name: _shown(name, values, seen.heading_turn) for name, values in read.items()}
