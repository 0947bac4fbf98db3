"""`Row`: the paper's value and ours, side by side."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any, Literal

from .choice import Choices
from .claim import Claim

__all__ = ["Kind", "Row", "Trial", "Verdict", "shown"]

Verdict = Literal["match", "differs"]
Kind = Literal["match", "explained", "moved at a cost", "open"]


@dataclass(frozen=True, slots=True)
class Trial:
    """What one suspect made of a row.

    Attributes
    ----------
    suspect
        The change in words.
    ours
        The value with it; words where it could not be run.
    verdict
        ``match`` or ``differs``.
    matching, of
        How many of the result's rows of the same set match with the change, and how many there are.
    """

    suspect: str
    ours: float | str
    verdict: Verdict
    matching: int
    of: int


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """The paper's value and ours, side by side.

    Attributes
    ----------
    number, name
        The result's number in the paper's order, and its name.
    claim
        What the paper says.
    set_name, choices
        The named set of choices that ours was run with, and the choices.
    ours, verdict
        Our value, and whether it agrees.
    trials
        What each suspect made of it, where it differs.
    matching, of
        How many of the result's rows of the same set match, and how many there are.
    """

    number: int
    name: str
    claim: Claim
    set_name: str
    choices: Choices
    ours: float | str
    verdict: Verdict
    trials: tuple[Trial, ...] = ()
    matching: int = 0
    of: int = 0

    @property
    def moving(self) -> tuple[Trial, ...]:
        """The trials that move our value to the paper's, those first with which most rows match."""
        found = [trial for trial in self.trials if trial.verdict == "match"]
        return tuple(sorted(found, key=lambda trial: -trial.matching))

    @property
    def kind(self) -> Kind:
        """Whether it matches, and if not, whether a change of one choice moves our value to the paper's.

        It is explained if more of the set's rows match with the change than without it, moved at a cost if not.
        """
        if self.verdict == "match":
            return "match"
        if not self.moving:
            return "open"
        return "explained" if any(trial.matching > self.matching for trial in self.moving) else "moved at a cost"

    @property
    def why(self) -> str:
        """Why it differs: what moves it to the paper's value, or what each suspect gave; a note, if it matches."""
        if self.verdict == "match":
            return self.claim.note
        note = [self.claim.note] if self.claim.note else []
        if not self.trials:
            return " ".join([*note, "no choice has been tried"])
        if self.moving:
            lead = "shown by a run" if self.kind == "explained" else "moved by a run, at the cost of other rows"
            return " ".join([*note, f"{lead}: {'; '.join(self._moves())}"])
        gave: dict[str, list[str]] = {}
        for trial in self.trials:
            gave.setdefault(shown(trial.ours), []).append(trial.suspect)
        unmoved = gave.pop(shown(self.ours), [])
        parts = [f"{value} with {', '.join(names)}" for value, names in gave.items()]
        if unmoved:
            parts.append(f"unchanged with {', '.join(unmoved)}")
        return " ".join([*note, f"none of the {len(self.trials)} choices tried explains it: {'; '.join(parts)}"])

    def _moves(self) -> list[str]:
        """Return what each value that meets the paper's comes from, with how many rows of the set then match."""
        gave: dict[tuple[str, int], list[str]] = {}
        for trial in self.moving:
            gave.setdefault((shown(trial.ours), trial.matching), []).append(trial.suspect)
        return [
            f"{value} with {' or '.join(names)} ({matching} of the set's {self.of} rows then match, {self.matching} "
            "before)"
            for (value, matching), names in gave.items()
        ]

    def table(self) -> dict[str, Any]:
        """Return the row as JSON holds it."""
        return {
            "number": self.number,
            "name": self.name,
            "robot": self.claim.robot,
            "quantity": self.claim.quantity,
            "paper": self.claim.paper,
            "ours": _json(self.ours),
            "verdict": self.verdict,
            "why": self.why,
            "kind": self.kind,
            "moved_by": [trial.suspect for trial in self.moving],
            "set": self.set_name,
            "tolerance": self.claim.tolerance.words,
            "tolerance_reason": self.claim.tolerance.reason,
            **asdict(self.choices),
            "tried": [{**asdict(trial), "ours": _json(trial.ours)} for trial in self.trials],
        }


def shown(value: float | str) -> str:
    """Return a value as a reader wants it: words as they are, numbers with four digits."""
    if isinstance(value, str):
        return value
    if not isfinite(value):
        return "no value"
    return f"{value:.4g}" if value and abs(value) < 1e-3 else f"{value:z.4g}"


def _json(value: float | str) -> float | str | None:
    return value if isinstance(value, str) or isfinite(value) else None
