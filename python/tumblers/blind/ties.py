"""Whether two explanations foretell the same observations: shown by simulation.

Of a truth that acts in another form than the catalogue's two things can be asked: whether what was named shows what it
shows, to which no effect of the catalogue may come near, the right one no more than another; and whether its effect in
the catalogue's form shows what was named, in some size. Where that is so, the two effects are tied, whatever the form
shows beside.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from math import inf
from os import PathLike
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from ..dataset import Dataset, LabTrial, load
from ..effects.base import Effect
from ..effects.catalogue import get
from ..errors import InputError, TumblersError, show
from .forms import scaled
from .jitter import Jitter
from .lab import Lab, Plan
from .law import EffectLaw, Law
from .strength import strength
from .world import Scene, watch

__all__ = ["SIZES", "Tie", "difference_sigma", "effect_of", "nearest_sigma"]

_STEP_S = 1.4e-4
_FRAMES_PER_SECOND = 60.0
# Sizes of an effect, over its true one, among which the nearest to another is sought, and how closely. A choice: in
# another form it is as strong as in the catalogue's somewhere in the data.
SIZES, _SIZED = (0.5, 1.5), 0.01


class Tie(NamedTuple):
    """By how many sigma what was named differs from the truth.

    Attributes
    ----------
    world
        From the truth in its own form.
    effect
        From its effect in the catalogue's form, in the size that comes nearest; infinite where that was not asked.
    """

    world: float
    effect: float = inf


def effect_of(name: str, parameters: Mapping[str, float]) -> Effect:
    """Return the effect of a name and of parameters by their keys.

    Parameters
    ----------
    name
        Of the catalogue.
    parameters
        A key that is left out is neutral.

    Raises
    ------
    InputError
        A name that is not in the catalogue, a key that the effect has not, or a number that is refused.
    """
    kind = get(name)
    known = [p.key for p in kind.parameters]
    for key in parameters:
        if key not in known:
            raise InputError(f"{name}.{show(key)}", "no such parameter", " or ".join(known))
    return kind.from_vector([parameters.get(p.key, p.neutral) for p in kind.parameters])


def difference_sigma(
    dataset: Dataset | str | PathLike[str],
    first: Sequence[Law],
    second: Sequence[Law],
    jitter: Jitter | None = None,
) -> float:
    """Return by how many standard deviations of the noise two explanations differ on a dataset's trials.

    Parameters
    ----------
    dataset
        The dataset, or its folder.
    first, second
        The laws of each explanation.
    jitter
        How far the numbers of the world in which the first are at work are from the nominal ones; not at all if None.

    Returns
    -------
    float
        Root mean square of what neither the sensor's tolerances nor one standard deviation of each nominal number can
        take, as a cause's strength is measured; infinite where one of them cannot be simulated.
    """
    data = dataset if isinstance(dataset, Dataset) else load(dataset)
    lab, nominal = _lab(data), Jitter(dimensions=(1.0,) * len(fields(data.robot.shape)))
    try:
        moved = [_scenes(lab, second, raised) for raised in nominal.each_raised()]
        return strength(lab, _scenes(lab, first, jitter or nominal), _scenes(lab, second, nominal), moved).sigma
    except (ArithmeticError, TumblersError):
        return inf


def nearest_sigma(dataset: Dataset | str | PathLike[str], effect: Effect, chosen: Sequence[Law]) -> float:
    """Return by how many sigma an effect differs from an explanation in the size in which it comes nearest.

    Both with the lab's numbers: what is asked is whether either could stand for the other there.

    Parameters
    ----------
    dataset
        The dataset, or its folder.
    effect
        In its true size, of which the shares between `SIZES` are tried; what says where or how it acts stays.
    chosen
        The laws of the explanation.
    """
    data = dataset if isinstance(dataset, Dataset) else load(dataset)

    def away(size: float) -> float:
        try:
            return difference_sigma(data, [EffectLaw(scaled(effect, size))], chosen)
        except TumblersError:
            # There is no effect of that size.
            return inf

    found = minimize_scalar(away, bounds=SIZES, method="bounded", options={"xatol": _SIZED})
    # Where motion hops there may be several minima, and the true size is the likeliest place of one.
    return min(float(found.fun), away(1.0))


def _scenes(lab: Lab, laws: Sequence[Law], jitter: Jitter) -> list[Scene]:
    return [
        watch(jitter.edit(lab.scenario(plan)), laws, lab.frames(plan), solver="reduced", filmed=plan.tracked)
        for plan in lab.plans
    ]


def _lab(data: Dataset) -> Lab:
    tracks = [trial.track for trial in data.trials if trial.track is not None and trial.track.time_s.size > 1]
    farthest = [
        np.nanmax(np.abs(t.channels[n]), initial=0.0) for t in tracks for n in ("x_m", "y_m") if n in t.channels
    ]
    return Lab(
        robot=data.robot,
        substrate=data.substrate,
        sensor=data.sensor,
        channels=tuple(tracks[0].channels) if tracks else (),
        frames_per_second=1.0 / tracks[0].frame_interval_s if tracks else _FRAMES_PER_SECOND,
        view_m=max(map(float, farthest), default=inf),
        step_s=_STEP_S,
        plans=tuple(_plan(trial) for trial in data.trials),
    )


def _plan(trial: LabTrial) -> Plan:
    outcome = trial.outcome
    kind = ""
    if outcome is not None:
        kind = (
            "tilt" if outcome.tilt_deg is not None else "speed" if outcome.mean_speed_m_per_s is not None else "climbs"
        )
    return Plan(
        id=trial.id,
        field=trial.field,
        duration_s=trial.duration_s,
        incline_deg=trial.incline_deg,
        tracked=trial.track is not None,
        outcome=kind,
    )
