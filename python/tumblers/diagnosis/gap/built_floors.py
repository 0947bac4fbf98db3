"""`BuiltFloors`: floors that were built, kept while there is room, for the search comes back to its best."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence

from .floor import Floor, Sensitivity, build_floor
from .reading import Reader

__all__ = ["BuiltFloors"]

# Bytes of whitening matrices that are kept; their native halves take half of it again.
_MOST_KEPT = 100_000_000


class BuiltFloors:
    """Builds the noise of trials, once for each sensitivity and share of it."""

    def __init__(self) -> None:
        self._known: OrderedDict[tuple[Sensitivity, float], Floor] = OrderedDict()
        self._kept = 0

    def of(
        self, readers: Sequence[Reader], moved: Sequence[Sensitivity], shares: Sequence[float] | None = None
    ) -> tuple[Floor, ...]:
        """Return the noise of each trial.

        Parameters
        ----------
        readers
            Of the dataset's trials.
        moved
            By trial, what moves the path that should not.
        shares
            By trial, how much of these changes of a track counts as noise; all of them if None.
        """
        counted = [1.0] * len(readers) if shares is None else shares
        floors = tuple(self._one(*each) for each in zip(readers, moved, counted, strict=True))
        while self._kept > _MOST_KEPT and len(self._known) > len(floors):
            self._kept -= _size(self._known.popitem(last=False)[1])
        return floors

    def _one(self, reader: Reader, moved: Sensitivity, share: float) -> Floor:
        key = moved, share
        if key in self._known:
            self._known.move_to_end(key)
        else:
            self._known[key] = floor = build_floor(reader, moved, share)
            self._kept += _size(floor)
        return self._known[key]


def _size(floor: Floor) -> int:
    return sum(matrix.nbytes for matrix in floor.whiten.values())
