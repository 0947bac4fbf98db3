"""The named sets of choices that results are run with."""

from __future__ import annotations

from typing import get_args

from ...robot import DraftModel
from ..choice import Choices, ParameterSet

__all__ = ["DRAFTS", "PARAMETERS"]

# Whose numbers of the substrate: the text's or the released code's.
PARAMETERS: dict[str, Choices] = {name: Choices(parameters=name) for name in get_args(ParameterSet)}
# The same with each formula of the draft.
DRAFTS: dict[str, Choices] = {
    f"{name}, {draft}": Choices(parameters=name, draft_model=draft)
    for name in get_args(ParameterSet)
    for draft in get_args(DraftModel)
}
