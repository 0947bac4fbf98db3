"""What the command line reads from its options."""

from __future__ import annotations

import os
from collections.abc import Sequence
from decimal import Decimal
from itertools import pairwise
from math import floor
from pathlib import Path
from typing import Annotated, Any

import typer

from .atomic import try_to_write
from .check import number
from .errors import InputError, reason, show

__all__ = [
    "PLOT_SUFFIXES",
    "EffectFiles",
    "as_option",
    "load_effect_files",
    "magnetization_cases",
    "numbers",
    "output_file",
    "path_argument",
    "path_option",
]

PLOT_SUFFIXES = (".png", ".pdf", ".svg")
EffectFiles = Annotated[
    list[str] | None,
    typer.Option(
        "--effects",
        metavar="FILE.py,..",
        help="Files with effects of your own, which the scenario's [[effect]] may then name.",
    ),
]

_MOST = 100_000
# As typer shows the type of a path.
_PATH = "<path>"
_EXPECTED = "numbers such as 0,1,2 or a range such as 0:15 or 10:360:10"


def numbers(option: str, text: str) -> list[float]:
    """Return the numbers of ``0,1,2``, ``0:15`` (both ends, step 1) or ``10:360:10``, or a mixture."""
    found: list[float] = []
    for part in text.split(","):
        bounds = [_number(option, text, word) for word in part.split(":")]
        if len(bounds) == 1:
            found += bounds
            continue
        first, last, step = [*bounds, 1.0] if len(bounds) == 2 else bounds if len(bounds) == 3 else [0.0, 0.0, 0.0]
        if step <= 0.0 or last < first or (last - first) / step > _MOST:
            raise InputError(option, repr(text), _EXPECTED)
        count = floor((last - first) / step * (1.0 + 1e-12) + 1e-9) + 1
        # In decimals, as they were typed: -0.3:0.3:0.1 goes through 0, and not a rounding beside it.
        exact = [Decimal(repr(bound)) for bound in (first, step)]
        found += [float(exact[0] + i * exact[1]) for i in range(count)]
    return found


def as_option(values: Sequence[float]) -> str:
    """Return the text that `numbers` reads as these values: a range where they are evenly spaced."""
    words = [f"{value:g}" for value in values]
    steps = {after - before for before, after in pairwise(values)}
    if len(values) < 3 or len(steps) != 1:
        return ",".join(words)
    step = steps.pop()
    return ":".join([words[0], words[-1], *([] if step == 1.0 else [f"{step:g}"])])


def _number(option: str, text: str, word: str) -> float:
    try:
        return number(option, float(word))
    except ValueError:
        raise InputError(option, repr(text), _EXPECTED) from None


def magnetization_cases(theta1: Sequence[float], theta2: Sequence[float]) -> list[tuple[float, float]]:
    """Return each θ1 with each θ2, degrees; θ1 = 0 once, since θ2 has no meaning there."""
    return [pair for first in theta1 for pair in ([(first, t) for t in theta2] if first != 0.0 else [(0.0, 0.0)])]


def load_effect_files(texts: Sequence[str] | None) -> None:
    """Register the effects of files, each text one file or several with commas between."""
    if not texts:
        return
    from .effects.catalogue import load_file

    for word in (word.strip() for text in texts for word in text.split(",")):
        if not word.endswith(".py"):
            raise InputError("--effects", repr(word), "a Python file with effects, .py")
        load_file(word)


def path_option(name: str, help: str) -> Any:  # noqa: A002
    """Return an option that is a path, and not an empty one, which would be the current folder."""
    return typer.Option(name, parser=_path, metavar=_PATH, help=help)


def path_argument(metavar: str, help: str) -> Any:  # noqa: A002
    """Return an argument that is a path, and not an empty one."""
    return typer.Argument(parser=_path, metavar=metavar, help=help)


def _path(text: str) -> Path:
    if not text:
        raise typer.BadParameter("found '', expected a path")
    return Path(text)


def output_file(option: str, path: Path, suffixes: Sequence[str], taken: Sequence[Path]) -> None:
    """Refuse a file that could not be written in the end, before anything is computed."""
    if path.suffix.lower() not in suffixes:
        raise InputError(option, f"'{path}'", f"a file name that ends in {' or '.join(suffixes)}")
    try:
        _check_file(option, path, taken)
        try_to_write(path)
    except OSError as error:
        raise InputError(option, f"{show(str(path))}: {reason(error)}", "a file that can be written") from None


def _check_file(option: str, path: Path, taken: Sequence[Path]) -> None:
    if path.is_dir():
        raise InputError(option, f"the folder '{path}'", "a file")
    if not path.parent.is_dir():
        raise InputError(option, f"'{path}'", f"a file in a folder that exists, '{path.parent}' does not")
    # `realpath` of a link to itself is no error before something is opened.
    if any(os.path.realpath(path) == os.path.realpath(other) for other in taken):
        raise InputError(option, f"'{path}'", "a file that is not named twice")
