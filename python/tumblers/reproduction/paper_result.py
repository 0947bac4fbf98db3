"""`PaperResult`: one result of the paper, its run, its claims and its figure."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import ClassVar

import xarray as xr
from matplotlib.figure import Figure

from ..progress import OnProgress
from .choice import Choices
from .claim import Claim
from .suspect import Suspect

__all__ = ["PaperResult"]


class PaperResult(ABC):
    """One result of the paper.

    Attributes
    ----------
    number, name
        Its number in the paper's order, and its name.
    title
        What it is, in words.
    sets
        The named choices that it is run with, by their names.
    suspects
        The changes of one choice that are tried where a row differs.
    runs
        How many runs it takes under one set of choices, for the progress bar.
    claims
        What the paper says, in the paper's order.
    """

    number: ClassVar[int]
    name: ClassVar[str]
    title: ClassVar[str]
    sets: ClassVar[Mapping[str, Choices]]
    suspects: ClassVar[tuple[Suspect, ...]]
    runs: ClassVar[int]
    claims: ClassVar[tuple[Claim, ...]]

    @property
    def stem(self) -> str:
        """What the names of its files begin with."""
        return f"{self.number:02d}_{self.name}"

    @abstractmethod
    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        """Run the result under some choices.

        Parameters
        ----------
        choices
            What it is run with.
        threads
            Number of threads, 0 for all; the data do not depend on it.
        on_progress
            Told how many of the `runs` are done.

        Raises
        ------
        InputError
            The choices cannot be run.
        SimulationError
            A motion diverged.
        """

    @abstractmethod
    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the result.

        Parameters
        ----------
        data
            What `simulate` returned, by the names of the sets.
        figure
            Empty figure to draw on.
        """
