"""The commands of ``tumblers``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any

import typer
import typer.main
from typer.exceptions import TyperException

from .blind.commands import blind_app
from .check import choice, thread_count
from .diagnose_command import diagnose
from .effects_command import effects
from .errors import InputError, SimulationError, TumblersError
from .field import field_to_table
from .grid import PAPER_DRAFTS_DEG, PAPER_MAGNETIZATION_DEG
from .options import (
    PLOT_SUFFIXES,
    EffectFiles,
    as_option,
    load_effect_files,
    magnetization_cases,
    numbers,
    output_file,
    path_argument,
    path_option,
)
from .parts import Parts, parts_beside
from .presets import DRIVES, EXPERIMENTS, ROBOTS, SUBSTRATES, preset_scenario
from .reproduce_command import reproduce
from .scenario import Scenario
from .section import as_section, write_section
from .studies.commands import climb, convergence, design, tolerance
from .studies.options import as_options
from .version import __version__
from .view_command import AnimateOption, CycleOption, Pictures, SnapshotsOption, ViewOption, view

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["app", "run"]

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"max_content_width": 120},
)

_ScenarioFile = Annotated[Path, path_argument("SCENARIO.toml", "Scenario, format tumblers-scenario/1.")]
_Out = Annotated[Path, path_option("--out", "Result, a netCDF file (.nc).")]
_Plot = Annotated[Path | None, path_option("--plot", "Figure (.png, .pdf or .svg).")]

_DRAFTS = as_option(PAPER_DRAFTS_DEG)
_THETA1 = as_option(list(dict.fromkeys(theta1 for theta1, _ in PAPER_MAGNETIZATION_DEG)))
_THETA2 = as_option(list(dict.fromkeys(theta2 for theta1, theta2 in PAPER_MAGNETIZATION_DEG if theta1 != 0.0)))


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"tumblers {__version__}")
        raise typer.Exit


@app.callback()
def _tumblers(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Version.")
    ] = False,
) -> None:
    """Simulation of tumbling magnetic microrobots.

    \b
    Examples:
      tumblers presets spiked > spiked.toml
      tumblers simulate spiked.toml --out run.nc --plot run.png
      tumblers sweep --robot spiked --out sweep.nc --plot sweep.png
      tumblers diagnose examples/aluminium_30deg --out diagnosis
    """


def simulate(
    scenario: _ScenarioFile,
    out: _Out,
    plot: _Plot = None,
    snapshots: SnapshotsOption = None,
    cycle: CycleOption = None,
    animate: AnimateOption = None,
    view: ViewOption = None,
    effects: EffectFiles = None,
    solver: Annotated[
        str, typer.Option(help="reduced (fast), or general (the paper's unreduced problem).")
    ] = "reduced",
) -> None:
    """Run one scenario.

    \b
    Examples:
      tumblers simulate slope.toml --out run.nc
      tumblers simulate slope.toml --out run.nc --plot run.png
      tumblers simulate slope.toml --out run.nc --animate run.gif --view run.html
      tumblers simulate turned.toml --effects coil_yaw.py --out run.nc
    """
    _check_outputs(out, plot, scenario)
    pictures = Pictures(snapshots=snapshots, cycle=cycle, animate=animate, view=view)
    pictures.check([scenario, out, *([] if plot is None else [plot])])
    choice("--solver", solver, ("reduced", "general"))
    if str(scenario) in EXPERIMENTS and not scenario.exists():
        raise InputError(None, "no such file", f"what `tumblers presets {scenario} > scenario.toml` writes", scenario)
    load_effect_files(effects)
    loaded = Scenario.load(scenario)
    from .simulate import simulate as run_scenario
    from .summary import run_summary, run_warnings

    start = perf_counter()
    with _of_file(scenario):
        result = run_scenario(loaded, solver, progress=True)  # type: ignore[arg-type]
    seconds = perf_counter() - start
    _write(result, out, plot, pictures)
    typer.echo(run_summary(result, seconds))
    _warn(run_warnings(result))


def sweep(
    robot: Annotated[
        str,
        typer.Option(
            "--robot",
            metavar="NAME|SCENARIO.toml",
            help="spiked, spiked_ends, another experiment or robot of `tumblers presets` (a robot runs on "
            "aluminium_pdms at 20mT_1Hz), or a scenario file.",
        ),
    ],
    out: _Out,
    drafts: Annotated[str, typer.Option(help="Drafts φ in degrees: 0:15, 0:15:0.5 or 0,1,2.")] = _DRAFTS,
    theta1: Annotated[str, typer.Option(help="Magnetization errors θ1 in degrees; 0 counts once.")] = _THETA1,
    theta2: Annotated[str, typer.Option(help="Magnetization errors θ2 in degrees, each with each θ1 but 0.")] = _THETA2,
    jobs: Annotated[int | None, typer.Option(help="Threads; all by default. The result does not depend on it.")] = None,
    plot: _Plot = None,
    effects: EffectFiles = None,
) -> None:
    """Run a scenario for a grid of drafts and magnetization errors; the paper's 16 × 37 cases by default.

    What a long sweep has done is kept in OUT.parts until the whole is written: the same command goes on from there.

    \b
    Examples:
      tumblers sweep --robot spiked --out sweep.nc --plot sweep.png
      tumblers sweep --robot slope.toml --drafts 0,2,4 --theta1 0,5,10 --theta2 0:350:10 --jobs 4 --out sweep.nc
    """
    file = None if robot in EXPERIMENTS or robot in ROBOTS else Path(robot)
    if file is not None and file.suffix != ".toml" and not file.exists():
        raise InputError("--robot", repr(robot), f"{', '.join([*EXPERIMENTS, *ROBOTS])} or a scenario file .toml")
    _check_outputs(out, plot, file)
    if jobs is not None:
        thread_count("--jobs", jobs)
    drafts_deg = numbers("--drafts", drafts)
    load_effect_files(effects)
    cases = magnetization_cases(numbers("--theta1", theta1), numbers("--theta2", theta2))
    if file is not None:
        scenario = Scenario.load(file)
    elif robot in EXPERIMENTS:
        scenario = preset_scenario(robot)
    else:
        scenario = preset_scenario(robot=robot, substrate="aluminium_pdms", drive="20mT_1Hz")
    from .summary import sweep_summary, sweep_warnings
    from .sweep import sweep as run_sweep
    from .sweep import sweep_settings

    start = perf_counter()
    parts = parts_beside(out)
    with as_options():
        kept = Parts(parts, sweep_settings(scenario, drafts_deg, cases))
        with kept.resumable():
            result = run_sweep(
                scenario, drafts_deg=drafts_deg, magnetization=cases, parts=parts, threads=jobs, progress=True
            )
            seconds = perf_counter() - start
            errors = result["error"].values.ravel()
            if all(errors):
                kept.discard()
                # A refusal says what was found; anything else failed on the way.
                refused = all(": found " in error for error in errors)
                raise (TumblersError if refused else SimulationError)(f"no case could be run, the first: {errors[0]}")
            _write(result, out, plot)
    kept.discard()
    typer.echo(sweep_summary(result, seconds))
    _warn(sweep_warnings(result))


def presets(
    name: Annotated[str | None, typer.Argument(help="Preset to print as TOML; all are listed without it.")] = None,
) -> None:
    """List the paper's robots, substrates, drives and experiments, or print one as TOML.

    \b
    Examples:
      tumblers presets
      tumblers presets spiked > spiked.toml
      tumblers presets aluminium
    """
    groups: dict[str, dict[str, Any]] = {
        "experiments": EXPERIMENTS,
        "robots": ROBOTS,
        "substrates": SUBSTRATES,
        "drives": DRIVES,
    }
    if name is None:
        for title, group in groups.items():
            typer.echo(f"{title}:")
            for key, preset in group.items():
                typer.echo(f"  {key:26}{preset.source}")
    elif name in EXPERIMENTS:
        typer.echo(preset_scenario(name).to_toml(), nl=False)
    elif name in ROBOTS:
        _echo_part(name, "robot", ROBOTS[name].value.to_table())
    elif name in SUBSTRATES:
        _echo_part(name, "substrate", as_section(SUBSTRATES[name].value))
    elif name in DRIVES:
        _echo_part(name, "field", field_to_table(DRIVES[name].value))
    else:
        raise InputError("NAME", repr(name), f"one of {', '.join(key for group in groups.values() for key in group)}")


def _echo_part(name: str, section: str, table: dict[str, object]) -> None:
    typer.echo(f"# {name}: the section [{section}] alone, a part of a scenario and not a whole one")
    typer.echo(write_section(section, table), nl=False)


@contextmanager
def _of_file(path: Path) -> Iterator[None]:
    try:
        yield
    except InputError as error:
        raise error.in_file(path) from None


def _check_outputs(out: Path, plot: Path | None, scenario: Path | None) -> None:
    taken = [] if scenario is None else [scenario]
    output_file("--out", out, (".nc",), taken)
    if plot is not None:
        output_file("--plot", plot, PLOT_SUFFIXES, [*taken, out])


def _write(result: xr.Dataset, out: Path, plot: Path | None, pictures: Pictures | None = None) -> None:
    from .atomic import write_files
    from .netcdf import netcdf_bytes

    files: dict[Path, bytes | memoryview] = {out: netcdf_bytes(result)}
    if plot is not None:
        from .plots import figure_bytes

        files[plot] = figure_bytes(result, plot.suffix.lower().removeprefix("."))
    if pictures is not None:
        files |= pictures.files(result)
    write_files(files)


def _warn(warnings: list[str]) -> None:
    for warning in warnings:
        typer.echo(f"tumblers: warning: {warning}", err=True)


def _failed(words: str, status: int) -> int:
    typer.echo(f"tumblers: {' '.join(words.split())}", err=True)
    return status


# In the order in which a newcomer needs them.
for _command, _words in (
    (presets, "List the paper's robots, substrates, drives, experiments."),
    (simulate, "Run one scenario."),
    (sweep, "Run a grid of drafts and magnetization errors."),
    (effects, "List what a scenario may have and a diagnosis looks for."),
    (diagnose, "Say where model and lab part, why, and what to try next."),
    (view, "Draw a saved run: pictures, an animation, a 3-D page."),
    (climb, "Find the greatest slope that a robot climbs."),
    (tolerance, "Find the errors with which a robot still works."),
    (design, "Explore the shapes around a robot."),
    (convergence, "Compute headline numbers for several steps."),
    (reproduce, "Run every result of the paper beside its number."),
):
    app.command(short_help=_words)(_command)
app.add_typer(blind_app, name="blind", short_help="Test the diagnosis on causes that are drawn and sealed.")


def run() -> int:
    """Run the command line and return its status; 130 where it was interrupted, whose line is the caller's."""
    try:
        status = typer.main.get_command(app).main(prog_name="tumblers", standalone_mode=False)
    except TyperException as error:
        return _failed(error.format_message(), 2)
    except (SimulationError, OSError) as error:
        return _failed(str(error), 1)
    except TumblersError as error:
        return _failed(str(error), 2)
    except MemoryError:
        return _failed(
            "not enough memory; fewer rows take less: a longer output_every_s in [run], fewer frames in a dataset", 1
        )
    except typer.Abort:
        raise KeyboardInterrupt from None
    return status if isinstance(status, int) else 0
