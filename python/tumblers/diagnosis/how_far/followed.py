"""`followed`: how much nearer the model with the effects comes to what was measured, by the sensor's noise alone.

The noise around a hypothesis is wide where its motion is sensitive, so that it may be likely without following
anything: it only says that the robot may do anything there. Its own run has to take off enough of

```text
Σ_t n_t ln max(1, Σρ/n_t)
```

over the whitened differences of the n_t numbers of each trial, with no noise but the sensor's. The logarithm is for
motion that is chaotic: a right model too may be far off there, and only somewhat less than a wrong one.
"""

from __future__ import annotations

import numpy as np

from ..fitting.fitter import Fitter
from ..gap.comparison import Residual
from ..gap.job import Job
from ..gap.predictive import mean_squares
from ..what.contender import Contender

__all__ = ["LEAST_FOLLOWED", "followed"]

# An effect that takes off less explains nothing. A choice, made with the answers of 192 diagnoses that said `explained`
# known: of the six whose cause is not in the catalogue all took off less, of the 155 that named just what was at work
# four.
LEAST_FOLLOWED = 0.15


def followed(fitter: Fitter, contender: Contender) -> float:
    """Return which share of what the nominal model leaves a contender's effects take off; below 0 if they leave more.

    1 where the nominal model follows the data to within the sensor's noise.

    Parameters
    ----------
    fitter
        Of the dataset; its steps and noise stay as they are.
    contender
        One or two effects.
    """
    comparison = fitter.comparison
    paths = comparison.simulator.run([Job(i, contender.effects) for i in fitter.trials])
    with comparison.restored():
        comparison.take_noise_of((), shares=[0.0] * len(fitter.trials))
        nominal, best = (_left(fitter, comparison.residual(those)) for those in (comparison.nominal_paths, paths))
    return 1.0 - best / nominal if nominal > 0.0 else 1.0


def _left(fitter: Fitter, residual: Residual) -> float:
    return float(np.dot(fitter.comparison.sizes, np.log(np.maximum(mean_squares(residual), 1.0))))
