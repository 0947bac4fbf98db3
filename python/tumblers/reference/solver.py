"""Solution of a step's problem: candidate active sets in order of likelihood, then the smoothed full problem.

1. Free motion: airborne if the body's lowest point ends above the plane.
2. The predictor's supports, sticking and slipping. What a solution violates names the next candidate: friction outside
   its ellipsoid, slip against itself, another point below the plane, or an ECP outside the support.
3. The same with a friction coefficient, or a magnetic torque, that rises from nearly 0 to its own.
4. Every other cell by the height of its highest point at the predicted pose, sticking and slipping.
5. The homotopy on the full problem from several starts, each result polished on the active set that it shows.

A candidate counts if the scaled natural residual of all unknowns of the full problem is at most 1e-10.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np

from .active_set import ActiveSet, Regime, complete
from .array import Array
from .body import Anchor
from .cell import Cell
from .homotopy import approximations
from .linearised import Guess
from .predictor import Prediction, free_motion, predictions
from .problem import NORMAL, StepProblem, Unknowns
from .residual import residual
from .rotation import aligning, cayley_vector, cross

TOLERANCE = 1e-10
_TIE = 1e-12
_PARTS = (0.003, 0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)


@dataclass(frozen=True, eq=False)
class Candidate:
    """An active set and where to start it."""

    cell: Cell
    regime: Regime
    guess: Guess


@dataclass(frozen=True, eq=False)
class Solution:
    """Unknowns, their scaled residual, and how many candidates were solved."""

    unknowns: Unknowns
    residual: float
    candidates: int


class Search:
    """The search for one step's solution."""

    def __init__(self, problem: StepProblem) -> None:
        self.problem, self.body = problem, problem.body
        self.best: Unknowns | None = None
        self.best_residual = float("inf")
        self.count = 0
        self.tried: set[tuple[frozenset[int], Regime]] = set()

    def run(self) -> Solution:
        """Search until a solution is found or every start is used up."""
        free = free_motion(self.problem)
        predicted = predictions(self.problem, free)
        stages: tuple[Callable[[], bool], ...] = (
            lambda: self.airborne(free),
            lambda: self.follow(self.likely(predicted), thorough=True),
            lambda: self.contact_adhesion_airborne(free),
            lambda: self.rising("friction"),
            lambda: self.rising("torque"),
            lambda: self.exhaust(predicted[0].guess),
            lambda: self.exhaust(self.still()),
            lambda: self.smoothed([p.guess for p in predicted[:2]] + [self.still(), self.lifted(free)]),
        )
        for stage in stages:
            if stage():
                break
        assert self.best is not None
        return Solution(self.best, self.best_residual, self.count)

    def offer(self, z: Unknowns | None) -> bool:
        """Keep `z` if it is the best so far; whether it solves the problem."""
        if z is None:
            return False
        self.count += 1
        value = residual(self.problem, z)
        if value < self.best_residual or self.best is None:
            self.best, self.best_residual = z, value
        return value <= TOLERANCE

    def airborne(self, free: Array) -> bool:
        """Free flight; the closest point is the middle of all lowest points, so a parallel face gives its middle."""
        _, rotation = self.problem.pose(free)
        anchors = list(self.body.anchors(rotation))
        y = np.array([rotation @ anchor.point for anchor in anchors])
        lowest = y[:, 2] <= y[:, 2].min() + _TIE * self.body.radius
        common = [anchor.surfaces for anchor, low in zip(anchors, lowest, strict=True) if low]
        on = frozenset.intersection(*common)
        z = complete(self.problem, free, y[lowest].mean(axis=0), np.zeros(3), 0.0, 0.0, on or common[0], False)
        return self.offer(z)

    def contact_adhesion_airborne(self, free: Array) -> bool:
        """Lift-off against adhesion at the closest point, which has to be lowest at the end of the step.

        The pull lowers the very point that it acts at, so several points may be consistent; those nearest to the last
        patch come first.
        """
        if not (self.problem.adhesion_at_ecp and self.problem.p_a > 0.0):
            return False
        position, rotation = self.problem.pose(free)
        centre = self.problem.centroid
        near = position + self.body.lowest_height(rotation) * NORMAL if centre is None else centre
        order: list[tuple[bool, float, int, Cell, Array]] = []
        for cell in self.body.cells:
            points = self.body.cell_points(cell, rotation)
            middle = points.mean(axis=0) if len(points) else np.zeros(3)
            start = self.problem.state.position + self.problem.rotation @ middle
            order.append((cell.kind in ("edge", "face"), float(np.linalg.norm(start - near)), len(order), cell, middle))
        for *_, cell, middle in sorted(order, key=lambda entry: entry[:3]):
            guess = Guess(free, rotation @ middle, np.zeros(3), 0.0)
            if self.offer(ActiveSet(self.problem, cell, "airborne").solve(guess)):
                return True
        return False

    def rising(self, what: Literal["friction", "torque"]) -> bool:
        """The problem with a friction or a torque that rises to its own, each solution starting the next."""
        guess: Guess | None = None
        for part in _PARTS:
            problem = copy(self.problem)
            if what == "friction":
                problem.mu = part * self.problem.mu
            else:
                problem.torque = partial(_part_of, part, self.problem.torque)
            search = Search(problem)
            free = free_motion(problem)
            solved = part < 1.0 and search.airborne(free)
            solved = solved or (guess is not None and search.touching(guess))
            solved = solved or search.follow(search.likely(predictions(problem, free)), thorough=True)
            self.count += search.count
            z = search.best
            if not solved or z is None:
                continue
            guess = Guess(z.V, z.a1 - problem.pose(z.V)[0], z.p, z.p_n)
            if part == 1.0:
                return self.offer(z)
        return False

    def touching(self, guess: Guess) -> bool:
        """Solve from `guess` on the support that it touches with."""
        _, rotation = self.problem.pose(guess.V)
        values = self.body.values(rotation.T @ guess.r)
        on = frozenset(int(i) for i in np.flatnonzero(np.abs(values) < 1e-9 * self.body.radius))
        cell = self.cell_with(on)
        if cell is None:
            return False
        return self.follow([Candidate(cell, "slip", guess), Candidate(cell, "stick", guess)], thorough=True)

    def likely(self, predicted: list[Prediction]) -> list[Candidate]:
        """The predictor's supports, in the regime that its friction suggests first."""
        found: list[Candidate] = []
        for prediction in predicted:
            cell = self.cell_with(prediction.surfaces)
            if cell is None or not prediction.loaded:
                continue
            found += [Candidate(cell, "stick", prediction.guess), Candidate(cell, "slip", prediction.guess)]
        return found

    def follow(self, queue: list[Candidate], thorough: bool = False) -> bool:
        """Solve candidates; the neighbours that a failed one names go first."""
        queue = list(queue)
        while queue:
            candidate = queue.pop(0)
            key = (candidate.cell.surfaces, candidate.regime)
            if key in self.tried:
                continue
            self.tried.add(key)
            z = ActiveSet(self.problem, candidate.cell, candidate.regime).solve(candidate.guess, thorough)
            if self.offer(z):
                return True
            if z is not None:
                queue = self.neighbours(candidate, z) + queue
        return False

    def neighbours(self, candidate: Candidate, z: Unknowns) -> list[Candidate]:
        """Candidates named by the conditions that `z` violates."""
        problem = self.problem
        position, rotation = problem.pose(z.V)
        guess = Guess(z.V, z.a1 - position, z.p, z.p_n)
        inside, _, xi, _ = problem.complements(z)
        names: list[frozenset[int]] = []
        beyond = [i for i in np.argsort(inside) if inside[i] < -1e-11 * self.body.radius]
        if beyond:
            names.append(candidate.cell.surfaces | {int(beyond[0])})
        low: Anchor = min(self.body.anchors(rotation), key=lambda anchor: float(rotation[2] @ anchor.point))
        if position[2] + problem.yielded(z.p_n) + float(rotation[2] @ low.point) < -1e-11 * self.body.radius:
            names += [candidate.cell.surfaces & low.surfaces, low.surfaces]
        found = []
        if candidate.regime == "stick" and xi < 0.0:
            found.append(Candidate(candidate.cell, "slip", guess))
        if candidate.regime == "slip" and z.sigma < 0.0:
            found.append(Candidate(candidate.cell, "stick", guess))
        for name in names:
            cell = self.cell_with(name)
            if cell is not None:
                other: Regime = "slip" if candidate.regime == "stick" else "stick"
                found += [Candidate(cell, candidate.regime, guess), Candidate(cell, other, guess)]
        return found

    def exhaust(self, guess: Guess) -> bool:
        """Every cell in both regimes, the lowest first, each from a pose in which it lies level."""
        _, rotation = self.problem.pose(guess.V)
        order: list[tuple[float, int, Cell]] = []
        for cell in self.body.cells:
            points = self.body.cell_points(cell, rotation)
            top = float((points @ rotation[2]).max()) if len(points) else 0.0
            order.append((top, len(order), cell))
        self.tried.clear()
        queue: list[Candidate] = []
        for _, _, cell in sorted(order, key=lambda entry: entry[:2]):
            level = self.levelled(cell, guess)
            queue += [Candidate(cell, "stick", level), Candidate(cell, "slip", level)]
        return self.follow(queue)

    def levelled(self, cell: Cell, guess: Guess) -> Guess:
        """`guess` turned by the least rotation that lays a flat cell level."""
        _, rotation = self.problem.pose(guess.V)
        if cell.kind == "face":
            (index,) = cell.surfaces
            normal = rotation @ self.body.surfaces[index].gradient(cell.points[0])
            rotation = aligning(normal, -NORMAL) @ rotation
        elif cell.kind == "edge":
            along = rotation @ (cell.points[1] - cell.points[0])
            along /= np.linalg.norm(along)
            level = cross(cross(NORMAL, along), NORMAL)
            if float(np.linalg.norm(level)) > 1e-6:
                rotation = aligning(along, level / np.linalg.norm(level)) @ rotation
        points = self.body.cell_points(cell, rotation)
        middle = points.mean(axis=0) if len(points) else self.body.cells[0].points.mean(axis=0)
        V = guess.V.copy()
        V[3:] = 2.0 / self.problem.h * cayley_vector(rotation @ self.problem.rotation.T)
        r = rotation @ middle
        V[2] = -(self.problem.state.position[2] + self.problem.yielded(guess.p_n) + r[2]) / self.problem.h
        return Guess(V, r, guess.p, guess.p_n)

    def smoothed(self, guesses: list[Guess]) -> bool:
        """The homotopy's approximations, polished on the active sets that they show."""
        for z in approximations(self.problem, guesses):
            position, _ = self.problem.pose(z.V)
            guess = Guess(z.V, z.a1 - position, z.p, z.p_n)
            weights = z.l.copy()
            weights[z.k] = 1.0
            on = frozenset(int(i) for i in np.flatnonzero(weights > 1e-3))
            cell = self.cell_with(on)
            if cell is None:
                continue
            self.tried.clear()
            if self.follow([Candidate(cell, "stick", guess), Candidate(cell, "slip", guess)]):
                return True
            if self.offer(ActiveSet(self.problem, cell, "airborne").solve(replace(guess, p_n=0.0))):
                return True
        return False

    def still(self) -> Guess:
        """The state at the start of the step, carrying its weight."""
        problem = self.problem
        V = np.concatenate([problem.state.velocity, problem.state.angular_velocity])
        low = min(self.body.anchors(problem.rotation), key=lambda a: float(problem.rotation[2] @ a.point))
        weight = problem.h * float(np.linalg.norm(problem.force)) + problem.p_a
        return Guess(V, problem.rotation @ low.point, np.zeros(3), weight)

    def lifted(self, free: Array) -> Guess:
        """Free motion, just touching."""
        _, rotation = self.problem.pose(free)
        low = min(self.body.anchors(rotation), key=lambda anchor: float(rotation[2] @ anchor.point))
        return Guess(free, rotation @ low.point, np.zeros(3), self.problem.p_a)

    def cell_with(self, surfaces: frozenset[int]) -> Cell | None:
        """The largest cell on all of `surfaces`; None for no surface or no cell."""
        if not surfaces:
            return None
        on = [cell for cell in self.body.cells if surfaces <= cell.surfaces]
        return min(on, key=lambda cell: len(cell.surfaces)) if on else None


def solve(problem: StepProblem) -> Solution:
    """All unknowns of a step."""
    return Search(problem).run()


def _part_of(part: float, torque: Callable[[Array], Array], omega: Array) -> Array:
    return part * torque(omega)
