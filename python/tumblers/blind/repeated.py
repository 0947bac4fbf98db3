"""`Repeated`: how long a diagnosis took again with nothing beside it, and whether it was the same."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Repeated"]


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
    """

    seconds: float
    processor_s: float | None
    threads: int
    cores: int | None
    same: bool

    def is_measured_on(self, cores: int) -> bool:
        """Return whether it had so many cores, or no more is known than how long it took.

        Parameters
        ----------
        cores
            At least 1.
        """
        return self._used >= cores or self._used == 1 or self.processor_s is None

    def seconds_on(self, cores: int) -> float:
        """Return how long it takes on so many cores, s, as measured where it had as many.

        W = S + P/n        C = S + P        W' = S + P/n'

        with W on the wall and C of the processors on the n cores that it had, S what runs on one core alone and P what
        runs on all (Amdahl 1967). What ran beside it makes S more.

        Parameters
        ----------
        cores
            n', at least 1.
        """
        if self.is_measured_on(cores) or self.processor_s is None:
            return self.seconds
        shared = max(self.processor_s - self.seconds, 0.0) / (1.0 - 1.0 / self._used)
        return self.seconds - shared * (1.0 / self._used - 1.0 / cores)

    @property
    def _used(self) -> int:
        return self.threads if self.cores is None else min(self.threads, self.cores)
