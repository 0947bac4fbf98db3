"""Draws a dataset and its truth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from math import inf, log

import numpy as np

from ..dataset import Dataset
from ..effects.catalogue import CATALOGUE
from ..errors import InputError, SimulationError
from ..field import RotatingField
from ..model import Model
from .answer import Answer, TrueCause
from .cause import CatalogueCause, Cause, OutsideCause
from .jitter import Jitter
from .lab import Lab
from .law import Law
from .layout import FINER, draw_lab, jitter_strength, world_scenario
from .schedule import Task, task
from .sensing import Nuisances, measure
from .strength import Strength, strength
from .world import Scene, Solver, watch

__all__ = ["CLEAR_SIGMA", "LEAST_BESIDE_SIGMA", "QUIET_SIGMA", "QUIET_TRIAL_SIGMA", "REPEATS", "draw_dataset"]

_TARGETS = (0.7, 1.5, 3.0, 6.0, 12.0, 25.0)
# Two effects, and causes outside the catalogue, are to be seen.
_CLEAR_TARGETS, CLEAR_SIGMA = (6.0, 12.0, 25.0), 4.5
# Where one of two shows less than the noise beside the other, there is one cause.
LEAST_BESIDE_SIGMA = 1.0
# A world without causes is one that its lab would call explained: what jitter shows stays below the noise.
QUIET_SIGMA, QUIET_TRIAL_SIGMA = 0.7, 1.3
# What one effect should reach even where its range does not allow the target.
_SEEN = 3.0
_LABS, _DRAWS, _BISECTIONS, _CLOSE = 12, 3, 9, 0.12
# One dataset that cannot be made must not cost the others: so often all is drawn again.
_ATTEMPTS = 3
# Labs after which another pair of effects is drawn: one of them may have no part in any lab's motion.
_LABS_PER_PAIR = 3
_SMALLEST = 1e-3
# Another step of the world (`FINER`) changes no more than this share of what its causes change.
REPEATS = 0.15
_OTHER_FORM = 1.0 / 3.0


@dataclass(frozen=True, slots=True)
class _World:
    lab: Lab
    jitter: Jitter
    plain: tuple[Scene, ...]
    moved: tuple[tuple[Scene, ...], ...]
    jitter_sigma: float

    def scenes(
        self,
        laws: Sequence[Law],
        late_s: Sequence[float] | None = None,
        solver: Solver = "reduced",
        finer: float = 1.0,
    ) -> list[Scene]:
        scenes = []
        for i, plan in enumerate(self.lab.plans):
            frames = self.lab.frames(plan) + (late_s[i] if late_s is not None and plan.tracked else 0.0)
            scenario = world_scenario(self.lab, plan, self.jitter)
            scenario = replace(scenario, run=replace(scenario.run, step_s=finer * scenario.run.fixed_step_s))
            scenes.append(watch(scenario, laws, frames, trial=i, solver=solver, filmed=plan.tracked))
        return scenes

    def strength(self, laws: Sequence[Law]) -> Strength | None:
        """Return how much the laws show, or None where the world does not stand them."""
        try:
            return strength(self.lab, self.scenes(laws), self.plain, self.moved)
        except (ArithmeticError, InputError):
            return None

    def beside(self, laws: Sequence[Law]) -> list[float]:
        """Return how much each of two laws shows where the other is at work.

        What a refit of the other would take up is not taken out. Nothing where the motion diverges, with both or with
        one and a number that is moved. In their order a law may leave nothing for the next: a table of a distorted
        field is not rolled off.
        """
        try:
            both, shown = self.scenes(laws), []
            for other in reversed(laws):
                moved = [replace(self, jitter=raised).scenes([other]) for raised in self.jitter.each_raised()]
                shown.append(strength(self.lab, both, self.scenes([other]), moved).sigma)
        except (ArithmeticError, InputError):
            return [0.0 for _ in laws]
        return shown

    def repeats(self, laws: Sequence[Law]) -> bool:
        """Return whether the world with its causes hardly depends on its step: a lab shows what it sees again."""
        try:
            scenes = self.scenes(laws)
            shown, stepped = strength(self.lab, scenes, self.plain, self.moved), self.scenes(laws, finer=FINER)
            # With the same numbers: what they may be off is no excuse.
            change = strength(self.lab, stepped, scenes)
            return change.sigma <= max(QUIET_SIGMA, REPEATS * shown.sigma)
        except (ArithmeticError, InputError):
            return False


@dataclass(frozen=True, slots=True)
class _Sized:
    cause: Cause
    size: float
    sigma: float
    # Of two the strength beside the other.
    beside: float = inf

    @property
    def law(self) -> Law:
        return self.cause.law(self.size)


def draw_dataset(seed: int, index: int) -> tuple[Dataset, Answer]:
    """Return a dataset and its truth, which depend on nothing but the seed and the number.

    Parameters
    ----------
    seed, index
        The seed of all datasets and the number of this one.

    Raises
    ------
    SimulationError
        No world of the drawn kind could be made.
    """
    rng, about = np.random.default_rng([seed, 0, index]), task(seed, index)
    for _ in range(_ATTEMPTS):
        drawn = _draw(about, rng, index)
        if drawn is not None:
            return drawn
    raise SimulationError(
        f"no world for {' and '.join(about.names) or 'no effect'} was found in {_ATTEMPTS * _LABS} labs"
    )


def _draw(about: Task, rng: np.random.Generator, index: int) -> tuple[Dataset, Answer] | None:
    targets = _TARGETS if about.kind == "one" else _CLEAR_TARGETS
    target = float(rng.choice(targets))
    other = [bool(rng.random() < _OTHER_FORM) for _ in about.names]
    names = about.names
    found: list[tuple[_World, list[_Sized]]] = []
    fleeting: list[tuple[_World, list[_Sized]]] = []
    for number in range(_LABS):
        world = _draw_world(rng)
        if world is None:
            continue
        if about.kind == "two" and number and number % _LABS_PER_PAIR == 0:
            first, second = rng.choice(len(CATALOGUE), size=2, replace=False).tolist()
            names = (tuple(CATALOGUE)[first], tuple(CATALOGUE)[second])
        sized = _sizes(world, about.kind, names, other, target, rng)
        if sized is None:
            continue
        if not world.repeats([s.law for s in sized]):
            fleeting.append((world, sized))
            continue
        found.append((world, sized))
        least = min(_SEEN, target) * (1.0 - _CLOSE) if about.kind == "one" else CLEAR_SIGMA
        if _weakest(sized) >= least:
            measured = _measured(about.kind, world, sized, rng, index)
            if measured is not None:
                return measured
            found.pop()
    # None is as strong as it should be: the strongest has to do.
    strongest = [sorted(those, key=lambda one: _weakest(one[1]), reverse=True) for those in (found, fleeting)]
    for world, sized in chain.from_iterable(strongest):
        measured = _measured(about.kind, world, sized, rng, index)
        if measured is not None:
            return measured
    return None


def _weakest(sized: Sequence[_Sized]) -> float:
    return min((min(s.sigma, s.beside) for s in sized), default=inf)


def _draw_world(rng: np.random.Generator) -> _World | None:
    for _ in range(_LABS):
        lab, jitter = draw_lab(rng)
        if not 6 <= len(lab.plans) <= 14:
            continue
        shown = jitter_strength(lab, jitter)
        if shown.sigma <= QUIET_SIGMA and max(shown.by_trial) <= QUIET_TRIAL_SIGMA:
            bare = _World(lab, jitter, (), (), shown.sigma)
            try:
                moved = [tuple(replace(bare, jitter=other).scenes(())) for other in jitter.each_raised()]
            except (ArithmeticError, InputError):
                continue
            return replace(bare, plain=tuple(bare.scenes(())), moved=tuple(moved))
    return None


def _sizes(
    world: _World, kind: str, names: Sequence[str], other: Sequence[bool], target: float, rng: np.random.Generator
) -> list[_Sized] | None:
    """Return the causes in sizes that are close to the target, or as close as their ranges allow."""
    sized: list[_Sized] = []
    for name, form in zip(names, other, strict=True):
        found: list[_Sized] = []
        for _ in range(_DRAWS):
            cause: Cause
            if kind == "outside":
                cause = OutsideCause(name, world.lab.robot, rng)
            else:
                scenarios = [world.lab.scenario(p) for p in world.lab.plans if isinstance(p.field, RotatingField)]
                cause = CatalogueCause(name, form, scenarios, rng)
            one = _size(world, cause, target)
            if one is not None:
                found.append(one)
                if abs(log(one.sigma / target)) < 2.0 * _CLOSE:
                    break
        if not found:
            return None
        if kind == "one" or max(s.sigma for s in found) >= CLEAR_SIGMA:
            sized.append(min(found, key=lambda s: abs(log(s.sigma / target))))
        elif len(sized) + 1 == len(names):
            sized.append(max(found, key=lambda s: s.sigma))
        else:
            # A first that hardly shows is no pair.
            return None
    if len(sized) < 2:
        return sized
    # What shows alone may have no part in the motion that another makes: nothing would tell that it is there.
    beside = world.beside([s.law for s in sized])
    if min(beside) < LEAST_BESIDE_SIGMA:
        return None
    return [replace(s, beside=sigma) for s, sigma in zip(sized, beside, strict=True)]


def _size(world: _World, cause: Cause, target: float) -> _Sized | None:
    """Return the cause in the size whose strength is the closest to the target, by bisection."""
    found: list[_Sized] = []

    def sigma(size: float) -> float:
        shown = world.strength([cause.law(size)])
        if shown is None:
            return inf
        if shown.sigma > 0.0:
            found.append(_Sized(cause, size, shown.sigma))
        return shown.sigma

    low, high = log(_SMALLEST), 0.0
    if sigma(1.0) > target * (1.0 + _CLOSE):
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            reached = sigma(float(np.exp(middle)))
            if abs(reached / target - 1.0) < _CLOSE:
                break
            low, high = (low, middle) if reached > target else (middle, high)
    return min(found, key=lambda s: abs(log(s.sigma / target)), default=None)


def _as_filmed(lab: Lab, shown: Strength, axis: str, region: tuple[float, float]) -> tuple[float, float]:
    """Return a region as the lab's films have it: until the last ends, and of the cycle no narrower than a frame."""
    low, high = region
    if axis == "time_s":
        return low, min(high, max(plan.duration_s for plan in lab.plans))
    if axis == "cycle_phase_deg":
        # Of the film that shows the cause most.
        films = [
            (shows, plan.field.frequency_Hz)
            for shows, plan in zip(shown.by_trial, lab.plans, strict=True)
            if plan.tracked and isinstance(plan.field, RotatingField)
        ]
        frame = 360.0 * max(films)[1] / lab.frames_per_second if films else 0.0
        more = 0.5 * max(frame - (high - low), 0.0)
        return low - more, high + more
    return region


def _measured(
    kind: str, world: _World, sized: list[_Sized], rng: np.random.Generator, index: int
) -> tuple[Dataset, Answer] | None:
    """Return what the lab writes down of the world, or None where the motion diverges."""
    laws = [s.law for s in sized]
    nuisances = Nuisances.draw(rng, world.lab)
    shown = world.strength(laws)
    try:
        scenes = world.scenes(laws, nuisances.clock_s, "general")
    except (ArithmeticError, InputError):
        return None
    if shown is None:
        return None
    trials = [measure(world.lab, i, scene, nuisances, rng) for i, scene in enumerate(scenes)]
    ids = [plan.id for plan in world.lab.plans]
    where = {
        axis: _as_filmed(world.lab, shown, axis, region)
        for s in sized
        for axis, region in s.cause.where(s.size).items()
    }
    answer = Answer(
        kind=kind,
        effects=tuple(
            TrueCause(
                name=s.cause.name,
                form=s.cause.form,
                form_seed=s.cause.form_seed,
                parameters=s.cause.parameters(s.size),
                strength_sigma=s.sigma,
                beside_sigma=s.beside if kind == "two" else None,
            )
            for s in sized
        ),
        strength_sigma=shown.sigma,
        strength_by_trial=dict(zip(ids, shown.by_trial, strict=True)),
        affected_trials=tuple(i for i, sigma in zip(ids, shown.by_trial, strict=True) if sigma >= 1.0),
        where=where,
        nuisances=nuisances.table(),
        jitter=world.jitter.table(),
        jitter_sigma=world.jitter_sigma,
    )
    dataset = Dataset(
        title=f"lab {index}",
        robot=world.lab.robot,
        substrate=world.lab.substrate,
        model=Model(magnetic_torque="midpoint"),
        sensor=world.lab.sensor,
        trials=tuple(trials),
    )
    return dataset, answer
