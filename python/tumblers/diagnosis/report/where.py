"""The report's part on where the gap lies."""

from __future__ import annotations

from html import escape

import numpy as np

from ...page import bar, data_table, figure, grid, text
from ..diagnosis import Diagnosis
from ..plots.heat_map import plot_heat_map
from ..plots.svg import WIDTH_IN, svg_bytes
from ..plots.wrench import By, averages, plot_wrench
from ..quantity import percent, plain, sigmas, with_sigma
from ..result import Floats
from ..wording.words import region_words

__all__ = ["where_part", "wrench_part"]

_GROUPS: tuple[tuple[By, str], ...] = (
    ("frequency", "Frequency"),
    ("phase", "Phase of the cycle"),
    ("mode", "Contact"),
    ("place", "Place along y"),
)


def where_part(diagnosis: Diagnosis) -> str:
    """Return the regions and the maps of the gap, as HTML."""
    rows = []
    for region in diagnosis.where:
        axis, extent = region_words(region)
        above = sigmas(region.sigmas) if region.sigmas is not None else ""
        there = "" if region.what is None else f", as with {region.what} there alone (not held against trials left out)"
        rows.append(
            [escape(axis), escape(extent + there), bar(region.share_of_gap, percent(region.share_of_gap)), above]
        )
    table = data_table(["axis", "region", "share of the gap", "sigmas"], rows, numbers=(3,))
    maps = []
    for heat_map in diagnosis.heat_maps:
        if not np.isfinite(heat_map.values).any():
            continue
        height = 1.5 + 0.27 * len(heat_map.row_labels)
        svg = svg_bytes(lambda f, drawn=heat_map: plot_heat_map(drawn, f.subplots()), WIDTH_IN, height)  # type: ignore[misc]
        maps.append(figure(svg, heat_map.title))
    if not rows and not maps:
        return text("No part of the data stands out above the noise.")
    words = (
        "Differences of the nominal model, the sensor's nuisances fitted, the nominal numbers as the verdict's effects "
        "ask for them, and as much of the computed motion taken for uncertain as is with these: so they may be other "
        "than in How far. Shares are of the squared difference above the noise, each axis for itself, so that they do "
        "not add up. In the maps 1 is what noise alone gives."
    )
    return text(words, "soft") + (table or text("No region stands out above the noise.")) + grid(maps)


def wrench_part(diagnosis: Diagnosis) -> str:
    """Return the force and the torque that the model lacks, as HTML."""
    missing = diagnosis.missing_wrench
    if missing is None:
        return text("Not estimated: it takes a track that parts from the nominal model.", "soft")
    groups = [(by, words) for by, words in _GROUPS if averages(missing, by)]
    pictures, rows = [], []
    for by, words in groups:
        for part in ("force", "torque"):
            svg = svg_bytes(lambda f, b=by, p=part: plot_wrench(missing, b, p, f.subplots()), WIDTH_IN, 2.7)  # type: ignore[misc]
            pictures.append(figure(svg, f"Missing {part}: {words.lower()}"))
        for label, mean in averages(missing, by).items():
            units = ["N"] * 3 + ["N m"] * 3
            cells = [
                with_sigma(float(w), float(s), unit) for w, s, unit in zip(mean.wrench, mean.sigma, units, strict=True)
            ]
            rows.append([escape(words), escape(label), *map(escape, cells)])
    heads = ["", "", "Fx", "Fy", "Fz", "Tx", "Ty", "Tz"]
    force, torque = _taken(missing.prior_sigma[:, 0], "N"), _taken(missing.prior_sigma[:, 3], "N m")
    words = (
        "The force and the torque (substrate frame) that must be added along the runs for the nominal model to follow "
        "the tracks, with one standard deviation. Before the data they were taken as 0 ± "
        f"{force} and 0 ± {torque}: a hollow marker is an average of which the data say "
        "little more, such as a force that friction holds. A small arrow at the edge stands for an average beyond it, "
        "for which see the numbers."
    )
    table = data_table(heads, rows, numbers=range(2, 8))
    return text(words, "soft") + grid(pictures) + f"<details><summary>Numbers</summary>{table}</details>\n"


def _taken(sigmas_before: Floats, unit: str) -> str:
    """Return what was assumed of some windows, of which trials in weaker fields may lack less."""
    low, high = plain(float(sigmas_before.min()), unit), plain(float(sigmas_before.max()), unit)
    return low if low == high else f"{low} to {high}"
