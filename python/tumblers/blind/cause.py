"""`Cause`: why a world is not its model, and in what size."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from ..effects.base import Effect
from ..effects.catalogue import CATALOGUE
from ..robot import Robot
from ..scenario import Scenario
from .forms import FORMS, SHAPES, law_of, scaled
from .law import Law
from .outside import OUTSIDE, Outside

__all__ = ["CatalogueCause", "Cause", "OutsideCause"]

# How often a cause in the catalogue's form varies in the way for which its effect has a parameter. With the third that
# takes another form, in which friction varies too, it does in about half of the worlds.
_VARYING = 0.2


class Cause(ABC):
    """Why a world is not its model.

    Attributes
    ----------
    name, form
        The cause's name, and ``catalogue``, the name of another form, or ``outside``.
    form_seed
        What the details of another form are drawn from; None for the others.
    """

    name: str
    form: str
    form_seed: int | None = None

    @abstractmethod
    def law(self, size: float) -> Law:
        """Return the law of this cause.

        Parameters
        ----------
        size
            Share of the drawn cause, from 0 to 1.
        """

    @abstractmethod
    def parameters(self, size: float) -> dict[str, Any]:
        """Return the cause's numbers at a size."""

    def where(self, size: float) -> dict[str, tuple[float, float]]:  # noqa: ARG002
        """Return the part of the data in which the cause acts, by the axes of a diagnosis; empty if in all."""
        return {}


class CatalogueCause(Cause):
    """An effect of the catalogue.

    Parameters
    ----------
    name
        Its name.
    other_form
        Whether it takes another form than the catalogue's, where there is one.
    scenarios
        Nominal scenarios of the lab, for the effect's ranges.
    rng
        What its parameters are drawn from.
    """

    def __init__(self, name: str, other_form: bool, scenarios: list[Scenario], rng: np.random.Generator) -> None:
        self.name = name
        effect = _draw(CATALOGUE[name], scenarios, rng)
        self.form = "catalogue"
        details = int(rng.integers(2**63))
        if other_form and name in FORMS:
            self.form, self.form_seed = FORMS[name][0], details
            # It varies in its own way.
            values = [p.neutral if p.form else v for p, v in zip(effect.parameters, effect.vector(), strict=True)]
            effect = type(effect).from_vector(values)
        self.effect = effect

    def law(self, size: float) -> Law:
        """Return the law of this effect in its form."""
        # Each size of a cause has the same details.
        return law_of(scaled(self.effect, size), self.form, self.form_seed)

    def parameters(self, size: float) -> dict[str, Any]:
        """Return the effect's parameters by their keys."""
        effect = scaled(self.effect, size)
        return {p.key: value for p, value in zip(effect.parameters, effect.vector(), strict=True)}


class OutsideCause(Cause):
    """A cause that is outside the catalogue.

    Parameters
    ----------
    name
        Its name.
    robot
        The robot that it befalls.
    rng
        What its numbers are drawn from.
    """

    form = "outside"

    def __init__(self, name: str, robot: Robot, rng: np.random.Generator) -> None:
        self.name = name
        self._outside = OUTSIDE[name](rng, robot)

    def law(self, size: float) -> Outside:
        """Return the law of this cause."""
        return self._outside.with_size(size)

    def parameters(self, size: float) -> dict[str, Any]:
        """Return the cause's numbers by name."""
        return self.law(size).parameters()

    def where(self, size: float) -> dict[str, tuple[float, float]]:
        """Return the part of the data in which the cause acts, by the axes of a diagnosis; empty if in all."""
        return dict(self.law(size).where())


def _draw(kind: type[Effect], scenarios: list[Scenario], rng: np.random.Generator) -> Effect:
    """Return an effect of a size that a lab might meet, of which any share may be taken."""
    # Where an effect cannot be at work its range is a point: take the widest.
    ranges = max((kind.ranges(s) for s in scenarios), key=lambda r: sum(high - low for low, high in r))
    free = [i for i, p in enumerate(kind.parameters) if p.key not in SHAPES]
    strong = [i for i in free if not kind.parameters[i].form]
    acting = [i for i in strong if rng.random() < 0.5] or [strong[int(rng.integers(len(strong)))]]
    acting += [i for i in free if i not in strong and rng.random() < _VARYING]
    values = [p.neutral for p in kind.parameters]
    for i, (parameter, (low, high)) in enumerate(zip(kind.parameters, ranges, strict=True)):
        if parameter.key == "theta2_deg":
            values[i] = float(rng.uniform(low, high))
        elif parameter.key == "wavelength_m":
            values[i] = float(np.exp(rng.uniform(np.log(8e-4), np.log(6e-3))))
        elif parameter.key == "frequency_exponent":
            values[i] = float(rng.choice([0.0, rng.uniform(1.0, 3.0)]))
        elif i in acting:
            ends = [end for end in (low, high) if end != parameter.neutral]
            end = ends[int(rng.integers(len(ends)))] if ends else parameter.neutral
            values[i] = parameter.neutral + float(rng.uniform(0.4, 1.0)) * (end - parameter.neutral)
    return kind.from_vector(values)
