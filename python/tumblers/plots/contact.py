"""The contact modes as colours."""

from __future__ import annotations

from matplotlib.patches import Patch

from ..simulate import CONTACT_MODES

__all__ = ["MODE_COLOURS", "mode_patches"]

# Okabe and Ito's, told apart by colour-blind readers: airborne, point, line, surface.
MODE_COLOURS = ("#CC79A7", "#D55E00", "#0072B2", "#009E73")


def mode_patches() -> list[Patch]:
    """Return the entries of a legend of the contact modes."""
    return [Patch(facecolor=colour, label=mode) for colour, mode in zip(MODE_COLOURS, CONTACT_MODES, strict=True)]
