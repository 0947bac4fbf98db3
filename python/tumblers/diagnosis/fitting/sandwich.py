"""`misfit_factors`: by how much more than Laplace's a parameter's deviation is where the fit is not as it should be.

Let A be the information of all trials about the coordinates u, the prior's included, A_t and s_t what trial t adds to
it and to the slope of half the tempered objective at the fit, and G that slope. At its best G is nothing; where motion
hops, least squares end in a small minimum, or the noise by which intervals are taken moves the best: a step of Newton's
-A⁻¹G says how far. Where the model is right, s_t - A_t A⁻¹G has the covariance A_t - A_t A⁻¹A_t; where trials pull at a
parameter in different directions, it has more. With the trials' leverages M_t = A^(-1/2) A_t A^(-1/2) that gives the
sandwich of Bell and McCaffrey (2002, Survey Methodology 28, 169), right where the model is, and the mean square

```text
d_t = A^(-1/2) (1 - M_t)^(-1/2) A^(-1/2) (s_t - A_t A⁻¹G)
V   = Σ_t d_t d_tᵀ + A⁻¹G (A⁻¹G)ᵀ
```

The prior is whole in A, and over the dispersion in G, whose minimum the fit has sought: where the data say little, the
step is too short by that. A coordinate that presses on an end of its range is not at a stationary point, and is left
out; of a direction of which one trial alone knows, no other can pull away.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["MOST_FACTOR", "Pulls", "misfit_factors"]

Floats = NDArray[np.float64]

# A trial that knows all but this share of a direction is alone with it.
_ALONE = 0.01
# No factor is more: where a step of Newton's is as long as this, nothing is known of where it leads. A choice, made
# with the answers of 150 datasets known.
MOST_FACTOR = 4.0


class Pulls(NamedTuple):
    """What the trials say of a fit, all over the dispersion but for the prior in A.

    Attributes
    ----------
    information, slope
        A, shape (p, p), and G, shape (p,).
    by_trial, slopes
        A_t, shape (T, p, p), and s_t, shape (T, p): the trial's differences, and its own clock's and origin's terms.
    """

    information: Floats
    slope: Floats
    by_trial: Floats
    slopes: Floats


def misfit_factors(pulls: Pulls, gradients: Floats, pressing: NDArray[np.bool_]) -> Floats:
    """Return by which factor each parameter's deviation is more than Laplace's, from 1 to `MOST_FACTOR`, shape (m,).

    Parameters
    ----------
    pulls
        Of the fit.
    gradients
        Of the parameters by the coordinates, shape (m, p).
    pressing
        Coordinates that are left out, shape (p,).
    """
    free = ~pressing
    if not free.any():
        return np.ones(len(gradients))
    information, by_trial = pulls.information[np.ix_(free, free)], pulls.by_trial[:, free][:, :, free]
    gradients = gradients[:, free]
    value, axes = np.linalg.eigh(information)
    root = (axes / np.sqrt(value)) @ axes.T
    step = root @ root @ pulls.slope[free]
    leverage, ways = np.linalg.eigh(root @ by_trial @ root)
    weight = np.where(1.0 - leverage > _ALONE, np.maximum(1.0 - leverage, _ALONE) ** -0.5, 0.0)
    centred = (pulls.slopes[:, free] - by_trial @ step) @ root
    moved = np.einsum("tij,tj,tkj,tk->ti", ways, weight, ways, centred) @ root
    found = np.sum((moved @ gradients.T) ** 2, axis=0) + (gradients @ step) ** 2
    said = np.sum((gradients @ root) ** 2, axis=1)
    return np.asarray(np.clip(np.sqrt(found / np.maximum(said, 1e-300)), 1.0, MOST_FACTOR), dtype=np.float64)
