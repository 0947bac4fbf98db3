"""`Diagnosis`: what a diagnosis says, and its JSON format ``tumblers-diagnosis/1``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, fields, replace
from math import isfinite
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import write_files
from ..camera import Camera, TrackedPoint
from ..dataset import Dataset
from ..effects.base import Effect
from ..effects.catalogue import file_of
from ..model import Model
from ..regular_file import read_regular
from ..scenario import Scenario
from ..section import write_entry
from .result import (
    EffectEstimate,
    Failing,
    Gap,
    HeatMap,
    Interval,
    MissingWrench,
    NextTrial,
    Overlay,
    RankedHypothesis,
    Region,
    TrialFloor,
    Verdict,
)

if TYPE_CHECKING:
    from .plots import Figures

__all__ = ["FILES", "FORMAT", "Diagnosis", "is_ours"]

FORMAT = "tumblers-diagnosis/1"
# What is missing, and its standard deviation.
_MISSING = {
    "missing_force": ("force_N", "force_sigma_N"),
    "missing_torque": ("torque_N_m", "torque_sigma_N_m"),
}
# What `Diagnosis.save` writes.
FILES = ("diagnosis.json", "effects.toml", "scenario.toml", "report.html")


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Where model and measurement part, which effect causes it, and how far the gap shrinks once it is added.

    Attributes
    ----------
    dataset
        What was diagnosed.
    model
        The model's switches that were used.
    tracked_point
        What the positions were taken to be of: what the sensor says, or else what was found.
    z_origin_tolerance_m
        Within what the zero of heights was fitted in each trial, m: what the sensor says, or else what was found.
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
    failings
        Of an ``unexplained`` verdict, what keeps the best hypothesis from explaining the data.
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
    tracked_point: TrackedPoint
    z_origin_tolerance_m: float
    verdict: Verdict
    effects: tuple[EffectEstimate, ...]
    chosen: tuple[Effect, ...]
    ranking: tuple[RankedHypothesis, ...]
    gap: Gap
    failings: tuple[Failing, ...]
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
        """Return a trial's scenario with the diagnosed effects in it, seen at the point that was tracked.

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
        return replace(base, effects=self.chosen, camera=Camera(tracked_point=self.tracked_point))

    @property
    def plots(self) -> Figures:
        """Figures of the parts, each drawn on axes of one's own or on new ones."""
        from .plots import Figures

        return Figures(self)

    def effects_toml(self) -> str:
        """Return the chosen effects as ``[[effect]]`` tables, to be pasted into a scenario; empty if there are none."""
        if not self.chosen:
            return ""
        steps = sorted({floor.step_s for floor in self.floors})
        span = " to ".join(f"{step:g}" for step in ([steps[0], steps[-1]] if len(steps) > 1 else steps))
        head = [
            "# To be pasted into a scenario. They were found with:",
            *(f'# [model] {f.name} = "{getattr(self.model, f.name)}"' for f in fields(self.model)),
            f'# [camera] tracked_point = "{self.tracked_point}"',
            f"# [run] step_s = {span}",
            *self._files_needed(),
        ]
        tables = (write_entry("effect", effect.to_table()) for effect in self.chosen)
        return "\n".join([*head, "", "\n".join(tables)])

    def scenario_toml(self) -> str:
        """Return the scenario of the trial with the largest gap, with the diagnosed effects: a whole one, to be run."""
        gaps = {trial.id: self.gap.by_trial.get(trial.id, (0.0,))[0] for trial in self.dataset.trials}
        trial = max(gaps, key=lambda id_: gaps[id_] if isfinite(gaps[id_]) else 0.0)
        head = [f"# Trial {trial}, as it was diagnosed.", *self._files_needed()]
        return "\n".join([*head, "", self.scenario(trial).to_toml()])

    def _files_needed(self) -> list[str]:
        lines = []
        for effect in self.chosen:
            kind, file = type(effect), file_of(type(effect))
            if file is not None:
                lines.append(f"# {effect.name} is not of the package: tumblers simulate --effects {file.name} ...")
            elif kind.__module__.partition(".")[0] != __package__.partition(".")[0]:
                lines.append(f"# {effect.name} is not of the package: register {kind.__qualname__} before.")
        return lines

    def to_json(self) -> str:
        """Return the diagnosis as ``tumblers-diagnosis/1``."""
        from .wording.caution import cautions
        from .wording.headline import headline

        gap = self.gap
        table: dict[str, Any] = {
            "format": FORMAT,
            "title": self.dataset.title,
            "verdict": self.verdict,
            "headline": headline(self),
            "cautions": list(cautions(self)),
            "tracked_point": self.tracked_point,
            "z_origin_tolerance_m": self.z_origin_tolerance_m,
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
                "followed": gap.followed,
                "by_trial": {
                    trial: dict(zip(("before", "after_nuisance_only", "after"), values, strict=True))
                    for trial, values in gap.by_trial.items()
                },
            },
            "failings": [asdict(failing) for failing in self.failings],
            "where": [_region(region) for region in self.where],
            "next_trials": [
                {
                    "why": proposed.why,
                    "trial": dict(proposed.trial),
                    "information_bits": proposed.information_bits,
                    "within_ranges": proposed.within_ranges,
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
                    "at_tolerance": list(floor.at_tolerance),
                }
                for floor in self.floors
            ],
            "seed": self.seed,
            "tumblers_version": self.version,
        }
        return json.dumps(_plain(table), indent=1, ensure_ascii=False, allow_nan=False) + "\n"

    def save(self, directory: str | PathLike[str]) -> None:
        """Write `FILES` into a folder, all or none.

        Parameters
        ----------
        directory
            The folder, made if missing; its parent must exist.

        Raises
        ------
        OSError
            The folder cannot be made or written to, or the disk is full.
        """
        from .report.report import report_html

        texts = (self.to_json(), self.effects_toml(), self.scenario_toml(), report_html(self))
        folder = Path(directory)
        new = not folder.exists()
        folder.mkdir(exist_ok=True)
        try:
            write_files({folder / name: text.encode() for name, text in zip(FILES, texts, strict=True)})
        except BaseException:
            if new:
                # What has taken its name already stays in it.
                with suppress(OSError):
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
    what = {} if region.what is None else {"what": region.what}
    missing = {} if region.missing is None else dict(zip(_MISSING[region.axis], region.missing, strict=True))
    return place | {"share_of_gap": region.share_of_gap, "sigmas": region.sigmas} | missing | what


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


def is_ours(folder: Path) -> bool:
    """Return whether a folder has a diagnosis that was written here.

    Parameters
    ----------
    folder
        Any, which need not exist.
    """
    try:
        table = json.loads(read_regular(folder / FILES[0]))
    except (OSError, RecursionError, ValueError):
        return False
    return isinstance(table, dict) and table.get("format") == FORMAT
