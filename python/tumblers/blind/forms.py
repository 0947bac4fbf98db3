"""Other forms of the catalogue's effects: what a real cause does that its one-line equation leaves out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from math import atan, cbrt, degrees, exp, hypot, inf, pi, radians, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..check import Vector
from ..effects.base import Effect
from ..errors import InputError, show
from ..field import RotatingField, TableField
from ..scenario import Scenario
from .law import EffectLaw, Law, State

__all__ = ["FORMS", "SHAPES", "law_of", "scaled"]

# Lengths and times over which the other forms vary: those of a track.
_WORKSPACE_M = 6e-3
_TRACK_S = 1.0
_EVERY = 8


def _share(position_m: float) -> float:
    return max(-1.0, min(1.0, position_m / _WORKSPACE_M))


class _Scaled(EffectLaw, ABC):
    """The effect's departure from neutral is scaled on the way."""

    every = _EVERY

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario as it is: each piece is edited."""
        return scenario

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:
        """Return the scenario edited by as much of the effect as acts here and now."""
        # A step of a hundredth of the effect is not seen, and saves new trials.
        scale = round(self.scale(time_s, state), 2)
        return scaled(self.effect, scale).edit(scenario)

    @abstractmethod
    def scale(self, time_s: float, state: State) -> float:
        """Return how much of the effect acts."""


def scaled(effect: Effect, scale: float) -> Effect:
    """Return an effect whose strength is `scale` times as far from neutral.

    Parameters
    ----------
    effect
        The effect.
    scale
        A number of at least 0. What says where or how an effect acts (an angle about the axis, a wavelength, an
        exponent) stays.
    """
    values = [
        value if p.key in SHAPES else p.neutral + scale * (value - p.neutral)
        for p, value in zip(effect.parameters, effect.vector(), strict=True)
    ]
    least = [-inf if p.least is None else p.least for p in effect.parameters]
    return type(effect).from_vector([max(pair) for pair in zip(values, least, strict=True)])


SHAPES = ("theta2_deg", "wavelength_m", "frequency_exponent")


class GradientOverWorkspace(_Scaled):
    """The gradient varies linearly over the workspace."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.slope = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 0.6))

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return 1 at the start, and more to one side."""
        return 1.0 + self.slope * _share(float(state["position_m"][1]))


class FrictionRunsIn(_Scaled):
    """The friction runs in from the moment the field is switched on: at first it is nearly what the lab believes."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.lacks = float(rng.uniform(0.5, 0.9))
        self.time_s = float(rng.uniform(0.15, 0.5) * _TRACK_S)

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return 1 once it has run in."""
        return 1.0 - self.lacks * exp(-time_s / self.time_s)


class FrictionDrift(_Scaled):
    """The friction drifts with the time since the field was switched on, which the catalogue's own can do by now."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.first = float(rng.uniform(0.5, 0.8))

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return less at the start than at the end, 1 in the middle of a track."""
        return self.first + 2.0 * (1.0 - self.first) * min(time_s / _TRACK_S, 1.5)


class AdhesionPlaces(_Scaled):
    """The adhesion varies with the place."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.wavelength_m, self.phase = float(rng.uniform(2e-3, 5e-3)), float(rng.uniform(0.0, 2.0 * pi))

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return a wave over the place."""
        return 1.0 + 0.5 * sin(2.0 * pi * float(state["position_m"][1]) / self.wavelength_m + self.phase)


class CurvedSubstrate(_Scaled):
    """The substrate is slightly curved: its slope changes along the way."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.bend = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 0.4))

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return 1 at the start, and more to one side."""
        return 1.0 + self.bend * _share(float(state["position_m"][1]))


class QuadraticDrag(_Scaled):
    """Half of the drag is quadratic in the speed: it is the catalogue's at a typical speed."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.typical_m_per_s = float(rng.uniform(6e-3, 1.2e-2))

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return what grows with the speed of the mass centre."""
        speed = hypot(*state["linear_velocity_m_per_s"])
        return 0.5 + 0.5 * min(speed / self.typical_m_per_s, 4.0)


class ThickConductor(_Scaled):
    """A conductor thick beside the height: the drag falls less with the height than over a thin sheet."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.power = float(rng.uniform(0.5, 1.0))
        self.height_m = 0.0

    def settle(self, scenario: Scenario, trial: int) -> Scenario:
        """Return the scenario as it is; a third of the length is the height at which both laws agree."""
        outline = np.concatenate(scenario.robot.body().outline)
        self.height_m = float(np.ptp(outline[:, 1])) / 3.0
        return super().settle(scenario, trial)

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return what grows with the height."""
        return float(min(max(state["position_m"][2] / self.height_m, 0.1), 4.0) ** self.power)


# Share of the present load in its running mean, each time that the law is asked.
_LATELY = 0.05


class HertzianContact(_Scaled):
    """The contact stiffens under the load of the last moments, as that of a sphere on a plane does."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:  # noqa: ARG002
        super().__init__(effect)
        self.load_N = 0.0
        self.lately_N = 0.0

    def settle(self, scenario: Scenario, trial: int) -> Scenario:
        """Return the scenario as it is; the load at rest is that at which both laws agree."""
        weight = scenario.robot.total_mass_kg * scenario.run.gravity_m_per_s2
        self.load_N = self.lately_N = weight + scenario.substrate.electrostatic_force_N
        return super().settle(scenario, trial)

    def scale(self, time_s: float, state: State) -> float:  # noqa: ARG002
        """Return (N0/N)^(1/3), within bounds."""
        # A plane whose give jumped with every impact would throw the body.
        self.lately_N += _LATELY * (float(state["normal_force_N"]) - self.lately_N)
        load = max(self.lately_N / self.load_N, 0.2)
        return min(max(cbrt(1.0 / load), 0.6), 1.5)


class ExplicitHeights(EffectLaw):
    """A random height map: many waves along and across the way beside the catalogue's three."""

    every = _EVERY

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.weights = rng.normal(size=(2, 24))
        self.waves = rng.uniform(0.5, 2.0, size=6) * rng.choice([-1.0, 1.0], size=6)
        self.phases = rng.uniform(0.0, 2.0 * pi, size=6)

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario on the heights along the way."""
        effect: Any = self.effect
        # The catalogue's waves stand at each fourth place of a row that is four times as long.
        cosine, sine = np.zeros(24), np.zeros(24)
        cosine[3:12:4], sine[3:12:4] = effect.cosine_m, effect.sine_m
        number = np.arange(1, 25)
        # Slopes of all waves alike, together 0.35 of the slope of the catalogue's.
        slope = sqrt(float(np.sum((number * cosine) ** 2 + (number * sine) ** 2)))
        extra = 0.35 * slope / (number * sqrt(2.0 * number.size)) * self.weights
        relief = replace(
            scenario.relief,
            wavelength_m=4.0 * effect.wavelength_m,
            cosine_m=tuple((cosine + extra[0]).tolist()),
            sine_m=tuple((sine + extra[1]).tolist()),
        )
        return replace(scenario, relief=relief)

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario with the slope across the way at this place."""
        effect: Any = self.effect
        amplitude = 0.2 * hypot(*effect.cosine_m, *effect.sine_m)
        k = 2.0 * pi / effect.wavelength_m
        x, y = float(state["position_m"][0]), float(state["position_m"][1])
        waves = self.waves * np.cos(k * (self.waves * x + self.waves[::-1] * y) + self.phases)
        slope = degrees(atan(amplitude * k * float(np.sum(waves)) / sqrt(waves.size)))
        run = scenario.run
        return replace(scenario, run=replace(run, side_incline_deg=run.side_incline_deg + round(slope, 2)))


class SecondOrderRolloff(EffectLaw):
    """The coils are a low pass of second order, as strong as the catalogue's at 6 Hz."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:  # noqa: ARG002
        super().__init__(effect)

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario with its field filtered."""
        field = scenario.field
        if not isinstance(field, RotatingField):
            return scenario
        effect: Any = self.effect
        at_6_Hz = sqrt(1.0 + (2.0 * pi * 6.0 * effect.time_constant_s) ** 2) - 1.0
        gain = 1.0 / (1.0 + at_6_Hz * (field.frequency_Hz / 6.0) ** 2)
        return replace(scenario, field=replace(field, strength_T=gain * field.strength_T))


class DistortedCoil(EffectLaw):
    """The second coil has a third harmonic beside its wrong amplitude and phase."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.share, self.phase = float(rng.uniform(0.15, 0.3)), float(rng.uniform(0.0, 2.0 * pi))

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario with its rotating field tabulated."""
        field = self.effect.edit(scenario).field
        if not isinstance(field, RotatingField):
            return scenario
        effect: Any = self.effect
        harmonic = self.share * hypot(effect.amplitude_ratio - 1.0, radians(effect.phase_error_deg))
        end = scenario.run.duration_s + scenario.run.fixed_step_s
        time = np.linspace(0.0, end, 2 + int(end * field.frequency_Hz * 300.0))
        angle = 2.0 * pi * field.frequency_Hz * time
        second = field.quadrature_ratio * np.sin(angle + radians(field.phase_error_deg))
        second += harmonic * np.sin(3.0 * angle + self.phase)
        b0 = np.asarray(field.initial_direction)
        q = np.cross(field.rotation_axis, b0)
        values = field.strength_T * (np.cos(angle)[:, None] * b0 + second[:, None] * q)
        rows: tuple[Vector, ...] = tuple((x, y, z) for x, y, z in values.tolist())
        return replace(scenario, field=TableField(time_s=tuple(time.tolist()), field_T=rows))


class SoftMagnet(EffectLaw):
    """The magnet is partly soft: a third of the departure grows with the field."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        self.typical_T = float(rng.uniform(0.008, 0.015))

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario with the magnet of this field."""
        field = scenario.field
        strength = (
            max(map(hypot, *zip(*field.field_T, strict=True))) if isinstance(field, TableField) else field.strength_T
        )
        return scaled(self.effect, 0.65 + 0.35 * min(strength / self.typical_T, 2.0)).edit(scenario)


class BarrelCamera(EffectLaw):
    """The lens adds a slight barrel distortion."""

    def __init__(self, effect: Effect, rng: np.random.Generator) -> None:
        super().__init__(effect)
        # Half a per cent at the end of the workspace.
        self.bend = float(rng.uniform(-0.005, 0.005)) / _WORKSPACE_M**2

    def seen(self, position_m: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return positions drawn together or apart with their distance from the start."""
        seen = position_m.copy()
        far = np.minimum(np.sum(seen[:, :2] ** 2, axis=1, keepdims=True), (2.0 * _WORKSPACE_M) ** 2)
        seen[:, :2] *= 1.0 + self.bend * far
        return seen


FORMS: dict[str, tuple[str, Callable[[Effect, np.random.Generator], Law]]] = {
    "magnetization_strength": ("partly_soft", SoftMagnet),
    "friction_coefficient": ("runs_in", FrictionRunsIn),
    "adhesion_coefficient": ("varies_with_place", AdhesionPlaces),
    "stray_field_gradient": ("varies_over_workspace", GradientOverWorkspace),
    "field_rolloff": ("second_order", SecondOrderRolloff),
    "field_ellipticity": ("third_harmonic", DistortedCoil),
    "substrate_tilt": ("curved", CurvedSubstrate),
    "eddy_current_drag": ("thick_conductor", ThickConductor),
    "viscous_drag": ("half_quadratic", QuadraticDrag),
    "surface_roughness": ("explicit_heights", ExplicitHeights),
    "contact_compliance": ("hertzian", HertzianContact),
    "camera_calibration": ("barrel", BarrelCamera),
}
# Forms that are drawn no more, of which answers tell.
_PAST: dict[tuple[str, str], Callable[[Effect, np.random.Generator], Law]] = {
    ("friction_coefficient", "drifts_with_time"): FrictionDrift
}
_KNOWN = {(name, form): law for name, (form, law) in FORMS.items()} | _PAST


def law_of(effect: Effect, form: str, form_seed: int | None) -> Law:
    """Return the law of an effect in the catalogue's form, or in another one.

    Parameters
    ----------
    effect
        The effect.
    form
        ``catalogue``, or the form's name.
    form_seed
        What the details of another form are drawn from.

    Raises
    ------
    InputError
        No such form of this effect is known.
    """
    if form == "catalogue":
        return EffectLaw(effect)
    known = {known: law for (name, known), law in _KNOWN.items() if name == effect.name}
    if form not in known:
        raise InputError(f"{effect.name}.form", show(form), " or ".join(["catalogue", *known]))
    return known[form](effect, np.random.default_rng(form_seed))
