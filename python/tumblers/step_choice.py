"""`choose_step`: a step that keeps speed, drift and twist within 1 %, by an error estimate.

From the released 5·10⁻⁴ s down by halves, a step h with the values v(h) is compared with the torque at the midpoint,
w, in half and in a quarter of it. Every treatment of the torque tends to the same motion, and the midpoint is of second
order and does not damp it:

```text
e(h) = max(|v(h) - w(h/2)|, |v(h) - w(h/4)|) + |w(h/2) - w(h/4)|
```

with the distances of `tumblers.metrics`. The last term is Richardson's estimate of what w(h/4) is off by itself where
the error is of first order, which is what contacts leave of the second; of v = w = v₀ + c h the estimate is c h, the
error. A scheme that damps is not compared with itself: in half a step that is too long it damps as much, and seems to
have converged (`docs/performance.md`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

from .errors import InputError
from .metrics import Metrics, Yardstick, measured
from .model import MagneticTorque
from .progress import OnProgress, native_call
from .run import AUTO, MOST_STEPS
from .scenario import Scenario

__all__ = ["ACCURACY", "StepChoice", "choose_step", "chosen_warnings", "chosen_words", "with_chosen_step"]

_Key = tuple[MagneticTorque, float]

ACCURACY = 0.01
_LONGEST_S = 5.0e-4
# The finest that is tried is a 32nd of the longest, and is compared with a quarter of itself.
_STEPS = 6
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class StepChoice:
    """A step that was chosen for a scenario.

    Attributes
    ----------
    scenario
        The scenario with the step as a number.
    tried
        Steps, s, and their error estimates, as shares; the last one is the step.
    """

    scenario: Scenario
    tried: tuple[tuple[float, float], ...]

    @property
    def step_s(self) -> float:
        """The step, s."""
        return self.tried[-1][0]

    @property
    def error(self) -> float:
        """Its error estimate, as a share; infinite where a run failed."""
        return self.tried[-1][1]

    @property
    def met(self) -> bool:
        """Whether the estimate is at most 1 %; if no step's is, this is the finest that was tried."""
        return self.error <= ACCURACY

    def attributes(self) -> dict[str, Any]:
        """Return what a result says of it."""
        return {"step_s": self.step_s, "step_error": self.error, "step_met": int(self.met)}


def chosen_words(attrs: Mapping[Any, Any]) -> list[str]:
    """Return a line on the step that was chosen and its error estimate; none where no step was.

    Parameters
    ----------
    attrs
        Attributes of a result.
    """
    if "step_met" not in attrs:
        return []
    how = "chosen" if attrs["step_met"] else "the finest tried"
    # What runs several scenarios chose for the one that they begin with.
    whose = "" if attrs["title"] == "tumblers run" else " for the scenario as it is"
    return [f"step: {1e6 * attrs['step_s']:.4g} µs, {how}{whose}, error estimate {_percent(attrs)}"]


def chosen_warnings(attrs: Mapping[Any, Any]) -> list[str]:
    """Return a line where no step that was tried is accurate; none otherwise.

    Parameters
    ----------
    attrs
        Attributes of a result.
    """
    if attrs.get("step_met", 1):
        return []
    bound = f"no step tried keeps speed, drift and twist within {100.0 * ACCURACY:g} %"
    return [f"{bound} (error estimate {_percent(attrs)} in the finest): the motion may be chaotic"]


def _percent(attrs: Mapping[Any, Any]) -> str:
    return f"{100.0 * attrs['step_error']:.3g} %"


def choose_step(scenario: Scenario, *, threads: int | None = None, progress: bool | OnProgress = False) -> StepChoice:
    """Choose the longest step tried whose error estimate is at most 1 %, or the finest where none is.

    Parameters
    ----------
    scenario
        What is to be run; the step that it has does not matter.
    threads
        Number of threads, all by default. The choice does not depend on it.
    progress
        True for a progress bar over the steps of all runs that may be needed, or a callback that is told how many are
        done.

    Raises
    ------
    InputError
        A scenario that is refused in every step, or that is too long for the finest.
    SimulationError
        The native module gave up.
    """
    scenario.check()
    steps = _steps_s(scenario)
    own = scenario.magnetic_torque
    runs: dict[float, tuple[_Key, _Key, _Key]] = {
        step: ((own, step), ("midpoint", step / 2.0), ("midpoint", step / 4.0)) for step in steps
    }
    # Only the steps that are tried fit the rows that are kept.
    unsampled = scenario.unsampled
    finest = steps[-1] / 4.0
    if scenario.run.duration_s / finest > MOST_STEPS:
        wanted = f"'{AUTO}', which may take steps of {finest:.3g} s, for {scenario.run.duration_s:g} s"
        raise InputError("run.step_s", wanted, f"a step in s for a run of more than {MOST_STEPS * finest:.3g} s")
    scenarios = {key: unsampled.at_step(key[1], key[0]) for keys in runs.values() for key in keys}
    yardstick = Yardstick.of(scenario)
    found: dict[_Key, Metrics | None] = {}
    tried = []
    total = sum(run.run.steps for run in scenarios.values())
    with native_call("steps to choose one", total, progress) as report:
        for step in steps:
            new = [key for key in dict.fromkeys(runs[step]) if key not in found]
            found.update(zip(new, measured([scenarios[key] for key in new], threads or 0), strict=True))
            coarse, half, quarter = (found[key] for key in runs[step])
            error = max(yardstick.apart(coarse, half), yardstick.apart(coarse, quarter))
            error += yardstick.apart(half, quarter)
            tried.append((step, error))
            if error <= ACCURACY:
                break
            if report is not None:
                report(sum(scenarios[key].run.steps for key in found))
    return StepChoice(scenario=scenario.at_step(tried[-1][0]), tried=tuple(tried))


def with_chosen_step(
    scenario: Scenario, threads: int | None = None, progress: bool | OnProgress = False
) -> tuple[Scenario, dict[str, Any]]:
    """Return a scenario whose step is a number, and what a result says of it: nothing where it was one before.

    Parameters
    ----------
    scenario, threads, progress
        As for `choose_step`.

    Raises
    ------
    InputError, SimulationError
        As `choose_step`.
    """
    if scenario.run.step_s != AUTO:
        return scenario, {}
    choice = choose_step(scenario, threads=threads, progress=progress)
    return choice.scenario, choice.attributes()


def _steps_s(scenario: Scenario) -> list[float]:
    """Return the steps that are tried, the longest first."""
    longest = min(_LONGEST_S, scenario.longest_step_s, scenario.effective().longest_step_s)
    longest = min([longest, *(effect.resolving_step_s for effect in scenario.effects)])
    every = scenario.run.output_every_s
    if every is not None:
        longest = every / ceil(every / longest * (1.0 - _ROUNDING))
    bound = scenario.stability_bound_s
    while longest >= bound:
        longest *= 0.5
    return [longest / 2**halvings for halvings in range(_STEPS)]
