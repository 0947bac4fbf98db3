"""`refined`: the best of some contenders, fitted again from points over their whole range.

Where an effect is strong, paths soon have nothing in common any more; their beginnings still have.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...progress import OnPhase
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from .beginnings import MANY, from_beginnings, from_its_own_beginning
from .contender import Contender, likeliest_first

__all__ = ["refined", "to_refine"]


def to_refine(contenders: Sequence[Contender], count: int) -> list[int]:
    """Return the places, of the first so many, of the best one and of those with few parameters.

    Parameters
    ----------
    contenders
        The likeliest first.
    count
        How many are looked at.
    """
    return [k for k, contender in enumerate(contenders[:count]) if k == 0 or contender.free <= MANY]


def refined(
    fitter: Fitter,
    contenders: Sequence[Contender],
    count: int,
    possible: Sequence[Hypothesis],
    seed: int,
    tell: OnPhase,
) -> list[Contender]:
    """Fit the best so many again from points over their whole range; the likeliest first.

    A pair of many parameters that is not the best starts from where it is and from nowhere else; a single such one
    stays.

    Parameters
    ----------
    fitter
        Of the dataset.
    contenders
        The likeliest first.
    count
        How many.
    possible
        Every effect by itself.
    seed
        Of the points over the range.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    made = list(contenders)
    wide = to_refine(made, count)
    for k, contender in enumerate(made[:count]):
        tell("points over the whole range", k, count)
        if k in wide:
            made[k] = from_beginnings(fitter, contender, possible, seed)
        elif len(contender.names) > 1:
            made[k] = from_its_own_beginning(fitter, contender)
    return likeliest_first(made)
