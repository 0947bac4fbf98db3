"""`followed`: how much nearer the model with the effects comes to what was measured, by the sensor's noise alone.

The noise around a hypothesis is wide where its motion is sensitive, so that it may be likely without following
anything: it only says that the robot may do anything there. Its own run has to take off enough of

```text
Σ_t n_t ln max(1, Σρ/n_t) + n_c Σ ln max(1, ρ(outcome))
```

over the whitened differences of the n_t numbers of each track, with no noise but the sensor's; an outcome counts as in
the objective, and keeps the noise of its threshold. Each model has the nuisances of the nominal numbers around itself.
The logarithm is for motion that is chaotic: a right model too may be far off there, and only somewhat less than a wrong
one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...effects.base import Effect
from ..fitting.fitter import Fitter
from ..gap.comparison import Comparison
from ..gap.job import Job
from ..gap.loss import huber, robust_cost
from ..gap.pose import Path
from ..what.contender import Contender

__all__ = ["LEAST_FOLLOWED", "followed"]

# An effect that takes off less explains nothing. A choice, made with answers known (docs/blind-history.md).
LEAST_FOLLOWED = 0.15


def followed(fitter: Fitter, contender: Contender) -> float:
    """Return which share of what the nominal model leaves a contender's effects take off; below 0 if they leave more.

    1 where the nominal model follows the data to within the sensor's noise.

    Parameters
    ----------
    fitter
        Of the dataset; its steps and noise stay as they are.
    contender
        One or two effects, as they were fitted to all trials.
    """
    comparison = fitter.comparison
    paths = comparison.simulator.run([Job(i, contender.effects) for i in fitter.trials])
    with comparison.restored():
        nominal, best = _left(comparison, (), comparison.nominal_paths), _left(comparison, contender.effects, paths)
    return 1.0 - best / nominal if nominal > 0.0 else 1.0


def _left(comparison: Comparison, effects: tuple[Effect, ...], paths: Sequence[Path | None]) -> float:
    """Return what a model leaves by the sensor's noise alone, which stays."""
    comparison.take_noise_of(effects, shares=[0.0] * len(paths))
    left = 0.0
    for floor, values in zip(comparison.floors, comparison.residual(paths).trials, strict=True):
        count = floor.tracked
        track = count * np.log(max(robust_cost(values[:count]) / max(count, 1), 1.0))
        left += float(track + comparison.alike * np.sum(np.log(np.maximum(huber(values[count:]), 1.0))))
    return left
