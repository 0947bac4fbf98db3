"""What the page of a run is given: its bodies and poses as plain numbers, millimetres and seconds."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..plots.body import PER_MM
from ..plots.contact import MODE_COLOURS
from ..plots.scene import Scene
from ..plots.style import scenario_words
from ..simulate import CONTACT_MODES

__all__ = ["page_content"]

# Between two of these the page turns and moves the robot evenly; a cycle of the field has so many at least.
_FRAMES_PER_CYCLE = 60
_MOST_FRAMES = 6000
_SPEEDS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
# A turn of the field that the eye can follow.
_CYCLE_S = 2.0


def page_content(run: xr.Dataset) -> dict[str, Any]:
    """Return what the page of a run is given, ready for JSON.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`; the body is that of its scenario with every effect.

    Returns
    -------
    dict
        ``faces`` and ``creases`` (body frame, mm), ``size`` (mm); for every frame ``time`` (s), ``position`` (mm),
        ``orientation`` (x, y, z, w), ``field`` (unit vectors) and ``mode``; ``moment`` (unit vector, body frame),
        ``down``, ``slope`` (words), ``relief`` ([y, height] in mm, empty where the substrate is flat), ``modes`` with
        their ``colours``, ``speeds`` with the first ``speed``, and ``title``.

    Raises
    ------
    InputError
        Something else than a run.
    """
    scene = Scene.of(run)
    rows = _frames(scene)
    strength = np.linalg.norm(scene.field_T[rows], axis=1, keepdims=True)
    quaternion = run["orientation"].values[rows]
    return {
        "title": scenario_words(run.attrs["scenario"]),
        "faces": [_listed(face * PER_MM, 6) for face in scene.faces],
        "creases": [_listed(crease * PER_MM, 6) for crease in scene.creases()],
        "size": scene.size_m * PER_MM,
        "time": _listed(scene.time_s[rows], 7),
        "position": _listed(scene.position_m[rows] * PER_MM, 5),
        "orientation": _listed(quaternion[:, [1, 2, 3, 0]], 5),
        "field": _listed(scene.field_T[rows] / np.where(strength > 0.0, strength, 1.0), 4),
        "mode": scene.mode[rows].tolist(),
        "moment": _listed(scene.magnetic_axis, 6),
        "down": _listed(scene.down, 6),
        "slope": scene.slope,
        "relief": _relief(scene),
        "modes": list(CONTACT_MODES),
        "colours": list(MODE_COLOURS),
        "speeds": list(_SPEEDS),
        "speed": _speed(scene),
    }


def _frames(scene: Scene) -> NDArray[np.int64]:
    cycle = scene.period_s if scene.period_s is not None else scene.duration_s
    wanted = min(max(_FRAMES_PER_CYCLE * scene.duration_s / cycle, 2.0), _MOST_FRAMES)
    stride = max(int((scene.time_s.size - 1) / wanted), 1)
    return np.append(np.arange(0, scene.time_s.size - 1, stride), scene.time_s.size - 1)


def _speed(scene: Scene) -> float:
    cycle = scene.period_s if scene.period_s is not None else scene.duration_s / 5.0
    return max((speed for speed in _SPEEDS if speed <= min(cycle / _CYCLE_S, 1.0)), default=_SPEEDS[0])


def _relief(scene: Scene) -> list[Any]:
    if not scene.relief.cosine_m:
        return []
    y = scene.position_m[:, 1]
    margin = 4.0 * scene.size_m
    step = scene.relief.wavelength_m / len(scene.relief.cosine_m) / 16.0
    places = np.linspace(y.min() - margin, y.max() + margin, min(int((np.ptp(y) + 2.0 * margin) / step) + 2, 4000))
    return _listed(np.stack([places, scene.height(places)], axis=1) * PER_MM, 6)


def _listed(values: NDArray[np.float64], digits: int) -> list[Any]:
    # Adding 0 turns -0 into 0.
    listed: list[Any] = (values.round(digits) + 0.0).tolist()
    return listed
