"""The trial that would best tell apart the effects that are still tied.

For every candidate draws of each hypothesis are simulated. With hypotheses h of probability p(h), the expected
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

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log

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

# Within the lab's ranges; and one beyond.
_WITHIN, _BEYOND = 2, 1
_LEAST_BITS = 0.02
# Two hypotheses of equal odds are told apart by a trial of so much information.
_APART_BITS = 0.1
_MOST_CANDIDATES = 40
# Draws for a first look, for a closer one at some of each kind, and for the last.
_FIRST_DRAWS, _CLOSER_DRAWS = 6, 12
_CLOSER, _LAST = 3, 2
# Noise that is drawn for each.
_NOISES = 32
# A speed that is measured again differs by this share of the way without slip over the time, and a rest by this angle,
# or by what the body still swings.
_REPEATS, _REST_DEG = 0.01, 1.0
# Beyond this many times the speed without slip the robot is gone from the camera's view, no matter how fast.
_GONE = 2.0
_RUNS, _SLIDES, _STAYS, _CLIMBS = -2, -1, 0, 1
_EVENTS = (_RUNS, _SLIDES, _STAYS, _CLIMBS)
# The robot has come to rest in this last share of a static trial.
_REST_SHARE = 0.1
# Shares of the draws that are next to none, and next to all.
_FEW, _MOST = 0.03, 0.97
# What is one point for certain counts as so many draws.
_CERTAIN = 50.0
# A drift is worth a word from this share of the speed.
_DRIFTS = 0.02
# A trial that went wrong says nothing: so often, and its numbers spread by so much more than all draws.
_LAPSE, _WIDE = 0.02, 3.0


@dataclass(frozen=True, eq=False)
class _Said:
    """What one hypothesis says of a candidate.

    Attributes
    ----------
    shares
        Of its different draws, shape (n,), together 1.
    values
        What would be measured with each, shape (n, kinds).
    events
        What happens, shape (n,): `_CLIMBS` on a slope, `_STAYS` in view, `_SLIDES` or `_RUNS` out of it.
    climbs
        The probability that a slope is noted as climbed, shape (n,).
    """

    shares: Floats
    values: Floats
    events: NDArray[np.int8]
    climbs: Floats

    def share(self, event: int) -> float:
        """Return the share of the draws with an event."""
        return float(self.shares[self.events == event].sum())

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Whether the robot stays in view."""
        return np.asarray(self.events >= _STAYS)


@dataclass(frozen=True, eq=False)
class _Foretold:
    """What the hypotheses say of a candidate.

    Attributes
    ----------
    kinds
        Of measurement.
    noise
        One standard deviation of each kind when it is measured, shape (kinds,).
    said
        By hypothesis.
    """

    kinds: tuple[str, ...]
    noise: Floats
    said: tuple[_Said, ...]


def next_trials(
    dataset: Dataset,
    simulator: Simulator,
    hypotheses: Sequence[tuple[tuple[str, ...], Sequence[tuple[Effect, ...]]]],
    seed: int,
    probabilities: Sequence[float] | None = None,
) -> tuple[NextTrial, ...]:
    """Return the trials that would tell hypotheses apart, the best first.

    Up to two, of different kinds, are within the lab's ranges; then comes one beyond them, if that tells more.

    Parameters
    ----------
    dataset
        What the lab did.
    simulator
        Of the same dataset.
    hypotheses
        The names of each one's effects, and draws of the effects themselves; the first is the one that was chosen.
    seed
        Of the noise.
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

    def look(options: Sequence[Candidate], most: int | None) -> list[tuple[float, Candidate, _Foretold]]:
        sets = [Counter(_spread(mine, len(mine) if most is None else most)) for _, mine in hypotheses]
        jobs = [Job(0, effects, edit=option.edit) for option in options for mine in sets for effects in mine]
        paths = iter(simulator.run(jobs))
        out: list[tuple[float, Candidate, _Foretold]] = []
        for option in options:
            run = [[(times, next(paths)) for times in mine.values()] for mine in sets]
            foretold = _foretold(dataset, simulator, option, run)
            if foretold is not None:
                out.append((_information(foretold, weights, seed), option, foretold))
        return sorted(out, key=lambda entry: -entry[0])

    options = candidates(dataset, _MOST_CANDIDATES)
    # A few draws say which trials deserve a closer look; of each kind some, and more slopes near the best.
    closer: dict[Candidate, None] = {}
    for same in _by_kind(look(options, _FIRST_DRAWS)):
        closer |= dict.fromkeys(same[:_CLOSER])
        if same[0].incline_deg != 0.0 and not same[0].outside:
            closer |= dict.fromkeys(same[0].steeper_and_flatter(options))
    last = [option for same in _by_kind(look(list(closer), _CLOSER_DRAWS)) for option in same[:_LAST]]
    chosen: list[tuple[float, Candidate, _Foretold]] = []
    found = [entry for entry in look(last, None) if entry[0] >= _LEAST_BITS]
    for entry in found:
        kinds = [option.kind for _, option, _ in chosen]
        if not entry[1].outside and entry[1].kind not in kinds and len(chosen) < _WITHIN:
            chosen.append(entry)
    most = chosen[0][0] if chosen else 0.0
    chosen += [entry for entry in found if entry[1].outside and entry[0] > most][:_BEYOND]
    names = [names for names, _ in hypotheses]
    return tuple(_proposal(option, foretold, bits, names, seed) for bits, option, foretold in chosen)


def _by_kind(entries: Sequence[tuple[float, Candidate, _Foretold]]) -> list[list[Candidate]]:
    """Return the candidates of each kind within the lab's ranges, and all beyond them, in their order."""
    groups: dict[str, list[Candidate]] = {}
    for _, option, _ in entries:
        groups.setdefault("beyond" if option.outside else option.kind, []).append(option)
    return list(groups.values())


def _spread(draws: Sequence[tuple[Effect, ...]], most: int) -> list[tuple[Effect, ...]]:
    """Return so many draws at most, evenly over all."""
    return [draws[int(k)] for k in np.unique(np.linspace(0, len(draws) - 1, min(most, len(draws))).round())]


def _foretold(
    dataset: Dataset, simulator: Simulator, option: Candidate, run: Sequence[Sequence[tuple[int, Path | None]]]
) -> _Foretold | None:
    """Return what is foretold of a candidate, None where a hypothesis cannot be run at all."""
    time, field = option.duration_s, option.field
    level = 0.0
    if isinstance(field, RotatingField):
        level = simulator.nominal(0).robot.body().hull_perimeter_m * field.frequency_Hz
    swings = 0.0
    said = []
    for mine in run:
        values, events, climbs = [], [], []
        for _, path in mine:
            if path is None:
                continue
            if isinstance(field, RotatingField):
                ends, _ = path.at(np.array([0.0, time]))
                speed, drift = (float(ends[1, k] - ends[0, k]) / time for k in (1, 0))
                chance = exp(-0.5 * climbed(speed / level, True) ** 2)
                up = _CLIMBS if option.incline_deg != 0.0 and chance > 0.5 else _STAYS
                gone = abs(speed) > _GONE * level
                values.append([speed, drift])
                events.append((_SLIDES if speed < 0.0 else _RUNS) if gone else up)
                climbs.append(chance)
            else:
                rest = np.linspace((1.0 - _REST_SHARE) * time, time, 16)
                tilts = np.degrees(tilt_of(body_axis(path.at(rest)[1])))
                values.append([float(np.mean(tilts))])
                events.append(_STAYS)
                climbs.append(0.0)
                swings = max(swings, float(np.std(tilts)))
        if not values:
            return None
        times = np.array([count for count, path in mine if path is not None], dtype=np.float64)
        said.append(_Said(times / times.sum(), np.array(values), np.array(events, dtype=np.int8), np.array(climbs)))
    if isinstance(field, RotatingField):
        noise = np.hypot(np.sqrt(2.0) * dataset.sensor.position_noise_m / time, _REPEATS * level)
        return _Foretold(("mean_speed_m_per_s", "drift_m_per_s"), np.full(2, noise), tuple(said))
    return _Foretold(("tilt_deg",), np.array([np.hypot(_REST_DEG, swings)]), tuple(said))


def _information(foretold: _Foretold, weights: Floats, seed: int) -> float:
    """Return the expected information about which hypothesis is true, bits; see the module."""
    # Few draws may know the events better than the numbers: both understate, and the larger one less.
    return max(0.0, *(_bound(foretold, weights, seed, measured) for measured in (False, True)))


def _bound(foretold: _Foretold, weights: Floats, seed: int, measured: bool) -> float:
    """Return a lower bound of the information from the events, and from what is measured if that counts, bits."""
    rng = np.random.default_rng(seed)
    said, noise = foretold.said, foretold.noise
    count = len({int(event) for one in said for event in one.events})
    total = 0.0
    for place, truth in enumerate(said):
        for event in _EVENTS:
            here = np.flatnonzero(truth.events == event)
            if not len(here):
                continue
            kernels = measured and event >= _STAYS
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


def _kernels(said: _Said, same: NDArray[np.bool_], foretold: _Foretold) -> tuple[Floats, Floats]:
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


def _anything(said: Sequence[_Said], event: int, noise: Floats) -> tuple[Floats, Floats]:
    """Return the centre and the width of a trial that went wrong, shape (1, kinds)."""
    values = np.concatenate([one.values[one.events == event] for one in said])
    return np.mean(values, axis=0)[None, :], np.hypot(noise, _WIDE * np.std(values, axis=0))[None, :]


def _normal(outcome: Floats, centres: Floats, widths: Floats) -> Floats:
    """Return the normal densities of outcomes (n, kinds) around centres (m, kinds), shape (n, m)."""
    scaled = (outcome[:, None, :] - centres) / widths
    size = np.prod(np.sqrt(2.0 * np.pi) * widths, axis=-1)
    return np.asarray(np.exp(-0.5 * np.sum(scaled**2, axis=2)) / size, dtype=np.float64)


def _proposal(
    option: Candidate, foretold: _Foretold, bits: float, names: list[tuple[str, ...]], seed: int
) -> NextTrial:
    labels = [" + ".join(effects) if effects else "the nominal model" for effects in names]
    predictions: dict[str, dict[str, tuple[float, float]]] = {}
    for label, said in zip(labels, foretold.said, strict=True):
        mine: dict[str, tuple[float, float]] = {}
        if option.incline_deg != 0.0:
            mine["climbs"] = _chance(float(said.shares @ said.climbs))
        for event, kind in ((_SLIDES, "slides_away"), (_RUNS, "runs_away")):
            if np.any(said.events == event):
                mine[kind] = _chance(said.share(event))
        if np.any(said.seen):
            shares = said.shares[said.seen] / said.shares[said.seen].sum()
            values = said.values[said.seen]
            mean = shares @ values
            spread = np.sqrt(shares @ (values - mean) ** 2)
            for k, kind in enumerate(foretold.kinds):
                mine[kind] = float(mean[k]), float(np.hypot(spread[k], foretold.noise[k]))
        predictions[label] = mine
    return NextTrial(
        why=_why(option, foretold, labels, seed),
        trial=option.table(),
        information_bits=bits,
        predictions=predictions,
        within_ranges=not option.outside,
    )


def _chance(chance: float) -> tuple[float, float]:
    chance = min(max(chance, 0.0), 1.0)
    return chance, float((chance * (1.0 - chance)) ** 0.5)


def _why(option: Candidate, foretold: _Foretold, labels: list[str], seed: int) -> str:
    """Return from which others a trial tells the chosen one, from which not, and what each of them says of it.

    Where it is told from none, the pair of others that is told apart best.
    """
    apart: dict[tuple[int, int], float] = {}
    for a in range(len(labels)):
        for b in range(a + 1, len(labels)):
            pair = _Foretold(foretold.kinds, foretold.noise, (foretold.said[a], foretold.said[b]))
            apart[a, b] = _information(pair, np.array([0.5, 0.5]), seed)
    told = [pair for pair in apart if pair[0] == 0 and apart[pair] >= _APART_BITS]
    told = told or [max(apart, key=lambda pair: apart[pair])]
    first = told[0][0]
    separates = _listed([f"{labels[b]} ({apart[a, b]:.2f} bit)" for a, b in told])
    alike = [labels[b] for b in range(1, len(labels)) if (0, b) not in told]
    whom = "hardly" if first == 0 else f"hardly {labels[0]}"
    hardly = f", {whom} from {_listed(alike)}" if alike else ""
    beyond = f" (beyond what was done so far in {_listed(list(option.outside))})" if option.outside else ""
    says = [f"{labels[k]} {_says(option, foretold.said[k])}" for k in (first, *(b for _, b in told))]
    return f"separates {labels[first]} from {separates}{hardly}{beyond}: {'; '.join(says)}"


def _says(option: Candidate, said: _Said) -> str:
    if said.values.shape[1] == 1:
        return f"comes to rest at {_range(said.values[:, 0], said.shares)}°"
    stays = "does not climb, at" if option.incline_deg != 0.0 else "goes"
    parts = []
    for event, words in ((_CLIMBS, "climbs"), (_STAYS, stays), (_SLIDES, "slides away"), (_RUNS, "runs away")):
        share, which = said.share(event), said.events == event
        if share < _FEW:
            continue
        if event >= _STAYS:
            speed, drift = (1e3 * said.values[which, k] for k in range(2))
            words += f" {_range(speed, said.shares[which])} mm/s"
            if np.max(np.abs(drift)) > _DRIFTS * np.max(np.abs(speed)):
                words += f" with {_range(drift, said.shares[which])} mm/s along x"
        parts.append(words if share > _MOST else f"{words} ({100.0 * share:.0f} %)")
    return " or ".join(parts)


def _range(values: Floats, shares: Floats) -> str:
    """Return what nine tenths of the draws lie between."""
    order = np.argsort(values)
    below = (np.cumsum(shares[order]) - 0.5 * shares[order]) / shares.sum()
    # Adding zero takes the sign off a zero.
    low, high = (f"{round(float(np.interp(q, below, values[order])), 4) + 0.0:.3g}" for q in (0.05, 0.95))
    return low if low == high else f"{low} to {high}"


def _listed(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
