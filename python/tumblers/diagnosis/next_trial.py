"""The trial that would best tell apart the effects that are still tied.

For every candidate samples of each hypothesis are simulated, and what would be noted of them is a mixture of normal
distributions: the samples', each as wide as the noise and the way to its neighbours. With hypotheses h of probability
p(h), the expected information about which of them is true is

```text
I = Σ_h p(h) ∫ p(o|h) log2 [p(o|h) / Σ_k p(k) p(o|k)] do
```

by a mean over draws of o from every sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, inf, log

import numpy as np
from numpy.typing import NDArray

from ..dataset import Dataset
from ..effects.base import Effect
from ..field import RotatingField
from .candidate import Candidate, candidates
from .pose import Path, body_axis, tilt_of
from .reading import climbed
from .result import NextTrial
from .simulator import Job, Simulator

__all__ = ["next_trials"]

Floats = NDArray[np.float64]

_PROPOSED = 3
_LEAST_BITS = 0.02
_LEAST_CANDIDATES, _MOST_CANDIDATES, _MOST_ROLLOUTS = 30, 90, 450
_FEW, _MOST_SAMPLES, _OF_KIND = 3, 9, 3
_DRAWS = 48
# A speed that is measured again differs by this share of the way without slip over the time, and a rest by this angle,
# or by what the body still swings.
_REPEATS, _REST_DEG = 0.01, 1.0
# Beyond this many times the speed without slip the robot is gone from the camera's view, no matter how fast.
_GONE = 2.0
# The robot has come to rest in this last share of a static trial.
_REST_SHARE = 0.1
# A climb of this probability is a climb.
_SURE = 0.8
# A trial that went wrong says nothing: so often, and its numbers spread by so much more than all samples.
_LAPSE, _WIDE = 0.02, 3.0


@dataclass(frozen=True, eq=False)
class _Foretold:
    """What the hypotheses say of a candidate.

    Attributes
    ----------
    kinds
        Of observation.
    values
        By hypothesis, shape (samples, kinds).
    noise
        One standard deviation of each kind when it is measured, shape (kinds,).
    climbs
        By hypothesis, the mean probability that the robot climbs; none where there is no slope.
    bound
        A size of the first kind at which the robot is gone from view.
    """

    kinds: tuple[str, ...]
    values: list[Floats]
    noise: Floats
    climbs: list[float]
    bound: float = inf


def next_trials(
    dataset: Dataset,
    simulator: Simulator,
    hypotheses: Sequence[tuple[tuple[str, ...], Sequence[tuple[Effect, ...]]]],
    seed: int,
    probabilities: Sequence[float] | None = None,
) -> tuple[NextTrial, ...]:
    """Return up to three trials that would tell hypotheses apart, of different kinds, the best first.

    What is within the lab's ranges comes before what is not, if it tells anything.

    Parameters
    ----------
    dataset
        What the lab did: its ranges are not left, but for a few degrees of slope.
    simulator
        Of the same dataset.
    hypotheses
        The names of each one's effects, and samples of the effects themselves; the first is the one that was chosen.
    seed
        Of the draws.
    probabilities
        Of the hypotheses, not all zero; equal if None.

    Returns
    -------
    tuple
        None where there are no two hypotheses, or where no trial would tell them apart.

    Raises
    ------
    SimulationError
        The native module gave up.
    """
    if len(hypotheses) < 2:
        return ()
    weights = np.ones(len(hypotheses)) if probabilities is None else np.asarray(probabilities, dtype=np.float64)
    weights = weights / weights.sum()

    def look(options: Sequence[Candidate], most: int) -> list[tuple[float, Candidate, _Foretold]]:
        sets = [_spread(mine, most) for _, mine in hypotheses]
        jobs = [Job(0, effects, edit=option.edit) for option in options for mine in sets for effects in mine]
        paths = iter(simulator.run(jobs))
        out: list[tuple[float, Candidate, _Foretold]] = []
        for option in options:
            foretold = _foretold(dataset, simulator, option, [[next(paths) for _ in mine] for mine in sets])
            if foretold is not None:
                rng = np.random.default_rng([seed, len(out)])
                out.append((_information(foretold, weights, rng), option, foretold))
        # What is within the lab's ranges comes first, if it tells anything.
        return sorted(out, key=lambda entry: (entry[1].outside or entry[0] < _LEAST_BITS, -entry[0]))

    count = max(_LEAST_CANDIDATES, _MOST_ROLLOUTS // (_FEW * len(hypotheses)))
    options = candidates(dataset, min(_MOST_CANDIDATES, count))
    # A few samples say which trials deserve a closer look; of each kind some, and more slopes near the best.
    few = look(options, _FEW)
    closer: list[Candidate] = []
    for kind in dict.fromkeys(option.kind for _, option, _ in few):
        same = [option for _, option, _ in few if option.kind == kind]
        closer += same[:_OF_KIND]
        if same[0].incline_deg != 0.0:
            closer += same[0].steeper_and_flatter(options)
    found = look(closer, _MOST_SAMPLES)
    chosen: list[NextTrial] = []
    kinds: set[str] = set()
    names = [names for names, _ in hypotheses]
    for bits, option, foretold in found:
        if len(chosen) == _PROPOSED:
            break
        if bits >= _LEAST_BITS and option.kind not in kinds:
            kinds.add(option.kind)
            chosen.append(_proposal(option, foretold, bits, names, np.random.default_rng([seed, len(options)])))
    return tuple(chosen)


def _spread(samples: Sequence[tuple[Effect, ...]], most: int) -> list[tuple[Effect, ...]]:
    """Return so many samples at most, evenly over all."""
    return [samples[int(k)] for k in np.unique(np.linspace(0, len(samples) - 1, min(most, len(samples))).round())]


def _foretold(
    dataset: Dataset, simulator: Simulator, option: Candidate, paths: list[list[Path | None]]
) -> _Foretold | None:
    """Return what is foretold of a candidate, None where a hypothesis cannot be run at all."""
    time = option.duration_s
    values: list[Floats] = []
    climbs: list[float] = []
    field = option.field
    level, swings = 0.0, 0.0
    if isinstance(field, RotatingField):
        level = simulator.nominal(0).robot.body().hull_perimeter_m * field.frequency_Hz
    for mine in paths:
        rows, chances = [], []
        for path in mine:
            if path is None:
                continue
            if isinstance(field, RotatingField):
                ends, _ = path.at(np.array([0.0, time]))
                speed, drift = (float(ends[1, k] - ends[0, k]) / time for k in (1, 0))
                gone = abs(speed) > _GONE * level
                rows.append([_GONE * level * np.sign(speed), 0.0] if gone else [speed, drift])
                chances.append(exp(-0.5 * climbed(speed / level, True) ** 2))
            else:
                rest = np.linspace((1.0 - _REST_SHARE) * time, time, 16)
                tilts = np.degrees(tilt_of(body_axis(path.at(rest)[1])))
                rows.append([float(np.mean(tilts))])
                swings = max(swings, float(np.std(tilts)))
        if not rows:
            return None
        values.append(np.array(rows))
        if option.incline_deg != 0.0 and chances:
            climbs.append(float(np.mean(chances)))
    if isinstance(field, RotatingField):
        noise = np.hypot(np.sqrt(2.0) * dataset.sensor.position_noise_m / time, _REPEATS * level)
        return _Foretold(("mean_speed_m_per_s", "drift_m_per_s"), values, np.full(2, noise), climbs, _GONE * level)
    return _Foretold(("tilt_deg",), values, np.array([np.hypot(_REST_DEG, swings)]), climbs)


def _widths(foretold: _Foretold, values: Floats) -> Floats:
    """Return how wide each sample's distribution is, shape (n, kinds): the noise, and the way to its neighbours."""
    widths = np.broadcast_to(foretold.noise, values.shape).copy()
    # Robots that are gone from view are alike, and no neighbours of the others.
    seen = np.flatnonzero(np.abs(values[:, 0]) < foretold.bound)
    count = len(seen)
    if count > 1:
        there = values[seen]
        apart = np.sort(np.abs(there[:, None, :] - there[None, :, :]), axis=1)[:, min(2, count - 1), :]
        usual = np.std(there, axis=0, ddof=1) * count**-0.2
        widths[seen] = np.hypot(foretold.noise, np.minimum(apart, usual))
    return widths


def _information(foretold: _Foretold, weights: Floats, rng: np.random.Generator) -> float:
    """Return the expected information about which hypothesis is true, bits."""
    everything = np.concatenate(foretold.values)
    wide = np.hypot(foretold.noise, _WIDE * np.std(everything, axis=0))
    centre = np.mean(everything, axis=0)
    widths = [_widths(foretold, values) for values in foretold.values]
    total = 0.0
    for place, (values, width) in enumerate(zip(foretold.values, widths, strict=True)):
        if weights[place] == 0.0:
            continue
        drawn = values[:, None, :] + width[:, None, :] * rng.standard_normal((len(values), _DRAWS, values.shape[1]))
        lapsed = rng.random(drawn.shape[:2]) < _LAPSE
        elsewhere = centre + wide * rng.standard_normal(drawn.shape)
        outcome = np.where(lapsed[..., None], elsewhere, drawn).reshape(-1, values.shape[1])
        rest = _LAPSE * _density(outcome, centre[None, :], wide[None, :])
        chances = np.array(
            [
                (1.0 - _LAPSE) * _density(outcome, other, spread) + rest
                for other, spread in zip(foretold.values, widths, strict=True)
            ]
        )
        total += float(weights[place] * np.mean(np.log(chances[place] / (weights @ chances)))) / log(2.0)
    return max(total, 0.0)


def _density(outcome: Floats, centres: Floats, widths: Floats) -> Floats:
    """Return the density of a mixture of normal distributions, shape (n,), of outcomes (n, kinds)."""
    scaled = (outcome[:, None, :] - centres) / widths
    each = np.exp(-0.5 * np.sum(scaled**2, axis=2)) / np.prod(widths, axis=-1)
    return np.asarray(np.mean(each, axis=1), dtype=np.float64)


def _proposal(
    option: Candidate, foretold: _Foretold, bits: float, names: list[tuple[str, ...]], rng: np.random.Generator
) -> NextTrial:
    labels = [" + ".join(effects) if effects else "the nominal model" for effects in names]
    # In words: the first hypothesis against the one that is farthest from it.
    apart = [_information(_pair(foretold, 0, b), np.array([0.5, 0.5]), rng) for b in range(1, len(labels))]
    a, b = 0, 1 + int(np.argmax(apart))
    told = [labels[1 + int(k)] for k in np.argsort(apart, kind="stable")[::-1] if apart[k] >= _LEAST_BITS]
    why = (
        f"separates {labels[a]} from {' and '.join(told or [labels[b]])}: {option.words()}, "
        f"{labels[a]} {_says(foretold, a)}, {labels[b]} {_says(foretold, b)}"
    )
    predictions: dict[str, dict[str, tuple[float, float]]] = {}
    for place, label in enumerate(labels):
        mean, spread = np.mean(foretold.values[place], axis=0), np.std(foretold.values[place], axis=0)
        predictions[label] = {
            kind: (float(mean[k]), float(np.hypot(spread[k], foretold.noise[k])))
            for k, kind in enumerate(foretold.kinds)
        }
        if foretold.climbs:
            chance = foretold.climbs[place]
            predictions[label]["climbs"] = chance, (chance * (1.0 - chance)) ** 0.5
    return NextTrial(
        why=why,
        trial=option.table(),
        information_bits=bits,
        predictions=predictions,
        within_ranges=not option.outside,
    )


def _pair(foretold: _Foretold, a: int, b: int) -> _Foretold:
    return _Foretold(foretold.kinds, [foretold.values[a], foretold.values[b]], foretold.noise, [], foretold.bound)


def _says(foretold: _Foretold, place: int) -> str:
    values = foretold.values[place]
    if foretold.kinds == ("tilt_deg",):
        return f"comes to rest at {_range(values[:, 0])}°"
    seen = values[np.abs(values[:, 0]) < foretold.bound]
    speed = f"at {_range(1e3 * seen[:, 0])} mm/s" if len(seen) else "out of view"
    if not foretold.climbs:
        return f"goes {speed} and drifts {_range(1e3 * seen[:, 1])} mm/s along x" if len(seen) else f"goes {speed}"
    chance = foretold.climbs[place]
    if chance < 1.0 - _SURE:
        back = values[values[:, 0] < 0.0]
        gone = bool(len(back)) and float(back[:, 0].min()) <= -foretold.bound
        if not len(back):
            return f"does not climb ({speed})"
        return "slides out of view" if gone else f"slides back at {_range(1e3 * back[:, 0])} mm/s"
    return f"climbs {speed}" if chance > _SURE else f"climbs in {100.0 * chance:.0f} % of the samples ({speed})"


def _range(values: Floats) -> str:
    # Adding zero takes the sign off a zero.
    low, high = (f"{round(float(end), 4) + 0.0:.3g}" for end in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"
