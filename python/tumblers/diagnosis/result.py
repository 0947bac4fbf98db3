"""`Diagnosis` and its parts: what a diagnosis says, and its JSON format ``tumblers-diagnosis/1``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..atomic import write_files
from ..dataset import Dataset
from ..effects.base import Effect
from ..model import Model
from ..scenario import Scenario
from ..section import write_entry

if TYPE_CHECKING:
    from .plots import Figures

__all__ = [
    "FORMAT",
    "Diagnosis",
    "EffectEstimate",
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
]

FORMAT = "tumblers-diagnosis/1"
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
        Laplace's, less that of the nominal model.
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
        What noise alone would give.
    before, after_nuisance_only, after
        For the nominal model and a perfect sensor, with the sensor's nuisances fitted, and with the chosen effects.
    shrink
        ``1 - (after - noise_floor) / (before - noise_floor)`` within [0, 1], with a 90 % interval by bootstrap over
        trials.
    held_out_trials
        Each was left out of a fit once.
    by_trial
        Trial id to (before, after_nuisance_only, after).
    """

    noise_floor: float
    before: float
    after_nuisance_only: float
    after: float
    shrink: Interval
    held_out_trials: tuple[str, ...]
    by_trial: Mapping[str, tuple[float, float, float]]


@dataclass(frozen=True)
class Region:
    """Part of the data where the gap lies.

    Attributes
    ----------
    axis
        One of the contract's axes, such as ``frequency_Hz`` or ``contact_mode``.
    share_of_gap
        Of the squared gap above the noise.
    low, high
        For an axis of numbers.
    value
        For an axis of names.
    sigmas
        Root mean square difference there, over what noise would give.
    """

    axis: str
    share_of_gap: float
    low: float | None = None
    high: float | None = None
    value: str | None = None
    sigmas: float | None = None


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
        What is left where the data say nothing, shape (6,).
    by_phase, by_mode, by_place, by_frequency
        Averages weighted by their uncertainty: label to (wrench, sigma), each of shape (6,).
    """

    trials: tuple[str, ...]
    start_s: Floats
    end_s: Floats
    wrench: Floats
    sigma: Floats
    prior_sigma: Floats
    by_phase: Mapping[str, tuple[Floats, Floats]]
    by_mode: Mapping[str, tuple[Floats, Floats]]
    by_place: Mapping[str, tuple[Floats, Floats]]
    by_frequency: Mapping[str, tuple[Floats, Floats]]


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
    """

    why: str
    trial: Mapping[str, Any]
    information_bits: float
    predictions: Mapping[str, Mapping[str, tuple[float, float]]]


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
        fitted.
    outcomes
        Kind of outcome to (measured, nominal, explained).
    """

    trial: str
    time_s: Floats
    measured: Mapping[str, Floats]
    nominal: Mapping[str, Floats]
    explained: Mapping[str, Floats]
    outcomes: Mapping[str, tuple[float, float, float]]


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
        Change of the path when the step is halved, and with the nominal numbers' tolerances, in noise sigmas.
    frames, lost, compared
        Frames of the track, frames lost, and numbers that were compared.
    """

    trial: str
    step_s: float
    numerical_sigmas: float
    tolerance_sigmas: float
    frames: int
    lost: int
    compared: int


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Where model and measurement part, which effect causes it, and how far the gap shrinks once it is added.

    Attributes
    ----------
    dataset
        What was diagnosed.
    model
        The model's switches that were used.
    verdict
        ``no_gap``, ``explained`` or ``unexplained``.
    effects
        The chosen set; empty for ``no_gap``.
    chosen
        The same as effects of the catalogue, ready to be added to a scenario.
    ranking
        Every hypothesis that was fitted, the best first.
    gap
        Before and after, on trials that no fit has seen.
    where
        Regions of the gap, the greatest share first.
    next_trials
        Trials that would tell tied effects apart, the best first.
    ruled_out
        Effect to the trial (its id) that speaks most against it.
    heat_maps, missing_wrench, overlays, floors
        What the report draws.
    assumptions
        Sentences.
    seed, seconds, version
        Of the computation.
    """

    dataset: Dataset
    model: Model
    verdict: Verdict
    effects: tuple[EffectEstimate, ...]
    chosen: tuple[Effect, ...]
    ranking: tuple[RankedHypothesis, ...]
    gap: Gap
    where: tuple[Region, ...]
    next_trials: tuple[NextTrial, ...]
    ruled_out: Mapping[str, str]
    heat_maps: tuple[HeatMap, ...]
    missing_wrench: MissingWrench | None
    overlays: tuple[Overlay, ...]
    floors: tuple[TrialFloor, ...]
    assumptions: tuple[str, ...]
    seed: int
    seconds: float
    version: str

    def scenario(self, trial: str, step_s: float | None = None) -> Scenario:
        """Return a trial's scenario with the diagnosed effects in it.

        Parameters
        ----------
        trial
            Its id.
        step_s
            Step, s; the one that the diagnosis used if None.

        Raises
        ------
        InputError
            No such trial.
        """
        lab = self.dataset.trial(trial)
        floor = next(floor for floor in self.floors if floor.trial == trial)
        base = lab.scenario(self.dataset, floor.step_s if step_s is None else step_s, model=self.model)
        return replace(base, effects=self.chosen)

    @property
    def plots(self) -> Figures:
        """Figures of the parts, each drawn on axes of one's own or on new ones."""
        from .plots import Figures

        return Figures(self)

    def effects_toml(self) -> str:
        """Return the chosen effects as ``[[effect]]`` tables, to be pasted into a scenario."""
        return "\n".join(write_entry("effect", effect.to_table()) for effect in self.chosen)

    def to_json(self) -> str:
        """Return the diagnosis as ``tumblers-diagnosis/1``."""
        gap = self.gap
        table: dict[str, Any] = {
            "format": FORMAT,
            "verdict": self.verdict,
            "effects": [
                {
                    "name": effect.name,
                    "probability": effect.probability,
                    "parameters": {key: _interval(value) for key, value in effect.parameters.items()},
                    "confounded_with": list(effect.confounded_with),
                }
                for effect in self.effects
            ],
            "ranking": [
                {
                    "effects": list(ranked.effects),
                    "probability": ranked.probability,
                    "held_out_gap": ranked.held_out_gap,
                    "shrink": ranked.shrink,
                    "gap": ranked.gap,
                    "log_evidence": ranked.log_evidence,
                }
                for ranked in self.ranking
            ],
            "gap": {
                "unit": "noise sigmas",
                "noise_floor": gap.noise_floor,
                "before": gap.before,
                "after_nuisance_only": gap.after_nuisance_only,
                "after": gap.after,
                "shrink": {"estimate": gap.shrink.estimate, "low": gap.shrink.low, "high": gap.shrink.high},
                "held_out_trials": list(gap.held_out_trials),
                "by_trial": {
                    trial: dict(zip(("before", "after_nuisance_only", "after"), values, strict=True))
                    for trial, values in gap.by_trial.items()
                },
            },
            "where": [_region(region) for region in self.where],
            "next_trials": [
                {
                    "why": proposed.why,
                    "trial": dict(proposed.trial),
                    "information_bits": proposed.information_bits,
                    "predictions": {
                        effect: {kind: {"mean": mean, "sigma": sigma} for kind, (mean, sigma) in said.items()}
                        for effect, said in proposed.predictions.items()
                    },
                }
                for proposed in self.next_trials
            ],
            "ruled_out": dict(self.ruled_out),
            "assumptions": list(self.assumptions),
            "trials": [
                {
                    "trial": floor.trial,
                    "step_s": floor.step_s,
                    "numerical_sigmas": floor.numerical_sigmas,
                    "tolerance_sigmas": floor.tolerance_sigmas,
                    "frames": floor.frames,
                    "lost": floor.lost,
                    "compared": floor.compared,
                }
                for floor in self.floors
            ],
            "seed": self.seed,
            "tumblers_version": self.version,
        }
        return json.dumps(_plain(table), indent=1, ensure_ascii=False, allow_nan=False) + "\n"

    def save(self, directory: str | PathLike[str]) -> None:
        """Write ``diagnosis.json``, ``effects.toml`` and ``report.html`` into a folder, all or none.

        Parameters
        ----------
        directory
            The folder, made if missing; its parent must exist.

        Raises
        ------
        OSError
            The folder cannot be made or written to, or the disk is full.
        """
        from .report import report_html

        contents = {
            "diagnosis.json": self.to_json().encode(),
            "effects.toml": self.effects_toml().encode(),
            "report.html": report_html(self).encode(),
        }
        folder = Path(directory)
        new = not folder.exists()
        folder.mkdir(exist_ok=True)
        try:
            write_files({folder / name: data for name, data in contents.items()})
        except BaseException:
            if new:
                folder.rmdir()
            raise


def _interval(value: Interval) -> dict[str, Any]:
    return {"estimate": value.estimate, "low": value.low, "high": value.high, "identified": value.identified}


def _region(region: Region) -> dict[str, Any]:
    place: dict[str, Any] = {"axis": region.axis}
    if region.value is None:
        place |= {"low": region.low, "high": region.high}
    else:
        place["value"] = region.value
    return place | {"share_of_gap": region.share_of_gap, "sigmas": region.sigmas}


def _plain(value: Any) -> Any:
    """Plain JSON values: a number that is not finite has no place in JSON and becomes null."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.bool_ | bool):
        return bool(value)
    if isinstance(value, np.integer):
        return int(value)
    if isinstance(value, np.floating | float):
        return float(value) if np.isfinite(value) else None
    return value
