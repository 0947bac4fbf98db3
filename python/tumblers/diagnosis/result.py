"""The parts of a diagnosis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..effects.parameter import Nuisance

__all__ = [
    "EffectEstimate",
    "Failing",
    "Gap",
    "HeatMap",
    "Interval",
    "MissingWrench",
    "NextTrial",
    "Overlay",
    "RankedHypothesis",
    "Region",
    "TrialFloor",
    "Verdict",
    "WrenchMean",
]

Verdict = Literal["no_gap", "explained", "unexplained"]
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Interval:
    """An estimate and its 90 % interval.

    Attributes
    ----------
    estimate, low, high
        In the parameter's unit.
    identified
        Whether the data narrow the parameter to less than half of its plausible range.
    """

    estimate: float
    low: float
    high: float
    identified: bool = True


@dataclass(frozen=True)
class EffectEstimate:
    """One effect of the chosen set.

    Attributes
    ----------
    name
        Of the catalogue.
    probability
        That this effect is at work, over all hypotheses that were fitted.
    parameters
        By the key of ``[[effect]]``, vectors as ``key[i]``.
    confounded_with
        Effects that these trials cannot tell apart from it.
    """

    name: str
    probability: float
    parameters: Mapping[str, Interval]
    confounded_with: tuple[str, ...]


@dataclass(frozen=True)
class RankedHypothesis:
    """One set of effects that was fitted.

    Attributes
    ----------
    effects
        Names; none for the nominal model.
    probability
        Over all hypotheses that were fitted.
    log_evidence
        ln of Laplace's evidence times the prior probability, less that of the nominal model.
    gap
        Root mean square difference over all trials after the fit, noise sigmas.
    held_out_gap, shrink
        On trials that the fit has not seen; None where that was not measured, for it is far behind.
    """

    effects: tuple[str, ...]
    probability: float
    log_evidence: float
    gap: float
    held_out_gap: float | None
    shrink: float | None


@dataclass(frozen=True)
class Gap:
    """The gap on trials that no fit has seen, in noise sigmas.

    Attributes
    ----------
    noise_floor
        What noise alone would give: 1, or less where outcomes of yes or no, of which it leaves nothing, are among the
        numbers, and 0 of those alone.
    before, after_nuisance_only, after
        For the nominal model and a perfect sensor, with the sensor's nuisances fitted, and with the chosen effects.
    shrink
        ``1 - (after - noise_floor) / (before - noise_floor)`` within [0, 1], with a 90 % interval by bootstrap over
        trials.
    held_out_trials
        Each was left out of a fit once.
    by_trial
        Trial id to (before, after_nuisance_only, after).
    followed
        How much nearer the chosen effects bring the model to the data where they are fitted, by the sensor's noise
        alone: a share of the ln of what the nominal model leaves; below 0 if farther, None without effects. Where it is
        next to nothing, the gap shrinks because the computed motion is uncertain with them.
    """

    noise_floor: float
    before: float
    after_nuisance_only: float
    after: float
    shrink: Interval
    held_out_trials: tuple[str, ...]
    by_trial: Mapping[str, tuple[float, float, float]]
    followed: float | None = None


@dataclass(frozen=True)
class Failing:
    """What keeps the best hypothesis from explaining the data.

    Attributes
    ----------
    test
        ``all trials`` or ``a trial`` where a mean square is more than a right model leaves, ``an outcome`` that is
        contradicted, ``trials left out`` that the others do not foretell, or ``the path``, to which the simulated robot
        itself comes no nearer.
    trials
        Their ids, where it is about some.
    left, allowed
        Σρ/n, and what is allowed of it at most; None where the test is of something else.
    """

    test: Literal["all trials", "a trial", "an outcome", "trials left out", "the path"]
    trials: tuple[str, ...] = ()
    left: float | None = None
    allowed: float | None = None


@dataclass(frozen=True)
class Region:
    """Part of the data where the gap lies.

    Attributes
    ----------
    axis
        One of the contract's axes, such as ``frequency_Hz`` or ``contact_mode``.
    share_of_gap
        Of the squared gap above the noise; with `what`, how much of it that takes.
    low, high
        For an axis of numbers.
    value
        For an axis of names.
    sigmas
        Root mean square difference there, over what noise would give.
    what
        What may act there and not elsewhere, such as ``0.12 times the magnetic torque``.
    missing
        Of a component of the missing wrench its mean and standard deviation, N or N m, at the frequency at which it is
        clearest.
    """

    axis: str
    share_of_gap: float
    low: float | None = None
    high: float | None = None
    value: str | None = None
    sigmas: float | None = None
    what: str | None = None
    missing: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class HeatMap:
    """Differences over two axes, in units of what noise alone gives (1).

    Attributes
    ----------
    title, rows, columns
        Words.
    row_labels, column_labels
        Of the cells.
    values
        Root mean square whitened difference, shape (rows, columns), NaN where there are no data.
    """

    title: str
    rows: str
    columns: str
    row_labels: tuple[str, ...]
    column_labels: tuple[str, ...]
    values: Floats


@dataclass(frozen=True, eq=False)
class WrenchMean:
    """The missing wrench over some of its windows: [Fx, Fy, Fz, Tx, Ty, Tz] in N and N m, substrate frame.

    Attributes
    ----------
    wrench
        The mean, weighted by its uncertainty, shape (6,).
    sigma
        Standard deviation of each component, shape (6,).
    prior_sigma
        What it is where the data say nothing, shape (6,).
    """

    wrench: Floats
    sigma: Floats
    prior_sigma: Floats


@dataclass(frozen=True, eq=False)
class MissingWrench:
    """The generalized force that must be added along the runs for the nominal model to follow the data.

    Attributes
    ----------
    trials
        Trial id by window, length n.
    start_s, end_s
        Of each window, shape (n,).
    wrench
        [Fx, Fy, Fz, Tx, Ty, Tz] in N and N m, substrate frame, shape (n, 6).
    sigma
        Standard deviation of each, shape (n, 6).
    prior_sigma
        What is left where the data say nothing, shape (n, 6): a stronger field may lack a greater torque.
    by_phase, by_mode, by_place, by_frequency
        Label to the mean. Where the windows of a trial are longer than half a cycle, phases and modes are of a wrench
        for each quarter of all its cycles instead. Phases in which the same windows lie are one.
    """

    trials: tuple[str, ...]
    start_s: Floats
    end_s: Floats
    wrench: Floats
    sigma: Floats
    prior_sigma: Floats
    by_phase: Mapping[str, WrenchMean]
    by_mode: Mapping[str, WrenchMean]
    by_place: Mapping[str, WrenchMean]
    by_frequency: Mapping[str, WrenchMean]


@dataclass(frozen=True)
class NextTrial:
    """A trial that would tell tied effects apart.

    Attributes
    ----------
    why
        In words.
    trial
        The keys of a dataset's ``[[trial]]``.
    information_bits
        Expected information about which effect is at work.
    predictions
        Effect to what would be seen: kind of observation to (mean, standard deviation).
    within_ranges
        Whether it stays within what the lab has done.
    """

    why: str
    trial: Mapping[str, Any]
    information_bits: float
    predictions: Mapping[str, Mapping[str, tuple[float, float]]]
    within_ranges: bool = True


@dataclass(frozen=True, eq=False)
class Overlay:
    """One trial's measurement and what the model says of it, before and after, when the fit has not seen the trial.

    Attributes
    ----------
    trial
        Its id.
    time_s
        Of the frames, s, shape (n,).
    measured, nominal, explained
        By channel (``x``, ``y``, ``z`` in m, ``tilt`` and ``heading`` in degrees), shape (n,); with the nuisances
        fitted, and but for the heading with the nominal numbers off as they fit best.
    outcomes
        Kind of outcome to (measured, nominal, explained).
    heading_turn_deg
        After which a heading is the same again, °: half a turn of an axis whose ends nobody can tell apart.
    noise
        By channel, one standard deviation of what counts as noise at each frame, in the channel's unit, shape (n,), NaN
        where lost: the sensor's, and what step and tolerances leave open.
    """

    trial: str
    time_s: Floats
    measured: Mapping[str, Floats]
    nominal: Mapping[str, Floats]
    explained: Mapping[str, Floats]
    outcomes: Mapping[str, tuple[float, float, float]]
    heading_turn_deg: float = 360.0
    noise: Mapping[str, Floats] = field(default_factory=dict)


@dataclass(frozen=True)
class TrialFloor:
    """What one trial's numbers can at best be compared to.

    Attributes
    ----------
    trial
        Its id.
    step_s
        Of the simulation, s.
    numerical_sigmas, tolerance_sigmas
        Change when the step is halved, and with the nominal numbers' tolerances, in noise sigmas: root mean square
        along the track, or an outcome's if more.
    frames, lost, compared
        Frames of the track, frames lost, and numbers that were compared.
    at_tolerance
        What of the sensor was fitted to the end of its tolerance here, under the verdict's hypothesis.
    """

    trial: str
    step_s: float
    numerical_sigmas: float
    tolerance_sigmas: float
    frames: int
    lost: int
    compared: int
    at_tolerance: tuple[Nuisance, ...] = ()
