"""Margins, in ln of a likelihood, and shares, by which what may be as good is told from what is not."""

from __future__ import annotations

__all__ = ["AS_GOOD", "CLEAR", "ENOUGH", "NEAR", "OPEN", "SECOND"]

# What is likelier by so much asks for another round.
ENOUGH = 0.3125
# What is likelier by so much is worth another look.
CLEAR = 1.25
# What is less than about e^12 behind the best is open, and fitted as far: a total moves by some e^3 with the place
# around which its noise is measured, and by more with where a fit stopped.
OPEN = 12.0
# What comes so near to the best is held against its own noise.
NEAR = 18.75
# The odds that a second effect must win beside: one effect in a form that is not the catalogue's leaves what a second
# could explain as well. Chosen from twelve datasets with a known truth in which two effects were named: where one was
# at work the second had won 2.4 to 7.4 over the best single one, where two were 20 or more.
SECOND = 10.0
# Another effect is fitted in the place of one where it leaves no more than this share of what that takes off the
# objective.
AS_GOOD = 0.5
