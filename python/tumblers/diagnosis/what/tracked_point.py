"""`with_tracked_point`: which point of the body the positions are of, where the sensor does not say.

A camera follows the body's shape, a computed track often the centre of mass. The two part where the mass is not at the
centre of the shape, and such an offset would be taken for something else by the wrong reading: it is fitted in both.
Of another cause it follows either as badly, or by chance one better: what leaves a gap speaks for neither.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import get_args

import numpy as np

from ...camera import TrackedPoint
from ...dataset import Dataset
from ...effects.base import Effect
from ...effects.center_of_mass_offset import CenterOfMassOffset
from ...progress import OnPhase
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..gap.comparison import Comparison
from ..gap.predictive import is_wanting
from ..gap.simulator import Simulator
from .contender import likeliest, of_nominal, whole_log_likelihood
from .margins import CLEAR
from .own_noise import against_itself

__all__ = ["with_tracked_point"]

_PLACES = frozenset({"x_m", "y_m", "z_m"})
# Trial points of the fit.
_POINTS = 8


def with_tracked_point(dataset: Dataset, kinds: Sequence[type[Effect]], jobs: int, tell: OnPhase) -> Dataset:
    """Return a dataset whose sensor says which point was tracked.

    The centre of mass where the nominal model or an offset alone then leaves no gap and is clearly likelier than either
    by the shape's centre; else that.

    Parameters
    ----------
    dataset
        What the lab measured.
    kinds
        The effects that are considered.
    jobs
        Threads, all if 0.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    if dataset.sensor.tracked_point is not None:
        return dataset
    points: tuple[TrackedPoint, ...] = get_args(TrackedPoint)
    readings = [replace(dataset, sensor=replace(dataset.sensor, tracked_point=point)) for point in points]
    tracks = [trial.track for trial in dataset.trials if trial.track is not None and trial.track.frames]
    placed = any(not _PLACES.isdisjoint(track.channels) for track in tracks)
    offset = CenterOfMassOffset in kinds
    if not placed or not (offset or any(dataset.robot.center_of_mass_m)):
        return readings[0]
    found = []
    for k, reading in enumerate(readings):
        tell("which point was tracked", k, len(readings))
        found.append(_likeliest(reading, offset, jobs))
    (shape, _), (mass, wanting) = found
    return readings[1 if mass > shape + CLEAR and not wanting else 0]


def _likeliest(dataset: Dataset, offset: bool, jobs: int) -> tuple[float, bool]:
    """Return ln of the likelihood of the nominal model or, where considered, an offset, and whether there is a gap."""
    fitter = Fitter(Comparison(dataset, Simulator(dataset, jobs)))
    fitter.take_likeliest_noise(())
    best = nominal = of_nominal(fitter)
    if offset:
        scenarios = [fitter.comparison.simulator.nominal(i) for i in fitter.trials]
        hypothesis = Hypothesis.of(CenterOfMassOffset, scenarios)
        (starts,) = fitter.scan([hypothesis], [np.zeros(len(hypothesis.neutral))], nominal.residual)
        _, start = starts[0]
        best = likeliest([nominal, against_itself(fitter, fitter.fit(hypothesis, start, evaluations=_POINTS))])
    return whole_log_likelihood(best, fitter.comparison), is_wanting(fitter.comparison, best.residual)
