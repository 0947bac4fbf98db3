"""``tumblers`` on the command line."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path
from time import perf_counter
from typing import Annotated, Any, NoReturn

import typer
import typer.main
import xarray as xr
from typer.exceptions import TyperException

from .atomic import atomic_file
from .check import choice
from .errors import InputError, SimulationError
from .field import field_to_table
from .options import PLOT_SUFFIXES, magnetization_cases, numbers, output_file
from .presets import DRIVES, EXPERIMENTS, ROBOTS, SUBSTRATES, preset_scenario
from .scenario import Scenario
from .section import as_section, write_section
from .simulate import simulate as run_scenario
from .summary import run_summary, sweep_summary
from .sweep import sweep as run_sweep
from .version import __version__

__all__ = ["app", "main"]

_INTERRUPTED = 130

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"max_content_width": 120},
)

_ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO.toml", help="Scenario, format tumblers-scenario/1.")]
_Out = Annotated[Path, typer.Option("--out", help="Result, a netCDF file (.nc).")]
_Plot = Annotated[Path | None, typer.Option("--plot", help="Figure (.png, .pdf or .svg).")]


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
    """


@app.command()
def simulate(
    scenario: _ScenarioFile,
    out: _Out,
    plot: _Plot = None,
    solver: Annotated[
        str, typer.Option(help="reduced (fast), or general (the paper's unreduced problem).")
    ] = "reduced",
) -> None:
    """Run one scenario.

    \b
    Examples:
      tumblers simulate slope.toml --out run.nc
      tumblers simulate slope.toml --out run.nc --plot run.png
    """
    _check_outputs(out, plot, scenario)
    choice("--solver", solver, ("reduced", "general"))
    loaded = Scenario.load(scenario)
    start = perf_counter()
    run = run_scenario(loaded, solver, progress=True)  # type: ignore[arg-type]
    seconds = perf_counter() - start
    _write(run, out, plot)
    typer.echo(run_summary(run, seconds))


@app.command()
def sweep(
    robot: Annotated[
        str,
        typer.Option(
            "--robot",
            metavar="NAME|SCENARIO.toml",
            help="spiked, spiked_ends, another experiment of `tumblers presets`, or a scenario file.",
        ),
    ],
    out: _Out,
    drafts: Annotated[str, typer.Option(help="Drafts φ in degrees: 0:15, 0:15:0.5 or 0,1,2.")] = "0:15",
    theta1: Annotated[str, typer.Option(help="Magnetization errors θ1 in degrees; 0 counts once.")] = "0,10",
    theta2: Annotated[
        str, typer.Option(help="Magnetization errors θ2 in degrees, each with each θ1 but 0.")
    ] = "10:360:10",
    jobs: Annotated[int | None, typer.Option(help="Threads; all by default. The result does not depend on it.")] = None,
    plot: _Plot = None,
) -> None:
    """Run a scenario for a grid of drafts and magnetization errors; the paper's 16 × 37 cases by default.

    \b
    Examples:
      tumblers sweep --robot spiked --out sweep.nc --plot sweep.png
      tumblers sweep --robot slope.toml --drafts 0,2,4 --theta1 0,5,10 --theta2 0:350:10 --jobs 4 --out sweep.nc
    """
    file = None if robot in EXPERIMENTS else Path(robot)
    if file is not None and file.suffix != ".toml" and not file.exists():
        raise InputError("--robot", repr(robot), f"{', '.join(EXPERIMENTS)} or a scenario file .toml")
    _check_outputs(out, plot, file)
    if jobs is not None and jobs < 1:
        raise InputError("--jobs", str(jobs), "a whole number of at least 1")
    drafts_deg = numbers("--drafts", drafts)
    cases = magnetization_cases(numbers("--theta1", theta1), numbers("--theta2", theta2))
    scenario = preset_scenario(robot) if file is None else Scenario.load(file)
    start = perf_counter()
    result = run_sweep(scenario, drafts_deg=drafts_deg, magnetization=cases, threads=jobs, progress=True)
    seconds = perf_counter() - start
    errors = result["error"].values.ravel()
    if all(errors):
        raise InputError(None, f"no case that could be run; the first: {errors[0]}", "at least one")
    _write(result, out, plot)
    typer.echo(sweep_summary(result, seconds))


@app.command()
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
        typer.echo(write_section("robot", ROBOTS[name].value.to_table()), nl=False)
    elif name in SUBSTRATES:
        typer.echo(write_section("substrate", as_section(SUBSTRATES[name].value)), nl=False)
    elif name in DRIVES:
        typer.echo(write_section("field", field_to_table(DRIVES[name].value)), nl=False)
    else:
        raise InputError("NAME", repr(name), f"one of {', '.join(key for group in groups.values() for key in group)}")


def _check_outputs(out: Path, plot: Path | None, scenario: Path | None) -> None:
    taken = [] if scenario is None else [scenario]
    output_file("--out", out, (".nc",), taken)
    if plot is not None:
        output_file("--plot", plot, PLOT_SUFFIXES, [*taken, out])


def _write(result: xr.Dataset, out: Path, plot: Path | None) -> None:
    # Both files or none: each is complete before the first takes its name.
    with ExitStack() as files:
        result.to_netcdf(files.enter_context(atomic_file(out)), engine="h5netcdf")
        if plot is not None:
            from .plots import plot_run, plot_sweep

            figure = plot_sweep(result) if "magnetization_case" in result.dims else plot_run(result)
            temporary = files.enter_context(atomic_file(plot))
            figure.savefig(temporary, format=plot.suffix.lower().removeprefix("."), dpi=150)


def _stop(words: str, status: int) -> NoReturn:
    typer.echo(f"tumblers: {' '.join(words.split())}", err=True)
    sys.exit(status)


def main() -> NoReturn:
    """Run the command line: 0 done, 1 failed, 2 bad input, 130 interrupted; one line on standard error but for 0."""
    try:
        status = typer.main.get_command(app).main(prog_name="tumblers", standalone_mode=False)
    except InputError as error:
        _stop(str(error), 2)
    except TyperException as error:
        _stop(error.format_message(), 2)
    except SimulationError as error:
        _stop(str(error), 1)
    except OSError as error:
        _stop(str(error), 1)
    except (KeyboardInterrupt, typer.Abort):
        status = _INTERRUPTED
    if status == _INTERRUPTED:
        _stop("interrupted, nothing was written", _INTERRUPTED)
    sys.exit(status if isinstance(status, int) else 0)
