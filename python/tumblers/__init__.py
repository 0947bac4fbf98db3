"""Simulation of tumbling magnetic microrobots.

Examples
--------
>>> import tumblers
>>> run = tumblers.simulate(tumblers.preset_scenario("spiked"))
>>> tumblers.save_netcdf(run, "run.nc")
>>> tumblers.diagnose(tumblers.dataset.load("examples/aluminium_30deg")).verdict
'explained'
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .exports import *  # noqa: F403
    from .exports import __version__ as __version__

# What the command line imports has to pass through here: the public names, and NumPy and xarray with them, wait until
# one of them is asked for.
_ASKED_FOR_BY_PYTHON = ("__all__", "__version__")


if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        if name.startswith("_") and name not in _ASKED_FOR_BY_PYTHON:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        exports = import_module(".exports", __name__)
        names = ["__all__", *exports.__all__]
        if name not in names:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        ready = vars(exports)
        globals().update((public, ready[public]) for public in names if public in ready)
        return globals().setdefault(name, getattr(exports, name))

    def __dir__() -> list[str]:
        return sorted({*globals(), *import_module(".exports", __name__).__all__})


class _Package(ModuleType):
    def __setattr__(self, name: str, value: object) -> None:
        # Importing the submodule `simulate` or `sweep` must not hide the function of that name.
        if not (isinstance(value, ModuleType) and name in ("simulate", "sweep")):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
