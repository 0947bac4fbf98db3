"""A run as an animation: the robot from the side and from above, in the field."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from ..errors import InputError, SimulationError, show
from ..progress import OnProgress, native_call
from ..simulate import CONTACT_MODES
from .body import PER_MM, SIDE, View, draw_body
from .contact import MODE_COLOURS, mode_patches
from .cycle import draw_gravity, draw_substrate
from .film import FRAMES_PER_SECOND, Film
from .interrupt import interrupt_between
from .scene import Scene
from .style import scenario_words

__all__ = ["ANIMATION_KINDS", "animation_bytes", "check_animation_kind"]

_Floats = NDArray[np.float64]
ANIMATION_KINDS = ("gif", "mp4")
# From above as in the view from the side: y to the right, hence x downwards.
_ALONG = View(1, 0, (0.0, 0.0, 1.0))
_WIDE, _DPI = 9.0, 100
_LEFT_INCHES, _RIGHT_INCHES, _TITLE_INCHES, _GAP_INCHES, _BELOW_INCHES = 0.85, 0.2, 0.75, 0.3, 0.55
_LOWEST, _TALLEST = 0.9, 2.6
# A longer path is followed in a window of this width, in sizes of the robot.
_WINDOW = 14.0
_FIELD, _MOMENT = "#7A3E9D", "#C00000"


def animation_bytes(
    run: xr.Dataset, kind: str, speed: float | None = None, progress: bool | OnProgress = False
) -> bytes:
    """Return an animation of a run as a file's content.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`; the body is that of its scenario with every effect.
    kind
        ``gif``, or ``mp4`` where there is ffmpeg.
    speed
        Time of the run over time of the film; see `Film` for what is taken if None.
    progress
        True for a progress bar over the frames, or a callback that is told how many are done.

    Returns
    -------
    bytes
        The content of the file.

    Raises
    ------
    InputError
        No run, another kind, an mp4 without ffmpeg, or a speed that is not above 0.
    SimulationError
        ffmpeg failed.
    """
    check_animation_kind("kind", kind)
    scene = Scene.of(run)
    film = Film.of(scene, speed)
    stage = _Stage(scene, film, scenario_words(run.attrs["scenario"]))
    writer: AbstractMovieWriter = PillowWriter(fps=FRAMES_PER_SECOND)
    if kind == "mp4":
        # Two pixels of colour are one in yuv420p, which every player shows.
        writer = FFMpegWriter(fps=FRAMES_PER_SECOND, codec="libx264", extra_args=["-pix_fmt", "yuv420p"])
    with tempfile.TemporaryDirectory() as folder, native_call("frames", film.rows.size, progress) as on_progress:
        path = Path(folder) / f"film.{kind}"
        try:
            with interrupt_between() as let_through, writer.saving(stage.figure, str(path), _DPI):
                for done, row in enumerate(film.rows, start=1):
                    stage.show(int(row))
                    writer.grab_frame()
                    let_through()
                    if on_progress is not None:
                        on_progress(done)
            return path.read_bytes()
        except OSError as error:
            if kind == "mp4":
                raise SimulationError(f"ffmpeg failed: {error}") from error
            raise


def check_animation_kind(key: str, kind: str) -> None:
    """Refuse a kind of animation that cannot be written here.

    Parameters
    ----------
    key
        What the kind is the value of, for the error.
    kind
        ``gif`` or ``mp4``.

    Raises
    ------
    InputError
        Another kind, or an mp4 without ffmpeg.
    """
    if kind not in ANIMATION_KINDS:
        raise InputError(key, show(kind), " or ".join(ANIMATION_KINDS))
    if kind == "mp4" and shutil.which("ffmpeg") is None:
        raise InputError(key, "mp4 but no ffmpeg on this machine", "gif, or an installed ffmpeg")


class _Stage:
    """The figure of an animation, and what of it changes from frame to frame."""

    def __init__(self, scene: Scene, film: Film, words: str) -> None:
        self.scene = scene
        self.moving: list[Artist] = []
        corners = [scene.corners(int(row)) for row in film.rows]
        tips = [self._tip(int(row), *arrow) for row in film.rows for arrow in self._arrows(int(row))]
        seen = np.concatenate([*corners, np.stack(tips)]) * PER_MM
        size = scene.size_m * PER_MM
        self.low, self.high = seen.min(axis=0) - 0.2 * size, seen.max(axis=0) + 0.2 * size
        self.width = float(min(self.high[1] - self.low[1], _WINDOW * size))
        inches = _WIDE - _LEFT_INCHES - _RIGHT_INCHES
        tall = [
            float(np.clip((self.high[2] - self.low[2]) * inches / self.width, _LOWEST, _TALLEST)),
            float(np.clip((self.high[0] - self.low[0]) * inches / self.width, _LOWEST, _TALLEST)),
        ]
        if max(tall) >= _TALLEST:
            self.width = max(
                self.width,
                (self.high[2] - self.low[2]) * inches / tall[0],
                (self.high[0] - self.low[0]) * inches / tall[1],
            )
        self.per_inch = self.width / inches
        high = _even(_TITLE_INCHES + tall[0] + _GAP_INCHES + tall[1] + _BELOW_INCHES)
        self.figure = Figure((_WIDE, high), dpi=_DPI)
        self.side = self._axes(_BELOW_INCHES + tall[1] + _GAP_INCHES, tall[0], high)
        self.top = self._axes(_BELOW_INCHES, tall[1], high)
        self.title = self.figure.text(_LEFT_INCHES / _WIDE, 1.0 - 0.28 / high, words, va="center")
        self.clock = self.figure.text(
            1.0 - _RIGHT_INCHES / _WIDE, 1.0 - 0.28 / high, "", va="center", ha="right", family="monospace"
        )
        self.speed = film.speed
        self._dress(tall)

    def _axes(self, bottom: float, tall: float, high: float) -> Axes:
        wide = _WIDE - _LEFT_INCHES - _RIGHT_INCHES
        return self.figure.add_axes((_LEFT_INCHES / _WIDE, bottom / high, wide / _WIDE, tall / high))

    def _dress(self, tall: list[float]) -> None:
        self.side.set_ylim(self.low[2], self.low[2] + tall[0] * self.per_inch)
        middle = 0.5 * (self.low[0] + self.high[0])
        self.top.set_ylim(middle + 0.5 * tall[1] * self.per_inch, middle - 0.5 * tall[1] * self.per_inch)
        self.side.set_ylabel("z (mm)")
        self.side.tick_params(labelbottom=False)
        self.top.set(xlabel="y (mm), direction of travel", ylabel="x (mm)")
        for ax in (self.side, self.top):
            ax.locator_params(axis="y", nbins=4)
            ax.yaxis.set_label_coords(-0.65 / (_WIDE - _LEFT_INCHES - _RIGHT_INCHES), 0.5)
        self.side.set_xlim(self.low[1] - self.width, self.high[1] + self.width)
        draw_substrate(self.side, self.scene)
        draw_gravity(self.side, self.scene, at=(0.05, 0.9), points=24.0)
        arrows = [
            Line2D([], [], color=_FIELD, marker=">", markevery=[1], label="field"),
            Line2D([], [], color=_MOMENT, marker=">", markevery=[1], label="magnetization"),
        ]
        self.side.legend(
            handles=[*mode_patches(), *arrows],
            loc="lower right",
            bbox_to_anchor=(1.0, 1.0),
            ncols=len(CONTACT_MODES) + len(arrows),
            frameon=False,
            fontsize="small",
            borderaxespad=0.1,
            handlelength=1.4,
            columnspacing=1.2,
        )

    def show(self, row: int) -> None:
        """Draw a row of the run."""
        for artist in self.moving:
            artist.remove()
        self.moving.clear()
        scene, colour = self.scene, MODE_COLOURS[self.scene.mode[row]]
        left = self._left(row)
        for ax, view in ((self.side, SIDE), (self.top, _ALONG)):
            ax.set_xlim(left, left + self.width)
            path = scene.position_m[: row + 1] * PER_MM
            (trail,) = ax.plot(path[:, view.across], path[:, view.upward], color="0.25", linewidth=0.8, zorder=1.5)
            body = draw_body(ax, scene, row, view, colour)
            self.moving += [trail, body]
        for (direction, length), colour in zip(self._arrows(row), (_MOMENT, _FIELD), strict=True):
            self.moving.append(self._arrow(row, self._tip(row, direction, length), colour))
        self.clock.set_text(f"t = {scene.time_s[row]:7.4f} s   played at {self.speed:g}×")

    def _arrows(self, row: int) -> tuple[tuple[_Floats, float], ...]:
        """Return direction and length, in sizes of the robot, of the magnetization and of the field."""
        field = self.scene.field_T[row]
        strength = float(np.linalg.norm(field))
        along = field / strength if strength > 0.0 else field
        return (self.scene.rotation[row] @ self.scene.magnetic_axis, 1.1), (along, 1.35)

    def _tip(self, row: int, direction: _Floats, length: float) -> _Floats:
        tip: _Floats = self.scene.position_m[row] + length * self.scene.size_m * direction
        return tip

    def _arrow(self, row: int, tip: _Floats, colour: str) -> Artist:
        centre = self.scene.position_m[row] * PER_MM
        return self.side.annotate(
            "",
            (float(tip[1]) * PER_MM, float(tip[2]) * PER_MM),
            xytext=(float(centre[1]), float(centre[2])),
            arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.4, "shrinkA": 0.0, "shrinkB": 0.0},
            zorder=4.0,
        )

    def _left(self, row: int) -> float:
        low, high = float(self.low[1]), float(self.high[1])
        if high - low <= self.width:
            return 0.5 * (low + high - self.width)
        return float(np.clip(self.scene.position_m[row, 1] * PER_MM - 0.5 * self.width, low, high - self.width))


def _even(inches: float) -> float:
    """Return a height of an even number of pixels, which video asks for."""
    return 2.0 * round(inches * _DPI / 2.0) / _DPI
