"""`Scene`: what every picture of a run shows: the body and where it is, the field, gravity, the substrate's height."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, radians, sin
from typing import Self

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from ..errors import InputError, show
from ..field import RotatingField
from ..relief import Relief
from ..scenario import Scenario

__all__ = ["Scene"]

_Floats = NDArray[np.float64]
# Two faces that meet at less than this are parts of one smooth surface, and no line is drawn between them.
_SMOOTH_DEG = 35.0
_NEEDED = {
    "time": ("time",),
    "position_m": ("time", "axis"),
    "orientation": ("time", "wxyz"),
    "contact_mode": ("time",),
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """A run as something to look at; substrate frame, SI units.

    Attributes
    ----------
    faces
        Faces of the real body, counterclockwise from outside, body frame, m, each of shape (k, 3).
    size_m
        Greatest distance of a point of the body from its centre of mass, m.
    time_s, position_m, rotation, mode
        Rows of the run: times, s, shape (n,); the centre of mass, m, (n, 3); body to substrate, (n, 3, 3); the contact
        mode, (n,).
    magnetic_axis
        u, body frame, shape (3,).
    field_T
        B at every row, T, shape (n, 3).
    down
        Unit vector along gravity, shape (3,).
    incline_deg, side_incline_deg
        Slopes along +y and along +x, degrees.
    period_s
        Period of the rotating field, s; None where the field does not rotate.
    relief
        Heights of the substrate.
    """

    faces: tuple[_Floats, ...]
    size_m: float
    time_s: _Floats
    position_m: _Floats
    rotation: _Floats
    mode: NDArray[np.int64]
    magnetic_axis: _Floats
    field_T: _Floats
    down: _Floats
    incline_deg: float
    side_incline_deg: float
    period_s: float | None
    relief: Relief

    @classmethod
    def of(cls, run: xr.Dataset) -> Self:
        """Return the scene of a run, whose body, field and slope are those of its scenario with every effect.

        Parameters
        ----------
        run
            Result of `tumblers.simulate`, or a file that it was saved to.

        Raises
        ------
        InputError
            Something else than a run.
        """
        for name, dims in _NEEDED.items():
            if name not in run.variables or run[name].dims != dims:
                raise InputError("run", f"no variable {name}({', '.join(dims)})", "a run of `tumblers simulate`")
        if "scenario" not in run.attrs:
            raise InputError("run", "no attribute scenario", "a run of `tumblers simulate`, which carries its scenario")
        scenario = Scenario.from_toml(str(run.attrs["scenario"])).effective()
        body, field = scenario.robot.body(), scenario.field.core()
        time = run["time"].values.astype(float)
        if time.size < 2:
            raise InputError("run", f"{time.size} rows", "at least 2")
        position, quaternion = run["position_m"].values.astype(float), run["orientation"].values.astype(float)
        if not (np.diff(time) > 0.0).all():
            raise InputError("run", "times that do not increase", "increasing times")
        if not (np.isfinite(position).all() and np.isfinite(quaternion).all()):
            raise InputError("run", "a pose that is not finite", "finite positions and orientations")
        # g (-sin σ, -sin φ cos σ, -cos φ cos σ)
        slope, side = radians(scenario.run.incline_deg), radians(scenario.run.side_incline_deg)
        return cls(
            faces=tuple(body.outline),
            size_m=body.size_m,
            time_s=time,
            position_m=position,
            rotation=Rotation.from_quat(quaternion, scalar_first=True).as_matrix(),
            mode=run["contact_mode"].values.astype(np.int64),
            magnetic_axis=np.array(scenario.robot.magnetic_axis),
            field_T=np.array([field.at(t) for t in time]),
            down=np.array([-sin(side), -sin(slope) * cos(side), -cos(slope) * cos(side)]),
            incline_deg=scenario.run.incline_deg,
            side_incline_deg=scenario.run.side_incline_deg,
            period_s=1.0 / scenario.field.frequency_Hz if isinstance(scenario.field, RotatingField) else None,
            relief=scenario.relief,
        )

    @property
    def duration_s(self) -> float:
        """Time from the first row to the last, s."""
        return float(self.time_s[-1] - self.time_s[0])

    @property
    def slope(self) -> str:
        """The slope in a few words."""
        along = {"slope": self.incline_deg, "sideways": self.side_incline_deg}
        return ", ".join(f"{word} {angle:g}°" for word, angle in along.items() if angle) or "level"

    def rows(self, times_s: ArrayLike) -> NDArray[np.int64]:
        """Return the rows nearest to some times.

        Parameters
        ----------
        times_s
            Times, s, shape (m,).

        Returns
        -------
        numpy.ndarray
            Their rows, shape (m,).

        Raises
        ------
        InputError
            A time outside the run.
        """
        times = np.asarray(times_s, dtype=float)
        first, last = self.time_s[0], self.time_s[-1]
        slack = 1e-9 * self.duration_s
        for time in times:
            if not first - slack <= time <= last + slack:
                raise InputError("times_s", show(float(time)), f"times from {first:g} to {last:g} s")
        right = np.clip(np.searchsorted(self.time_s, times), 1, self.time_s.size - 1)
        nearer = times - self.time_s[right - 1] < self.time_s[right] - times
        rows: NDArray[np.int64] = (right - nearer).astype(np.int64)
        return rows

    def corners(self, row: int) -> _Floats:
        """Return all corners of the body at a row, substrate frame, m, shape (k, 3)."""
        corners: _Floats = np.concatenate(self.faces) @ self.rotation[row].T + self.position_m[row]
        return corners

    def seen(self, row: int, towards: Sequence[float]) -> Iterator[tuple[_Floats, _Floats, list[_Floats]]]:
        """Give the faces that are turned to an observer, the farthest first.

        Parameters
        ----------
        row
            Row of the run.
        towards
            Unit vector towards the observer, substrate frame.

        Yields
        ------
        tuple
            A face, substrate frame, m, shape (k, 3); its unit normal, shape (3,); and its edges to draw, each of shape
            (2, 3): those where the surface has a crease or turns away from the observer.
        """
        turn, at, view = self.rotation[row], self.position_m[row], np.asarray(towards, dtype=float)
        normals = self.normals @ turn.T
        facing = normals @ view > 1e-9
        placed = [face @ turn.T + at for face in self.faces]
        for i in sorted(np.flatnonzero(facing), key=lambda i: float((placed[i] @ view).mean())):
            face = placed[i]
            edges = [
                np.stack([face[k], face[(k + 1) % len(face)]])
                for k, beside in enumerate(self.neighbours[i])
                if beside is None or not facing[beside]
            ]
            yield face, normals[i], edges

    @cached_property
    def normals(self) -> _Floats:
        """Unit outward normals of the faces, body frame, shape (faces, 3)."""
        # Newell's sum, exact for polygons that are not convex.
        areas = np.array([np.cross(face, np.roll(face, -1, axis=0)).sum(axis=0) for face in self.faces])
        normals: _Floats = areas / np.linalg.norm(areas, axis=1, keepdims=True)
        return normals

    @cached_property
    def neighbours(self) -> tuple[tuple[int | None, ...], ...]:
        """For each edge of each face the face that it runs smoothly into, None at a crease."""
        grain = 1e-6 * self.size_m
        keys = [[tuple(corner) for corner in np.rint(face / grain).astype(int).tolist()] for face in self.faces]
        owner = {(ring[k], ring[(k + 1) % len(ring)]): i for i, ring in enumerate(keys) for k in range(len(ring))}
        smooth = cos(radians(_SMOOTH_DEG))

        def beside(i: int, ring: list[tuple[int, ...]], k: int) -> int | None:
            other = owner.get((ring[(k + 1) % len(ring)], ring[k]))
            return other if other is not None and self.normals[i] @ self.normals[other] > smooth else None

        return tuple(tuple(beside(i, ring, k) for k in range(len(ring))) for i, ring in enumerate(keys))

    def creases(self) -> list[_Floats]:
        """Return the edges where two faces meet at an angle, body frame, m, each of shape (2, 3), each once."""
        ends: dict[tuple[bytes, ...], _Floats] = {}
        for face, besides in zip(self.faces, self.neighbours, strict=True):
            for k, beside in enumerate(besides):
                if beside is None:
                    edge = np.stack([face[k], face[(k + 1) % len(face)]])
                    key = sorted(np.rint(end / (1e-6 * self.size_m)).astype(int).tobytes() for end in edge)
                    ends.setdefault(tuple(key), edge)
        return list(ends.values())

    def height(self, y_m: ArrayLike) -> _Floats:
        """Return the substrate's height h(y), m, of the shape of `y_m`."""
        y, relief = np.asarray(y_m, dtype=float), self.relief
        height = np.zeros_like(y)
        for k, (cosine, sine) in enumerate(zip(relief.cosine_m, relief.sine_m, strict=True), start=1):
            phase = 2.0 * pi * k * y / relief.wavelength_m
            height += cosine * (np.cos(phase) - 1.0) + sine * np.sin(phase)
        return height
