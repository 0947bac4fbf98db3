"""What a model says that a trial's sensor should have read, and by how much it is wrong.

With the camera's nuisances (clock τ, origin o, heading ψ, scale s, all small) the seen place is

```text
(x, y) = (1 + s) R(ψ) (x, y)(t + τ) + (o_x, o_y),  z = z(t + τ) + o_z
```

Angles are compared as `measured - model`; of a quaternion, the rotation vector from model to measurement in the body
frame: about x it is a tilt, about z a heading, about y a twist.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees, log
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...camera import Camera
from ...dataset.climb import CLIMBED, way_without_slip_m
from ...dataset.outcome import REST_SHARE
from ...effects.parameter import Nuisance
from ...scenario import Scenario
from .observed import Observed
from .pose import Path, body_axis, heading_of, nearer_turn, relative_turn, tilt_of

__all__ = ["BORDERS", "SLID", "Reader", "reached", "seen_by"]

Floats = NDArray[np.float64]

# Share of the way slid from which a model slides as well, and how blurred this border and that of climbing are.
SLID, _BLUR = 0.3, 0.05
# Outcomes of yes or no, of which a right model leaves nothing, and from which share on it is yes.
BORDERS = {"climbs": CLIMBED, "slides": SLID}
# A human who writes down the wrong outcome.
_LAPSE = 0.01
# Moments of a rest that are averaged.
_REST_MOMENTS = 50


@dataclass(frozen=True, eq=False)
class Reader:
    """Compares the paths of one trial with what was measured in it.

    Attributes
    ----------
    observed
        The measurements.
    duration_s
        Time of the trial, s.
    level_way_m
        Way without slip in that time, hull perimeter × cycles, m; one perimeter where the field does not rotate.
    """

    observed: Observed
    duration_s: float
    level_way_m: float

    @classmethod
    def of(cls, observed: Observed, scenario: Scenario, duration_s: float) -> Reader:
        """Return the reader of a trial whose nominal scenario is given."""
        way = way_without_slip_m(scenario.robot, scenario.field, duration_s)
        return cls(observed, duration_s, way)

    def beginning(self, frames: int) -> Reader:
        """Return the reader of the first so many frames."""
        return replace(self, observed=self.observed.beginning(frames))

    def differences(self, path: Path, local: Floats, camera: Floats) -> dict[str, Floats]:
        """Return `measured - model` by channel, m or rad, shape (n,), NaN where lost.

        Parameters
        ----------
        path
            The model's.
        local
            Clock (s) and origin (x, y, z in m), shape (4,).
        camera
            Heading (rad) and scale, shape (2,).
        """
        if not len(self.observed.time_s):
            return {}
        return self._wrong(*seen_by(path, self.observed.time_s, local, camera), 1)

    def change(self, path: Path, other: Path) -> dict[str, Floats]:
        """Return how `differences` change from one path to another, m or rad, by channel, shape (n,), 0 where lost.

        Turned by half a turn from what was measured, a little more is a little more, and not a turn the other way.

        Parameters
        ----------
        path, other
            Two of the model's.
        """
        perfect = np.zeros(len(get_args(Nuisance))), np.zeros(2)
        before, after = (self.differences(p, *perfect) for p in (path, other))
        if self.observed.orientation is not None:
            names = ("tilt", "twist", "heading")
            error, turned = (np.stack([found[name] for name in names], axis=1) for found in (before, after))
            nearer = nearer_turn(turned, error)
            after |= {name: nearer[:, k] for k, name in enumerate(names)}
        elif "heading" in after:
            seen = seen_by(other, self.observed.time_s, *perfect)[1]
            turn = self.observed.heading_turn * np.cos(tilt_of(body_axis(seen)))
            # Of an axis that stands upright any heading counts for nothing.
            turns = np.rint((before["heading"] - after["heading"]) / np.maximum(turn, 1e-3))
            after["heading"] = after["heading"] + turn * turns
        return {name: np.nan_to_num(before[name] - after[name]) for name in before}

    def _wrong(self, position: Floats, orientation: Floats, times: int) -> dict[str, Floats]:
        """Return `measured - model` by channel, for poses (k n, 3) and (k n, 4) of k times all frames."""
        seen = self.observed

        def measured(values: Floats) -> Floats:
            return values if times == 1 else np.concatenate([values] * times)

        out = {
            name: measured(seen.values[name]) - position[:, k] for k, name in enumerate("xyz") if name in seen.values
        }
        if seen.orientation is not None:
            error = relative_turn(orientation, measured(seen.orientation))
            out["tilt"], out["twist"], out["heading"] = error[:, 0], error[:, 1], error[:, 2]
        elif "tilt" in seen.values or "heading" in seen.values:
            axis = body_axis(orientation)
            tilt = tilt_of(axis)
            if "tilt" in seen.values:
                out["tilt"] = measured(seen.values["tilt"]) - tilt
            if "heading" in seen.values:
                wrong = measured(seen.values["heading"]) - heading_of(axis)
                # The projection of an axis that stands upright points nowhere.
                out["heading"] = (wrong - seen.heading_turn * np.rint(wrong / seen.heading_turn)) * np.cos(tilt)
        return out

    @property
    def outcome_kinds(self) -> tuple[str, ...]:
        """Names of `outcome_terms`."""
        outcome = self.observed.outcome
        slides = ("slides",) if self.observed.slid_m > 0.0 else ()
        if outcome is None:
            return slides
        noted = {"mean_speed": outcome.mean_speed_m_per_s, "tilt": outcome.tilt_deg, "climbs": outcome.climbs}
        return (*(name for name, value in noted.items() if value is not None), *slides)

    def outcome_terms(self, path: Path, camera: Floats) -> dict[str, float]:
        """Return the scaled differences of the trial's outcome: numbers whose squares count as -2 log likelihood.

        Parameters
        ----------
        path
            The model's.
        camera
            Heading (rad) and scale, shape (2,).
        """
        terms, by_scale = self.outcome_lines(path)
        return {name: term + by_scale.get(name, 0.0) * float(camera[1]) for name, term in terms.items()}

    def outcome_lines(self, path: Path) -> tuple[dict[str, float], dict[str, float]]:
        """Return `outcome_terms` for a perfect camera, and their derivatives by its scale where they have one.

        Parameters
        ----------
        path
            The model's.
        """
        outcome = self.observed.outcome
        terms: dict[str, float] = {}
        by_scale: dict[str, float] = {}
        slides = {"slides": reached(self._slid_share(path), True, SLID)} if self.observed.slid_m > 0.0 else {}
        if outcome is None:
            return slides, by_scale
        if outcome.mean_speed_m_per_s is not None and outcome.sigma_m_per_s is not None:
            speed = self._way_m(path) / self.duration_s
            terms["mean_speed"] = (outcome.mean_speed_m_per_s - speed) / outcome.sigma_m_per_s
            by_scale["mean_speed"] = -speed / outcome.sigma_m_per_s
        if outcome.tilt_deg is not None and outcome.sigma_deg is not None:
            terms["tilt"] = (outcome.tilt_deg - self._tilt_at_rest_deg(path)) / outcome.sigma_deg
        if outcome.climbs is not None:
            terms["climbs"] = reached(self._way_m(path) / self.level_way_m, outcome.climbs)
        return terms | slides, by_scale

    def _slid_share(self, path: Path) -> float:
        """Return how far the model slides while the camera runs, as a share of how far the robot did."""
        ends, _ = path.at(np.array([0.0, self.duration_s]) + path.clock_s)
        return float(np.hypot(*(ends[1, :2] - ends[0, :2]))) / self.observed.slid_m

    def read_outcomes(self, path: Path) -> dict[str, float]:
        """Return what the model says of each kind of outcome: the share climbed, m/s, degrees."""
        way = self._way_m(path)
        return {
            "climbed_share": way / self.level_way_m,
            "mean_speed_m_per_s": way / self.duration_s,
            "tilt_deg": self._tilt_at_rest_deg(path),
        }

    def _way_m(self, path: Path) -> float:
        """Return how far the model comes along +y."""
        ends, _ = path.at(np.array([0.0, self.duration_s]))
        return float(ends[1, 1] - ends[0, 1])

    def _tilt_at_rest_deg(self, path: Path) -> float:
        """Return the mean tilt of the model over the last share of the trial."""
        rest = np.linspace((1.0 - REST_SHARE) * self.duration_s, self.duration_s, _REST_MOMENTS)
        return float(np.degrees(np.mean(tilt_of(body_axis(path.at(rest)[1])))))

    def linearised(self, path: Path, local: Floats, camera: Floats) -> dict[str, Floats]:
        """Return the differences' derivatives by the nuisances and the differences, by channel, shape (n, 7).

        By the trial's clock and origin (x, y, z) first, then by the camera's heading and scale; the differences last.
        """
        time = self.observed.time_s
        count = len(time)
        if not count:
            return {}
        clock = path.clock_s + local[0]
        position, orientation = path.at(np.concatenate([time, time + _core.CLOCK_STEP_S]) + clock)
        wrong = self._wrong(*_through(position, orientation, local, camera), 2)
        position, orientation = position[:count], orientation[:count]
        turned = self.observed.orientation is not None
        up = _upward(orientation) if turned else np.empty((count, 3))
        tables: dict[str, Floats] = {}
        for name, values in wrong.items():
            table = np.zeros((count, 7))
            table[:, 6] = values[:count]
            table[:, 0] = (values[count:] - values[:count]) / _core.CLOCK_STEP_S
            if name == "x":
                table[:, 1], table[:, 4], table[:, 5] = -1.0, position[:, 1], -position[:, 0]
            elif name == "y":
                table[:, 2], table[:, 4], table[:, 5] = -1.0, -position[:, 0], -position[:, 1]
            elif name == "z":
                table[:, 3] = -1.0
            elif turned and name in ("tilt", "twist", "heading"):
                table[:, 4] = -up[:, {"tilt": 0, "twist": 1, "heading": 2}[name]]
            elif name == "heading":
                table[:, 4] = -np.cos(tilt_of(body_axis(orientation)))
            tables[name] = table
        return tables


def reached(share: float, does: bool, border: float = CLIMBED) -> float:
    """Return the scaled difference of an outcome of yes or no, `±√(-2 log P)`, with a smooth likelihood.

    ```text
    P(it does) = ε + (1 - 2ε) / (1 + exp(-(share - border)/0.05))
    ```

    Parameters
    ----------
    share
        Way over the way without slip, or over the way that was slid.
    does
        What was seen: whether the robot climbs, or slides.
    border
        From where on it does.
    """
    odds = np.clip((share - border) / _BLUR, -60.0, 60.0)
    chance = _LAPSE + (1.0 - 2.0 * _LAPSE) / (1.0 + float(np.exp(-odds)))
    chance = chance if does else 1.0 - chance
    # A likely outcome counts as no difference at all.
    loss = -2.0 * log(chance / (1.0 - _LAPSE))
    return (1.0 if does else -1.0) * float(np.sqrt(max(loss, 0.0)))


def seen_by(path: Path, time_s: Floats, local: Floats, camera: Floats) -> tuple[Floats, Floats]:
    """Return the positions (n, 3), m, and orientations (n, 4) that a sensor with these nuisances reads at times (n,).

    Parameters
    ----------
    path
        The model's.
    time_s
        What the sensor's clock says, s.
    local
        Clock (s) and origin (x, y, z in m), shape (4,).
    camera
        Heading (rad) and scale, shape (2,).
    """
    return _through(*path.at(time_s + (path.clock_s + local[0])), local, camera)


def _through(position: Floats, orientation: Floats, local: Floats, camera: Floats) -> tuple[Floats, Floats]:
    """Return what a sensor reads of poses (n, 3) and (n, 4)."""
    seen = Camera(scale=1.0 + float(camera[1]), heading_deg=degrees(camera[0]))
    position = seen.seen_position(position)
    position += local[1:]
    return position, seen.seen_orientation(orientation)


def _upward(orientation: Floats) -> Floats:
    """Return the substrate's normal in the body frame, shape (n, 3)."""
    w, x, y, z = orientation.T
    return np.stack([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)], axis=1)
