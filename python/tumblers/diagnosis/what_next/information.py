"""How much a trial would tell about which hypothesis is true.

With hypotheses h of probability p(h), the expected
information about which of them is true is

```text
I = Σ_h p(h) E_{o|h} log2 [p(o|h) / Σ_k p(k) p(o|k)]
```

over what would be noted, o: whether the robot climbs, stays or leaves the view, and what is measured if it stays in it.
Each p(o|h) is the share of the draws with that event, times kernels around what is measured with them, the draw that o
itself comes from left out: with any stand-in for p that has not seen o the mean is no more than I (Barber and Agakov
2003), so that few draws understate what a trial tells, and draws of one hypothesis under two names tell nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import log

import numpy as np
from numpy.typing import NDArray

from .foretold import EVENTS, STAYS, Foretold, Said

__all__ = ["information"]

Floats = NDArray[np.float64]

# Noise that is drawn for each.
_NOISES = 32
# What is one point for certain counts as so many draws.
_CERTAIN = 50.0
# A trial that went wrong says nothing: so often, and its numbers spread by so much more than all draws.
_LAPSE, _WIDE = 0.02, 3.0


def information(foretold: Foretold, weights: Floats, seed: int) -> float:
    """Return the expected information about which hypothesis is true, bits; see the module.

    Parameters
    ----------
    foretold
        What the hypotheses say of the trial.
    weights
        Their probabilities, shape (hypotheses,).
    seed
        Of the noise.
    """
    # Few draws may know the events better than the numbers: both understate, and the larger one less.
    return max(0.0, *(_bound(foretold, weights, seed, measured) for measured in (False, True)))


def _bound(foretold: Foretold, weights: Floats, seed: int, measured: bool) -> float:
    """Return a lower bound of the information from the events, and from what is measured if that counts, bits."""
    rng = np.random.default_rng(seed)
    said, noise = foretold.said, foretold.noise
    count = len({int(event) for one in said for event in one.events})
    total = 0.0
    for place, truth in enumerate(said):
        for event in EVENTS:
            here = np.flatnonzero(truth.events == event)
            if not len(here):
                continue
            kernels = measured and event >= STAYS
            drawn = truth.values[here, None, :] + noise * rng.standard_normal((len(here), _NOISES, len(noise)))
            outcome = drawn.reshape(-1, len(noise))
            # Hypotheses by outcomes: the share with this event, the density of what is measured, the number of draws.
            happens, density, trusted = np.empty((3, len(said), len(outcome)))
            for k, one in enumerate(said):
                same = one.events == event
                shares = np.broadcast_to(one.shares, (len(outcome), len(one.shares))).copy()
                # What is one point for certain has nothing that an outcome could have been learnt from.
                if k == place and len(one.shares) > 1:
                    shares[np.arange(len(outcome)), np.repeat(here, _NOISES)] = 0.0
                    shares /= shares.sum(axis=1, keepdims=True)
                trusted[k] = _CERTAIN if len(one.shares) == 1 else 1.0 / np.sum(shares**2, axis=1)
                happens[k] = shares[:, same].sum(axis=1)
                density[k] = happens[k]
                if kernels and same.any():
                    density[k] = np.sum(shares[:, same] * _normal(outcome, *_kernels(one, same, foretold)), axis=1)
            # Few draws show shares to within half a draw of each event (Krichevsky and Trofimov 1981).
            chances = (trusted * happens + 0.5) / (trusted + 0.5 * count)
            if kernels:
                # What they have not shown is as with all hypotheses: that counts as one more draw.
                usual = weights @ density / np.maximum(weights @ happens, 1e-300)
                usual = (1.0 - _LAPSE) * usual + _LAPSE * _normal(outcome, *_anything(said, event, noise))[:, 0]
                own = density / np.maximum(happens, 1e-300)
                shrunk = np.maximum(1.0 / (trusted * happens + 1.0), _LAPSE)
                chances *= (1.0 - shrunk) * own + shrunk * usual
            odds = np.log(chances[place] / (weights @ chances)).reshape(len(here), _NOISES)
            total += float(weights[place] * (truth.shares[here] @ np.mean(odds, axis=1))) / log(2.0)
    return total


def _kernels(said: Said, same: NDArray[np.bool_], foretold: Foretold) -> tuple[Floats, Floats]:
    """Return the centres and widths (n, kinds) of the draws with an event: the noise, and Silverman's rule (1986)."""
    values = said.values[same]
    if len(said.shares) == 1:
        return values, np.broadcast_to(foretold.noise, values.shape)
    event = int(said.events[same][0])
    # One draw alone does not show how far others are.
    others = values if len(values) > 1 else np.concatenate([s.values[s.events == event] for s in foretold.said])
    low, high = np.percentile(others, (25.0, 75.0), axis=0)
    spread = np.minimum(np.std(others, axis=0), (high - low) / 1.34) if len(values) > 3 else np.std(others, axis=0)
    return values, np.broadcast_to(np.hypot(foretold.noise, 0.9 * spread * len(values) ** -0.2), values.shape)


def _anything(said: Sequence[Said], event: int, noise: Floats) -> tuple[Floats, Floats]:
    """Return the centre and the width of a trial that went wrong, shape (1, kinds)."""
    values = np.concatenate([one.values[one.events == event] for one in said])
    return np.mean(values, axis=0)[None, :], np.hypot(noise, _WIDE * np.std(values, axis=0))[None, :]


def _normal(outcome: Floats, centres: Floats, widths: Floats) -> Floats:
    """Return the normal densities of outcomes (n, kinds) around centres (m, kinds), shape (n, m)."""
    scaled = (outcome[:, None, :] - centres) / widths
    size = np.prod(np.sqrt(2.0 * np.pi) * widths, axis=-1)
    return np.asarray(np.exp(-0.5 * np.sum(scaled**2, axis=2)) / size, dtype=np.float64)
