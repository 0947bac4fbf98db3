"""What a diagnosis takes for granted, said in words: of its data, of the lab's numbers and of its own statistics."""

from __future__ import annotations

from dataclasses import asdict
from math import pi

import numpy as np

from ..dataset import Dataset
from ..effects.parameter import FORM_SHARE
from .fitting.fitter import Fitter
from .fitting.sandwich import MOST_FACTOR
from .gap.comparison import Comparison
from .how_far.held_out import folds
from .what.attribute import LAPSE, PRIOR, REFUSED, Attribution
from .what.margins import SECOND
from .what_next.rivals import PARTIAL_RIVALS, RIVALS

__all__ = ["assumptions"]


def assumptions(dataset: Dataset, comparison: Comparison, attribution: Attribution) -> tuple[str, ...]:
    """Return every assumption of a diagnosis, a sentence or two each."""
    simulator, sensor = comparison.simulator, comparison.dataset.sensor
    tried = sorted(c.names[0] for c in attribution.contenders if len(c.names) == 1)
    clock = "half a frame" if sensor.time_offset_s is None else f"{1e3 * sensor.time_offset_s:g} ms"
    known_to = asdict(dataset.tolerance)
    nominal = ", ".join(f"{name.replace('_', ' ')} {100.0 * share:g} %" for name, share in known_to.items())
    given = "magnetic_torque" in comparison.dataset.model_given
    stated = "as the dataset states" if given else "which the dataset leaves open"
    origin = f"{1e6 * sensor.origin_tolerance_m:g} µm"
    if sensor.height_tolerance_m > 0.0:
        origin += f", along z {1e6 * sensor.height_tolerance_m:g} µm"
    said = [
        f"The magnetic torque is taken by the scheme '{simulator.model.magnetic_torque}', {stated}.",
        "The robot starts at rest on the substrate, long axis along +y, when the field starts.",
        f"The sensor's nuisances are fitted in every hypothesis: clock within {clock}, origin within "
        f"{origin}, heading within {sensor.heading_tolerance_deg:g}°, scale within "
        f"{100.0 * sensor.scale_tolerance:g} %. Larger ones, but for z, are the effect camera_calibration, the same in "
        "all trials.",
        "A substrate that is tilted, rough or sticky is so alike under every trial's start. A friction that drifts "
        f"does so anew, and alike, in every trial, which is expected in {100.0 * FORM_SHARE:g} % of the cases.",
        f"The nominal numbers may be off by these standard deviations: {nominal}.",
        "What halving the step changes is part of the noise, around each hypothesis that counts for itself, and in "
        "each trial as much of it as makes the differences likeliest. One that comes near the best, and says the "
        "same against either's noise, may be held against the best's, and what is nearly as good is compared with the "
        "best by the mean over both.",
        "Data that were themselves computed in a coarse step"
        + ("" if given else " by the formats' own torque scheme")
        + " are no gap: the change to it is fitted in every hypothesis.",
        "A trial that a hypothesis cannot follow at all counts by its logarithm.",
        "A trial left out has its own clock and origin; the camera's heading and scale, the nominal numbers and the "
        "effects are fitted to the others.",
        f"{_weight(attribution.dispersion)} in probabilities and intervals.",
        f"Tried were {', '.join(tried)}." if tried else "No effect that was tried can be at work in these trials.",
        f"However strong the evidence, {100.0 * LAPSE:.0f} % of the probability belongs to all hypotheses alike; what "
        "may only say that nominal numbers are off within their tolerances gives its own to the nominal model, where "
        "that passes the predictive test.",
        f"A next trial is sought among the likeliest {RIVALS} that are tied, {PARTIAL_RIVALS} where none of them "
        "explains the gap.",
        f"Before anything is fitted, {100.0 * PRIOR[0]:g} % for no gap, {100.0 * PRIOR[1]:g} % for one effect (half of "
        "it where one alone is tried), "
        f"{100.0 * PRIOR[2]:g} % for two; no more than two are tried. A nominal model that fails the predictive test "
        f"counts {REFUSED:g} of that where something is likelier by as much.",
        f"A second effect must add a factor e^{SECOND:g} of evidence: one in another form than ours looks like two.",
        "Evidence is Laplace's approximation; a parameter costs no more than a unit information prior says, however "
        "sharply the data know it.",
        "Intervals are 90 % likelihood ratios along the ridge of the posterior, whose deviation counts up to "
        f"{MOST_FACTOR:g} times where trials pull in different directions or the fit stopped short, and what "
        "multiplies a nominal number, or adds to a nominal force, is known no better than that.",
    ]
    if dataset.sensor.tracked_point is None:
        said.append(
            "Positions are taken to be of the body's centre of mass: the sensor does not say, and so the nominal model "
            "or an offset of the mass alone leaves no gap, and is clearly likelier than with the centre of the shape."
            if sensor.tracked_point == "centre_of_mass"
            else "Positions are taken to be of the centre of the body's shape, for the sensor does not say."
        )
    if dataset.sensor.z_origin_tolerance_m is None and any(comparison.heights):
        said.append(
            "Heights are taken to be measured from a zero of their own in each trial, not from the substrate: the data "
            "clearly ask for it, and the sensor does not say."
            if sensor.height_tolerance_m > 0.0
            else "Heights are taken to be measured from the substrate, for the sensor does not say."
        )
    if attribution.refused:
        names = ", ".join(" + ".join(effects) for effects in attribution.refused)
        said.append(
            "What evidence ranks first as nearly alike, and the predictive test, trials left out or its own run "
            f"refuse (it comes no nearer to the data), counts {REFUSED:g} of that beside one that passes: {names}."
        )
    tracks = [trial.track for trial in comparison.dataset.trials if trial.track is not None]
    observed = [reader.observed for reader in comparison.readers]
    if any(one.frames - one.lost > len(one.time_s) and not one.slid_m for one in observed):
        said.append("Of long tracks, frames at even distances are compared; the others add next to nothing.")
    if any(one.slid_m for one in observed):
        said.append(
            "Of a robot that slides without a field, half of its way is compared, and that it slides as an outcome: "
            "where it catches again is up to the spot."
        )
    if any(one.heading_turn < 2.0 * pi for one in observed):
        why = "as the sensor says" if dataset.sensor.heading_of else "for all lie within half a turn"
        said.append(f"Headings are taken to be of an axis of which nobody knows which end is which, {why}.")
    if any(np.isnan(column).any() for track in tracks for column in track.channels.values()):
        said.append(
            "Lost frames, and frames after the robot has left the view, are not compared: it is not at rest then."
        )
    if not folds(Fitter(comparison)):
        said.append(
            "With one measured trial none can be left out: the gap is that of the fit itself, and proves nothing."
        )
    return tuple(said)


def _weight(dispersion: float) -> str:
    written = f"{dispersion:.3g}"
    return (
        "Every measured number counts for itself"
        if written == "1"
        else f"Every {written} measured numbers of a track count as one"
    )
