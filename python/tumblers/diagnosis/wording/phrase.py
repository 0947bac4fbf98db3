"""`Phrase`: what an effect says about the robot and the lab, in words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot, isfinite, pi

from ...dataset import Dataset
from ...effects.catalogue import CATALOGUE
from ...effects.parameter import Parameter
from ..quantity import enumerated, handy_unit, rounded, with_interval
from ..result import EffectEstimate, Interval

__all__ = ["Phrase", "meaning_of", "phrase_of", "title_of", "unit_of"]

_AXES = "xyz"
# Of a plausible range.
_DUST = 1e-4


@dataclass(frozen=True)
class Phrase:
    """A diagnosed effect in words.

    Attributes
    ----------
    cause
        A clause that says what is the matter: ``the substrate is not level``.
    amount
        A noun and its numbers, which can be a sentence's subject: ``a slope of 2.1 ± 0.3° along +y``.
    plural
        Whether the amount is several nouns.
    """

    cause: str
    amount: str
    plural: bool = False


def title_of(name: str) -> str:
    """Return an effect's name as words."""
    return name.replace("_", " ").replace("center", "centre")


def unit_of(name: str, key: str) -> str:
    """Return the unit of an effect's parameter, nothing for one that is not in the catalogue.

    Parameters
    ----------
    name, key
        Of the effect and of its parameter.
    """
    return next((p.unit for p in _parameters(name) if p.key == key), "")


def meaning_of(name: str, key: str) -> str:
    """Return what an effect's parameter is; see `unit_of`."""
    return next((p.meaning for p in _parameters(name) if p.key == key), key)


def phrase_of(effect: EffectEstimate, dataset: Dataset) -> Phrase:
    """Return a diagnosed effect in words.

    Parameters
    ----------
    effect
        Its name and its parameters.
    dataset
        Whose nominal numbers the effect changes.
    """
    found = _Found(effect, dataset)
    write = _WRITERS.get(effect.name)
    if write is not None and all(p.key in effect.parameters for p in _parameters(effect.name)):
        return write(found)
    kind = CATALOGUE.get(effect.name)
    lines = (kind.__doc__ or "").strip().splitlines() if kind is not None else []
    cause = lines[0].strip().rstrip(".") if lines else f"{title_of(effect.name)} is at work"
    numbers = ", ".join(f"{key} = {found.text(key)}" for key in effect.parameters)
    return Phrase(cause[:1].lower() + cause[1:], f"{title_of(effect.name)} with {numbers}" if numbers else cause)


def _parameters(name: str) -> Sequence[Parameter]:
    return CATALOGUE[name].parameters if name in CATALOGUE else ()


class _Found:
    """The numbers of a diagnosed effect."""

    def __init__(self, effect: EffectEstimate, dataset: Dataset) -> None:
        self.name, self.numbers, self.dataset = effect.name, effect.parameters, dataset

    def interval(self, key: str) -> Interval:
        return self.numbers[key]

    def value(self, key: str) -> float:
        return self.numbers[key].estimate

    def text(self, key: str) -> str:
        return with_interval(self.numbers[key], unit_of(self.name, key))

    def off(self, key: str) -> bool:
        """Whether the interval leaves the neutral value out, or where there is none the estimate is not neutral.

        By more than the dust that a fit leaves of no number.
        """
        p, found = next(p for p in _parameters(self.name) if p.key == key), self.numbers[key]
        dust = _DUST * (p.high - p.low)
        low, high = (end if isfinite(end) else found.estimate for end in (found.low, found.high))
        return low > p.neutral + dust or high < p.neutral - dust

    def entries(self, key: str) -> list[int]:
        """Which entries of a vector to name: those that are off zero, or the largest."""
        sizes = [abs(self.value(f"{key}[{i}]")) for i in range(3)]
        return [i for i in range(3) if self.off(f"{key}[{i}]")] or [sizes.index(max(sizes))]

    def towards(self, key: str) -> str:
        """Return the direction of a vector's largest entry that is off zero, such as ``+y``."""
        i = max(self.entries(key), key=lambda i: abs(self.value(f"{key}[{i}]")))
        return _along(i, self.value(f"{key}[{i}]"))

    def vector(self, key: str) -> str:
        return enumerated([f"{self.text(f'{key}[{i}]')} along {_AXES[i]}" for i in self.entries(key)])


def _along(axis: int, value: float) -> str:
    return f"{'-' if value < 0.0 else '+'}{_AXES[axis]}"


def _than_assumed(value: float, more: str, less: str) -> str:
    return f"{more if value >= 1.0 else less} than assumed"


def _factor(found: _Found, key: str, nominal: float, unit: str) -> str:
    text = f"{found.text(key)} times the nominal one"
    if not isfinite(nominal) or nominal == 0.0 or not isfinite(found.value(key)):
        return text
    scale, written = handy_unit(nominal, unit)
    after = f" {written}" if written else ""
    return f"{text} ({rounded(scale * nominal * found.value(key))} instead of {rounded(scale * nominal)}{after})"


def _misalignment(found: _Found) -> Phrase:
    return Phrase(
        "the robot's magnetic axis is not where it is assumed to be",
        f"a misalignment of {found.text('theta1_deg')} in the direction θ2 = {found.text('theta2_deg')}",
    )


def _strength(found: _Found) -> Phrase:
    magnet = _than_assumed(found.value("factor"), "stronger", "weaker")
    nominal = found.dataset.robot.magnetization_A_per_m
    return Phrase(f"the robot's magnet is {magnet}", f"a moment of {_factor(found, 'factor', nominal, 'A/m')}")


def _draft(found: _Found) -> Phrase:
    return Phrase("the robot's sides are tapered", f"a draft of {found.text('draft_deg')}")


def _size(found: _Found) -> Phrase:
    words = [
        f"{more if found.value(key) >= 1.0 else less}"
        for key, more, less in (("length_factor", "longer", "shorter"), ("height_factor", "higher", "flatter"))
        if found.off(key)
    ]
    return Phrase(
        f"the robot is {' and '.join(words) or 'of another size'} than drawn",
        f"a length of {found.text('length_factor')} and a height of {found.text('height_factor')} times the nominal",
        plural=True,
    )


def _mass_centre(found: _Found) -> Phrase:
    return Phrase(
        f"the robot's mass is off its centre, towards {found.towards('offset_m')} of the body",
        f"an offset of {found.vector('offset_m')}",
    )


def _friction(found: _Found) -> Phrase:
    nominal = found.dataset.substrate.friction_coefficient
    more = "more" if found.value("factor") >= 1.0 else "less"
    amount = f"a friction coefficient of {_factor(found, 'factor', nominal, '1')}"
    if not found.off("drift_per_s"):
        return Phrase(f"there is {more} friction than assumed", amount)
    drift = found.interval("drift_per_s")
    way, sign = ("grows", 100.0) if drift.estimate > 0.0 else ("falls", -100.0)
    low, high = sorted((sign * drift.low, sign * drift.high))
    share = with_interval(Interval(sign * drift.estimate, low, high), "%")
    if not found.off("factor"):
        return Phrase(
            f"friction {way} in the course of a trial",
            f"a friction coefficient that {way} from each trial's start by {share} per second",
        )
    return Phrase(
        f"there is {more} friction than assumed at first, and it {way} in the course of a trial",
        f"{amount} at each trial's start, {'growing' if sign > 0.0 else 'falling'} by {share} per second,",
    )


def _anisotropy(found: _Found) -> Phrase:
    along_x, along_y = found.interval("e_t_factor"), found.interval("e_o_factor")
    apart = along_x.high < along_y.low or along_y.high < along_x.low
    return Phrase(
        f"friction is {'' if apart else 'not as assumed, and perhaps '}not the same in all directions",
        f"friction of {found.text('e_t_factor')} along x and {found.text('e_o_factor')} along y times the nominal one",
    )


def _adhesion(found: _Found) -> Phrase:
    nominal = found.dataset.substrate.adhesion_N_per_m2
    return Phrase(
        f"a face in contact holds on {_than_assumed(found.value('factor'), 'more', 'less')}",
        f"an adhesion per area of {_factor(found, 'factor', nominal, 'N/m²')}",
    )


def _line_contact(found: _Found) -> Phrase:
    return Phrase(
        "an edge in contact holds on to the substrate, which a line without area does not",
        f"a strip of {found.text('width_m')} that holds on along the edge",
    )


def _electrostatic(found: _Found) -> Phrase:
    more = "more" if found.value("added_force_N") >= 0.0 else "less"
    return Phrase(
        f"the robot is attracted to the substrate {more} than assumed",
        f"an attraction that is off by {found.text('added_force_N')}",
    )


def _gradient(found: _Found) -> Phrase:
    exponent = "frequency_exponent"
    grows = found.off(exponent) and found.value(exponent) > 0.0
    growth = f", growing with the frequency to the power {found.text(exponent)} (stated at 10 Hz)" if grows else ""
    return Phrase(
        f"the robot is pulled along {found.towards('gradient_T_per_m')}{', more at high frequency' if grows else ''}",
        f"a stray field gradient of {found.vector('gradient_T_per_m')}{growth}",
    )


def _rolloff(found: _Found) -> Phrase:
    time = found.value("time_constant_s")
    corner = f", a corner at {rounded(1.0 / (2.0 * pi * time))} Hz" if time > 0.0 else ""
    return Phrase(
        "the coils' field falls with the frequency", f"a time constant of {found.text('time_constant_s')}{corner},"
    )


def _ellipticity(found: _Found) -> Phrase:
    return Phrase(
        "the rotating field is an ellipse, not a circle",
        f"a second phase of {found.text('amplitude_ratio')} times the first, early by {found.text('phase_error_deg')},",
    )


def _tilt(found: _Found) -> Phrase:
    slopes = {"x": "slope_x_deg", "y": "slope_y_deg"}
    named = [axis for axis, key in slopes.items() if found.off(key)]
    named = named or [max(slopes, key=lambda axis: abs(found.value(slopes[axis])))]
    towards = max(named, key=lambda axis: abs(found.value(slopes[axis])))
    return Phrase(
        f"the substrate is not level, it rises along {_along(_AXES.index(towards), found.value(slopes[towards]))}",
        f"a slope of {' and '.join(f'{found.text(slopes[axis])} along {axis}' for axis in named)}",
    )


def _eddy(found: _Found) -> Phrase:
    return Phrase(
        "the moving magnet is dragged on, as by eddy currents in a conducting substrate",
        f"a sheet conductance of {found.text('sheet_conductance_S')}",
    )


def _viscous(found: _Found) -> Phrase:
    return Phrase(
        "a fluid drags on the robot",
        f"a viscosity of {found.text('viscosity_Pa_s')} (water: 1 mPa s)",
    )


def _roughness(found: _Found) -> Phrase:
    waves = [hypot(found.value(f"cosine_m[{i}]"), found.value(f"sine_m[{i}]")) for i in range(3)]
    factor, unit = handy_unit(max(waves), "m")
    heights = ", ".join(rounded(factor * wave) for wave in waves)
    return Phrase(
        "the substrate is not flat",
        f"a relief of waves {heights} {unit} high, the longest over {found.text('wavelength_m')},",
    )


def _compliance(found: _Found) -> Phrase:
    return Phrase("the contact yields under load", f"a compliance of {found.text('compliance_m_per_N')}")


def _camera(found: _Found) -> Phrase:
    said = [f"a scale of {found.text('scale')}", f"a heading of {found.text('heading_deg')}"]
    more = {
        "origin_m[0]": "an origin at {} along x",
        "origin_m[1]": "an origin at {} along y",
        "time_offset_s": "a clock that says 0 at {}",
    }
    said += [words.format(found.text(key)) for key, words in more.items() if found.off(key)]
    return Phrase(
        "the camera is off, a gap of the measurement and not of the model",
        enumerated(said),
        plural=True,
    )


_WRITERS: dict[str, Callable[[_Found], Phrase]] = {
    "magnetization_misalignment": _misalignment,
    "magnetization_strength": _strength,
    "draft_angle": _draft,
    "size_error": _size,
    "center_of_mass_offset": _mass_centre,
    "friction_coefficient": _friction,
    "friction_anisotropy": _anisotropy,
    "adhesion_coefficient": _adhesion,
    "line_contact_adhesion": _line_contact,
    "electrostatic_force": _electrostatic,
    "stray_field_gradient": _gradient,
    "field_rolloff": _rolloff,
    "field_ellipticity": _ellipticity,
    "substrate_tilt": _tilt,
    "eddy_current_drag": _eddy,
    "viscous_drag": _viscous,
    "surface_roughness": _roughness,
    "contact_compliance": _compliance,
    "camera_calibration": _camera,
}
