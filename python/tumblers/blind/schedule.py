"""Which kind of truth each dataset has: a shuffled deck, so that every effect of the catalogue has its turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..effects.catalogue import CATALOGUE
from .outside import OUTSIDE

__all__ = ["Task", "task"]

_DECK = ("none",) * 4 + ("one",) * 10 + ("two",) * 3 + ("outside",) * 3


@dataclass(frozen=True, slots=True)
class Task:
    """What a dataset is to be about.

    Attributes
    ----------
    kind
        ``none``, ``one``, ``two`` or ``outside``.
    names
        The causes.
    """

    kind: str
    names: tuple[str, ...]


def task(seed: int, index: int) -> Task:
    """Return the task of a dataset, which depends on nothing else.

    Parameters
    ----------
    seed, index
        The seed of all datasets and the number of this one.
    """
    deck, place = divmod(index, len(_DECK))
    kinds = np.random.default_rng([seed, 1, deck]).permutation(_DECK).tolist()
    kind = kinds[place]
    turn = deck * _DECK.count(kind) + kinds[:place].count(kind)
    names = tuple(CATALOGUE)
    if kind == "one":
        return Task(kind, (_turn(names, seed, 2, turn),))
    if kind == "outside":
        return Task(kind, (_turn(tuple(OUTSIDE), seed, 3, turn),))
    if kind == "two":
        pair = np.random.default_rng([seed, 4, turn]).choice(len(names), size=2, replace=False)
        return Task(kind, (names[int(pair[0])], names[int(pair[1])]))
    return Task(kind, ())


def _turn(names: tuple[str, ...], seed: int, stream: int, turn: int) -> str:
    around, place = divmod(turn, len(names))
    return names[int(np.random.default_rng([seed, stream, around]).permutation(len(names))[place])]
