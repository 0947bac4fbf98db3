"""`Effect`: what every cause of a gap has in common."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache
from math import inf
from typing import TYPE_CHECKING, Any, ClassVar, Self

from ..check import number, sequence
from ..errors import EffectError, InputError, TumblersError, show
from ..section import known_keys
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["Effect"]

# The paragraph of a docstring that says where the equation comes from.
_SOURCE = re.compile(r"^\s*Source: (.+?)\s*(?:\n\s*\n|\Z)", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True, kw_only=True, slots=True)
class Effect(ABC):
    """A cause of a gap between model and measurement: an edit of a scenario.

    A subclass is a frozen dataclass with slots whose fields are the keys of ``[[effect]]``: floats or tuples of floats,
    whose defaults are neutral. It states `name`, `parameters` (in the order of the fields, a tuple's entries one by
    one) and `act`, and its docstring has a paragraph ``Source: ...``.

    Attributes
    ----------
    name
        Its name in ``[[effect]]``.
    parameters
        Its numbers.
    source
        Where its equation comes from: what the docstring says, unless the class states it itself.
    longest_step_s
        The longest step that resolves it, s; infinite where it makes nothing faster.

    Raises
    ------
    InputError
        A number that is refused.
    """

    name: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    source: ClassVar[str]
    longest_step_s: ClassVar[float] = inf

    @classmethod
    def __init_subclass__(cls, **options: Any) -> None:
        # The decorator with slots makes the class again, by when `super()` without arguments knows another one.
        super(Effect, cls).__init_subclass__(**options)
        stated = _SOURCE.search(cls.__doc__ or "")
        if "source" not in cls.__dict__ and stated is not None:
            cls.source = " ".join(stated[1].split()).removesuffix(".")

    def __post_init__(self) -> None:
        for name, mine in _numbers_of(type(self)):
            object.__setattr__(self, name, self._checked(name, mine))

    def _checked(self, name: str, mine: Sequence[Parameter]) -> float | tuple[float, ...]:
        value = getattr(self, name)
        key = f"{self.name}.{name}"
        if mine[0].key == name:
            return number(key, value, least=mine[0].least, above=mine[0].above)
        expected = f"a list of {len(mine)} numbers"
        found = sequence(key, value, expected, number)
        if len(found) != len(mine):
            raise InputError(key, show(value), expected)
        return tuple(
            number(f"{self.name}.{p.key}", entry, least=p.least, above=p.above)
            for p, entry in zip(mine, found, strict=True)
        )

    @abstractmethod
    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with the effect in it; called where the effect is not neutral.

        Parameters
        ----------
        scenario
            What the effect adds to: factors multiply, offsets add.
        """

    def edit(self, scenario: Scenario) -> Scenario:
        """Return the scenario with the effect in it, and the same object where the effect is neutral.

        Parameters
        ----------
        scenario
            What the effect adds to.

        Raises
        ------
        InputError
            A scenario that the effect cannot be added to.
        EffectError
            An effect whose `act` fails, or returns no scenario.
        """
        if self.is_neutral():
            return scenario
        try:
            changed = self.act(scenario)
        except TumblersError:
            raise
        except Exception as error:
            raise EffectError(f"{self.name}: act failed with {type(error).__name__}: {error}") from error
        if not isinstance(changed, type(scenario)):
            raise EffectError(f"{self.name}: act returned {show(changed)}, expected a scenario")
        return changed

    @property
    def resolving_step_s(self) -> float:
        """The longest step that resolves it as it is, s; infinite where it is neutral."""
        return inf if self.is_neutral() else self.longest_step_s

    def is_neutral(self) -> bool:
        """Whether the effect changes nothing."""
        return self.vector() == _neutral(type(self))

    @classmethod
    def ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:  # noqa: ARG003
        """Return the plausible range of each parameter for a scenario.

        Parameters
        ----------
        scenario
            The nominal scenario. Where the effect cannot be at work in it, the range is the neutral value alone.
        """
        return tuple((p.low, p.high) for p in cls.parameters)

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:
        """Return the points from which a fit starts, in the order of `parameters`, none of them neutral.

        Parameters
        ----------
        scenario
            The nominal scenario. Where the effect cannot be at work in it, there are no points.
        """
        neutral = tuple(p.neutral for p in cls.parameters)
        points = []
        for i, (p, (low, high)) in enumerate(zip(cls.parameters, cls.ranges(scenario), strict=True)):
            # A third of the way to either end, and two thirds as well where there is one end only.
            ends = [end for end in (low, high) if end != neutral[i]]
            shares = (1.0 / 3.0,) if len(ends) == 2 else (1.0 / 3.0, 2.0 / 3.0)
            here = p.to_fit(neutral[i])
            for end in ends:
                for share in shares:
                    value = p.from_fit(here + share * (p.to_fit(end) - here))
                    points.append((*neutral[:i], value, *neutral[i + 1 :]))
        return tuple(points)

    @classmethod
    def close_starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:
        """Return the points from which an effect of many parameters is searched where it is strong: `starts`, or more.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return cls.starts(scenario)

    @classmethod
    def to_fit(cls, values: Sequence[float]) -> tuple[float, ...]:
        """Return the coordinates in which a fit moves: each parameter's own, unless some turn in a circle.

        Parameters
        ----------
        values
            Of the parameters, in their order.
        """
        return tuple(p.to_fit(value) for p, value in zip(cls.parameters, values, strict=True))

    @classmethod
    def from_fit(cls, coordinates: Sequence[float]) -> tuple[float, ...]:
        """Return the values of the parameters at a fit's coordinates.

        Parameters
        ----------
        coordinates
            As many as there are parameters.
        """
        return tuple(p.from_fit(coordinate) for p, coordinate in zip(cls.parameters, coordinates, strict=True))

    @classmethod
    def fit_ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        """Return the range of each of a fit's coordinates.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        ranges = cls.ranges(scenario)
        return tuple((p.to_fit(low), p.to_fit(high)) for p, (low, high) in zip(cls.parameters, ranges, strict=True))

    @classmethod
    def from_vector(cls, values: Sequence[float]) -> Self:
        """Return the effect whose parameters, in their order, have these values.

        Parameters
        ----------
        values
            As many numbers as there are parameters.

        Raises
        ------
        InputError
            Another number of values, or one that is refused.
        """
        if len(values) != len(cls.parameters):
            raise InputError(cls.name, f"{len(values)} values", f"{len(cls.parameters)}")
        entries: dict[str, float | tuple[float, ...]] = {}
        for parameter, value in zip(cls.parameters, values, strict=True):
            if parameter.key == parameter.field:
                entries[parameter.key] = value
            else:
                before = entries.get(parameter.field, ())
                assert isinstance(before, tuple)
                entries[parameter.field] = (*before, value)
        return cls(**entries)

    def vector(self) -> tuple[float, ...]:
        """Return the values of the parameters, in their order."""
        values: list[float] = []
        for name, _ in _numbers_of(type(self)):
            value = getattr(self, name)
            values.extend(value if isinstance(value, tuple) else (value,))
        return tuple(values)

    @classmethod
    def from_table(cls, table: Mapping[str, object], section: str = "effect") -> Self:
        """Return the effect of an ``[[effect]]`` table; a key that is left out is neutral.

        Parameters
        ----------
        table
            ``name`` and the effect's keys.
        section
            The table's place, for errors.

        Raises
        ------
        InputError
            An unknown key, or a value that is refused.
        """
        names = [f.name for f in fields(cls)]
        known_keys(section, table, ["name", *names], ["name"])
        try:
            return cls(**{key: entry for key, entry in table.items() if key in names})
        except InputError as error:
            key = (error.key or "").removeprefix(f"{cls.name}.")
            raise InputError(f"{section}.{key}", error.found, error.expected) from None

    def to_table(self) -> dict[str, object]:
        """Return the ``[[effect]]`` table that `from_table` reads."""
        return {"name": self.name, **{f.name: getattr(self, f.name) for f in fields(self)}}


# A fit makes an effect for each of its points: what is the same for all of a class is looked up once.
@cache
def _numbers_of(kind: type[Effect]) -> tuple[tuple[str, tuple[Parameter, ...]], ...]:
    """Return the names of an effect's fields, each with the parameters that it holds."""
    return tuple((f.name, tuple(p for p in kind.parameters if p.field == f.name)) for f in fields(kind))


@cache
def _neutral(kind: type[Effect]) -> tuple[float, ...]:
    return tuple(p.neutral for p in kind.parameters)
