"""`design`: a family of shapes, its Pareto front, and its best design without and with manufacturing errors."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import differential_evolution
from scipy.stats import qmc

from ..effects.catalogue import sources_of
from ..errors import InputError, show
from ..parts import Parts, numbers_of
from ..progress import OnProgress, native_call
from ..scenario import Scenario
from ..step_choice import with_chosen_step
from ..version import __version__
from .climb import whole_number
from .defaults import DRIFT_COST, GENERATIONS, SAMPLES
from .front import pareto_front
from .native import Native
from .robust import NO_ERROR, Errors, merits, with_errors
from .space import QUANTITIES, DesignSpace

__all__ = ["CANDIDATES", "design", "design_settings"]

Floats = NDArray[np.float64]

CANDIDATES = ("base", "nominal", "robust")
# Designs to a native batch, and to a part on the disk.
_CHUNK = 8
# Best samples that an optimisation starts from.
_POPULATION = 12
# The candidates are compared on robots that no optimisation has seen, so many times as many.
_FRESH = 4
_MOST = 2**16


def design_settings(
    scenario: Scenario, *, samples: int, generations: int, errors: Errors, drift_cost: float, seed: int
) -> dict[str, Any]:
    """Return what the result of `design` depends on, as JSON has it.

    Parameters
    ----------
    scenario, samples, generations, errors, drift_cost, seed
        As for `design`.
    """
    return {
        "study": "design",
        "tumblers_version": __version__,
        "samples": samples,
        "generations": generations,
        "draws": errors.draws,
        "draft_most_deg": errors.draft_most_deg,
        "axis_sigma_deg": errors.axis_sigma_deg,
        "errors_seed": errors.seed,
        "drift_cost": float(drift_cost),
        "seed": seed,
        "scenario": scenario.to_toml(),
        "effect_files": sources_of(scenario.effects),
    }


def design(
    scenario: Scenario,
    *,
    samples: int = SAMPLES,
    generations: int = GENERATIONS,
    errors: Errors | None = None,
    drift_cost: float = DRIFT_COST,
    seed: int = 0,
    parts: str | PathLike[str] | None = None,
    threads: int | None = None,
    progress: bool | OnProgress = False,
) -> xr.Dataset:
    """Explore a family of shapes, and find its best design without errors and over manufacturing errors.

    The free lengths and angles of the base robot's kind (`tumblers.studies.family.family_of`) are sampled by a
    scrambled Sobol sequence. Every sample is run without errors, on slopes, and with the same robots drawn from the
    distribution of errors. The merit of a robot is its way in a second less what its drift costs
    (`tumblers.studies.robust.merits`); a design that the field is too weak to tip over (`tumblers.studies.tipping`) has
    none. Differential evolution from the best samples then looks for the greatest merit without errors, the *nominal*
    design, and, with that one among its start, for the greatest mean merit over the errors, the *robust* one; both and
    the base robot are compared on robots that no search has seen.

    Parameters
    ----------
    scenario
        The base robot, its substrate, a rotating field, and the time of a run, at least a cycle of the field.
    samples
        Number of designs sampled, a power of two.
    generations
        Generations of each search, after its start; 0 takes the best samples as they are.
    errors
        The distribution of errors; that of `Errors` by default.
    drift_cost
        Cost of a metre of drift, in metres of way.
    seed
        What samples and searches are drawn from.
    parts
        Folder for parts of the result, from which a later call with the same settings goes on; none by default.
    threads
        Number of threads, all by default. The result does not depend on it.
    progress
        True for a progress bar over the runs, or a callback that is told how many are done.

    Returns
    -------
    xarray.Dataset
        Dimension ``design``: each parameter, the quantities (speed, ``climb_deg``, ``tipping_torque_N_m`` and
        ``tipping_field_T``, speed and drift over the errors, both merits), ``turns``, and ``front``: the Pareto front
        of fast, climbing high, tipped by a weak field and drifting little over the errors. Dimension ``candidate``
        (base, nominal, robust): the same with ``candidate_`` before the name, on fresh errors; with ``draw``
        (coordinates ``draft_deg``, ``theta1_deg``, ``theta2_deg``) ``draw_speed_m_per_s``, ``draw_drift_m`` and
        ``draw_upright``.
        Attributes: ``robust_gain_m_per_s`` and ``robust_gain_error_m_per_s``, by how much the robust design's mean
        merit over the errors exceeds the nominal one's and the standard error of that; ``settings`` as JSON; the
        scenario.

    Raises
    ------
    InputError
        A scenario or a number that is refused, or parts of other settings (key ``parts``).
    SimulationError
        The native module gave up.
    """
    errors = Errors() if errors is None else errors
    for key, count in (("samples", samples), ("draws", errors.draws)):
        whole_number(key, count, 8, _MOST)
        if count & (count - 1):
            raise InputError(key, show(count), "a power of two, for an even Sobol sequence")
    whole_number("generations", generations, 0)
    whole_number("seed", seed, 0, 2**31)
    settings = design_settings(
        scenario, samples=samples, generations=generations, errors=errors, drift_cost=drift_cost, seed=seed
    )
    scenario, chosen_step = with_chosen_step(scenario, threads, progress is True)
    space = DesignSpace(scenario, drift_cost)
    kept = Parts(None if parts is None else Path(parts), settings)
    seen, fresh = errors.drawn(), replace(errors, draws=_FRESH * errors.draws, seed=errors.seed + 1).drawn()
    unit = qmc.Sobol(len(space.family.parameters), scramble=True, seed=seed).random(samples)
    per_design = space.runs(len(seen))
    searched = min(_POPULATION, samples) + min(_POPULATION, samples + 1) * len(seen)
    searched = (generations + 1) * searched if generations else 0
    finals = len(CANDIDATES) * (space.runs(len(fresh)) + len(fresh))
    with native_call("runs", samples * per_design + searched + finals, progress) as report:
        native = Native(threads, report)
        table: dict[str, list[float]] = {name: [] for name in QUANTITIES}
        for first in range(0, samples, _CHUNK):
            chunk = [space.family.values(place) for place in unit[first : first + _CHUNK]]
            part = kept.part(
                f"samples-{first:05d}", partial(space.described, chunk, seen, native), partial(_table, len(chunk))
            )
            for name, values in part.items():
                table[name] += values
            native.done = (first + len(chunk)) * per_design
        nominal = _search("nominal", _best(unit, table, "nominal"), space, NO_ERROR, generations, seed, native, kept)
        # The nominal design takes part, so that the robust one is no worse over the errors that the search sees.
        start = np.vstack([_best(unit, table, "robust")[: _POPULATION - 1], nominal])
        robust = _search("robust", start, space, seen, generations, seed, native, kept)
        best = {"nominal": nominal, "robust": robust}
        chosen = {"base": space.family.start} | {goal: space.family.values(place) for goal, place in best.items()}
        final = kept.part(
            "candidates",
            lambda: space.described([chosen[name] for name in CANDIDATES], fresh, native),
            partial(_table, len(CANDIDATES)),
        )
        drawn = native.outcomes(
            [case for name in CANDIDATES for case in with_errors(space.scenario(chosen[name]), fresh)]
        )
    result = _dataset(space, unit, table, chosen, final)
    shape = (len(CANDIDATES), len(fresh))
    dims = ("candidate", "draw")
    result["draw_speed_m_per_s"] = (dims, drawn.speed_m_per_s.reshape(shape), _units("m s-1", "speed with errors"))
    result["draw_drift_m"] = (dims, drawn.drift_m.reshape(shape), _units("m", "drift in a cycle with errors"))
    result["draw_upright"] = (dims, drawn.upright.reshape(shape), _units("1", "neither flipped nor failed"))
    turns = space.turns(np.array(final["tipping_field_T"]))[:, None]
    merit = np.where(turns, merits(space.base, drawn, drift_cost).reshape(shape), 0.0)
    gain = merit[CANDIDATES.index("robust")] - merit[CANDIDATES.index("nominal")]
    result = result.assign_coords(
        {
            name: ("draw", fresh[:, i], _units("degree", meaning))
            for i, (name, meaning) in enumerate(
                {"draft_deg": "φ", "theta1_deg": "θ1, off the long axis", "theta2_deg": "θ2, about it"}.items()
            )
        }
    )
    result.attrs = {
        "title": "tumblers design",
        "tumblers_version": __version__,
        "scenario": scenario.to_toml(),
        "settings": json.dumps(settings),
        "drift_cost": float(drift_cost),
        "robust_gain_m_per_s": float(gain.mean()),
        "robust_gain_error_m_per_s": float(gain.std(ddof=1) / np.sqrt(gain.size)),
        **chosen_step,
    }
    return result


def _table(count: int, value: object) -> bool:
    """Return whether a value has every quantity of so many designs."""
    return isinstance(value, dict) and {*value} == {*QUANTITIES} and all(numbers_of(count, v) for v in value.values())


def _best(unit: Floats, table: dict[str, list[float]], goal: str) -> Floats:
    """Return the samples of the greatest merit, places in the unit cube, the best first."""
    order = np.argsort(-np.array(table[f"{goal}_merit_m_per_s"]), kind="stable")
    return unit[order[:_POPULATION]]


def _search(
    goal: str,
    start: Floats,
    space: DesignSpace,
    errors: Floats,
    generations: int,
    seed: int,
    native: Native,
    kept: Parts,
) -> Floats:
    """Return the design of the greatest merit, a place in the unit cube, from a population on, the best of it first."""
    if generations == 0:
        return np.asarray(start[0])
    generation = 0

    def costs(places: Floats) -> Floats:
        # SciPy gives one column to each design of a generation.
        nonlocal generation
        designs = np.atleast_2d(places.T)
        before = native.done
        part = kept.part(
            f"{goal}-{generation:05d}",
            lambda: space.merit(designs, errors, native).tolist(),
            partial(numbers_of, len(designs)),
        )
        native.done = before + len(designs) * len(errors)
        generation += 1
        return -np.array(part)

    try:
        found = differential_evolution(
            costs,
            [(0.0, 1.0)] * start.shape[1],
            init=start,
            maxiter=generations,
            tol=0.0,
            seed=seed,
            polish=False,
            updating="deferred",
            vectorized=True,
        )
    except RuntimeError as error:
        # SciPy hides a ValueError, and so what is wrong with a part.
        if isinstance(error.__cause__, InputError):
            raise error.__cause__ from None
        raise
    best: Floats = found.x
    return best


def _dataset(
    space: DesignSpace,
    unit: Floats,
    table: dict[str, list[float]],
    chosen: dict[str, tuple[float, ...]],
    final: dict[str, list[float]],
) -> xr.Dataset:
    variables: dict[str, Any] = {}
    sampled = np.array([space.family.values(place) for place in unit])
    for i, parameter in enumerate(space.family.parameters):
        attrs = _units("degree" if parameter.name.endswith("_deg") else "m", parameter.meaning)
        attrs |= {"low": parameter.low, "high": parameter.high}
        variables[parameter.name] = ("design", sampled[:, i], attrs)
        variables[f"candidate_{parameter.name}"] = ("candidate", [chosen[name][i] for name in CANDIDATES], attrs)
    for name, (units, meaning) in QUANTITIES.items():
        variables[name] = ("design", np.array(table[name]), _units(units, meaning))
        variables[f"candidate_{name}"] = ("candidate", np.array(final[name]), _units(units, meaning))
    column = {name: np.array(values) for name, values in table.items()}
    turns = space.turns(column["tipping_field_T"])
    costs = np.column_stack(
        [-column["speed_m_per_s"], -column["climb_deg"], column["tipping_field_T"], column["error_drift_m"]]
    )
    costs[~(turns & (column["nominal_merit_m_per_s"] > 0.0))] = np.nan
    variables["turns"] = ("design", turns, _units("1", "the field can tip it over"))
    variables["front"] = (
        "design",
        pareto_front(costs),
        _units("1", "on the Pareto front of speed, slope, tipping field and drift over the errors"),
    )
    return xr.Dataset(variables, {"candidate": ("candidate", list(CANDIDATES))})


def _units(units: str, meaning: str) -> dict[str, Any]:
    return {"units": units, "long_name": meaning}
