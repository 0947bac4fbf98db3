"""The trial that would best tell apart the effects that are still tied.

For every candidate draws of each hypothesis are simulated (`foretold.py`), and the expected information about which of
them is true is computed (`information.py`): a few draws for a first look, all for the last.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...dataset import Dataset
from ...effects.base import Effect
from ..gap.job import Job
from ..gap.simulator import Simulator
from ..quantity import enumerated
from ..result import NextTrial
from .candidate import Candidate, candidates, turned
from .foretold import CLIMBS, RUNS, SLIDES, STAYS, Foretold, Said, foretell
from .information import information

__all__ = ["in_one_step", "next_trials"]

Floats = NDArray[np.float64]

# The names of a hypothesis's effects, and draws of the effects themselves.
Drawn = tuple[tuple[str, ...], Sequence[tuple[Effect, ...]]]

# Within the lab's ranges; and one beyond.
_WITHIN, _BEYOND = 2, 1
_LEAST_BITS = 0.02
# Two hypotheses of equal odds are told apart by a trial of so much information.
_APART_BITS = 0.1
_MOST_CANDIDATES, _MOST_TURNED = 40, 16
# Draws for a first look, for a closer one at some of each kind, and for the last.
_FIRST_DRAWS, _CLOSER_DRAWS = 6, 12
_CLOSER, _LAST = 3, 2
# Shares of the draws that are next to none, and next to all.
_FEW, _MOST = 0.03, 0.97
# A drift is worth a word from this share of the speed.
_DRIFTS = 0.02


def next_trials(
    dataset: Dataset,
    simulator: Simulator,
    hypotheses: Sequence[Drawn],
    seed: int,
    probabilities: Sequence[float] | None = None,
) -> tuple[NextTrial, ...]:
    """Return the trials that would tell hypotheses apart, the best first.

    Up to two, of different kinds, are within the lab's ranges; then comes one beyond them, if that tells more. Where
    none of them tells enough, one is looked for that rolls the robot in another direction.

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

    def look(options: Sequence[Candidate], most: int | None) -> list[tuple[float, Candidate, Foretold]]:
        sets = [Counter(_spread(mine, len(mine) if most is None else most)) for _, mine in hypotheses]
        out: list[tuple[float, Candidate, Foretold]] = []
        for option in options:
            paths = iter(simulator.run([Job(0, effects, edit=option.edit) for mine in sets for effects in mine]))
            run = [[(times, next(paths)) for times in mine.values()] for mine in sets]
            foretold = foretell(dataset, simulator, option, run)
            if foretold is not None:
                out.append((information(foretold, weights, seed), option, foretold))
        return sorted(out, key=lambda entry: -entry[0])

    def telling(options: Sequence[Candidate]) -> list[tuple[float, Candidate, Foretold]]:
        # A few draws say which trials deserve a closer look; of each kind some, and more slopes near the best.
        closer: dict[Candidate, None] = {}
        for same in _by_kind(look(options, _FIRST_DRAWS)):
            closer |= dict.fromkeys(same[:_CLOSER])
            if same[0].incline_deg != 0.0 and not same[0].outside:
                closer |= dict.fromkeys(same[0].steeper_and_flatter(options))
        last = [option for same in _by_kind(look(list(closer), _CLOSER_DRAWS)) for option in same[:_LAST]]
        return [entry for entry in look(last, None) if entry[0] >= _LEAST_BITS]

    found = telling(candidates(dataset, _MOST_CANDIDATES))
    if not found or found[0][0] < _APART_BITS:
        found = sorted([*found, *telling(turned(dataset, _MOST_TURNED))], key=lambda entry: -entry[0])
    chosen: list[tuple[float, Candidate, Foretold]] = []
    for entry in found:
        kinds = [option.kind for _, option, _ in chosen]
        if not entry[1].outside and entry[1].kind not in kinds and len(chosen) < _WITHIN:
            chosen.append(entry)
    most = chosen[0][0] if chosen else 0.0
    chosen += [entry for entry in found if entry[1].outside and entry[0] > most][:_BEYOND]
    names = [names for names, _ in hypotheses]
    return tuple(_proposal(option, foretold, bits, names, seed) for bits, option, foretold in chosen)


def in_one_step(dataset: Dataset, hypotheses: Sequence[Drawn], threads: int = 0) -> Simulator:
    """Return a simulator whose steps are the longest in which all hypotheses can be run.

    In steps of their own, their numerical errors would part them.

    Parameters
    ----------
    dataset
        What the lab did.
    hypotheses
        As for `next_trials`.
    threads
        Of the simulator.
    """
    simulator = Simulator(dataset, threads)
    for _, draws in hypotheses:
        for effects in draws:
            simulator.shorten_steps_for(effects)
    return simulator


def _by_kind(entries: Sequence[tuple[float, Candidate, Foretold]]) -> list[list[Candidate]]:
    """Return the candidates of each kind within the lab's ranges, and all beyond them, in their order."""
    groups: dict[str, list[Candidate]] = {}
    for _, option, _ in entries:
        groups.setdefault("beyond" if option.outside else option.kind, []).append(option)
    return list(groups.values())


def _spread(draws: Sequence[tuple[Effect, ...]], most: int) -> list[tuple[Effect, ...]]:
    """Return so many draws at most, evenly over all."""
    return [draws[int(k)] for k in np.unique(np.linspace(0, len(draws) - 1, min(most, len(draws))).round())]


def _proposal(option: Candidate, foretold: Foretold, bits: float, names: list[tuple[str, ...]], seed: int) -> NextTrial:
    labels = [" + ".join(effects) if effects else "the nominal model" for effects in names]
    predictions: dict[str, dict[str, tuple[float, float]]] = {}
    for label, said in zip(labels, foretold.said, strict=True):
        mine: dict[str, tuple[float, float]] = {}
        if option.incline_deg > 0.0:
            mine["climbs"] = _chance(said.share(CLIMBS))
        for event, kind in ((SLIDES, "slides_away"), (RUNS, "runs_away")):
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


def _why(option: Candidate, foretold: Foretold, labels: list[str], seed: int) -> str:
    """Return from which others a trial tells the chosen one, from which not, and what each of them says of it.

    Where it is told from none, the pair of others that is told apart best.
    """
    apart: dict[tuple[int, int], float] = {}
    for a in range(len(labels)):
        for b in range(a + 1, len(labels)):
            pair = Foretold(foretold.kinds, foretold.noise, (foretold.said[a], foretold.said[b]))
            apart[a, b] = information(pair, np.array([0.5, 0.5]), seed)
    told = [pair for pair in apart if pair[0] == 0 and apart[pair] >= _APART_BITS]
    told = told or [max(apart, key=lambda pair: apart[pair])]
    first = told[0][0]
    separates = enumerated([f"{labels[b]} ({apart[a, b]:.2f} bit)" for a, b in told])
    alike = [labels[b] for b in range(1, len(labels)) if (0, b) not in told]
    whom = "hardly" if first == 0 else f"hardly {labels[0]}"
    hardly = f", {whom} from {enumerated(alike)}" if alike else ""
    beyond = f" (beyond what was done so far in {enumerated(list(option.outside))})" if option.outside else ""
    says = [f"{labels[k]} {_says(option, foretold.said[k])}" for k in (first, *(b for _, b in told))]
    return f"separates {labels[first]} from {separates}{hardly}{beyond}: {'; '.join(says)}"


def _says(option: Candidate, said: Said) -> str:
    if said.values.shape[1] == 1:
        return f"comes to rest at {_range(said.values[:, 0], said.shares)}°"
    stays = "does not climb, at" if option.incline_deg > 0.0 else "goes"
    parts = []
    for event, words in ((CLIMBS, "climbs"), (STAYS, stays), (SLIDES, "slides away"), (RUNS, "runs away")):
        share, which = said.share(event), said.events == event
        if share < _FEW:
            continue
        if event >= STAYS:
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
