"""What the definition of an effect has to hold."""

from __future__ import annotations

import re
from dataclasses import MISSING, fields
from inspect import isabstract
from typing import get_args

from ..errors import InputError, show
from .base import Effect
from .parameter import Nuisance, Parameter

__all__ = ["check_definition"]

_NAME = re.compile(r"[a-z][a-z0-9_]*")


def check_definition(effect: object) -> type[Effect]:
    """Return a class that is the complete definition of an effect.

    Parameters
    ----------
    effect
        The class.

    Raises
    ------
    InputError
        No subclass of `Effect`, or one whose name, parameters, fields or defaults do not fit together.
    """
    if not (isinstance(effect, type) and issubclass(effect, Effect)):
        raise InputError("effect", show(effect), "a subclass of tumblers.effects.Effect")
    name = getattr(effect, "name", None)
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise InputError(f"{effect.__name__}.name", show(name), "a name in small letters, digits and underscores")
    if isabstract(effect):
        raise InputError(name, "no method `act`", "one that returns the scenario with the effect in it")
    source = getattr(effect, "source", None)
    if not isinstance(source, str):
        raise InputError(
            f"{name}.source", show(source), "where its equation comes from, a paragraph `Source: ...` of the docstring"
        )
    parameters = getattr(effect, "parameters", ())
    if not parameters or not all(isinstance(p, Parameter) for p in parameters):
        raise InputError(f"{name}.parameters", show(parameters), "a tuple of Parameter")
    _check_defaults(effect)
    for p in parameters:
        if not p.low <= p.neutral <= p.high:
            raise InputError(f"{name}.{p.key}", f"a range from {p.low:g} to {p.high:g}", f"one around {p.neutral:g}")
        if p.beyond not in (None, *get_args(Nuisance)):
            raise InputError(f"{name}.{p.key}", f"beyond={show(p.beyond)}", f"one of {', '.join(get_args(Nuisance))}")
    effect()
    return effect


def _check_defaults(effect: type[Effect]) -> None:
    # In a class that lacks the decorator, `fields` shows those of `Effect`: none.
    defaults: dict[str, object] = {}
    for f in fields(effect):
        if f.default is MISSING:
            raise InputError(f"{effect.name}.{f.name}", "no default", "its neutral value")
        if isinstance(f.default, tuple):
            defaults.update((f"{f.name}[{i}]", entry) for i, entry in enumerate(f.default))
        else:
            defaults[f.name] = f.default
    stated = {p.key: p.neutral for p in effect.parameters}
    if list(stated.items()) != list(defaults.items()):
        found = f"the fields {show(defaults)} beside the parameters {show(stated)}"
        raise InputError(
            f"{effect.name}.parameters", found, "the fields in their order, with their defaults as neutral"
        )
