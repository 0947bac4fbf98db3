"""`CameraCalibration`: the track's scale, heading, origin and clock are off."""

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
    """The track's scale, heading, origin and clock are off: a gap of the measurement, not of the model.

    (x, y) seen at t = scale R(heading) (x, y) at (t + offset) + origin, R the rotation about +z, from +y towards -x

    All compose with the nominal camera's: scales multiply, the others add. They are the same in every trial. The motion
    itself stays the same, bit for bit. Where the sensor's tolerances take origin and clock, a diagnosis leaves them at
    zero here. Not modelled: distortion of the lens, a camera that looks down at an angle, a clock that runs fast.

    Source: arithmetic; a ruler read wrongly, a camera turned in its mount, a corner of the image taken for the robot's
    start, a field that is switched on before the film runs.

    Attributes
    ----------
    scale
        Length seen over true length, no unit: 1 is neutral, 0.85 to 1.15 plausible.
    heading_deg
        Degrees: 0 is neutral, -20 to 20 plausible.
    origin_m
        Where the robot's start is seen, (x, y), m: 0 is neutral, -1e-3 to 1e-3 plausible.
    time_offset_s
        The field's time when the track's clock says 0, s: 0 is neutral, -0.2 to 0.2 plausible.
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
        Parameter(
            key="origin_m[0]",
            neutral=0.0,
            low=-1e-3,
            high=1e-3,
            unit="m",
            meaning="where the start is seen along x",
            beyond="origin x",
        ),
        Parameter(
            key="origin_m[1]",
            neutral=0.0,
            low=-1e-3,
            high=1e-3,
            unit="m",
            meaning="where the start is seen along y",
            beyond="origin y",
        ),
        Parameter(
            key="time_offset_s",
            neutral=0.0,
            low=-0.2,
            high=0.2,
            unit="s",
            meaning="the field's time when the track's clock says 0",
            beyond="clock",
        ),
    )
    scale: float = 1.0
    heading_deg: float = 0.0
    origin_m: tuple[float, float] = (0.0, 0.0)
    time_offset_s: float = 0.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its camera changed.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        camera = scenario.camera
        (x, y), (more_x, more_y) = camera.origin_m, self.origin_m
        changed = replace(
            camera,
            scale=camera.scale * self.scale,
            heading_deg=camera.heading_deg + self.heading_deg,
            origin_m=(x + more_x, y + more_y),
            time_offset_s=camera.time_offset_s + self.time_offset_s,
        )
        return replace(scenario, camera=changed)
