"""The results of the paper, one to a file, in the paper's order."""

from __future__ import annotations

from ..paper_result import PaperResult
from .adhesion_on_slope import AdhesionOnSlope
from .aluminium_inclines import AluminiumInclines
from .both_errors import BothErrors
from .draft_only import DraftOnly
from .four_seconds import FourSeconds
from .four_shapes import FourShapes
from .magnetization_only import MagnetizationOnly
from .paper_inclines import PaperInclines
from .shape_inclines import ShapeInclines
from .speed_on_paper import SpeedOnPaper

__all__ = ["RESULTS"]

RESULTS: tuple[PaperResult, ...] = (
    SpeedOnPaper(),
    PaperInclines(),
    AdhesionOnSlope(),
    AluminiumInclines(),
    FourShapes(),
    ShapeInclines(),
    DraftOnly(),
    MagnetizationOnly(),
    BothErrors(),
    FourSeconds(),
)
