"""`Runs`: an axis's trials with effects in a region, and what the model leaves of all of them."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, log

import numpy as np

from ...progress import OnPhase
from ..gap.comparison import Comparison, Residual
from ..gap.job import Interlude, Job
from ..gap.simulator import rows_per_s
from .onset import CLEAR_LN
from .part_axis import Axis, Tried
from .remainder import left_of

__all__ = ["Runs"]

# Runs of one batch at most, and rows of their paths.
_AT_ONCE, _MOST_ROWS = 256, 1_000_000


class Runs:
    """Runs of an axis's trials.

    Parameters
    ----------
    comparison
        The dataset.
    residual
        How wrong the nominal model is, the sensor's nuisances fitted.
    axis
        What regions are parts of.
    most
        What leaves clearly more than this is of no use.
    tell
        Is told the phase, how much of it is done, and of how much.
    expected
        How many there will be.

    Attributes
    ----------
    known
        C of what was run, or so much of it that it is of no use.
    whole
        That of which all trials were run.
    clear
        What is clear, by C, where the best leaves no more than noise.
    numbers
        That the trials have.
    """

    def __init__(
        self, comparison: Comparison, residual: Residual, axis: Axis, most: float, tell: OnPhase, expected: int
    ) -> None:
        self.comparison, self.residual, self.axis = comparison, residual, axis
        self.known: dict[Tried, float] = {}
        self.whole: set[Tried] = set()
        asked = {(tried.ends, tried.kind) for table in axis.first for tried in table if tried.is_part}
        self.clear = comparison.objective_of(CLEAR_LN + log(max(len(asked), 1)))
        self.numbers = sum(comparison.weighed[trial] for trial in axis.trials)
        self._most, self._tell, self._expected = most, tell, expected
        scenarios = [comparison.simulator.nominal(trial) for trial in axis.trials]
        rows = max(scenario.run.duration_s * rows_per_s(scenario.field) for scenario in scenarios)
        self._at_once = int(np.clip(_MOST_ROWS / rows, 1, _AT_ONCE))

    def cost(self, those: Sequence[Tried]) -> list[float]:
        """Return C with each, or so much of it that it is of no use; infinite if it cannot run.

        Parameters
        ----------
        those
            Effects in regions.
        """
        new = [tried for tried in dict.fromkeys(those) if tried not in self.known]
        phase = f"in which part of the {self.axis.noun} something else acts"
        for first in range(0, len(new), self._at_once):
            self._tell(phase, min(len(self.known), self._expected), self._expected)
            # What leaves more of some trials than another of all is left there: none leaves less than nothing.
            self._run(new[first : first + self._at_once], self._most + self.clear * max(1.0, self._most / self.numbers))
        return [self.known[tried] for tried in those]

    def least_rival(self) -> float:
        """Return the least C of what is no part, all trials run of those that it takes."""
        rivals = [tried for tried in self.known if not tried.is_part]
        while rivals and (best := self.best(rivals)) not in self.whole:
            self._run([best], inf)
        return min((self.known[tried] for tried in rivals), default=inf)

    def _run(self, those: Sequence[Tried], most: float) -> None:
        left, some = dict.fromkeys(those, 0.0), list(those)
        for trial in self.axis.trials:
            some = [tried for tried in some if left[tried] <= most]
            paths = self.comparison.simulator.run([self._job(trial, tried) for tried in some])
            for tried, path in zip(some, paths, strict=True):
                left[tried] += left_of(self.comparison, self.residual, trial, path)
        self.known |= left
        self.whole.update(some)
        self._most = min([self._most, *(left[tried] for tried in some)])

    def best(self, those: Sequence[Tried]) -> Tried:
        """Return that which leaves least, of what was run."""
        return min(those, key=self.known.__getitem__)

    def _job(self, trial: int, tried: Tried) -> Job:
        effects = tried.kind.effects(tried.strength, self.comparison.simulator.nominal(trial))
        if tried.ends is None:
            return Job(trial, effects)
        edges = self.axis.edges(trial, tried.ends)
        return Job(trial, interlude=Interlude(effects, edges)) if edges else Job(trial)
