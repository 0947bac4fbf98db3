"""Result 5: four shapes on paper."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ...plots.style import BLUE, GREEN, ORANGE
from ...presets import drive
from ...progress import OnProgress
from ...simulate import simulate
from ..choice import Choices, Ground
from ..claim import Claim
from ..paper_result import PaperResult
from ..suspect import STANDARD
from ..tolerance import exact, relative
from .sets import PARAMETERS

__all__ = ["SHAPES", "FourShapes"]

# name in the paper: key of the presets
SHAPES = {
    "cuboid": "cuboid_second_generation",
    "spiked": "spiked_su8",
    "spiked ends": "spiked_ends_su8",
    "curved": "curved_su8",
}
_GROUNDS: tuple[Ground, ...] = ("paper", "aluminium")
_DURATION_S = 1.0
_COLOURS = ("black", BLUE, GREEN, ORANGE)


def _speeds(data: xr.Dataset, ground: str) -> xr.DataArray:
    way = data["y_m"].sel(ground=ground)
    speeds: xr.DataArray = (way.isel(time=-1) - way.isel(time=0)) / _DURATION_S
    return speeds


def _first(ground: str, fastest: bool) -> Callable[[xr.Dataset], str]:
    def measure(data: xr.Dataset) -> str:
        speeds = _speeds(data, ground)
        place = speeds.argmax("shape") if fastest else speeds.argmin("shape")
        return str(data["shape"][int(place)].item())

    return measure


def _spiked_ends_before_cuboid(data: xr.Dataset) -> str:
    speeds = _speeds(data, "paper")
    return "Y" if float(speeds.sel(shape="spiked ends")) > float(speeds.sel(shape="cuboid")) else "N"


def _unlike(data: xr.Dataset) -> float:
    return 1.0 + float(abs(_speeds(data, "aluminium") / _speeds(data, "paper") - 1.0).max())


class FourShapes(PaperResult):
    """Displacement of four shapes at 20 mT and 10 Hz, on paper and on aluminium."""

    number = 5
    name = "four_shapes"
    title = "Four shapes, 20 mT at 10 Hz"
    sets = PARAMETERS
    suspects = STANDARD
    runs = len(SHAPES) * len(_GROUNDS)
    claims = (
        *(
            Claim(
                robot="all four",
                quantity=f"{'fastest' if fastest else 'slowest'} on {ground}",
                paper=shape,
                tolerance=exact("one of four shapes"),
                measure=_first(ground, fastest),
            )
            for ground in _GROUNDS
            for fastest, shape in ((True, "curved"), (False, "cuboid"))
        ),
        Claim(
            robot="all four",
            quantity="speed on aluminium over that on paper, the shape that differs most",
            paper=1.0,
            tolerance=relative(0.1, "'similar': two curves of one figure that part by less than a tenth"),
            measure=_unlike,
        ),
        Claim(
            robot="spiked ends",
            quantity="faster than the cuboid on paper",
            paper="Y",
            tolerance=exact("yes or no"),
            measure=_spiked_ends_before_cuboid,
        ),
    )

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:  # noqa: ARG002
        """Return ``y_m`` (ground, shape, time)."""
        ways, done = [], 0
        for ground in _GROUNDS:
            for robot in SHAPES.values():
                scenario = choices.scenario(
                    robot, ground, drive(0.020, 10.0), duration_s=_DURATION_S, output_every_s=5e-3
                )
                run = simulate(scenario)
                ways.append(run["position_m"].sel(axis="y").values)
                done += 1
                on_progress(done)
        return xr.Dataset(
            {
                "y_m": (
                    ("ground", "shape", "time"),
                    np.array(ways).reshape(len(_GROUNDS), len(SHAPES), -1),
                    {"units": "m"},
                )
            },
            {
                "ground": list(_GROUNDS),
                "shape": list(SHAPES),
                "time": ("time", run["time"].values, {"units": "s"}),
            },
        )

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the displacements along y over time."""
        figure.set_size_inches(10.0, 4.0 * len(data))
        axes = figure.subplots(len(data), len(_GROUNDS), squeeze=False, sharex=True, sharey=True)
        for row, (name, found) in zip(axes, data.items(), strict=True):
            for ax, ground in zip(row, _GROUNDS, strict=True):
                for shape, colour in zip(SHAPES, _COLOURS, strict=True):
                    way = found["y_m"].sel(ground=ground, shape=shape) * 1e3
                    ax.plot(found["time"], way, color=colour, label=f"{shape}: {float(way[-1] - way[0]):.1f} mm")
                ax.set_title(f"{ground}, {name} parameters", loc="left")
                ax.legend(fontsize="small", frameon=False)
            row[0].set_ylabel("displacement along y (mm)")
        for ax in axes[-1]:
            ax.set_xlabel("time (s)")
        figure.suptitle(self.title)
