"""Descriptions of effects for people who look for one: what its docstring says, its numbers, a table to paste."""

from __future__ import annotations

import inspect
from collections.abc import Iterable

from ..section import write_entry
from .base import Effect
from .parameter import Parameter

__all__ = ["describe", "effects_page", "headline"]

# Where the parts of a docstring begin that repeat the parameters.
_PARTS = ("Attributes", "Parameters", "Raises")

_HEAD = """# Effects: what may be missing in a scenario

Written by `tumblers effects --page docs/effects.md` from the catalogue. An effect edits a scenario before it is run, or
is fitted by `tumblers diagnose`, which searches each number over its plausible range. With every number at neutral it
changes nothing, to the bit. Tables to paste stand at neutral: change a number. An effect of your own:
[adding_an_effect.md](adding_an_effect.md).
"""


def headline(effect: type[Effect]) -> str:
    """Return what an effect is, in the first paragraph of its docstring.

    Parameters
    ----------
    effect
        Of the catalogue, or a user's own.
    """
    return " ".join(_said(effect).partition("\n\n")[0].split())


def describe(effect: type[Effect]) -> str:
    """Return what an effect's docstring says, its parameters and a table to paste, as Markdown.

    Parameters
    ----------
    effect
        Of the catalogue, or a user's own.
    """
    rows = "\n".join(_row(p) for p in effect.parameters)
    table = write_entry("effect", effect().to_table())
    return (
        f"## `{effect.name}`\n\n{_said(effect)}\n\n"
        f"| key | what it is | unit | neutral | plausible |\n| --- | --- | --- | --- | --- |\n{rows}\n\n"
        f"```toml\n{table.strip()}\n```\n"
    )


def effects_page(effects: Iterable[type[Effect]]) -> str:
    """Return the page of some effects, as Markdown.

    Parameters
    ----------
    effects
        In the order of the page.
    """
    listed = list(effects)
    index = "\n".join(f"| [`{e.name}`](#{e.name}) | {headline(e)} |" for e in listed)
    return "\n".join([_HEAD, f"| effect | what it is |\n| --- | --- |\n{index}\n", *(describe(e) for e in listed)])


def _said(effect: type[Effect]) -> str:
    """Return a docstring without what it says of the attributes, its equations set apart."""
    text = inspect.cleandoc(effect.__doc__ or "")
    ends = [place for part in _PARTS if (place := text.find(f"\n{part}\n---")) >= 0]
    paragraphs = text[: min(ends, default=len(text))].strip().split("\n\n")
    return "\n\n".join(f"```text\n{p}\n```" if _is_equation(p) else p for p in paragraphs)


def _is_equation(paragraph: str) -> bool:
    """Whether a paragraph is no sentence, but has a sign of equations."""
    return not paragraph.endswith((".", ":")) and any(sign in paragraph for sign in "=≤→")


def _row(p: Parameter) -> str:
    unit = "" if p.unit == "1" else p.unit
    return f"| `{p.key}` | {p.meaning} | {unit} | {p.neutral:g} | {p.low:g} to {p.high:g} |"
