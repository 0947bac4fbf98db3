"""`Pieces`: of which parts of a run a missing wrench is the same.

Along a run each window has a wrench of its own. Where it turns so fast that such windows are longer than half a cycle,
the phase is lost in them: then each quarter of the cycle has one, the same in all cycles.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

__all__ = ["HALF_A_CYCLE", "Pieces", "along", "at_rest", "within_cycles"]

Floats = NDArray[np.float64]

# Cycles of a window that may still tell the phase.
HALF_A_CYCLE = 0.5 + 1e-9
_QUARTERS = 4


@dataclass(frozen=True, eq=False)
class Pieces:
    """A run in pieces, each of one window.

    Attributes
    ----------
    edges
        Their ends, s, shape (p + 1,).
    window
        The window of each, shape (p,), numbers from 0 without a gap.
    """

    edges: Floats
    window: NDArray[np.intp]

    @property
    def count(self) -> int:
        """Number of windows."""
        return int(self.window.max()) + 1

    @property
    def first(self) -> tuple[Floats, Floats]:
        """Start and end of the first piece of each window, s, shape (k,) each."""
        places = np.array([int(np.argmax(self.window == k)) for k in range(self.count)])
        return self.edges[places], self.edges[places + 1]

    def rows(self, wrench: Floats) -> list[tuple[float, ...]]:
        """Return the wrench of each piece, and none after the last.

        Parameters
        ----------
        wrench
            By window, N and N m, shape (k, 6).
        """
        return [*(tuple(row) for row in wrench[self.window].tolist()), (0.0,) * wrench.shape[1]]


def at_rest(end_s: float, count: int) -> Pieces:
    """Return even windows of a run in a field that does not rotate.

    Parameters
    ----------
    end_s, count
        Its end, s, and their number.
    """
    return Pieces(np.linspace(0.0, end_s, count + 1), np.arange(count))


def along(frequency_Hz: float, end_s: float, most: int) -> Pieces:
    """Return windows along a run: quarter cycles, or whole numbers of them where those would be too many.

    Parameters
    ----------
    frequency_Hz, end_s
        Of the field, Hz, and the run's end, s.
    most
        Number of windows at most.
    """
    quarters = _QUARTERS * frequency_Hz * end_s
    each = max(1, ceil(quarters / most - 1e-9))
    count = max(1, ceil(quarters / each - 0.25))
    edges = np.append(np.arange(count) * each / (_QUARTERS * frequency_Hz), end_s)
    return Pieces(edges, np.arange(count))


def within_cycles(frequency_Hz: float, end_s: float) -> Pieces:
    """Return the quarters of the cycle, each the same in all cycles of a run of one at least.

    Parameters
    ----------
    frequency_Hz, end_s
        Of the field, Hz, and the run's end, s.
    """
    count = ceil(_QUARTERS * frequency_Hz * end_s - 1e-9)
    edges = np.append(np.arange(count) / (_QUARTERS * frequency_Hz), end_s)
    return Pieces(edges, np.arange(count) % _QUARTERS)
