"""`Repeated`: how long a diagnosis took again with nothing beside it, and whether it was the same."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["TRIALS", "Repeated"]

# Of a dataset whose diagnosis has to be made within a time: more may take longer.
TRIALS = 12


@dataclass(frozen=True, kw_only=True, slots=True)
class Repeated:
    """A diagnosis that was made again.

    Attributes
    ----------
    seconds
        On the wall, s.
    processor_s
        Of all processors together, s; None where it was not noted.
    threads, cores
        Its threads, and how many cores it could use; None where nobody can say.
    same
        Whether it is the same, byte for byte.
    trials
        How many the dataset has.
    """

    seconds: float
    processor_s: float | None
    threads: int
    cores: int | None
    same: bool
    trials: int

    @property
    def is_timed(self) -> bool:
        """Whether its time has to hold: the dataset has no more than `TRIALS` trials."""
        return self.trials <= TRIALS

    def seconds_on(self, cores: int) -> float | None:
        """Return how long it takes on so many cores, s; None where nobody can say.

        W = S + P/n        C = S + P        W' = S + P/n'

        with W on the wall and C of the processors on the n cores that it had, S what runs on one core alone and P what
        runs on all (Amdahl 1967). What ran beside it makes S more; that what runs on n runs on n' as well is taken for
        granted. On n as measured.

        Parameters
        ----------
        cores
            n', at least 1.
        """
        if self.cores is None:
            return None
        used = min(self.threads, self.cores)
        if used == cores:
            return self.seconds
        if used == 1 or self.processor_s is None:
            return None
        shared = min(max(self.processor_s - self.seconds, 0.0) / (1.0 - 1.0 / used), used * self.seconds)
        return self.seconds - shared * (1.0 / used - 1.0 / cores)
