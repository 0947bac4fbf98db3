"""`Robot`: a shape with a mass and a magnetization."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import lru_cache
from math import cos, fmod, radians, sin
from typing import Literal, Self, get_args

from . import _core
from .check import Vector, choice, direction, number, vector
from .core_errors import core_error
from .errors import InputError, show
from .section import as_section, known_keys, require_table, required_keys
from .shape import SHAPES, Shape

__all__ = ["DraftModel", "Robot"]

DraftModel = Literal["geometric", "as_released"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Robot:
    """A rigid magnetic robot.

    Attributes
    ----------
    shape
        One of the classes of `tumblers.shape`.
    magnetization_A_per_m
        |E| of the paper, A/m.
    mass_kg, density_kg_per_m3
        One of them is needed; the mass counts where both are given.
    magnetic_volume_m3
        V_m of the paper, m³; the body's volume if None.
    magnetization_axis
        Magnetic axis u in the body frame, normalised; +y if neither it nor the angles are given.
    theta1_deg, theta2_deg
        Instead of the axis: u = (sin θ2 sin θ1, cos θ1, cos θ2 sin θ1), degrees.
    draft_deg, draft_model
        Inward draft of the sides, degrees, and how the slanted faces of the spiked shapes take it.
    center_of_mass_m
        Where the mass centre is, from the body's geometric centre, body frame, m. The inertia about the mass centre is
        that of the homogeneous body wherever it is.

    Raises
    ------
    InputError
        A number that is refused, no mass, or both an axis and angles.
    """

    shape: Shape
    magnetization_A_per_m: float
    mass_kg: float | None = None
    density_kg_per_m3: float | None = None
    magnetic_volume_m3: float | None = None
    magnetization_axis: Vector | None = None
    theta1_deg: float | None = None
    theta2_deg: float | None = None
    draft_deg: float = 0.0
    draft_model: DraftModel = "geometric"
    center_of_mass_m: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        def put(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        if not isinstance(self.shape, Shape):
            raise InputError("robot.shape", show(self.shape), "a shape of tumblers.shape")
        put("magnetization_A_per_m", number("robot.magnetization_A_per_m", self.magnetization_A_per_m, least=0.0))
        for name in ("mass_kg", "density_kg_per_m3"):
            if getattr(self, name) is not None:
                put(name, number(f"robot.{name}", getattr(self, name), above=0.0))
        if self.mass_kg is None and self.density_kg_per_m3 is None:
            raise InputError("robot.mass_kg", "no such key", "mass_kg or density_kg_per_m3")
        if self.magnetic_volume_m3 is not None:
            put("magnetic_volume_m3", number("robot.magnetic_volume_m3", self.magnetic_volume_m3, least=0.0))
        for name in ("theta1_deg", "theta2_deg"):
            if getattr(self, name) is None:
                continue
            put(name, number(f"robot.{name}", getattr(self, name)))
            if self.magnetization_axis is not None:
                raise InputError(f"robot.{name}", "it beside magnetization_axis", "the axis or the angles, not both")
        if self.theta2_deg is not None and self.theta1_deg is None:
            raise InputError("robot.theta1_deg", "no such key beside theta2_deg", "theta1_deg")
        if self.magnetization_axis is not None:
            put("magnetization_axis", direction("robot.magnetization_axis", self.magnetization_axis))
        put("draft_deg", number("robot.draft_deg", self.draft_deg, least=0.0, below=90.0))
        choice("robot.draft_model", self.draft_model, get_args(DraftModel))
        put("center_of_mass_m", vector("robot.center_of_mass_m", self.center_of_mass_m))

    @classmethod
    def from_table(cls, value: object, section: str = "robot") -> Self:
        """Return the robot of a TOML table, whose keys are those of its shape and of this class.

        Parameters
        ----------
        value
            What the file holds.
        section
            The table's name, for errors.

        Raises
        ------
        InputError
            A key or a value that is refused.
        """
        table = require_table(section, value)
        if "shape" not in table:
            raise InputError(f"{section}.shape", "no such key", " or ".join(SHAPES))
        shape = SHAPES[choice(f"{section}.shape", table["shape"], list(SHAPES))]
        of_shape = [f.name for f in fields(shape)]
        of_robot = [f.name for f in fields(cls) if f.name != "shape"]
        required = [*required_keys(shape), *required_keys(cls)]
        known_keys(section, table, ["shape", *of_shape, *of_robot], required)
        made: Shape = shape(**{key: entry for key, entry in table.items() if key in of_shape})  # type: ignore[arg-type]
        return cls(shape=made, **{key: entry for key, entry in table.items() if key in of_robot})  # type: ignore[arg-type]

    def to_table(self) -> dict[str, object]:
        """Return the TOML table that `from_table` reads."""
        table = as_section(self)
        del table["shape"]
        return {"shape": self.shape.kind, **as_section(self.shape), **table}

    def with_draft(self, draft_deg: float) -> Robot:
        """Return this robot with another draft.

        Parameters
        ----------
        draft_deg
            Inward draft of the sides, degrees.
        """
        return replace(self, draft_deg=draft_deg)

    def with_magnetization(self, theta1_deg: float, theta2_deg: float) -> Robot:
        """Return this robot with another magnetic axis.

        Parameters
        ----------
        theta1_deg, theta2_deg
            θ1, off the long axis, and θ2, about it, degrees.
        """
        return replace(self, magnetization_axis=None, theta1_deg=theta1_deg, theta2_deg=theta2_deg)

    @property
    def magnetic_axis(self) -> Vector:
        """Unit magnetic axis u, body frame."""
        if self.magnetization_axis is not None:
            return self.magnetization_axis
        sin1, cos1 = _sin_cos(self.theta1_deg or 0.0)
        sin2, cos2 = _sin_cos(self.theta2_deg or 0.0)
        return sin2 * sin1, cos1, cos2 * sin1

    @property
    def magnetic_moment_A_m2(self) -> Vector:
        """Magnetic moment V_m |E| u, A m², body frame."""
        volume = self.body().volume_m3 if self.magnetic_volume_m3 is None else self.magnetic_volume_m3
        x, y, z = (volume * self.magnetization_A_per_m * component for component in self.magnetic_axis)
        return x, y, z

    @property
    def total_mass_kg(self) -> float:
        """Mass, from the density and the body's volume where `mass_kg` is not given, kg."""
        if self.mass_kg is not None:
            return self.mass_kg
        assert self.density_kg_per_m3 is not None
        return self.density_kg_per_m3 * self.body().volume_m3

    def body(self) -> _core.Body:
        """Return the native body.

        Raises
        ------
        InputError
            A hull without volume or not around its centre of mass, a draft that makes a face vanish, or a centre of
            mass outside the body.
        """
        return _body(self.shape, self.draft_deg, self.draft_model, self.center_of_mass_m)


def _sin_cos(angle_deg: float) -> tuple[float, float]:
    # Exact at multiples of 90°, and θ and 360° - θ are mirror images to the bit.
    angle = fmod(angle_deg, 360.0)
    quarter = round(angle / 90.0)
    rest = radians(angle - 90.0 * quarter)
    s, c = sin(rest), cos(rest)
    return ((s, c), (c, -s), (-s, -c), (-c, s))[quarter % 4]


@lru_cache(maxsize=256)
def _body(shape: Shape, draft_deg: float, draft_model: DraftModel, center_of_mass_m: Vector) -> _core.Body:
    try:
        body = shape.body(radians(draft_deg), draft_model == "as_released")
        return body.with_center_of_mass(center_of_mass_m) if any(center_of_mass_m) else body
    except InputError:
        raise
    except ValueError as error:
        raise core_error(error) from None
