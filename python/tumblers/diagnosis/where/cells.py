"""`Cells`: every number that was compared, with the conditions it was taken under."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...field import RotatingField, StaticField
from ..gap.comparison import Comparison, Residual
from ..gap.loss import huber
from ..gap.observed import CHANNELS
from ..gap.pose import Path
from .seen_along import seen_along

__all__ = ["MODES", "Cells"]

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

# Contact modes as the core numbers them.
MODES = ("airborne", "point", "line", "surface")
# What an outcome tells of.
_OF_OUTCOME = {"mean_speed": "y", "climbs": "y", "slides": "y"}
# Channels in which a robot that was knocked off its course stays off it, and the frames that say where it was before.
_LASTING = ("x", "y", "heading")
_BEFORE = 12
# Median of a squared standard normal number.
_MEDIAN = 0.4549


@dataclass(frozen=True, eq=False)
class Cells:
    """Whitened differences side by side, arrays of shape (n,).

    Attributes
    ----------
    loss, fresh
        Huber's ρ of each difference, and of what it has gained over those of the same channel just before.
    noise
        What noise alone would give each, at most 1: measured in the trial's channel, whose floor may be wide.
    channel, trial
        Places in `CHANNELS` and in the dataset.
    outcome
        Whether it is of an outcome and not of a track.
    time_s, phase_deg, x_m, y_m
        Time, phase of the rotating field's cycle, place of the model across, and along where the robot was seen, or the
        model's where y was not tracked; NaN where there is none.
    mode
        Place in `MODES`, -1 for outcomes.
    frequency_Hz, strength_T, incline_deg
        Of the trial; NaN where the field has none.
    """

    loss: Floats
    fresh: Floats
    noise: Floats
    channel: Ints
    trial: Ints
    outcome: NDArray[np.bool_]
    time_s: Floats
    phase_deg: Floats
    x_m: Floats
    y_m: Floats
    mode: Ints
    frequency_Hz: Floats
    strength_T: Floats
    incline_deg: Floats

    @classmethod
    def of(cls, comparison: Comparison, residual: Residual, paths: Sequence[Path | None]) -> Cells:
        """Return the numbers of a comparison.

        Parameters
        ----------
        comparison
            The dataset, ready to be compared.
        residual
            How wrong the model is.
        paths
            The model's; a trial that it cannot run has no contact modes.
        """
        blocks: list[dict[str, Floats]] = []
        for i, path in enumerate(paths):
            first = 0
            lab = comparison.dataset.trials[i]
            field = lab.field
            tracked = len(comparison.floors[i].valid)
            for place, (name, times) in enumerate(comparison.labels(i)):
                values = residual.trials[i][first : first + len(times)]
                first += len(times)
                outcome = place >= tracked
                channel = _OF_OUTCOME.get(name, name)
                clock = times + residual.local[i, 0] + (path.clock_s if path is not None else 0.0)
                across, along = np.full((2, len(times)), np.nan)
                mode = np.full(len(times), -1.0)
                if not outcome and len(times):
                    if path is not None:
                        (across, along, _), mode = path.at(clock)[0].T, path.mode_at(clock).astype(np.float64)
                    along = seen_along(comparison.readers[i].observed, residual.local[i], times, along)
                loss = huber(values)
                level = 1.0 if outcome or not len(times) else min(1.0, float(np.median(values**2)) / _MEDIAN)
                block = {
                    "loss": loss,
                    "fresh": huber(_gained(values)) if channel in _LASTING and not outcome else loss,
                    "noise": np.full(len(times), level),
                    "channel": np.full(len(times), float(CHANNELS.index(channel))),
                    "trial": np.full(len(times), float(i)),
                    "outcome": np.full(len(times), float(outcome)),
                    # An outcome is of the whole trial.
                    "time_s": np.where(outcome, np.nan, times),
                    "phase_deg": np.full(len(times), np.nan),
                    "x_m": across,
                    "y_m": along,
                    "mode": mode,
                    "frequency_Hz": np.full(len(times), np.nan),
                    "strength_T": np.full(len(times), np.nan),
                    "incline_deg": np.full(len(times), lab.incline_deg),
                }
                if isinstance(field, RotatingField | StaticField):
                    block["strength_T"][:] = field.strength_T
                if isinstance(field, RotatingField):
                    block["frequency_Hz"][:] = field.frequency_Hz
                    if not outcome:
                        block["phase_deg"] = (360.0 * field.frequency_Hz * clock) % 360.0
                blocks.append(block)
        table = {key: np.concatenate([np.empty(0), *(block[key] for block in blocks)]) for key in _KEYS}
        return cls(
            outcome=table.pop("outcome") > 0.5,
            channel=table.pop("channel").astype(np.intp),
            trial=table.pop("trial").astype(np.intp),
            mode=table.pop("mode").astype(np.intp),
            **table,
        )

    @property
    def excess(self) -> Floats:
        """What is there beside the noise, shape (n,)."""
        return self.loss - self.noise


_KEYS = tuple(Cells.__dataclass_fields__)


def _gained(values: Floats) -> Floats:
    """Return each number less the mean of those before it, scaled to the same variance for white noise."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    place = np.arange(len(values))
    first = np.maximum(place - _BEFORE, 0)
    count = place - first
    before = (sums[place] - sums[first]) / np.maximum(count, 1)
    return np.asarray((values - before) / np.sqrt(1.0 + (count > 0) / np.maximum(count, 1)), dtype=np.float64)
