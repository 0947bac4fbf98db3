"""`diagnose`: where model and measurement part, which effect causes it, and how far the gap shrinks with it added."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

from threadpoolctl import threadpool_limits

from ..check import thread_count
from ..dataset import Dataset
from ..effects.base import Effect
from ..effects.catalogue import CATALOGUE, get
from ..errors import InputError, show
from ..progress import OnPhase, phases
from .conclusion import Conclusion
from .diagnosis import Diagnosis
from .gap.comparison import Comparison
from .gap.simulator import Simulator
from .what.attribute import attribute
from .what.height_zero import with_height_zero
from .what.tracked_point import with_tracked_point

__all__ = ["diagnose"]


def diagnose(
    dataset: Dataset,
    *,
    effects: Sequence[str] | None = None,
    jobs: int | None = None,
    seed: int = 0,
    progress: bool | OnPhase = False,
) -> Diagnosis:
    """Diagnose the gap between a lab's measurements and its nominal model.

    Parameters
    ----------
    dataset
        What the lab measured and what it believes.
    effects
        Names of the effects that are considered; the whole catalogue if None.
    jobs
        Threads, all by default. The result does not depend on it.
    seed
        Of everything that is drawn: the same for the same seed.
    progress
        True for a progress bar with the phase's name, or a callback that is told the phase, how much of it is done, and
        of how much.

    Returns
    -------
    Diagnosis
        With its parts as attributes.

    Raises
    ------
    InputError
        An effect or a number that is refused, or a dataset in which nothing was measured.
    EffectError
        An effect of a user's own that fails.
    SimulationError
        The native module gave up.
    """
    if not isinstance(dataset, Dataset):
        raise InputError("dataset", show(dataset), "a Dataset, as tumblers.dataset.load returns it")
    kinds = _kinds(effects)
    if jobs is not None:
        thread_count("jobs", jobs)
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("seed", show(seed), "a whole number of at least 0")
    start = perf_counter()
    # The sums of the linear algebra depend on its threads, and what follows from them would.
    with threadpool_limits(1), phases(progress) as tell:
        read = with_tracked_point(dataset, kinds, jobs or 0, tell)
        tell("simulating the nominal model", 0, 1)
        comparison = Comparison(read, Simulator(read, jobs or 0))
        if comparison.count == 0:
            raise InputError(
                "trial",
                "no measurement in any trial: every frame is lost",
                "at least one measurement",
                dataset.directory,
            )
        attribution = attribute(comparison, kinds, tell, seed)
        free = with_height_zero(comparison, attribution)
        if free is not None:
            comparison = Comparison(free, Simulator(free, jobs or 0))
            attribution = attribute(comparison, kinds, tell, seed)
        return Conclusion(dataset, comparison, attribution, seed, tell).diagnosis(start)


def _kinds(effects: Sequence[str] | None) -> list[type[Effect]]:
    if effects is None:
        return list(CATALOGUE.values())
    if isinstance(effects, str) or not effects:
        raise InputError("effects", show(effects), "a list of names of effects")
    chosen = {get(name) for name in effects}
    # However they were written, the answer is the same.
    return [kind for kind in CATALOGUE.values() if kind in chosen]
