"""`Claim`: one number or statement of the paper."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import xarray as xr

from .tolerance import Tolerance

__all__ = ["Claim", "Measure"]

Measure = Callable[[xr.Dataset], float | str]


@dataclass(frozen=True, kw_only=True, slots=True)
class Claim:
    """One number or statement of the paper, and how the same is read off a run.

    Attributes
    ----------
    robot
        Which robot it is about.
    quantity
        What is measured, with its unit.
    paper
        The paper's number or words.
    tolerance
        How far ours may lie from it.
    measure
        Reads our value off the result's data; not a number where the data have none.
    note
        What a reader must know, such as that the paper measured it rather than simulated it.
    """

    robot: str
    quantity: str
    paper: float | str
    tolerance: Tolerance
    measure: Measure
    note: str = ""
