"""Causes of a gap between model and measurement, each an edit of a scenario.

Examples
--------
>>> from tumblers.effects import CATALOGUE
>>> pull = CATALOGUE["stray_field_gradient"](gradient_T_per_m=(0.0, 0.05, 0.0))
>>> pulled = pull.edit(scenario)
"""

from .base import Effect
from .catalogue import CATALOGUE, effects_from_tables, get, load_file, register
from .parameter import Parameter

__all__ = ["CATALOGUE", "Effect", "Parameter", "effects_from_tables", "get", "load_file", "register"]
