"""`with_height_zero`: whether heights are measured from another zero than the substrate, where the sensor does not say.

A zero that is off does to all frames of a trial what a size, a relief or a compliance does to some: it would be taken
for one of these. Fitted always, it would hide them. So it is fitted where the data ask for it: with z₀ the zero of
every trial and n its heights, where

```text
max ln L(z₀, M) - Σ ½ ln n  >  max ln L(0, M) + 1.25
```

and the left side leaves no gap. M is the nominal model, what leads with z₀ = 0, or one of the effects of that; ½ ln n
is what a zero costs by Schwarz's criterion (Schwarz 1978). Of another cause, what follows a little better speaks for no
zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import log

from ...dataset import Dataset
from ..fitting.fitter import Fitter
from ..gap.comparison import Comparison
from ..gap.predictive import is_right
from .attribute import Attribution
from .contender import Contender, likeliest, of_nominal, whole_log_likelihood
from .margins import CLEAR
from .own_noise import POLISH_POINTS, against_itself, by_itself

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
    heights = comparison.heights
    if sensor.z_origin_tolerance_m is not None or attribution.nominal_is_right or not any(heights):
        return None
    free = replace(dataset, sensor=replace(sensor, z_origin_tolerance_m=sensor.origin_tolerance_m))
    best = attribution.contenders[0]
    # What leads with no zero may have a second effect for it.
    those = [c for c in attribution.contenders if c is best or (len(c.names) == 1 and c.names[0] in best.names)]
    with comparison.restored():
        fixed, _ = _likeliest(comparison, those, fit=False)
        fitted, right = _likeliest(Comparison(free, comparison.simulator), those, fit=True)
    cost = sum(0.5 * log(n) for n in heights if n)
    return free if right and fitted - cost > fixed + CLEAR else None


def _likeliest(comparison: Comparison, those: Sequence[Contender], fit: bool) -> tuple[float, bool]:
    """Return the greatest ln of the likelihood of the nominal model and of others, and whether that leaves no gap.

    Each against its own noise, fitted on if `fit`.
    """
    fitter = Fitter(comparison)
    fitter.take_likeliest_noise(())
    found = [of_nominal(fitter)]
    for contender in those:
        if contender.fit is not None:
            one = against_itself(fitter, contender.fit)
            found.append(by_itself(fitter, one, POLISH_POINTS) if fit else one)
    leading = likeliest(found)
    return whole_log_likelihood(leading, comparison), is_right(comparison, leading.residual)
