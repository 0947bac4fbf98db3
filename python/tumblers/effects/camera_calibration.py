"""`CameraCalibration`: the track's scale and heading are off."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["CameraCalibration"]


@dataclass(frozen=True, kw_only=True, slots=True)
class CameraCalibration(Effect):
    """The track's scale and heading are off: a gap of the measurement, not of the model.

    (x, y) seen = scale R(heading) (x, y), R the rotation about +z, from +y towards -x

    Both compose with the nominal camera's. The motion itself stays the same, bit for bit. Not modelled: distortion of
    the lens, a camera that looks down at an angle, a time base that is off.

    Source: arithmetic; a ruler read wrongly, a camera turned in its mount.

    Attributes
    ----------
    scale
        Length seen over true length, no unit: 1 is neutral, 0.85 to 1.15 plausible.
    heading_deg
        Degrees: 0 is neutral, -20 to 20 plausible.
    """

    name: ClassVar[str] = "camera_calibration"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="scale", neutral=1.0, low=0.85, high=1.15, unit="1", meaning="length seen over true length", above=0.0
        ),
        Parameter(
            key="heading_deg",
            neutral=0.0,
            low=-20.0,
            high=20.0,
            unit="degrees",
            meaning="angle by which what is seen is turned about +z",
        ),
    )
    scale: float = 1.0
    heading_deg: float = 0.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its camera changed.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        camera = scenario.camera
        return replace(
            scenario,
            camera=replace(camera, scale=camera.scale * self.scale, heading_deg=camera.heading_deg + self.heading_deg),
        )
