"""`with_height_zero`: whether heights are measured from another zero than the substrate, where the sensor does not say.

A zero that is off does to all frames of a trial what a size, a relief or a compliance does to some: it would be taken
for one of these. Fitted always, it would hide them. So it is fitted where the data ask for it: with z₀ the zero of
every trial and n its heights, where

```text
max ln L(z₀, M) - Σ ½ ln n  >  max ln L(0, M) + 1.25,      M the nominal model, or what leads with z₀ = 0
```

which is what a zero of each trial costs by Schwarz's criterion (Schwarz 1978), and where that leaves no gap: of another
cause, what follows a little better speaks for no zero.
"""

from __future__ import annotations

from dataclasses import replace
from math import log

import numpy as np

from ...dataset import Dataset
from ..fitting.fitter import Fitter
from ..gap.comparison import Comparison
from ..gap.predictive import is_wanting
from .attribute import Attribution
from .contender import Contender, likeliest, of_nominal
from .margins import CLEAR
from .own_noise import against_itself

__all__ = ["with_height_zero"]


def with_height_zero(comparison: Comparison, attribution: Attribution) -> Dataset | None:
    """Return the dataset with the zero of z fitted within the tolerance of x and y, None where it need not be.

    Parameters
    ----------
    comparison
        The dataset; its steps, noise and paths are as before at the end.
    attribution
        Every hypothesis as the zero is not fitted.
    """
    dataset = comparison.dataset
    sensor = dataset.sensor
    heights = [int(np.isfinite(r.observed.values.get("z", np.empty(0))).sum()) for r in comparison.readers]
    if sensor.z_origin_tolerance_m is not None or attribution.nominal_is_right or not any(heights):
        return None
    free = replace(dataset, sensor=replace(sensor, z_origin_tolerance_m=sensor.origin_tolerance_m))
    best = attribution.contenders[0]
    with comparison.restored():
        fixed, _ = _likeliest(comparison, best)
        fitted, wanting = _likeliest(Comparison(free, comparison.simulator), best)
    cost = sum(0.5 * log(n) for n in heights if n)
    return free if fitted - cost > fixed + CLEAR and not wanting else None


def _likeliest(comparison: Comparison, best: Contender) -> tuple[float, bool]:
    """Return the greater ln of the likelihood of the nominal model and of what leads, and whether that leaves a gap.

    Each against its own noise.
    """
    fitter = Fitter(comparison)
    fitter.take_likeliest_noise(())
    found = [of_nominal(fitter)]
    if best.fit is not None:
        found.append(against_itself(fitter, best.fit))
    leading = likeliest(found)
    total = leading.total + comparison.nominal_log_determinant
    fitter.take_likeliest_noise(leading.effects)
    return -total / comparison.objective_of(1.0), is_wanting(comparison, leading.residual)
