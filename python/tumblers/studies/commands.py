"""The commands ``tumblers climb``, ``tolerance``, ``design`` and ``convergence``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, get_args

import typer

from ..check import choice, number
from ..options import as_option, numbers, path_option
from ..parts import Parts, parts_beside
from ..robot import DraftModel
from .defaults import (
    AXIS_SIGMA_DEG,
    CYCLES,
    DRAFT_MOST_DEG,
    DRAFTS_DEG,
    DRAWS,
    DRIFT_COST,
    E_R_M,
    GENERATIONS,
    RESOLUTION_DEG,
    SAMPLES,
    SETTLING_CYCLES,
    SLOPES_DEG,
    STEPS_S,
    THETA1_DEG,
    THETA2_DEG,
    TORQUES,
)
from .finish import finish, finished_design
from .options import as_options, outputs, prepared, words_of

__all__ = ["climb", "convergence", "design", "tolerance"]

_Robot = Annotated[
    str,
    typer.Option(
        "--robot",
        metavar="NAME|SCENARIO.toml",
        help="An experiment or a robot of `tumblers presets` (a robot runs on aluminium_pdms at 20mT_1Hz where nothing "
        "else is given), or a scenario file.",
    ),
]
_Substrate = Annotated[str | None, typer.Option("--substrate", help="A substrate of `tumblers presets`.")]
_Field = Annotated[str | None, typer.Option("--field", help="A drive of `tumblers presets`.")]
_Out = Annotated[Path, path_option("--out", "Result, a netCDF file (.nc).")]
_Plot = Annotated[Path | None, path_option("--plot", "Figure (.png, .pdf or .svg).")]
_Jobs = Annotated[int | None, typer.Option(help="Threads; all by default. The result does not depend on it.")]


def climb(
    robot: _Robot,
    out: _Out,
    substrate: _Substrate = None,
    field: _Field = None,
    slopes: Annotated[str, typer.Option(help="Slopes of the scan in degrees: 0:85:5 or 0,10,20.")] = as_option(
        SLOPES_DEG
    ),
    resolution: Annotated[float, typer.Option(help="How close the limit is sought, degrees.")] = RESOLUTION_DEG,
    settling: Annotated[int, typer.Option(help="Cycles of the field before measuring starts.")] = SETTLING_CYCLES,
    cycles: Annotated[int, typer.Option(help="Cycles that are measured.")] = CYCLES,
    jobs: _Jobs = None,
    plot: _Plot = None,
) -> None:
    """Find the greatest slope that a robot climbs, with the slope that friction holds beside it.

    \b
    Examples:
      tumblers climb --robot cuboid --substrate paper --field 20mT_1Hz --out climb.nc --plot climb.png
      tumblers climb --robot slope.toml --slopes 0:60:2 --resolution 0.05 --out climb.nc
    """  # noqa: D301 - \b keeps the lines of an example apart
    scenario = prepared(robot, substrate, field, out, plot, jobs)
    slopes_deg = numbers("--slopes", slopes)
    from .climb import climb as run
    from .words import climb_words

    with as_options():
        finish(
            lambda: run(
                scenario,
                slopes_deg=slopes_deg,
                resolution_deg=resolution,
                settling_cycles=settling,
                cycles=cycles,
                threads=jobs,
                progress=True,
            ),
            climb_words,
            out,
            plot,
        )


def tolerance(
    robot: _Robot,
    out: _Out,
    substrate: _Substrate = None,
    field: _Field = None,
    drift_limit_um: Annotated[
        float | None, typer.Option(help="Limit on the drift in a cycle, µm; the paper's 50 without it.")
    ] = None,
    draft_model: Annotated[
        str | None, typer.Option(help="geometric or as_released, instead of the robot's own.")
    ] = None,
    drafts: Annotated[str, typer.Option(help="Drafts φ in degrees, from 0.")] = as_option(DRAFTS_DEG),
    theta1: Annotated[str, typer.Option(help="Magnetization errors θ1 in degrees, from 0.")] = as_option(THETA1_DEG),
    theta2: Annotated[str, typer.Option(help="Magnetization errors θ2 in degrees, with 0.")] = as_option(THETA2_DEG),
    jobs: _Jobs = None,
    plot: _Plot = None,
) -> None:
    """Find the drafts and magnetization errors with which a robot neither flips nor drifts too far.

    \b
    Examples:
      tumblers tolerance --robot spiked --out tolerance.nc --plot tolerance.png
      tumblers tolerance --robot spiked --draft-model as_released --drift-limit-um 80 --out tolerance.nc
    """  # noqa: D301
    scenario = prepared(robot, substrate, field, out, plot, jobs)
    if draft_model is not None:
        choice("--draft-model", draft_model, get_args(DraftModel))
        scenario = replace(scenario, robot=replace(scenario.robot, draft_model=draft_model))  # type: ignore[arg-type]
    grid = {
        "drafts_deg": numbers("--drafts", drafts),
        "theta1_deg": numbers("--theta1", theta1),
        "theta2_deg": numbers("--theta2", theta2),
    }
    from ..sweep import DRIFT_LIMIT_M
    from .tolerance import tolerance as run
    from .words import tolerance_words

    limit_m = DRIFT_LIMIT_M
    if drift_limit_um is not None:
        # In the option's own unit, as it was typed.
        limit_m = 1e-6 * number("--drift-limit-um", drift_limit_um, above=0.0)

    with as_options():
        finish(
            lambda: run(scenario, drift_limit_m=limit_m, **grid, threads=jobs, progress=True),
            tolerance_words,
            out,
            plot,
        )


def design(
    robot: _Robot,
    out: _Out,
    substrate: _Substrate = None,
    field: _Field = None,
    samples: Annotated[int, typer.Option(help="Designs sampled, a power of two.")] = SAMPLES,
    generations: Annotated[int, typer.Option(help="Generations of each search.")] = GENERATIONS,
    draws: Annotated[int, typer.Option(help="Robots drawn with errors for each design, a power of two.")] = DRAWS,
    draft_most: Annotated[float, typer.Option(help="Drafts are uniform from 0 to this, degrees.")] = DRAFT_MOST_DEG,
    axis_sigma: Annotated[
        float, typer.Option(help="Standard deviation of the magnetic axis along each of two directions, degrees.")
    ] = AXIS_SIGMA_DEG,
    drift_cost: Annotated[float, typer.Option(help="Cost of a metre of drift, in metres of way.")] = DRIFT_COST,
    seed: Annotated[int, typer.Option(help="What samples, errors and searches are drawn from.")] = 0,
    jobs: _Jobs = None,
    plot: _Plot = None,
) -> None:
    """Explore the shapes around a robot: the Pareto front, and the best one without and with manufacturing errors.

    What is done is kept in OUT.parts until the whole is written: the same command goes on from there.

    \b
    Examples:
      tumblers design --robot spiked --out design.nc --plot design.png
      tumblers design --robot curved_su8 --substrate aluminium --samples 256 --draft-most 2 --out design.nc
    """  # noqa: D301
    scenario = prepared(robot, substrate, field, out, plot, jobs)
    from .design import design as run
    from .design import design_settings
    from .robust import Errors
    from .words import design_words

    parts = parts_beside(out)
    with as_options():
        errors = Errors(draft_most_deg=draft_most, axis_sigma_deg=axis_sigma, draws=draws, seed=seed)
        given: dict[str, Any] = {
            "samples": samples,
            "generations": generations,
            "errors": errors,
            "drift_cost": drift_cost,
            "seed": seed,
        }
        settings = design_settings(scenario, **given)
        kept = Parts(parts, settings)
        finished = finished_design(out, settings)
        with kept.resumable():
            finish(
                lambda: (
                    finished
                    if finished is not None
                    else run(scenario, **given, parts=parts, threads=jobs, progress=True)
                ),
                design_words,
                out,
                plot,
            )
    kept.discard()


def convergence(
    out: _Out,
    only: Annotated[str, typer.Option(help="Numbers such as speed_10Hz,spiked_drift; all without it.")] = "",
    steps: Annotated[str, typer.Option(help="Steps in seconds.")] = as_option(STEPS_S),
    torques: Annotated[str, typer.Option(help="Times of the torque in a step.")] = ",".join(TORQUES),
    e_r: Annotated[str, typer.Option(help="Third axes of the friction ellipsoid, m.")] = as_option(E_R_M),
    jobs: _Jobs = None,
    plot: _Plot = None,
) -> None:
    """Compute headline numbers for several steps, times of the torque in a step, and e_r.

    \b
    Examples:
      tumblers convergence --out convergence.nc --plot convergence.png
      tumblers convergence --only speed_10Hz,spiked_drift --steps 5e-4,1e-4 --e-r 0.1 --out convergence.nc
    """  # noqa: D301
    outputs(out, plot, None, jobs)
    steps_s, e_r_m = numbers("--steps", steps), numbers("--e-r", e_r)
    from .convergence import convergence as run
    from .words import convergence_words

    with as_options():
        finish(
            lambda: run(
                numbers=words_of(only) or None,
                steps_s=steps_s,
                torques=words_of(torques),
                e_r_m=e_r_m,
                threads=jobs,
                progress=True,
            ),
            convergence_words,
            out,
            plot,
        )
