"""`Headline`: the numbers that the paper, or this package beside it, leads with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import nan
from typing import Literal

from ..presets import drive, preset_scenario
from ..robot import DraftModel
from ..scenario import Scenario

__all__ = ["HEADLINES", "Headline"]

Reading = Literal["speed_m_per_s", "drift_m", "twist_deg", "share_without_slip", "climb_deg"]

# Cycles of the field, the first of which is not measured.
_CYCLES = 6


@dataclass(frozen=True, kw_only=True, slots=True)
class Headline:
    """One number.

    Attributes
    ----------
    words
        What it is.
    reading
        What is read of the run: the speed (m/s), the drift (m) or the twist (degrees) after a cycle, the speed after
        the first turn over the one without slip, or the greatest slope climbed (degrees).
    paper
        The paper's number in the same unit; NaN if it has none.
    make
        Makes the scenario.
    """

    words: str
    reading: Reading
    paper: float
    make: Callable[[], Scenario]

    @property
    def units(self) -> str:
        """The unit of the number."""
        return {"speed_m_per_s": "m s-1", "drift_m": "m", "share_without_slip": "1"}.get(self.reading, "degree")


def _on_paper(frequency_Hz: float) -> Headline:
    def make() -> Scenario:
        field = drive(0.010, frequency_Hz)
        return preset_scenario("cuboid_on_paper", drive=field, duration_s=_CYCLES / frequency_Hz)

    return Headline(
        words=f"cuboid on paper, {frequency_Hz:g} Hz: speed over 2(L+H)f",
        reading="share_without_slip",
        paper=1.0 if frequency_Hz <= 10.0 else nan,
        make=make,
    )


def _erring(
    words: str, reading: Reading, paper: float, robot: str, draft_deg: float, draft_model: DraftModel = "geometric"
) -> Headline:
    def make() -> Scenario:
        scenario = preset_scenario(robot)
        return replace(scenario, robot=replace(scenario.robot, draft_deg=draft_deg, draft_model=draft_model))

    return Headline(words=words, reading=reading, paper=paper, make=make)


HEADLINES: dict[str, Headline] = {
    "speed_1Hz": _on_paper(1.0),
    "speed_5Hz": _on_paper(5.0),
    "speed_10Hz": _on_paper(10.0),
    "speed_15Hz": _on_paper(15.0),
    "spiked_speed": _erring("spiked, no errors: speed", "speed_m_per_s", 1093e-6, "spiked", 0.0),
    "spiked_ends_speed": _erring("spiked ends, no errors: speed", "speed_m_per_s", 1197e-6, "spiked_ends", 0.0),
    # The paper's words are "at most 50 µm up to 2°": it is the bound that stands here.
    "spiked_drift": _erring("spiked, φ = 2° as drawn: drift", "drift_m", 50e-6, "spiked", 2.0),
    "spiked_drift_released": _erring(
        "spiked, φ = 2° as released: drift", "drift_m", 50e-6, "spiked", 2.0, "as_released"
    ),
    "spiked_twist": _erring("spiked, φ = 5° as drawn: twist", "twist_deg", nan, "spiked", 5.0),
    "spiked_ends_twist": _erring("spiked ends, φ = 8° as drawn: twist", "twist_deg", nan, "spiked_ends", 8.0),
    "climb_paper": Headline(
        words="cuboid on paper: greatest slope",
        reading="climb_deg",
        paper=nan,
        make=lambda: preset_scenario("cuboid_up_paper"),
    ),
    "climb_aluminium": Headline(
        words="cuboid on aluminium: greatest slope",
        reading="climb_deg",
        paper=nan,
        make=lambda: preset_scenario("cuboid_up_aluminium"),
    ),
}
