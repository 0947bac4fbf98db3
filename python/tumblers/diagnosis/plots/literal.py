"""A user's own words on a figure."""

from __future__ import annotations

__all__ = ["literal", "shortened"]


def literal(text: str) -> str:
    """Return a text in which matplotlib finds no formula."""
    return text.replace("$", r"\$")


def shortened(text: str, most: int) -> str:
    """Return a text of at most so many characters, its middle left out where it is longer."""
    if len(text) <= most:
        return literal(text)
    tail = (most - 1) // 2
    return literal(f"{text[: most - 1 - tail]}…{text[len(text) - tail :]}")
