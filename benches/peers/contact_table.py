"""Contacts of several engines as one Markdown table, and what its figures mean."""

from __future__ import annotations

from .case import FINE_STEP_S, SLIDING_M_PER_S, STEP_S
from .contact import TRANSIENT_S, Contact
from .page import table

__all__ = ["contact_table"]


def contact_table(contacts: list[Contact]) -> str:
    """Return a table with a column for each engine, and the definitions of its rows.

    Parameters
    ----------
    contacts
        Of engines that ran the same robots.
    """
    rows = []
    for i, tumble in enumerate(contacts[0].tumbles):
        found = [contact.tumbles[i] for contact in contacts]
        rows.append([f"{tumble.robot}: speed, µm/s", *(f"{each.speed_um_per_s:.5g}" for each in found)])
        depths = (f"{_shown(each.greatest_um)} / {_shown(each.median_um)}" for each in found)
        rows.append([f"{tumble.robot}: penetration, greatest / median, µm", *depths])
    rows.append(["penetration at rest, µm", *(_shown(contact.rest_um) for contact in contacts)])
    rows.append(["slip on a slope below friction, µm/s", *(_shown(contact.creep_um_per_s) for contact in contacts)])
    lifts = (
        (f"lift of a sliding box, step {1e6 * step_s:.3g} µs, µm", [_shown(value) for value in values])
        for step_s, values in (
            (STEP_S, [contact.lift_um for contact in contacts]),
            (FINE_STEP_S, [contact.fine_lift_um for contact in contacts]),
        )
    )
    rows += [[words, *values] for words, values in lifts]
    definitions = f"""All of it is measured in the poses, by the same arithmetic for every engine:

- *penetration*: depth of the lowest corner below the plane, after the first {TRANSIENT_S:g} s of a run; at rest, after
  a second on a face under its weight and F_elect. What is below 1e-9 µm is the rounding of the poses.
- *slip*: of the cuboid down a slope of 10° with μ = 0.3, which holds up to 16.7°, in the second second; no field.
- *lift*: greatest height of the lowest corner of the cuboid, 100 µm high, that starts on the plane, settled, at
  {SLIDING_M_PER_S:.3g} m/s with μ = 0.5, and should slide and stop. That is the Froude number v²/(g L) of 6 m/s and a
  box a thousand times as large, and the finer step is that box's 2 ms."""
    return table(["", *(contact.engine for contact in contacts)], rows) + "\n\n" + definitions


def _shown(value: float) -> str:
    # A float64 of these poses resolves no less.
    return "< 1e-9" if abs(value) < 1e-9 else f"{value:.3g}"
